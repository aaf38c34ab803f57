#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate {

/// The one exception of Palpate: a file, a device, a context, a shader or an argument that cannot be used.
/// what() is a single line, "WHAT in WHERE; REMEDY": what is wrong, in which file or device, and what to do.
/// Nothing throws inside a step or a haptic loop: their input is checked before they begin.
class Error : public std::runtime_error {
 public:
    Error(std::string_view what, std::string_view where, std::string_view remedy);

    /// From the line of an Error that was thrown in another process.
    explicit Error(const std::string& line);
};

/// For what belongs to a part of Palpate (PALPATE_PARTS) that was left out of this build. `instead`: what to
/// do other than to build that part.
Error missing_part(std::string_view part, std::string_view where, std::string_view instead);

/// For messages: "1 file", "3 files".
inline std::string counted(std::size_t count, std::string_view one) {
    return std::to_string(count) + ' ' + std::string(one) + (count == 1 ? "" : "s");
}

}  // namespace palpate
