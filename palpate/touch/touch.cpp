#include "palpate/touch/touch.h"

#include "palpate/base/realtime.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

constexpr std::size_t most_marks = most_dents - 3;  // the others are for what is under the tip

bool is_finite(vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

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
    for (Feel& feel : settings_.feels) {
        feel.stiffness = std::min(feel.stiffness, 0.5 * double(spec_.stiffness));
        friction_.push_back(feel.friction);
    }
    for (auto& list : marks_) list.reserve(most_marks);
    for (auto& list : lasting_) list.reserve(most_marks);
    device_->open();
}

Touch::~Touch() { device_->stop(); }

void Touch::feel(Patch patch) {
    patches_.draft() = std::move(patch);
    patches_.publish();
}

void Touch::tick(double now) noexcept {
    ticked_.store(now, std::memory_order_release);
    Hand read = hand_;
    const bool there = device_->read(now, read);
    if (there) take_in(read);
    patches_.fetch();
    const double seconds = std::clamp(now - time_, 0.0, 0.01);
    time_ = now;
    const dvec3 want = turned_slowly(wanted(now), seconds);
    const dvec3 surface = proxy_.contacts().empty() ? dvec3(0) : proxy_.contacts()[0].velocity;
    dvec3 force = safety_.allow(want, read, velocity_, surface, now);
    if (!there) safety_.let_go(Held::gone);
    // The watchdog may have come between: then what was reckoned belongs to a time long ago.
    if (stopped_.exchange(false, std::memory_order_acq_rel)) {
        safety_.let_go(Held::stalled);
        force = safety_.none();
    }
    if (!device_->write(vec3(force))) safety_.let_go(Held::gone);
    leave_marks(now);
    tell(now, force);
}

bool Touch::watch(double now) noexcept {
    const double last = ticked_.load(std::memory_order_acquire);
    if (last < 0 || now - last <= settings_.lost) return false;
    if (stopped_.exchange(true, std::memory_order_acq_rel)) return false;
    device_->stop();
    return true;
}

// A sample that is none leaves the hand where it was; Safety sees it too and lets go.
void Touch::take_in(const Hand& read) {
    if (!is_finite(read.position) || !std::isfinite(read.time)) return;
    if (!knows_hand_ || read.placed != hand_.placed) {
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

dvec3 Touch::wanted(double now) {
    if (!knows_hand_) return dvec3(0);
    const double start = times_proxy ? thread_seconds() : 0;
    const dvec3 hand(hand_.position);
    proxy_.follow(patches_.shown(), now, hand, friction_);
    if (times_proxy) proxy_seconds_ = thread_seconds() - start;
    const auto contacts = proxy_.contacts();
    if (contacts.empty()) return dvec3(0);
    const auto most = std::max_element(contacts.begin(), contacts.end(),
                                       [](const Contact& a, const Contact& b) { return a.depth < b.depth; });
    return force(proxy_, hand, velocity_, settings_.feels, lasting_[std::size_t(most->surface)]);
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

// What is deeper than a surface springs back from stays.
void Touch::leave_marks(double now) {
    const Patch& patch = patches_.shown();
    for (std::size_t s = 0; s < marks_.size(); ++s)
        for (std::size_t m = 0; m < marks_[s].size(); ++m) {
            Mark& mark = marks_[s][m];
            const auto face = patch.moves() ? patch.find(int(s), mark.triangle, now) : std::nullopt;
            if (!face) continue;
            mark.dent.centre = vec3(mark.weights.x * face->corners[0] + mark.weights.y * face->corners[1] +
                                    mark.weights.z * face->corners[2]);
            lasting_[s][m] = mark.dent;
        }
    for (const Contact& contact : proxy_.contacts()) {
        const auto s = std::size_t(contact.surface);
        const Feel& feel = settings_.feels[s];
        const vec3 place(contact.point);
        const double more =
            contact.depth - feel.yield - double(depth_at(lasting_[s], place, vec3(contact.normal)));
        if (!(more > 0)) continue;
        // Near enough to one that is there already, that one grows; else there is a new one, as long as there
        // is room.
        std::size_t nearest = marks_[s].size();
        float closest = 0.25f * float(feel.dent_width);
        for (std::size_t m = 0; m < marks_[s].size(); ++m)
            if (const float off = glm::distance(marks_[s][m].dent.centre, place); off < closest) {
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
