#pragma once
#include "palpate/base/sequence_lock.h"
#include "palpate/scene/camera.h"
#include "palpate/touch/device.h"
#include "palpate/touch/devices/damped_spring.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace palpate {

/// One event of a pointer: its position, buttons and wheel.
struct PointerEvent {
    double time = 0;          // s, on the loop's clock
    vec2 position = vec2(0);  // pixels to the right and down from the picture's upper left corner
    unsigned buttons = 0;     // as in DeviceState
    float wheel = 0;          // all notches so far, away from the person
};

struct MouseSettings {
    Camera camera{};
    ivec2 size = ivec2(1280, 720);  // of the picture, pixels
    float notch = 0.005f;           // m, by which one notch of the wheel moves the hand into the picture
    /// s, the time constant of a critically damped filter: a mouse reports 60 to 1000 times a second, and
    /// between two events the hand moves on smoothly instead of jumping. It lags behind a steady motion by 2
    /// · smoothing.
    double smoothing = 0.01;
};

/// A pointer in a picture as a hand in the scene: under the pointer, at the depth of the point that the
/// camera looks at, and nearer or farther by the wheel. It does not know a window: the owner of the window
/// passes on events.
class Mouse final : public Device {
 public:
    /// `replay`: events that it plays back, in order of their times, which count from the first read.
    explicit Mouse(const MouseSettings& settings, std::vector<PointerEvent> replay = {});

    // For one thread at a time, which may differ from the loop's and never waits:

    /// The pointer, a button or the wheel has moved. The time of the event is clamped to the interval between
    /// the last two reads.
    void point(const PointerEvent& event) noexcept;
    /// The same, but the hand jumps there, with a new `placed`, instead of moving through what lies between.
    /// A point() right after it continues from there.
    void place(const PointerEvent& event) noexcept;
    /// The camera or the size of the picture has changed: the hand jumps under the pointer, with a new
    /// `placed`.
    void look(const Camera& camera, ivec2 size) noexcept;

    /// It has no motor that gets warm.
    DeviceSpec spec() const override {
        DeviceSpec spec{.name = "mouse"};
        spec.lasting_force = spec.peak_force;
        return spec;
    }
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench&) noexcept override { return true; }
    void stop() noexcept override {}

 private:
    // What the window's thread passes on; the counters tell what is new.
    struct Input {
        PointerEvent event;
        PointerEvent placed;  // where it was last placed, before it moved on
        Camera camera;
        ivec2 size = ivec2(1);
        unsigned events = 0, placings = 0;
    };

    void take(const Input& input, double time, double now, bool placed);
    void advance(double time);
    dvec3 place() const;

    MouseSettings settings_;
    std::vector<PointerEvent> replay_;
    std::size_t next_ = 0;  // of replay_
    Input next_input_;      // of the window's thread
    SequenceLock<Input> shared_;
    Input input_;  // that the hand follows now

    std::optional<double> start_;  // on the loop's clock
    double time_ = 0;              // s, on that clock: the time of the hand's state
    dvec3 target_ = dvec3(0);
    Swing swing_;  // of the hand about its target
    unsigned placed_ = 0;
};

}  // namespace palpate
