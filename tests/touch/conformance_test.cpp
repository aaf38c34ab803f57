// All devices that come with Palpate, by themselves and decorated, and one of a program outside of
// it.
#include "tests/touch/conformance.h"

#include "examples/programs/pen.h"
#include "palpate/touch/devices/clutch.h"
#include "palpate/touch/devices/faulty.h"
#include "palpate/touch/devices/mouse.h"
#include "palpate/touch/devices/playback.h"
#include "palpate/touch/devices/recorder.h"
#include "palpate/touch/devices/scaled.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"

namespace palpate {
namespace {

const Path path = {{0, vec3(0, 0.1f, 0)}, {0.5, vec3(0.02f, -0.01f, 0)}, {2, vec3(0.1f, 0.05f, -0.03f)}};

// A hand, and what `around` puts around it.
template <class Around>
std::function<Subject()> hand_in(Around around, VirtualHandSettings settings = {}) {
    return [=] {
        auto hand = std::make_unique<VirtualHand>(path, settings);
        const VirtualHand* inside = hand.get();
        return Subject{around(std::move(hand)), [inside] { return Wrench{inside->force()}; }};
    };
}

template <class D, class... With>
auto in_a(With... with) {
    return [=](std::unique_ptr<Device> inner) -> std::unique_ptr<Device> {
        return std::make_unique<D>(std::move(inner), with...);
    };
}

template <class D, class... With>
std::function<Subject()> simple(With... with) {
    return [=] { return Subject{std::make_unique<D>(with...)}; };
}

Log some_log() {
    Log log{.device = "a log", .rate = 500, .ticks = {}};
    for (int i = 0; i < 700; ++i)
        log.ticks.push_back({2 + i * 2e-3, {{dvec3(i, 0, 0)}, 1.999 + i * 2e-3, 0, unsigned(i / 100)}, {}});
    return log;
}

const std::vector<PointerEvent> moves = {
    {0.01, vec2(100, 20)}, {0.02, vec2(300, 40), 1}, {1.5, vec2(310, 700), 0, 2}};

const auto alone = [](std::unique_ptr<Device> device) { return device; };
const auto no_sleep = [](double) {};

Fault fault(FaultKind kind, double from, double to) { return {.kind = kind, .from = from, .to = to}; }

std::unique_ptr<Device> wrapped_often(std::unique_ptr<Device> device) {
    return in_a<Recorder>(3.0)(
        in_a<Clutch>(1u)(in_a<Scaled>(Scale{.motion = 3})(in_a<Recorder>(1.0)(std::move(device)))));
}

const std::vector<Specimen> all = {
    {"Pen",
     [] {
         auto pen = std::make_unique<Pen>();
         const Pen* inside = pen.get();
         return Subject{std::move(pen), [inside] { return inside->wrench(); }};
     }},
    {"Hand", hand_in(alone)},
    {"QuantisedLateHand", hand_in(alone, {.resolution = 2.5e-5, .delay = 0.0025})},
    {"Script", simple<Script>(path)},
    {"Mouse", simple<Mouse>(MouseSettings{})},
    {"ReplayedMouse", simple<Mouse>(MouseSettings{}, moves)},
    {"Playback", simple<Playback>(some_log())},
    {"Scaled", hand_in(in_a<Scaled>(Scale{.about = vec3(1, 2, 3), .motion = 0.1f}))},
    {"Clutch", hand_in(in_a<Clutch>())},
    {"Recorder", hand_in(in_a<Recorder>(1.0))},
    {"FaultyWithoutFaults", hand_in(in_a<Faulty>(std::vector<Fault>{}, no_sleep))},
    {"FrozenRefusingStalling",
     hand_in(in_a<Faulty>(std::vector{fault(FaultKind::freeze, 0.5, 0.7), fault(FaultKind::refuse, 0.6, 0.9),
                                      fault(FaultKind::stall, 1, 1.2), fault(FaultKind::jump, 1.5, 2)},
                          no_sleep))},
    {"ThereAndGone",
     hand_in(in_a<Faulty>(std::vector{fault(FaultKind::vanish, 0, 0.05), fault(FaultKind::vanish, 1, 2)},
                          no_sleep)),
     false},
    {"AllAroundTheHand", hand_in(wrapped_often)},
};

TEST(Allocations, AreCountedByThread) {
    const std::size_t before = allocations();
    std::vector<int> one(3), two(5);
    struct alignas(64) Wide {
        char bytes[64];
    };
    auto three = std::make_unique<Wide[]>(2);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(three.get()) % 64, 0u);
    EXPECT_EQ(allocations() - before, 3u) << one[2] + two[4];
    std::size_t elsewhere = 1;
    std::thread([&] { elsewhere = allocations(); }).join();
    EXPECT_EQ(elsewhere, 0u);
}

}  // namespace

INSTANTIATE_TEST_SUITE_P(Devices, Conformance, testing::ValuesIn(all), specimen_name);

}  // namespace palpate
