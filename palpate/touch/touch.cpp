#include "palpate/touch/touch.h"

#include "palpate/base/error.h"
#include "palpate/base/realtime.h"
#include "palpate/touch/emergency.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

constexpr int no_stroke = std::numeric_limits<int>::max();
constexpr double usual_rate = 1000;  // Hz, the rate for which DeviceSpec::stiffness holds

void check(const Feel& feel, const std::string& device) {
    struct Field {
        const char* name;
        double value;
        bool may_be_zero = true, may_be_infinite = false;
    };
    const Field all[] = {
        {"stiffness", feel.stiffness, false},          {"damping", feel.damping},
        {"friction.still", feel.friction.still},       {"friction.sliding", feel.friction.sliding},
        {"dent_width", feel.dent_width, false, false}, {"yield", feel.yield, true, true}};
    for (const Field& one : all)
        if (!(one.may_be_zero ? one.value >= 0 : one.value > 0) ||
            !(one.may_be_infinite || std::isfinite(one.value)))
            throw Error(fmt::format("Feel::{} is {}", one.name, one.value), device,
                        fmt::format("give it {} zero{}", one.may_be_zero ? "at least" : "above",
                                    one.may_be_infinite ? "" : ", and finite"));
}

void check(const TouchSettings& settings, const std::string& device) {
    const std::pair<const char*, double> all[] = {{"surprise", settings.surprise},
                                                  {"velocity_filter", settings.velocity_filter},
                                                  {"direction_filter", settings.direction_filter}};
    if (!(settings.radius > 0 && settings.radius < 1))
        throw Error(fmt::format("a tip radius of {} m", settings.radius), device,
                    "choose one above zero and below 1 m");
    for (const auto& [name, value] : all)
        if (!(value >= 0) || !std::isfinite(value))
            throw Error(fmt::format("TouchSettings::{} is {}", name, value), device,
                        "give it at least zero, and finite");
    for (const Feel& feel : settings.feels) check(feel, device);
    check(settings.safety, device);
}

std::unique_ptr<Device> given(std::unique_ptr<Device> device) {
    if (!device) throw Error("no device", "a hand", "make one first");
    return device;
}

}  // namespace

std::vector<Dent> Felt::dents_of(int surface) const {
    std::vector<Dent> list;
    for (int i = 0; i < count; ++i)
        if (surfaces[std::size_t(i)] == surface) list.push_back(dents[std::size_t(i)]);
    return list;
}

Touch::Touch(std::unique_ptr<Device> device, TouchSettings settings, const Warmth& warmth)
    : device_(given(std::move(device))),
      spec_(device_->spec()),
      settings_(settings),
      feels_(settings.feels),
      friction_(settings.feels.size()),
      proxy_(settings.radius),
      safety_(spec_, settings.safety, warmth),
      marks_(settings.feels.size()),
      pushes_(settings.feels.size()),
      ticked_(-1),
      forget_from_(no_stroke) {
    set(std::move(settings));
    take_new_settings();
    device_->open();
    device_->stop();
    add_touch(*this);
}

Touch::~Touch() {
    device_->stop();
    remove_touch(*this);
}

void Touch::set(TouchSettings settings) {
    check(settings, spec_.name);
    if (settings.feels.size() != feels_.size())
        throw Error(fmt::format("feels for {} surfaces instead of {}", settings.feels.size(), feels_.size()),
                    spec_.name, "make a new touch for other surfaces");
    settings_ = settings;
    for (Feel& feel : settings_.feels)
        feel.stiffness = std::min(feel.stiffness, 0.5 * double(spec_.stiffness));
    new_settings_.draft() = std::move(settings);
    new_settings_.publish();
}

void Touch::forget(int from_stroke) noexcept {
    int from = forget_from_.load();
    while (from_stroke < from && !forget_from_.compare_exchange_weak(from, from_stroke)) {}
}

void Touch::begin_anew() noexcept {
    forget(0);
    begins_anew_ = true;
}

void Touch::feel(Patch patch, Simulated simulated) {
    if (patch.surfaces() > settings_.feels.size())
        throw Error(fmt::format("{} surfaces, but only {} feels", patch.surfaces(), settings_.feels.size()),
                    spec_.name, "give TouchSettings::feels one entry for each");
    surroundings_.draft() = {std::move(patch), simulated};
    surroundings_.publish();
}

bool Touch::tick(double now, double* proxy_seconds) noexcept {
    ticking_ = true;
    ticked_.store(now, std::memory_order_release);
    const double seconds = std::max(now - time_, 0.0);
    push(now, seconds);
    time_ = now;
    take_new_settings();
    DeviceState read = state_;
    const bool there = device_->read(now, read);
    if (there)
        take_sample(read);
    else
        read = state_;
    was_gone_ = !there;
    bound_stiffness();
    is_fresh_ = surroundings_.fetch();
    if (is_fresh_ || surroundings_.shown().patch.fastest() > 0)
        marks_.carry(surroundings_.shown().patch, now);
    const dvec3 want = turned_slowly(wanted(now, proxy_seconds), std::min(seconds, 0.01));
    const Contact* most = proxy_.deepest();
    if (most) touched_ = {most->surface, most->triangle, most->weights};
    wrench_ = safety_.allow({vec3(want), {}}, read, velocity_, most ? most->velocity : dvec3(0), now);
    // The watchdog may have stopped the device meanwhile: then this force was computed long ago.
    if (stopped_.exchange(false, std::memory_order_acq_rel)) {
        safety_.let_go(Held::stalled);
        wrench_ = safety_.none();
    }
    // A device that cannot be read or written may still apply its last force.
    if (!there || !device_->write(wrench_)) {
        device_->stop();
        safety_.let_go(Held::gone);
        wrench_ = safety_.none();
    }
    // It may also have stopped it just before the write.
    if (stopped_.load(std::memory_order_acquire)) {
        device_->stop();
        wrench_ = {};
    }
    leave_marks();
    publish(now);
    ticking_ = false;
    return there;
}

// Newton's third law: the surface gets the opposite of the hand's impulse. The watchdog ends a force after a
// limited time without ticks.
void Touch::push(double now, double seconds) {
    const dvec3 force(wrench_.force);
    if (force != dvec3(0)) {
        Push one = touched_;
        one.impulse = -std::min(seconds, lost_.load()) * force;
        one.time = now;
        pushes_.add(one);
    }
    pushes_.send();
}

// Takes the settings that another thread has sent since the last tick.
void Touch::take_new_settings() {
    if (new_settings_.fetch()) {
        const TouchSettings& settings = new_settings_.shown();
        proxy_.set_radius(settings.radius);
        safety_.set(settings.safety);
        lost_ = settings.safety.lost;
        for (std::size_t s = 0; s < feels_.size(); ++s) {
            feels_[s] = settings.feels[s];
            friction_[s] = settings.feels[s].friction;
        }
    }
    if (const int from = forget_from_.exchange(no_stroke); from != no_stroke) marks_.forget(from);
    if (begins_anew_.exchange(false)) {
        proxy_.put(state_.pose.place);
        safety_.let_go(Held::placed);
    }
}

// Limits stiffness to what the device can render stably at the loop's rate and in its present scale. Half of
// what it claims is on the safe side.
void Touch::bound_stiffness() {
    const double scale = double(state_.forces) * double(state_.motion);
    const double most = 0.5 * double(spec_.stiffness) * std::min(rate_ / usual_rate, 1.0) / scale;
    for (std::size_t s = 0; s < feels_.size(); ++s)
        feels_[s].stiffness = std::min(new_settings_.shown().feels[s].stiffness, most);
}

bool Touch::watch(double now) noexcept {
    const double last = ticked_.load(std::memory_order_acquire);
    if (last < 0 || now - last <= lost_) return false;
    const bool again = stopped_.load(std::memory_order_acquire);
    let_go();
    return !again;
}

void Touch::let_go() noexcept {
    stopped_.store(true, std::memory_order_release);  // for a tick under way,
    device_->stop();
    stopped_.store(true, std::memory_order_release);  // and for one that began meanwhile
}

// An invalid sample does not move the hand; Safety sees it, too, and lets go of the force. After the device
// was gone, the hand may be anywhere, as after a jump of `placed`.
void Touch::take_sample(const DeviceState& read) {
    if (!is_sound(read)) return;
    if (!knows_place_ || was_gone_ || read.placed != state_.placed) {
        proxy_.put(read.pose.place);
        velocity_ = dvec3(0);
    } else if (const double seconds = read.time - state_.time; seconds > 0) {
        const TouchSettings& settings = new_settings_.shown();
        dvec3 speed = (read.pose.place - state_.pose.place) / seconds;
        if (!(glm::length(speed) <= settings.safety.fastest_hand))
            speed = velocity_ = dvec3(0);  // the jump is no motion
        velocity_ += (1 - std::exp(-seconds / settings.velocity_filter)) * (speed - velocity_);
    }
    state_ = read;
    knows_place_ = true;
}

dvec3 Touch::wanted(double now, double* proxy_seconds) {
    if (!knows_place_) return dvec3(0);
    const double start = proxy_seconds ? thread_seconds() : 0;
    const dvec3 hand = state_.pose.place;
    const double pushed = proxy_.follow(surroundings_.shown().patch, now, hand, friction_);
    if (proxy_seconds) *proxy_seconds = thread_seconds() - start;
    if (pushed > new_settings_.shown().surprise) safety_.let_go(Held::pushed);
    const Contact* most = proxy_.deepest();
    if (!most) return feels_load(now) ? surroundings_.shown().simulated.load / safety_.part() : dvec3(0);
    const std::span<const Dent> lasting = marks_.on(std::size_t(most->surface));
    // Whoever is deep inside when no force acts yet must come out first.
    if (!(safety_.part() > 0)) return force(proxy_, hand, velocity_, feels_, lasting);
    const Simulated& simulated = surroundings_.shown().simulated;
    const dvec3 still = force(proxy_, hand, velocity_, feels_, lasting, int(simulated.surfaces));
    return feels_load(now) ? still + simulated.load / safety_.part() : still;
}

bool Touch::is_simulated(const Contact& contact) const {
    return std::size_t(contact.surface) < surroundings_.shown().simulated.surfaces;
}

bool Touch::touches_simulated() const {
    return std::ranges::any_of(proxy_.contacts(), [this](const Contact& one) { return is_simulated(one); });
}

bool Touch::feels_load(double now) const {
    constexpr double oldest = 0.02;  // s
    return safety_.part() > 0 &&
           (is_fresh_ || touches_simulated() || surroundings_.shown().simulated.grasped) &&
           now - surroundings_.shown().patch.time() <= oldest;
}

// A low-pass filter on the direction of the force: without it one would feel the edges of a coarse mesh.
dvec3 Touch::turned_slowly(dvec3 wanted, double seconds) {
    const double strength = glm::length(wanted);
    if (!(strength > 0)) {
        direction_ = dvec3(0);
        return wanted;
    }
    const dvec3 now = wanted / strength;
    if (direction_ == dvec3(0)) direction_ = now;
    const double slowness = new_settings_.shown().direction_filter;
    const double weight = slowness > 0 ? 1 - std::exp(-seconds / slowness) : 1;
    direction_ += weight * (now - direction_);
    const double length = glm::length(direction_);
    direction_ = length > 1e-6 ? direction_ / length : now;
    return strength * direction_;
}

// What is deeper than the yield depth lasts; but only where a force was felt.
void Touch::leave_marks() {
    if (safety_.held() != Held::no && safety_.held() != Held::ramping) return;
    for (const Contact& contact : proxy_.contacts())
        if (!is_simulated(contact)) marks_.leave(contact, feels_[std::size_t(contact.surface)], stroke_);
}

void Touch::publish(double now) {
    published_.time = now;
    published_.pose = state_.pose;
    published_.velocity = vec3(velocity_);
    published_.proxy = vec3(proxy_.position());
    published_.force = wrench_.force;
    published_.held = safety_.held();
    published_.last_reason = safety_.last_reason();
    published_.part = touches_simulated() ? float(safety_.part()) : 0;
    published_.buttons = state_.buttons;
    published_.placed = state_.placed;
    published_.warmth = safety_.warmth();
    published_.depth = 0;
    published_.surface = proxy_.deepest() ? proxy_.deepest()->surface : -1;
    published_.count = 0;
    auto add = [&](const Dent& dent, std::size_t surface) {
        if (published_.count == most_dents) return;
        published_.dents[std::size_t(published_.count)] = dent;
        published_.surfaces[std::size_t(published_.count++)] = int(surface);
    };
    for (std::size_t s = 0; s < marks_.surfaces(); ++s)
        for (const Dent& dent : marks_.on(s)) add(dent, s);
    published_.lasting = published_.count;
    published_.last_stroke = marks_.last_stroke();
    for (const Contact& contact : proxy_.contacts()) {
        const auto s = std::size_t(contact.surface);
        const Dent dent = dent_under(contact, feels_[s], marks_.on(s));
        if (dent.depth != 0 && !is_simulated(contact)) add(dent, s);
        published_.depth =
            std::max(published_.depth, float(contact.depth - lasting_depth(marks_.on(s), contact)));
    }
    felt_.store(published_);
}

}  // namespace palpate
