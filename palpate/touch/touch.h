#pragma once
#include "palpate/base/sequence_lock.h"
#include "palpate/base/triple_buffer.h"
#include "palpate/body/dent.h"
#include "palpate/body/patch.h"
#include "palpate/touch/device.h"
#include "palpate/touch/force.h"
#include "palpate/touch/marks.h"
#include "palpate/touch/proxy.h"
#include "palpate/touch/push_queue.h"
#include "palpate/touch/safety.h"

#include <array>
#include <atomic>
#include <memory>
#include <vector>

namespace palpate {

struct TouchSettings {
    double radius = 0.003;           // m, of the tip, the proxy; above 0, below 1
    std::vector<Feel> feels = {{}};  // one for each surface, in the order of the patches' Touchables
    SafetySettings safety = {};
    double surprise = 0.002;  // m: if a surface moves the proxy farther than its speed explains, the force is
                              // let go
    double velocity_filter = 0.002;  // s: the window over which the velocity of the hand is measured, because
                                     // positions are quantised
    double direction_filter = 0.003;  // s: the time constant with which the force turns when the tip goes
                                      // over an edge
};

/// What a hand feels of surfaces that something simulates: not the penalty force of its proxy, but what the
/// simulation did to it.
struct Simulated {
    std::size_t surfaces = 0;  // so many of a patch's, the first
    /// N, on the hand, when they were where the patch shows them. They were pressed with Felt::part of the
    /// stiffness, so that the ramp does not weaken it once more.
    dvec3 load = dvec3(0);
    bool grasped = false;  // the hand holds one of them: it feels the load wherever it is
};

/// The state of a touch at its last tick.
struct Felt {
    double time = 0;                   // s
    Pose pose = {};                    // of the device
    vec3 velocity = vec3(0);           // m/s, of the hand
    vec3 proxy = vec3(0);              // m
    vec3 force = vec3(0);              // N, on the hand
    float depth = 0;                   // m, how deep it presses, below lasting dents
    int surface = -1;                  // the one that it presses deepest; below 0: it touches none
    Held held = Held::waiting;         // whether and why the force is reduced,
    Held last_reason = Held::waiting;  // and why it was last let go
    /// With which part of the stiffness the tip presses a simulated surface, 0 to 1: as much of the wanted
    /// force as acts (Safety::part), and none while it touches none.
    float part = 0;
    unsigned buttons = 0;
    unsigned placed = 0;
    Warmth warmth = {};  // of the device's motors

    // The dents to draw surfaces with: the lasting ones and those under the tip.
    std::array<Dent, most_dents> dents = {};
    std::array<int, most_dents> surfaces = {};  // the surfaces that they are in
    int count = 0;
    int lasting = 0;      // how many of them last: they come first
    int last_stroke = 0;  // the latest stroke that made one of those; 0 if there are none

    std::vector<Dent> dents_of(int surface) const;
};

/// One hand's touch: its device, its proxy, what it feels and the dents it leaves. tick() is one step of the
/// servo loop, a thousandth of a second; a TouchLoop calls it on a thread of its own, tests and films on
/// their own clock. It allocates nothing, locks nothing and never throws. All other methods may be called
/// meanwhile, from one other thread.
class Touch {
 public:
    /// Opens the device. Throws Error if it cannot be opened, or if its properties or the settings are out of
    /// range. `warmth`: of its motors, if they were used before (Felt::warmth).
    Touch(std::unique_ptr<Device> device, TouchSettings settings, const Warmth& warmth = {});
    ~Touch();  // no force is left
    Touch(const Touch&) = delete;
    Touch& operator=(const Touch&) = delete;

    /// Sets new settings from the next tick on, for the same number of surfaces. The device stays open, the
    /// warmth of its motors and the dents are kept. Throws Error like the constructor; then nothing has
    /// changed.
    void set(TouchSettings settings);

    /// Sets what the hand can touch from now on. Call it whenever surfaces have moved; once if they do not
    /// move. Simulated surfaces are felt by their load and keep no dents. The load acts while the tip touches
    /// or grasps one of them, and in the first tick of a patch, but no longer than 20 ms after the patch's
    /// time. While Safety waits for a small force, what is wanted is as of surfaces that stand still. Throws
    /// Error if there are more surfaces than feels.
    void feel(Patch patch, Simulated simulated = {});

    /// The newest state.
    Felt felt() const { return felt_.load(); }

    /// Begins a stroke and returns its number, from 1 on: lasting dents belong to it from now on.
    int begin_stroke() noexcept { return ++stroke_; }

    /// Removes the dents of this stroke and of all later ones, at the next tick.
    void forget(int from_stroke) noexcept;

    /// Removes all dents and begins again without force: for when surfaces were replaced or reset.
    void begin_anew() noexcept;

    /// The next push, the reaction of the hand on a surface: a simulation should take all of them at each of
    /// its steps. False if there is none. Their sum is minus the time integral of the force that was written
    /// to the device, up to the last tick; a slow reader loses nothing. A force that still fades after the
    /// hand has left pushes the surface that it left. After a stall, the force counts for
    /// SafetySettings::lost at most. Triangles are those of the patch at Push::time, so take all pushes
    /// before a patch with other triangles is set.
    bool next(Push& push) noexcept { return pushes_.next(push); }

    /// Sets the rate of the loop that ticks it, Hz: below 1000, stiffness is reduced in proportion, or walls
    /// would vibrate.
    void expect_rate(double rate) noexcept { rate_ = rate; }

    /// False if the device did not answer. `proxy_seconds`, if given, receives the processor time of the
    /// proxy.
    bool tick(double now, double* proxy_seconds = nullptr) noexcept;

    /// For the watchdog, once a millisecond: stops the device if there has been no tick for too long. True
    /// the first time.
    bool watch(double now) noexcept;

    /// Stops the device, when nothing ticks any more; the next tick, if any, begins without force.
    /// Async-signal-safe.
    void let_go() noexcept;

    /// Whether a tick is under way.
    bool is_ticking() const noexcept { return ticking_; }

    /// With stiffnesses limited to what the device can render.
    const TouchSettings& settings() const { return settings_; }
    const DeviceSpec& device() const { return spec_; }

 private:
    void take_new_settings();
    void take_sample(const DeviceState& read);
    void bound_stiffness();
    dvec3 wanted(double now, double* proxy_seconds);
    bool is_simulated(const Contact& contact) const;
    bool touches_simulated() const;
    bool feels_load(double now) const;
    dvec3 turned_slowly(dvec3 wanted, double seconds);
    void leave_marks();
    void push(double now, double seconds);
    void publish(double now);

    std::unique_ptr<Device> device_;
    const DeviceSpec spec_;
    TouchSettings settings_;                    // of the thread that sets them
    TripleBuffer<TouchSettings> new_settings_;  // on their way to the loop
    std::vector<Feel> feels_;  // the same, with stiffness limited to what the device can render
                               // now
    std::vector<Friction> friction_;
    Proxy proxy_;
    Safety safety_;
    struct Surroundings {
        Patch patch;
        Simulated simulated;
    };
    TripleBuffer<Surroundings> surroundings_;
    bool is_fresh_ = false;         // whether the patch came since the last tick
    std::atomic<double> lost_ = 0;  // s, of the settings, for the watchdog
    DeviceState state_ = {};        // the newest valid sample
    bool knows_place_ = false;
    bool was_gone_ = false;
    dvec3 velocity_ = dvec3(0);
    dvec3 direction_ = dvec3(0);
    double time_ = 0;
    Marks marks_;
    Wrench wrench_ = {};  // that was written to the device
    Push touched_ = {};   // where it last touched a surface
    PushQueue pushes_;
    Felt published_ = {};
    SequenceLock<Felt> felt_;
    std::atomic<double> ticked_;  // s; below 0 before the first
    std::atomic<bool> stopped_ = false, ticking_ = false, begins_anew_ = false;
    std::atomic<int> stroke_ = 0, forget_from_;
    std::atomic<double> rate_ = 1000;  // Hz
};

}  // namespace palpate
