#pragma once
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>

namespace palpate {

/// The one exception of Palpate: a file, a device, a context, a shader or an argument that cannot be used.
/// what() is a single line, "WHAT in WHERE; REMEDY": what is wrong, in which file or device, and what to do.
/// In a step and in a haptic loop nothing throws: what they are given is looked at before they begin.
class Error : public std::runtime_error {
 public:
    Error(std::string_view what, std::string_view where, std::string_view remedy);

    /// The line of an Error that was thrown in another process.
    explicit Error(const std::string& line);
};

/// For messages: "1 file", "3 files".
inline std::string counted(std::size_t count, std::string_view one) {
    return std::to_string(count) + ' ' + std::string(one) + (count == 1 ? "" : "s");
}

}  // namespace palpate
