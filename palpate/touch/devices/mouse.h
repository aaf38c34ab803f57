#pragma once
#include "palpate/base/sequence_lock.h"
#include "palpate/scene/camera.h"
#include "palpate/touch/device.h"
#include "palpate/touch/devices/damped_spring.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace palpate {

/// Where a pointer was, and how its buttons and its wheel stood.
struct PointerEvent {
    double time = 0;          // s, on the loop's clock
    vec2 position = vec2(0);  // pixels to the right and down from the picture's upper left corner
    unsigned buttons = 0;     // as in DeviceState
    float wheel = 0;          // notches in all so far, away from the person
};

struct MouseSettings {
    Camera camera{};
    ivec2 size = ivec2(1280, 720);  // of the picture, pixels
    float notch = 0.005f;           // m into the picture that a notch of the wheel moves the hand
    /// s, of a critically damped filter: a mouse speaks 60 to 1000 times a second, and between two events the
    /// hand goes on smoothly instead of jumping. It follows a steady motion 2 · smoothing late.
    double smoothing = 0.01;
};

/// A pointer in a picture as a hand in the scene: under the pointer, as deep in the picture as the point that
/// the camera looks at, and nearer or farther by the wheel. It knows no window: whoever has one tells it of
/// events.
class Mouse final : public Device {
 public:
    /// `replay`: events that come by themselves, in the order of their times, which count from the first
    /// read.
    explicit Mouse(const MouseSettings& settings, std::vector<PointerEvent> replay = {});

    // From one thread at a time, which may be another than the loop's and never waits:

    /// The pointer has moved, or a button or the wheel has. Its time counts as far as it lies between the
    /// last two reads.
    void point(const PointerEvent& event) noexcept;
    /// The same, and the hand is there at once, `placed` anew: it does not go there through what lies
    /// between. Where point() comes at once after it, it goes on from there.
    void place(const PointerEvent& event) noexcept;
    /// The picture is seen from elsewhere now, or has another size; the hand is `placed` anew under the
    /// pointer.
    void look(const Camera& camera, ivec2 size) noexcept;

    DeviceSpec spec() const override { return {.name = "mouse"}; }
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench&) noexcept override { return true; }
    void stop() noexcept override {}

 private:
    // All that the window's thread tells; how often says what is new in it.
    struct Told {
        PointerEvent event;
        PointerEvent placed;  // where it was placed the last time, before it went to where it is
        Camera camera;
        ivec2 size = ivec2(1);
        unsigned events = 0, placings = 0;
    };

    void take(const Told& told, double time, double now, bool anew);
    void advance(double time);
    dvec3 place() const;

    MouseSettings settings_;
    std::vector<PointerEvent> replay_;
    std::size_t next_ = 0;  // of replay_
    Told telling_;          // the window's thread's own
    SequenceLock<Told> shared_;
    Told told_;  // what the hand follows

    std::optional<double> start_;  // of the loop's clock
    double time_ = 0;              // s, on it: how far the hand has come
    dvec3 target_ = dvec3(0);
    Swing swing_;  // of the hand about its target
    unsigned placed_ = 0;
};

}  // namespace palpate
