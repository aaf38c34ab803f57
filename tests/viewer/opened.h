#pragma once
#include "app/viewer/viewer.h"
#include "palpate/base/clock.h"

#include <chrono>
#include <thread>

namespace palpate {

/// Goes on until what is being opened is open, or was refused; a minute at most.
inline void wait_until_open(Viewer& viewer) {
    const double start = now();
    while (viewer.importing() && now() - start < 60) {
        viewer.advance(0);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
}

}  // namespace palpate
