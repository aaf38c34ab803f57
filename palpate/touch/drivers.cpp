#include "palpate/touch/drivers.h"

#include "palpate/base/error.h"
#include "palpate/base/names.h"
#include "palpate/touch/devices/playback.h"
#include "palpate/touch/devices/script.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {

std::span<const Driver> drivers() {
    using Settings = const DeviceSettings&;
    using Made = std::unique_ptr<Device>;
    static constexpr Driver all[] = {
        {"hand", "a simulated person, who yields to forces", DeviceNeeds::path,
         [](Settings of) -> Made { return std::make_unique<VirtualHand>(of.path, of.hand); }},
        {"script", "a path, whatever forces act", DeviceNeeds::path,
         [](Settings of) -> Made { return std::make_unique<Script>(of.path); }},
        {"mouse", "a pointer in a picture", DeviceNeeds::pointer,
         [](Settings of) -> Made { return std::make_unique<Mouse>(of.mouse, of.replay); }},
        {"playback", "a log of another device", DeviceNeeds::log,
         [](Settings of) -> Made { return std::make_unique<Playback>(read_log(of.log)); }},
    };
    return all;
}

const Driver& driver(std::string_view name) {
    const auto all = drivers();
    const auto nearest =
        std::ranges::min_element(all, {}, [&](const Driver& d) { return edits(d.name, name); });
    if (nearest->name == name) return *nearest;
    throw Error(fmt::format("no device \"{}\"", name), "the list of devices",
                fmt::format("did you mean \"{}\"? There are {}", nearest->name, names_of_drivers()));
}

std::string names_of_drivers(std::optional<DeviceNeeds> needs) {
    std::string list;
    for (const Driver& one : drivers())
        if (!needs || one.needs == *needs) list += (list.empty() ? "" : ", ") + std::string(one.name);
    return list;
}

}  // namespace palpate
