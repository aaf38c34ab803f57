#include "palpate/touch/emergency.h"

#include "palpate/base/error.h"
#include "palpate/base/halt.h"
#include "palpate/touch/touch.h"

#include <poll.h>

#include <array>
#include <atomic>
#include <thread>

namespace palpate {
namespace {

constexpr int longest_tick = 20;  // ms, how long to wait for ticks under way, in all

// Data of a signal handler, so at fixed places.
std::array<std::atomic<Touch*>, 256> touches{};
std::atomic<int> visitors = 0;  // how many threads may be using one of them

template <class Act>
void for_each_touch(const Act& act) {
    for (auto& place : touches)
        if (Touch* touch = place.load()) act(*touch);
}

}  // namespace

void let_go_of_all() noexcept {
    ++visitors;
    for_each_touch([](Touch& touch) { touch.let_go(); });
    // A tick under way may have written a force afterwards.
    int ms = 0;
    for_each_touch([&](Touch& touch) {
        for (; ms < longest_tick && touch.is_ticking(); ++ms) poll(nullptr, 0, 1);
        touch.let_go();
    });
    --visitors;
}

void let_go_at_halt() {
    on_halt([](Halt) noexcept { let_go_of_all(); });
}

void add_touch(Touch& touch) {
    for (auto& place : touches)
        if (Touch* empty = nullptr; place.compare_exchange_strong(empty, &touch)) return;
    throw Error("too many devices at once", touch.device().name, "close some of them");
}

void remove_touch(Touch& touch) noexcept {
    for (auto& place : touches)
        if (Touch* same = &touch; place.compare_exchange_strong(same, nullptr)) break;
    while (visitors > 0) std::this_thread::yield();
}

}  // namespace palpate
