#include "palpate/touch/devices/script.h"

namespace palpate {

Script::Script(Path path) : path_(std::move(path)) {}

void Script::open() {
    check(path_, "script");
    start_.reset();
}

bool Script::read(double now, DeviceState& state) noexcept {
    if (!start_) start_ = now;
    state = {.pose = pose(path_, now - *start_), .time = now};
    return true;
}

}  // namespace palpate
