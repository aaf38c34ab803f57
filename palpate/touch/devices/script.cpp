#include "palpate/touch/devices/script.h"

namespace palpate {

Script::Script(Path path) : path_(std::move(path)) {}

void Script::open() {
    check(path_, "script");
    start_.reset();
}

bool Script::read(double now, Hand& hand) noexcept {
    if (!start_) start_ = now;
    hand = {.position = position(path_, now - *start_), .time = now};
    return true;
}

}  // namespace palpate
