// The loop on the wall's clock. How well it keeps time is measured by palpate bench touch; here only what
// must hold however late the machine lets it run.
#include "palpate/touch/loop.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/triple_buffer.h"
#include "palpate/touch/devices/script.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "tests/shapes.h"
#include "tests/touch/allocations.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace palpate {
namespace {

void pass(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Counts what is asked of it, and what the thread that asks allocates.
class Counting final : public Device {
 public:
    DeviceSpec spec() const override { return {}; }
    void open() override {}
    bool read(double now, DeviceState& state) noexcept override {
        while (hangs) pass(0.001);
        state.time = now;
        ++reads;
        const std::size_t count = allocations();
        if (reads > 1) allocated += count - before_;
        before_ = count;
        return true;
    }
    bool write(const Wrench&) noexcept override { return true; }
    void stop() noexcept override { ++stops; }

    std::atomic<long> reads = 0, stops = 0;
    std::atomic<std::size_t> allocated = 0;
    std::atomic<bool> hangs = false;

 private:
    std::size_t before_ = 0;
};

struct Counted {
    Counting* device;
    std::unique_ptr<Touch> touch;
    Counted() {
        auto made = std::make_unique<Counting>();
        device = made.get();
        touch = std::make_unique<Touch>(std::move(made), TouchSettings{});
    }
};

TEST(TouchLoop, TicksAllItsTouchesAndEnds) {
    Counted one, two;
    {
        TouchLoop loop({one.touch.get(), two.touch.get()});
        EXPECT_FALSE(loop.granted().schedule.empty());
        while (one.device->reads < 50) pass(0.001);
        EXPECT_GT(loop.timing().periods.count(), 10u);
        EXPECT_GT(loop.timing().work.count(), 10u);
    }
    EXPECT_LE(std::abs(one.device->reads - two.device->reads), 0);
    EXPECT_GE(one.device->stops, 1);
    EXPECT_GE(two.device->stops, 1);
    EXPECT_EQ(one.device->allocated, 0u);
}

TEST(TouchLoop, IsNeverFasterThanItsRate) {
    for (double rate : {250.0, 1000.0, 4000.0}) {
        Counted one;
        const double start = now();
        TouchLoop loop({one.touch.get()}, {.rate = rate});
        while (one.device->reads < 100) pass(0.001);
        const long reads = one.device->reads;  // first: this thread may have to wait before it sees the clock
        EXPECT_LE(double(reads), rate * (now() - start) + 3) << rate;
    }
}

TEST(TouchLoop, ItsWatchdogStopsADeviceThatHangs) {
    Counted one;
    TouchLoop loop({one.touch.get()});
    while (one.device->reads < 20) pass(0.001);
    const long stops = one.device->stops;
    one.device->hangs = true;
    while (loop.times_stalled() == 0 || one.device->stops == stops) pass(0.001);
    one.device->hangs = false;
    const long reads = one.device->reads;
    while (one.device->reads < reads + 20) pass(0.001);  // it goes on
}

// A vendor's servo thread ticks, not ours, and hangs.
TEST(Watchdog, LetsGoOfWhatAForeignThreadLeavesAlone) {
    Counted one;
    Watchdog watchdog({one.touch.get()});
    std::atomic<bool> ends = false;
    std::thread servo([&] {
        for (; !ends; pass(0.001)) one.touch->tick(now());
    });
    while (one.device->reads < 20) pass(0.001);
    const long stops = one.device->stops;
    one.device->hangs = true;
    while (watchdog.times_stalled() == 0 || one.device->stops < stops + 3) pass(0.001);
    one.device->hangs = false;
    const long reads = one.device->reads;
    while (one.device->reads < reads + 20) pass(0.001);  // it goes on, from nothing
    EXPECT_EQ(one.touch->felt().last_reason, Held::stalled);
    ends = true;
    servo.join();
    EXPECT_THROW(Watchdog({nullptr}), Error);
}

TEST(TouchLoop, RefusesARateThatIsNone) {
    Counted one;
    for (double rate : {0.0, 100.0, 5000.0, -1.0, double(NAN)})
        EXPECT_THROW(TouchLoop({one.touch.get()}, {.rate = rate}), Error) << rate;
    for (double spin : {double(INFINITY), double(NAN), -1.0, 1.0})
        EXPECT_THROW(TouchLoop({one.touch.get()}, {.spin = spin}), Error) << spin;
    EXPECT_THROW(TouchLoop({nullptr}), Error);
}

// Surfaces come from one thread while another feels them and a third looks on; for the thread sanitizer too.
TEST(TouchLoop, SurfacesComeAndDentsGoWhileItRuns) {
    const Mesh mesh = block(vec3(-0.1f, -0.05f, -0.1f), vec3(0.1f, 0, 0.1f), 8);
    TouchSettings settings{.radius = 0.003, .feels = {{.stiffness = 300, .yield = 0.001}}};
    Touch touch(std::make_unique<VirtualHand>(
                    Path{{0, {0, 0.01f, 0}}, {0.1, {0, -0.01f, 0}}, {0.5, {0.05f, -0.01f, 0}}}),
                settings);
    TouchLoop loop({&touch});
    std::atomic<bool> ends = false;
    std::thread looks_on([&] {
        while (!ends) {
            const Felt felt = touch.felt();
            EXPECT_GE(felt.count, felt.lasting);
            EXPECT_LE(felt.count, most_dents);
        }
    });
    for (int frame = 0; frame < 40; ++frame) {
        std::vector<vec3> places = mesh.positions, speeds(places.size(), vec3(0, 0.01f, 0));
        for (vec3& p : places) p.y += 0.0001f * float(frame);
        const Touchable one[] = {{places, mesh.triangles, speeds}};
        touch.feel(Patch(one, touch.felt().proxy, 0.05f, now()));
        pass(0.005);
    }
    ends = true;
    looks_on.join();
}

TEST(TripleBuffer, TheReaderGetsWholeValuesAndTheNewestInTheEnd) {
    struct Pair {
        long a = 0, b = 0;
    };
    TripleBuffer<Pair> buffer;
    constexpr long last = 200'000;
    std::thread writes([&] {
        for (long i = 1; i <= last; ++i) {
            buffer.draft() = {i, -i};
            buffer.publish();
        }
    });
    long seen = 0;
    while (seen < last) {
        if (!buffer.fetch()) continue;
        const Pair& pair = buffer.shown();
        ASSERT_EQ(pair.a, -pair.b);
        ASSERT_GT(pair.a, seen);
        seen = pair.a;
    }
    writes.join();
    EXPECT_FALSE(buffer.fetch());
}

}  // namespace
}  // namespace palpate
