#include "palpate/touch/touch.h"

#include "palpate/base/error.h"
#include "palpate/base/realtime.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t most_marks = most_dents - 3;  // the others are for what is under the tip

bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

bool is_sound(const Feel& feel) {
    const double numbers[] = {feel.stiffness, feel.damping, feel.friction.still, feel.friction.sliding,
                              feel.dent_width};
    for (double number : numbers)
        if (!(number >= 0) || !std::isfinite(number)) return false;
    return feel.stiffness > 0 && feel.dent_width > 0 && feel.yield >= 0;
}

}  // namespace

std::vector<Dent> Felt::dents_of(int surface) const {
    std::vector<Dent> list;
    for (int i = 0; i < count; ++i)
        if (surfaces[std::size_t(i)] == surface) list.push_back(dents[std::size_t(i)]);
    return list;
}

Touch::Touch(std::unique_ptr<Device> device, TouchSettings settings)
    : device_(std::move(device)),
      spec_(device_->spec()),
      settings_(std::move(settings)),
      proxy_(settings_.radius),
      safety_(spec_, settings_.safety),
      marks_(settings_.feels.size()),
      lasting_(settings_.feels.size()),
      ticked_(-1) {
    if (!(settings_.radius > 0 && settings_.radius < 1))
        throw Error(fmt::format("a tip with a radius of {} m", settings_.radius), spec_.name,
                    "give it one above zero");
    for (Feel& feel : settings_.feels) {
        if (!is_sound(feel))
            throw Error("a surface that feels like nothing", spec_.name,
                        "give finite numbers that are not below zero");
        feel.stiffness = std::min(feel.stiffness, 0.5 * double(spec_.stiffness));
        friction_.push_back(feel.friction);
    }
    for (auto& list : marks_) list.reserve(most_marks);
    for (auto& list : lasting_) list.reserve(most_marks);
    device_->open();
    device_->stop();
}

Touch::~Touch() { device_->stop(); }

void Touch::feel(Patch patch) {
    if (patch.surfaces() > settings_.feels.size())
        throw Error(
            fmt::format("{} surfaces, of which {} have a feel", patch.surfaces(), settings_.feels.size()),
            spec_.name, "give TouchSettings::feels one for each");
    patches_.draft() = std::move(patch);
    patches_.publish();
}

bool Touch::tick(double now, double* proxy_seconds) noexcept {
    ticked_.store(now, std::memory_order_release);
    Hand read = hand_;
    const bool there = device_->read(now, read);
    if (there)
        take_in(read);
    else
        read = hand_;
    was_gone_ = !there;
    if (patches_.fetch() || patches_.shown().fastest() > 0) carry_marks(now);
    const double seconds = std::clamp(now - time_, 0.0, 0.01);
    time_ = now;
    const dvec3 want = turned_slowly(wanted(now, proxy_seconds), seconds);
    const Contact* most = proxy_.deepest();
    dvec3 force = safety_.allow(want, read, velocity_, most ? most->velocity : dvec3(0), now);
    if (!there) safety_.let_go(Held::gone);
    // The watchdog may have come between: then what was reckoned belongs to a time long ago.
    if (stopped_.exchange(false, std::memory_order_acq_rel)) {
        safety_.let_go(Held::stalled);
        force = safety_.none();
    }
    if (!device_->write(vec3(force))) safety_.let_go(Held::gone);
    // Or here: then what it stopped was not yet this.
    if (stopped_.load(std::memory_order_acquire)) device_->stop();
    leave_marks();
    tell(now, force);
    return there;
}

bool Touch::watch(double now) noexcept {
    const double last = ticked_.load(std::memory_order_acquire);
    if (last < 0 || now - last <= settings_.safety.lost) return false;
    const bool again = stopped_.load(std::memory_order_acquire);
    let_go();
    return !again;
}

void Touch::let_go() noexcept {
    stopped_.store(true, std::memory_order_release);  // for a tick that is under way,
    device_->stop();
    stopped_.store(true, std::memory_order_release);  // and for one that began in between
}

// A sample that is none leaves the hand where it was; Safety sees it too and lets go. After the device was
// gone the hand may be anywhere, as if it had been placed.
void Touch::take_in(const Hand& read) {
    if (!is_finite(read.position) || !std::isfinite(read.time)) return;
    if (!knows_hand_ || was_gone_ || read.placed != hand_.placed) {
        proxy_.put(dvec3(read.position));
        velocity_ = dvec3(0);
    } else if (const double seconds = read.time - hand_.time; seconds > 0) {
        dvec3 speed = dvec3(read.position - hand_.position) / seconds;
        if (!(glm::length(speed) <= settings_.safety.fastest_hand))
            speed = velocity_ = dvec3(0);  // no motion of a hand
        velocity_ += (1 - std::exp(-seconds / settings_.velocity_filter)) * (speed - velocity_);
    }
    hand_ = read;
    knows_hand_ = true;
}

dvec3 Touch::wanted(double now, double* proxy_seconds) {
    if (!knows_hand_) return dvec3(0);
    const double start = proxy_seconds ? thread_seconds() : 0;
    const dvec3 hand(hand_.position);
    const double pushed = proxy_.follow(patches_.shown(), now, hand, friction_);
    if (proxy_seconds) *proxy_seconds = thread_seconds() - start;
    if (pushed > settings_.surprise) safety_.let_go(Held::pushed);
    const Contact* most = proxy_.deepest();
    return most ? force(proxy_, hand, velocity_, settings_.feels, lasting_[std::size_t(most->surface)])
                : dvec3(0);
}

// A force that turns at once, as over an edge of a coarse mesh, feels like the edge and not like the surface.
dvec3 Touch::turned_slowly(dvec3 wanted, double seconds) {
    const double strength = glm::length(wanted);
    if (!(strength > 0)) {
        direction_ = dvec3(0);
        return wanted;
    }
    const dvec3 now = wanted / strength;
    if (direction_ == dvec3(0)) direction_ = now;
    const double weight =
        settings_.direction_filter > 0 ? 1 - std::exp(-seconds / settings_.direction_filter) : 1;
    direction_ += weight * (now - direction_);
    const double length = glm::length(direction_);
    direction_ = length > 1e-6 ? direction_ / length : now;
    return strength * direction_;
}

// Where their surfaces are now.
void Touch::carry_marks(double now) {
    for (std::size_t s = 0; s < marks_.size(); ++s)
        for (std::size_t m = 0; m < marks_[s].size(); ++m) {
            Mark& mark = marks_[s][m];
            const auto face = patches_.shown().find(int(s), mark.triangle, now);
            if (!face) continue;
            const auto& [a, b, c] = face->corners;
            mark.dent.centre = vec3(mark.weights.x * a + mark.weights.y * b + mark.weights.z * c);
            const dvec3 up = glm::cross(b - a, c - a);
            const double length = glm::length(up), side = glm::dot(up, dvec3(mark.dent.facing)) < 0 ? -1 : 1;
            if (length > 0) mark.dent.facing = vec3(side / length * up);
            lasting_[s][m] = mark.dent;
        }
}

// What is deeper than a surface springs back from stays; but what no hand felt leaves nothing.
void Touch::leave_marks() {
    if (safety_.held() != Held::no && safety_.held() != Held::ramping) return;
    for (const Contact& contact : proxy_.contacts()) {
        const auto s = std::size_t(contact.surface);
        const Feel& feel = settings_.feels[s];
        const vec3 place(contact.point);
        const double more =
            contact.depth - feel.yield - double(depth_at(lasting_[s], place, vec3(contact.normal)));
        if (!(more > 0)) continue;
        // Near enough to one that is there already and counts here in full, that one grows; else there is a
        // new one, as long as there is room.
        std::size_t nearest = marks_[s].size();
        float closest = 0.25f * float(feel.dent_width);
        for (std::size_t m = 0; m < marks_[s].size(); ++m)
            if (const float off = glm::distance(marks_[s][m].dent.centre, place);
                off < closest && glm::dot(marks_[s][m].dent.facing, vec3(contact.normal)) >= 0.5f) {
                closest = off;
                nearest = m;
            }
        if (nearest < marks_[s].size()) {
            marks_[s][nearest].dent.depth += float(more);
            lasting_[s][nearest] = marks_[s][nearest].dent;
            continue;
        }
        std::size_t all = 0;
        for (const auto& list : marks_) all += list.size();
        if (all == most_marks) continue;
        marks_[s].push_back({{place, float(more), float(feel.dent_width), vec3(contact.normal)},
                             contact.triangle,
                             contact.weights});
        lasting_[s].push_back(marks_[s].back().dent);
    }
}

void Touch::tell(double now, dvec3 force) {
    told_.time = now;
    told_.hand = hand_.position;
    told_.velocity = vec3(velocity_);
    told_.proxy = vec3(proxy_.position());
    told_.force = vec3(force);
    told_.held = safety_.held();
    told_.last_reason = safety_.last_reason();
    told_.buttons = hand_.buttons;
    told_.placed = hand_.placed;
    told_.count = 0;
    auto add = [&](const Dent& dent, std::size_t surface) {
        if (told_.count == most_dents) return;
        told_.dents[std::size_t(told_.count)] = dent;
        told_.surfaces[std::size_t(told_.count++)] = int(surface);
    };
    for (std::size_t s = 0; s < lasting_.size(); ++s)
        for (const Dent& dent : lasting_[s]) add(dent, s);
    told_.lasting = told_.count;
    for (const Contact& contact : proxy_.contacts()) {
        const auto s = std::size_t(contact.surface);
        const vec3 place(contact.point);
        const float depth = float(contact.depth) - depth_at(lasting_[s], place, vec3(contact.normal));
        if (depth > 0) add({place, depth, float(settings_.feels[s].dent_width), vec3(contact.normal)}, s);
    }
    felt_.store(told_);
}

}  // namespace palpate
