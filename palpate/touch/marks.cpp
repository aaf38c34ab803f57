#include "palpate/touch/marks.h"

#include "palpate/touch/force.h"

#include <algorithm>

namespace palpate {
namespace {

constexpr std::size_t most_marks = most_dents - 3;  // the others are for the contacts under the tip

Dent dent_of(const Contact& contact, double depth, const Feel& feel) {
    return {vec3(contact.point), float(contact.behind ? -depth : depth), float(feel.dent_width),
            vec3(contact.front())};
}

// The greatest depth of a dent from a single press.
double deepest_press(const Feel& feel) { return 2.0 / 3 * deepest_dent(feel.dent_width); }

// How much depth one more dent may add there. What it adds at the centres of others counts less with
// distance, or the first press would use up what a stroke may add beside it.
double room_for_dent(std::span<const Dent> lasting, const Contact& contact, const Feel& feel) {
    double room = deepest_press(feel) - lasting_depth(lasting, contact);
    const Dent one[] = {dent_of(contact, 1, feel)};
    for (const Dent& dent : lasting) {
        const double side = dent.depth < 0 ? -1 : 1;
        const double share = side * double(depth_at(one, dent.centre, dent.facing));
        if (share < 1e-3) continue;
        const double there = side * double(depth_at(lasting, dent.centre, dent.facing));
        room = std::min(room, (deepest_dent(feel.dent_width) * (1 - share / 3) - there) / share);
    }
    return room;
}

}  // namespace

Dent dent_under(const Contact& contact, const Feel& feel, std::span<const Dent> lasting) {
    const double depth = std::min(contact.depth, deepest_press(feel)) - lasting_depth(lasting, contact);
    return dent_of(contact, std::max(depth, 0.0), feel);
}

Marks::Marks(std::size_t surfaces) : marks_(surfaces), dents_(surfaces) {
    for (auto& list : marks_) list.reserve(most_marks);
    for (auto& list : dents_) list.reserve(most_marks);
}

int Marks::last_stroke() const {
    int last = 0;
    for (const auto& list : marks_)
        for (const Mark& mark : list) last = std::max(last, mark.stroke);
    return last;
}

void Marks::carry(const Patch& patch, double time) {
    for (std::size_t s = 0; s < marks_.size(); ++s)
        for (std::size_t m = 0; m < marks_[s].size(); ++m) {
            const Mark& mark = marks_[s][m];
            Dent& dent = dents_[s][m];
            const auto face = patch.find(int(s), mark.triangle, time);
            if (!face) continue;
            const auto& [a, b, c] = face->corners;
            dent.centre = vec3(mark.weights.x * a + mark.weights.y * b + mark.weights.z * c);
            const dvec3 up = glm::cross(b - a, c - a);
            const double length = glm::length(up), side = glm::dot(up, dvec3(dent.facing)) < 0 ? -1 : 1;
            if (length > 0) dent.facing = vec3(side / length * up);
        }
}

void Marks::leave(const Contact& contact, const Feel& feel, int stroke) {
    auto& marks = marks_[std::size_t(contact.surface)];
    auto& dents = dents_[std::size_t(contact.surface)];
    const double wanted = contact.depth - feel.yield - lasting_depth(dents, contact);
    const double least = 1e-4 * feel.dent_width;  // less is added later, once it is more
    if (!(wanted > least)) return;
    const double more = std::min(wanted, room_for_dent(dents, contact, feel));
    if (!(more > least)) return;
    const Dent dent = dent_of(contact, more, feel);
    // A dent of the same stroke that is near enough to count in full grows; otherwise there is a new one, if
    // there is room.
    std::size_t nearest = dents.size();
    float closest = 0.25f * dent.width;
    for (std::size_t m = 0; m < dents.size(); ++m) {
        const bool alike = marks[m].stroke == stroke && glm::dot(dents[m].facing, dent.facing) >= 0.5f &&
                           (dents[m].depth > 0) == (dent.depth > 0);
        const float off = glm::distance(dents[m].centre, dent.centre);
        if (!alike || off >= closest) continue;
        closest = off;
        nearest = m;
    }
    if (nearest < dents.size()) {
        dents[nearest].depth += dent.depth;
        return;
    }
    std::size_t all = 0;
    for (const auto& list : marks_) all += list.size();
    if (all == most_marks) return;
    marks.push_back({contact.triangle, contact.weights, stroke});
    dents.push_back(dent);
}

void Marks::forget(int from_stroke) {
    for (std::size_t s = 0; s < marks_.size(); ++s) {
        std::size_t kept = 0;
        for (std::size_t m = 0; m < marks_[s].size(); ++m) {
            if (marks_[s][m].stroke >= from_stroke) continue;
            marks_[s][kept] = marks_[s][m];
            dents_[s][kept++] = dents_[s][m];
        }
        marks_[s].resize(kept);
        dents_[s].resize(kept);
    }
}

}  // namespace palpate
