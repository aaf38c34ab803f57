#include "palpate/run/live_touch.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/realtime.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr float in_reach = 0.02f;      // m, beyond the tip: more than a hand moves in a slice,
constexpr float fastest_in_reach = 1;  // m/s, and in longer ones

// What acts `age` seconds later.
Interaction as_of(Interaction hands, double age) {
    const auto moved_for = float(std::min(age, frame_seconds));
    const bool moves = age < frame_seconds;
    auto move = [&](vec3& place, vec3& velocity) {
        place += moved_for * velocity;
        if (!moves) velocity = vec3(0);
    };
    for (Press& press : hands.presses) move(press.centre, press.velocity);
    for (BodyPush& pull : hands.pulls) move(pull.push.to, pull.push.velocity);
    return hands;
}

}  // namespace

LiveTouch::LiveTouch(Experiment& experiment, std::vector<FeltHand*> hands, Experiment* beside)
    : experiment_(experiment),
      beside_(beside),
      hands_(std::move(hands)),
      grasps_(hands_.size()),
      near_(hands_.size()),
      loads_(hands_.size(), dvec3(0)) {
    thread_ = std::thread([this] { run(); });
}

LiveTouch::~LiveTouch() {
    {
        const std::lock_guard lock(mutex_);
        ends_ = true;
        goes_ = false;
    }
    changed_.notify_all();
    thread_.join();
}

void LiveTouch::set(const Interaction& besides) {
    besides_ = besides;
    besides_age_ = 0;
}

void LiveTouch::grasp(std::size_t hand, std::vector<BodyPush> pulls, vec3 at) {
    if (grasps_[hand].pulls.empty()) grasps_[hand].last = at;
    grasps_[hand].pulls = std::move(pulls);
    grasps_[hand].at = at;
}

void LiveTouch::go_on() {
    if (!may_go_on())
        throw Error("bodies on a GPU cannot be advanced on another thread", experiment_.source().name,
                    "use the backend cpu; or call LiveTouch::advance() on the thread of the context");
    const double time = now();
    begun_ = std::max(begun_ + double(done_) * slice_seconds, time - frame_seconds);
    done_ = 0;
    {
        const std::lock_guard lock(mutex_);
        goes_ = true;
    }
    changed_.notify_all();
}

bool LiveTouch::may_go_on() const {
    auto is_on_gpu = [](const Experiment& one) { return on_gpu(one.models().simulation.backend); };
    return !is_on_gpu(experiment_) && !(beside_ && is_on_gpu(*beside_));
}

void LiveTouch::hold_still() {
    std::unique_lock lock(mutex_);
    goes_ = false;
    changed_.wait(lock, [&] { return is_still_; });
    if (auto thrown = std::exchange(thrown_, nullptr)) std::rethrow_exception(thrown);
}

void LiveTouch::run() {
    std::unique_lock lock(mutex_);
    while (!ends_) {
        is_still_ = !goes_;
        changed_.notify_all();
        changed_.wait(lock, [&] { return goes_ || ends_; });
        is_still_ = false;
        while (goes_) {
            lock.unlock();
            try {
                const int due = slices_due(now());
                if (due == 0)
                    sleep_until(begun_ + double(done_ + 1) * slice_seconds);
                else
                    advance(due);
            } catch (...) {
                thrown_ = std::current_exception();
            }
            lock.lock();
            if (thrown_) goes_ = false;
        }
    }
}

// Of the time that is lost, a frame is made up for.
int LiveTouch::slices_due(double time) {
    begun_ = std::max(begun_, time - double(done_ + slices_per_frame) * slice_seconds);
    const auto due = long(std::floor((time - begun_) / slice_seconds)) - done_;
    return int(std::clamp(due, 0L, long(slices_per_frame)));
}

bool LiveTouch::advance(int slices) {
    const double start = now(), seconds = slices * slice_seconds;
    const std::size_t bodies = experiment_.models().models.size();
    Interaction hands = as_of(besides_, besides_age_);
    const std::size_t first = hands.presses.size(), first_pull = hands.pulls.size();
    if (std::exchange(shapes_, experiment_.shapes()) != shapes_)
        for (NearSkins& near : near_) near.forget();
    for (std::size_t h = 0; h < hands_.size(); ++h) {
        const float reach = hands_[h]->radius() + in_reach + fastest_in_reach * float(seconds);
        const std::vector<Skin>& skins =
            near_[h].at(experiment_.play(), experiment_.models(), hands_[h]->place(), reach);
        if (near_[h].chose()) hands_[h]->remember(near_[h].before());
        hands_[h]->feel(skins, start, reach,
                        {.surfaces = bodies, .load = loads_[h], .grasped = !grasps_[h].pulls.empty()},
                        last_seconds_);
        hands.presses.push_back(hands_[h]->press(seconds, bodies));
        const vec3 place(hands_[h]->felt().pose.place), last = std::exchange(grasps_[h].last, place);
        for (BodyPush pull : grasps_[h].pulls) {
            pull.push.to += last - grasps_[h].at;
            pull.push.velocity = (place - last) / float(seconds);
            hands.pulls.push_back(pull);
        }
    }
    const bool goes_well = experiment_.advance(hands, slices);
    if (beside_ && beside_->trouble().empty()) beside_->advance(hands, slices);
    const InteractionForces& felt = experiment_.play().interaction_forces();
    for (std::size_t h = 0, pull = first_pull; h < hands_.size(); ++h) {
        loads_[h] = goes_well ? felt.presses[first + h] : dvec3(0);
        for (std::size_t i = 0; goes_well && i < grasps_[h].pulls.size(); ++i)
            loads_[h] += felt.pulls[pull++];
    }
    last_seconds_ = seconds;
    besides_age_ += seconds;
    done_ += slices;
    lengths_.add(seconds);
    work_.add(now() - start);
    return goes_well;
}

}  // namespace palpate
