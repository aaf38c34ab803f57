#pragma once
#include "palpate/viewer/viewer.h"

#include <chrono>
#include <thread>

namespace palpate {

/// Goes on, so many frames at a time, until something is so: however long that takes on a busy machine. What
/// hangs is ended by ctest.
template <class Condition>
void wait_until(Viewer& viewer, int frames, Condition is_so) {
    while (!is_so()) {
        viewer.advance(frames);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

/// Until what is being opened is open, or was refused.
inline void wait_until_open(Viewer& viewer) {
    wait_until(viewer, 0, [&] { return !viewer.importing(); });
}

}  // namespace palpate
