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
    double radius = 0.003;  // m, of the tip; above 0, below 1
    std::vector<Feel> feels = {
        {}};  // one for each surface that it meets, in the order of the patches' Touchables
    SafetySettings safety = {};
    double surprise = 0.002;  // m: a surface that moves the tip by more than its speed explains lets go of it
    double velocity_filter =
        0.002;  // s: a hand's speed is its way over so long, because places come in steps
    double direction_filter = 0.003;  // s: so long a force takes to turn when the tip goes over an edge
};

/// What a touch was like at its last tick.
struct Felt {
    double time = 0;                   // s
    Pose pose = {};                    // of the device
    vec3 velocity = vec3(0);           // m/s, of the hand
    vec3 proxy = vec3(0);              // m
    vec3 force = vec3(0);              // N, on the hand
    float depth = 0;                   // m, how deep it presses, below what stays of dents
    Held held = Held::waiting;         // whether that is all,
    Held last_reason = Held::waiting;  // and why it was let go of the last time
    unsigned buttons = 0;
    unsigned placed = 0;
    Warmth warmth = {};  // of the device's motors

    // The dents that surfaces shall be drawn with: those that stay and those under the tip.
    std::array<Dent, most_dents> dents = {};
    std::array<int, most_dents> surfaces = {};  // whose they are
    int count = 0;
    int lasting = 0;      // the first so many of them stay,
    int last_stroke = 0;  // and the latest of the strokes that made those; 0 if there are none

    std::vector<Dent> dents_of(int surface) const;
};

/// One hand: its device, its proxy, what it feels and leaves. tick() is all that happens in a thousandth of a
/// second; a TouchLoop calls it on a thread of its own, tests and films on a clock of theirs. It allocates
/// nothing, locks nothing and never throws. Everything else may be called from any one other thread
/// meanwhile.
class Touch {
 public:
    /// Opens the device. Throws Error if it cannot be opened, or if it or the settings are out of bounds.
    /// `warmth`: of its motors, where they were used before (Felt::warmth).
    Touch(std::unique_ptr<Device> device, TouchSettings settings, const Warmth& warmth = {});
    ~Touch();  // no force is left
    Touch(const Touch&) = delete;
    Touch& operator=(const Touch&) = delete;

    /// Other settings from the next tick on, for as many surfaces: the device stays open and its motors as
    /// warm as they are, and dents stay. Throws Error like the constructor, and then all is as it was.
    void set(TouchSettings settings);

    /// What the hand can meet from now on, of no more surfaces than there are feels; else throws Error. Call
    /// it as often as surfaces move, or once if they do not.
    void feel(Patch patch);

    /// The newest.
    Felt felt() const { return felt_.load(); }

    /// Begins a stroke and returns its number, from 1 on: dents that will stay belong to it.
    int begin_stroke() noexcept { return ++stroke_; }

    /// From the next tick on the dents of this stroke and of all later ones are gone.
    void forget(int from_stroke) noexcept;

    /// All dents are gone, and the hand begins without force, as where it is placed: for surfaces that are
    /// others now, or as they were at the start.
    void begin_anew() noexcept;

    /// The next of the pushes by which the hand gives to surfaces what they gave to it: a simulation takes
    /// all that there are at each of its steps. Their sum is the time integral of the force that was written
    /// to the device, the other way, up to the last tick; a slow reader loses nothing of it. Where a force
    /// fades after the hand has left, it is the surface that it left which is pushed. What a watchdog took
    /// back counts for SafetySettings::lost at most. Triangles are those of the patch that was felt at
    /// Push::time, so take all before another one has others. False if there is none.
    bool next(Push& push) noexcept { return pushes_.next(push); }

    /// Of the loop that ticks it, Hz: below 1000, walls are as much less stiff, or they would not be still.
    void expect_rate(double rate) noexcept { rate_ = rate; }

    /// False if the device did not answer. `proxy_seconds`, if given, is what the proxy took of the
    /// processor's time.
    bool tick(double now, double* proxy_seconds = nullptr) noexcept;

    /// The watchdog's, once a millisecond: stops the device as long as there has been no tick for too long.
    /// True the first time.
    bool watch(double now) noexcept;

    /// No more force, when nobody ticks any more; the next tick, if there is one, begins anew.
    /// Async-signal-safe.
    void let_go() noexcept;

    /// Whether a tick is under way.
    bool is_ticking() const noexcept { return ticking_; }

    /// Stiffnesses as far as the device bears them.
    const TouchSettings& settings() const { return settings_; }
    const DeviceSpec& device() const { return spec_; }

 private:
    void take_wishes();
    void take_in(const DeviceState& read);
    void bound_stiffness();
    dvec3 wanted(double now, double* proxy_seconds);
    dvec3 turned_slowly(dvec3 wanted, double seconds);
    void leave_marks();
    void push(double now, double seconds);
    void tell(double now);

    std::unique_ptr<Device> device_;
    const DeviceSpec spec_;
    TouchSettings settings_;              // of whoever sets them
    TripleBuffer<TouchSettings> wishes_;  // as they were set
    std::vector<Feel> feels_;             // those, as far as the device bears them now
    std::vector<Friction> friction_;
    Proxy proxy_;
    Safety safety_;
    TripleBuffer<Patch> patches_;
    std::atomic<double> lost_ = 0;  // s, of the settings, for the watchdog
    DeviceState state_ = {};        // the newest that is sound
    bool knows_place_ = false;
    bool was_gone_ = false;
    dvec3 velocity_ = dvec3(0);
    dvec3 direction_ = dvec3(0);
    double time_ = 0;
    Marks marks_;
    Wrench wrench_ = {};  // that the device was told
    Push touched_ = {};   // where it touched a surface the last time
    PushQueue pushes_;
    Felt told_ = {};
    SequenceLock<Felt> felt_;
    std::atomic<double> ticked_;  // s; below 0 before the first
    std::atomic<bool> stopped_ = false, ticking_ = false, begins_anew_ = false;
    std::atomic<int> stroke_ = 0, forget_from_;
    std::atomic<double> rate_ = 1000;  // Hz
};

}  // namespace palpate
