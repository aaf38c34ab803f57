#pragma once
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

namespace palpate {

/// Metres per unit of length, by its name in small letters ("mm", "micron"); nothing if the name is unknown.
inline std::optional<double> metres_of(std::string_view name) {
    constexpr std::pair<std::string_view, double> all[] = {
        {"m", 1},
        {"meter", 1},
        {"meters", 1},
        {"metre", 1},
        {"metres", 1},
        {"cm", 1e-2},
        {"centimeter", 1e-2},
        {"centimeters", 1e-2},
        {"centimetre", 1e-2},
        {"centimetres", 1e-2},
        {"mm", 1e-3},
        {"millimeter", 1e-3},
        {"millimeters", 1e-3},
        {"millimetre", 1e-3},
        {"millimetres", 1e-3},
        {"um", 1e-6},
        {"\xc2\xb5m", 1e-6},
        {"\xce\xbcm", 1e-6},
        {"\xb5m", 1e-6},
        {"micron", 1e-6},
        {"microns", 1e-6},
        {"micrometer", 1e-6},
        {"micrometers", 1e-6},
        {"micrometre", 1e-6},
        {"micrometres", 1e-6},
        {"nm", 1e-9},
        {"nanometer", 1e-9},
        {"nanometers", 1e-9},
        {"nanometre", 1e-9},
        {"nanometres", 1e-9},
        {"in", 0.0254},
        {"inch", 0.0254},
        {"inches", 0.0254},
        {"ft", 0.3048},
        {"foot", 0.3048},
        {"feet", 0.3048},
    };
    const auto found = std::ranges::find(all, name, &std::pair<std::string_view, double>::first);
    return found == std::end(all) ? std::nullopt : std::optional(found->second);
}

}  // namespace palpate
