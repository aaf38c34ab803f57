#include "palpate/touch/proxy.h"

#include "palpate/base/error.h"
#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double clearance =
    1e-7;  // m: the gap that the ball keeps to what it touches, so that rounding never makes it penetrate
constexpr double still = 1e-7;             // m: a shorter way is no motion
constexpr std::size_t most_touching = 12;  // contacts with different normals
constexpr int most_moves = 12;             // in one call; the rest of the way is left to the next

// The nearest point of a face, as seen from the ball's centre.
struct Nearest {
    dvec3 weights, point;
    dvec3 normal;  // unit, towards the centre
    double distance;
};

dvec3 front(const Patch::Face& face) {
    return glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
}

Nearest nearest(const Patch::Face& face, dvec3 centre) {
    Nearest found;
    found.weights = nearest_weights(centre, face.corners[0], face.corners[1], face.corners[2]);
    found.point = found.weights.x * face.corners[0] + found.weights.y * face.corners[1] +
                  found.weights.z * face.corners[2];
    const dvec3 away = centre - found.point;
    found.distance = glm::length(away);
    const dvec3 outward = found.distance > 1e-12 ? away : front(face);
    const double length = glm::length(outward);
    found.normal = length > 0 ? outward / length : dvec3(0, 1, 0);
    return found;
}

// A face with its plane and its bounding disc in that plane: they rule out most faces quickly.
struct BoundedFace {
    Patch::Face face;
    dvec3 up;  // unit; zero if the face is degenerate, so that every point is at its height
    double level;
    dvec3 middle;
    double size;  // m, from there to the farthest corner

    BoundedFace() = default;
    explicit BoundedFace(const Patch::Face& f) : face(f), up(front(f)) {
        const auto& [a, b, c] = face.corners;
        const double square = glm::dot(up, up);
        up *= square > 0 ? 1 / std::sqrt(square) : 0;
        level = glm::dot(up, a);
        middle = (a + b + c) / 3.0;
        const auto squared = [this](dvec3 corner) { return glm::dot(corner - middle, corner - middle); };
        size = std::sqrt(std::max({squared(a), squared(b), squared(c)}));
    }

    double height(dvec3 point) const { return glm::dot(up, point) - level; }  // m

    // m, from a point at that height over the plane to the disc: no point of the face is nearer.
    double distance(dvec3 point, double high) const {
        const dvec3 off = point - middle;
        const double aside = std::sqrt(std::max(glm::dot(off, off) - high * high, 0.0)) - size;
        return (1 - 1e-9) * (aside > 0 ? std::sqrt(high * high + aside * aside) : std::abs(high));
    }
};

// Whether a face can stop a ball of radius `off` that moves from one height over its plane to another. From
// behind, only a sheet stops it (back faces of a solid do not): so a ball that got into a solid by mistake
// finds its way out.
bool may_stop(const BoundedFace& flat, double begin, double end, double off) {
    if (begin >= 0) return std::min(begin, end) <= off;
    return flat.face.is_sheet && std::max(begin, end) >= -off;
}

// The narrow phase: the time of impact as a part of the way, up to `most`, after which the ball is within
// `off` of a face. The distance to a triangle, as to any convex set, is a convex function along a line, so
// Newton's steps never overshoot the root (conservative advancement).
double free_part(const Patch::Face& face, dvec3 from, dvec3 way, double off, double most) {
    const double hardly = 1e-12 * glm::length(way);
    double part = 0;
    for (int i = 0; i < 40; ++i) {
        const Nearest there = nearest(face, from + part * way);
        const double closing = -glm::dot(there.normal, way), gap = there.distance - off;
        if (closing <= hardly) return most;
        if (gap <= 0.01 * clearance) return part;
        part += gap / closing;
        if (part >= most) return most;
    }
    return part;
}

// ---- what is touched ----

struct Touching {
    std::array<Contact, most_touching> list;
    std::size_t count = 0;

    // If there are too many, it keeps those that oppose the wanted way most.
    void add(const Contact& contact, dvec3 wanted) {
        for (std::size_t i = 0; i < count; ++i)
            if (glm::dot(list[i].normal, contact.normal) > 1 - 1e-12) return;
        if (count < list.size()) {
            list[count++] = contact;
            return;
        }
        auto along = [&](const Contact& one) { return glm::dot(one.normal, wanted); };
        Contact* least = &list[0];
        for (Contact& one : list)
            if (along(one) > along(*least)) least = &one;
        if (along(contact) < along(*least)) *least = contact;
    }
};

template <class Near>
Touching touching(Near& near, dvec3 centre, double radius, dvec3 wanted) {
    const double reach = radius + 2 * clearance;
    Touching found;
    near.for_each(centre, reach, [&](const BoundedFace& flat) {
        const Patch::Face& face = flat.face;
        const double high = flat.height(centre);
        if (!may_stop(flat, high, high, reach) || flat.distance(centre, high) > reach) return;
        const Nearest at = nearest(face, centre);
        if (at.distance > reach) return;
        const dvec3 velocity = at.weights.x * face.velocities[0] + at.weights.y * face.velocities[1] +
                               at.weights.z * face.velocities[2];
        found.add({at.point, at.normal, velocity, face.surface, face.triangle, at.weights, 0, high < 0},
                  wanted);
    });
    return found;
}

// ---- sliding along contact planes ----

// The projection of the wanted way onto the cone of ways that enter no contact plane (non-negative least
// squares): the wanted way plus the normals of at most three active planes, each times its depth.
struct Projection {
    dvec3 way;
    std::array<std::size_t, 3> planes = {};
    std::array<double, 3> depths = {};
    std::size_t count = 0;
};

// Tries one set of active planes; false if it is not the solution.
bool try_planes(dvec3 wanted, const Touching& all, Projection& found) {
    auto normal = [&](std::size_t i) { return all.list[found.planes[i]].normal; };
    const double tiny = 1e-9 * glm::length(wanted);
    found.way = wanted;
    if (found.count == 1) {
        found.depths[0] = -glm::dot(normal(0), wanted);
    } else if (found.count > 1) {
        // Solves for the depths with which the way lies in all active planes. A missing third plane is at
        // right angles to the others.
        const dvec3 a = normal(0), b = normal(1), c = found.count > 2 ? normal(2) : glm::cross(a, b);
        const double volume = glm::dot(glm::cross(a, b), c);
        if (!(std::abs(volume) > 1e-9)) return false;
        // wanted = -sum depth · normal + a part along c; by the reciprocal basis.
        const dvec3 depths = -dvec3(glm::dot(wanted, glm::cross(b, c)), glm::dot(wanted, glm::cross(c, a)),
                                    glm::dot(wanted, glm::cross(a, b))) /
                             volume;
        for (std::size_t i = 0; i < found.count; ++i) found.depths[i] = depths[int(i)];
    }
    for (std::size_t i = 0; i < found.count; ++i) {
        if (found.depths[i] < -tiny) return false;
        found.way += found.depths[i] * normal(i);
    }
    for (std::size_t i = 0; i < all.count; ++i)
        if (glm::dot(all.list[i].normal, found.way) < -tiny) return false;
    return true;
}

Projection project(dvec3 wanted, const Touching& all) {
    Projection found{wanted};
    if (try_planes(wanted, all, found)) return found;
    const std::size_t n = all.count;
    found.count = 1;
    for (std::size_t i = 0; i < n; ++i) {
        found.planes = {i};
        if (try_planes(wanted, all, found)) return found;
    }
    found.count = 2;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            found.planes = {i, j};
            if (try_planes(wanted, all, found)) return found;
        }
    found.count = 3;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            for (std::size_t k = j + 1; k < n; ++k) {
                found.planes = {i, j, k};
                if (try_planes(wanted, all, found)) return found;
            }
    // The planes are so nearly parallel that rounding decides: the ball stays, stopped by the plane that
    // opposes it most.
    found = {dvec3(0), {}, {}, 1};
    for (std::size_t i = 0; i < n; ++i)
        if (const double depth = -glm::dot(all.list[i].normal, wanted); depth > found.depths[0]) {
            found.planes[0] = i;
            found.depths[0] = depth;
        }
    return found;
}

// The part of a way that lies within a ball, from its start; none if it starts outside and does not lead in.
double part_within(dvec3 from, dvec3 way, dvec3 centre, double radius) {
    if (std::isinf(radius)) return 1;
    const dvec3 off = from - centre;
    const double a = glm::dot(way, way), b = glm::dot(off, way), c = glm::dot(off, off) - radius * radius;
    const double square = b * b - a * c;
    if (!(radius > 0) || !(a > 0) || !(square >= 0) || (c >= 0 && b >= 0)) return 0;
    return std::min(1.0, (std::sqrt(square) - b) / a);
}

}  // namespace

// The faces near the ball at this tick, the nearest first, since there are many queries about nearly the same
// place.
class Proxy::Near {
 public:
    static constexpr double beyond = 3e-4;  // m: how far the ball usually moves in a tick

    Near(const Patch& patch, double time) : patch_(patch), time_(time) {
        for (std::size_t i = 0; i < room; ++i) order_[i].slot = i;
    }

    const Patch& patch() const { return patch_; }

    // Calls act(BoundedFace) for every face that comes within `reach` of a point, and for some others.
    template <class Act>
    void for_each(dvec3 point, double reach, const Act& act) {
        if (!holds(point, reach)) fetch(point, reach);
        if (!holds(point, reach))
            return patch_.for_each_near(point, reach, time_,
                                        [&](const Patch::Face& face) { act(BoundedFace(face)); });
        const double far = glm::distance(point, centre_) + reach;
        for (std::size_t i = 0; i < count_ && order_[i].distance <= far; ++i) act(faces_[order_[i].slot]);
    }

 private:
    static constexpr std::size_t room = 512;

    struct Place {
        double distance;  // m, from centre_
        std::size_t slot;
    };

    bool holds(dvec3 point, double reach) const { return glm::distance(point, centre_) + reach <= reach_; }

    void fetch(dvec3 point, double reach) {
        centre_ = point;
        reach_ = reach + beyond;
        count_ = 0;
        patch_.for_each_near(point, reach_, time_, [&](const Patch::Face& face) { add(BoundedFace(face)); });
        sort();
    }

    void add(const BoundedFace& flat) {
        const double distance = flat.distance(centre_, flat.height(centre_));
        if (distance > reach_) return;
        if (count_ == room) {
            sort();
            count_ /= 2;
            reach_ = std::nextafter(order_[count_].distance, 0.0);
            return add(flat);
        }
        order_[count_].distance = distance;
        faces_[order_[count_++].slot] = flat;
    }

    void sort() {
        std::sort(order_.begin(), order_.begin() + std::ptrdiff_t(count_),
                  [](const Place& a, const Place& b) { return a.distance < b.distance; });
    }

    const Patch& patch_;
    const double time_;
    dvec3 centre_ = dvec3(0);
    double reach_ = -1;  // m; below 0 nothing is known
    std::size_t count_ = 0;
    std::array<Place, room> order_;
    std::array<BoundedFace, room> faces_;
};

void Proxy::put(dvec3 place) {
    place_ = place;
    slips_ = true;
    count_ = 0;
}

const Contact* Proxy::deepest() const {
    const Contact* most = nullptr;
    for (const Contact& contact : contacts())
        if (!most || contact.depth > most->depth) most = &contact;
    return most;
}

double Proxy::follow(const Patch& patch, double time, dvec3 hand, std::span<const Friction> friction) {
    if (friction.size() < patch.surfaces())
        throw Error("fewer frictions than the patch has surfaces", "a proxy", "give one for each");
    const bool touched = count_ > 0;
    const dvec3 before = place_;
    const double explained = patch.fastest() * std::clamp(time - time_, 0.0, Patch::longest_guess);
    Near near(patch, time);
    if (touched) move_with_surface(patch, time, explained);
    leave_penetration(near);
    const double pushed = std::max(glm::distance(before, place_) - explained, 0.0);
    if (touched) follow_receding_surface(near);
    time_ = time;

    dvec3 goal = hand;
    const dvec3 along = constrained_way(near, hand);
    if (touched && count_ > 0) {
        // Coulomb friction: a spring along the surface holds it back, up to the friction limit.
        dvec3 sunk(0);
        for (const Contact& contact : contacts()) sunk += contact.depth * contact.normal;
        const auto surface = std::size_t(deepest()->surface);
        const Friction& rough = friction[surface];
        const double way = glm::length(along);
        slips_ = way > (slips_ ? rough.sliding : rough.still) * glm::length(sunk);
        if (!slips_) return pushed;
        const double held = std::min(rough.sliding * glm::length(sunk), way);
        goal -= held / way * along;
    } else {
        slips_ = true;
    }
    approach(near, goal);
    constrained_way(near, hand);
    return pushed;
}

// Moves the ball along with the point of the surface that it touches. A triangle that is no longer in the
// patch is taken to have moved on evenly; one that has moved farther than surfaces do is another one of the
// same number.
void Proxy::move_with_surface(const Patch& patch, double time, double explained) {
    const Contact& held = *deepest();
    const auto face = patch.find(held.surface, held.triangle, time);
    const dvec3 now = face ? held.weights.x * face->corners[0] + held.weights.y * face->corners[1] +
                                 held.weights.z * face->corners[2]
                           : held.point + std::clamp(time - time_, 0.0, Patch::longest_guess) * held.velocity;
    if (glm::distance(now, held.point) <= explained + radius_) place_ += now - held.point;
}

// A contact is kept when the surface recedes.
void Proxy::follow_receding_surface(Near& near) {
    if (touching(near, place_, radius_, dvec3(0)).count > 0) return;
    dvec3 sunk(0);
    for (const Contact& contact : contacts()) sunk += contact.depth * contact.normal;
    go(near, -sunk);
}

void Proxy::leave_penetration(Near& near) {
    for (int i = 0; i < most_moves; ++i) {
        double least = radius_;
        dvec3 out(0);
        near.for_each(place_, radius_, [&](const BoundedFace& flat) {
            const double high = flat.height(place_);
            if (!may_stop(flat, high, high, radius_) || flat.distance(place_, high) > radius_) return;
            const Nearest at = nearest(flat.face, place_);
            if (at.distance >= least) return;
            least = at.distance;
            out = at.normal;
        });
        if (least >= radius_) return;
        place_ += (radius_ + clearance - least) * out;
    }
}

// The way towards a goal that the contacts allow; and sets the contacts.
dvec3 Proxy::constrained_way(Near& near, dvec3 goal) {
    const Touching all = touching(near, place_, radius_, goal - place_);
    const Projection found = project(goal - place_, all);
    count_ = 0;
    for (std::size_t i = 0; i < found.count; ++i) {
        if (!(found.depths[i] > 0)) continue;
        contacts_[count_] = all.list[found.planes[i]];
        contacts_[count_++].depth = found.depths[i];
    }
    return found.way;
}

void Proxy::approach(Near& near, dvec3 goal) {
    for (int i = 0; i < most_moves; ++i) {
        const dvec3 way = constrained_way(near, goal);
        if (!(glm::length(way) > still)) return;
        go(near, way);
    }
}

// Moves along a way to the first obstacle: continuous collision detection. The way is divided, so that each
// piece has few faces near it. Pieces grow, since most ways end soon.
void Proxy::go(Near& near, dvec3 way) {
    way *= part_within(place_, way, near.patch().centre(), near.patch().radius() - radius_ - clearance);
    const double longest = std::max(radius_, 0.001), off = radius_ + clearance;
    constexpr int most_pieces = 64;  // the rest is left to the next tick
    double length = glm::length(way), piece = Near::beyond / 3;
    for (int i = 0; i < most_pieces && length > 0; ++i) {
        const dvec3 step = std::min(piece / length, 1.0) * way;
        const dvec3 middle = place_ + 0.5 * step;
        const double reach = 0.5 * glm::length(step) + off;
        double part = 1;
        near.for_each(middle, reach, [&](const BoundedFace& flat) {
            if (flat.distance(middle, flat.height(middle)) <= reach &&
                may_stop(flat, flat.height(place_), flat.height(place_ + part * step), off))
                part = std::min(part, free_part(flat.face, place_, step, off, part));
        });
        place_ += part * step;
        if (part < 1) return;
        way -= step;
        length = piece < length ? glm::length(way) : 0;
        piece = std::min(2 * piece, longest);
    }
}

}  // namespace palpate
