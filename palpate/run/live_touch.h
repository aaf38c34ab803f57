#pragma once
#include "palpate/run/experiment.h"
#include "palpate/run/felt_hand.h"
#include "palpate/run/near_skins.h"
#include "palpate/touch/timing.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace palpate {

/// An experiment in real time, whose bodies hands feel and press at once. It advances in slices that are as
/// short as the machine affords: each makes up for the time since the last, from a slice_seconds to a frame.
/// Where a frame takes longer than 1/60 s, it is slower than real time.
class LiveTouch {
 public:
    /// `hands` are live, and feel the skins of the experiment. `beside`: another one, made by
    /// Experiment::beside(), that the same hands press. All must outlive it.
    LiveTouch(Experiment& experiment, std::vector<FeltHand*> hands, Experiment* beside = nullptr);
    ~LiveTouch();
    LiveTouch(const LiveTouch&) = delete;
    LiveTouch& operator=(const LiveTouch&) = delete;

    /// What else acts from now on; what of it moves does so for a frame, and then stays.
    void set(const Interaction& besides);

    /// Lets a hand pull at nodes, and feel that: by these springs when its place is `at`, and they move with
    /// it. Without pulls it lets go.
    void grasp(std::size_t hand, std::vector<BodyPush> pulls, vec3 at = vec3(0));

    /// Begins to advance on a thread of its own. Until hold_still(), nobody else may use the experiments or
    /// the hands. Throws Error if the bodies are on a GPU, whose context belongs to one thread.
    void go_on();
    bool may_go_on() const;  // whether they are not
    /// Waits for the end of a slice, at most a frame of simulated time, and throws what that threw. Time
    /// stands still for the bodies until it goes on, when they catch up, by a frame at most.
    void hold_still();

    /// Advances on the caller's thread, while it is held still: once, by so many slices. False as
    /// Experiment::advance().
    bool advance(int slices = slices_per_frame);

    /// How long the slices since the beginning were, simulated, and what they took, s of wall-clock time.
    const Durations& lengths() const { return lengths_; }
    const Durations& work() const { return work_; }

    /// How often it has advanced.
    std::uint64_t advances() const { return lengths_.count(); }

 private:
    void run();
    int slices_due(double now);

    Experiment& experiment_;
    Experiment* const beside_;
    const std::vector<FeltHand*> hands_;
    struct Grasp {
        std::vector<BodyPush> pulls;
        vec3 at = vec3(0), last = vec3(0);  // m, where the hand was when it began, and in the last slice
    };
    std::vector<Grasp> grasps_;
    std::vector<NearSkins> near_;  // what each may touch
    Experiment::Shapes shapes_;    // of those
    std::vector<dvec3> loads_;     // N, on the hands, in the last slice
    Interaction besides_;
    double besides_age_ = 0;              // s, simulated
    std::optional<double> last_seconds_;  // the length of the last slice
    double begun_ = 0;                    // s, when it went on, less than a frame ago if it cannot keep up,
    long done_ = 0;                       // and the slices since
    Durations lengths_, work_;

    std::mutex mutex_;
    std::condition_variable changed_;
    bool goes_ = false, is_still_ = true, ends_ = false;  // asked for; reached; asked for
    std::exception_ptr thrown_;
    std::thread thread_;  // started last
};

}  // namespace palpate
