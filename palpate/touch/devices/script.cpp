#include "palpate/touch/devices/script.h"

#include "palpate/base/error.h"

namespace palpate {

Script::Script(Path path) : path_(std::move(path)) {}

void Script::open() {
    if (path_.empty()) throw Error("no waypoint", "script", "give it a path of one at least");
    start_.reset();
}

bool Script::read(double now, Hand& hand) noexcept {
    if (!start_) start_ = now;
    hand = {.position = position(path_, now - *start_), .time = now};
    return true;
}

}  // namespace palpate
