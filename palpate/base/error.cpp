#include "palpate/base/error.h"

namespace palpate {
namespace {

std::string one_line(std::string text) {
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    return text;
}

}  // namespace

Error::Error(std::string_view what, std::string_view where, std::string_view remedy)
    : Error(std::string(what) + " in " + std::string(where) + "; " + std::string(remedy)) {}

Error::Error(const std::string& line) : std::runtime_error(one_line(line)) {}

Error missing_part(std::string_view part, std::string_view where, std::string_view instead) {
    return Error("Palpate was built without its part " + std::string(part), where,
                 std::string(instead) + ", or build with -D PALPATE_PARTS=all");
}

}  // namespace palpate
