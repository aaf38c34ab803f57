#include "palpate/touch/proxy.h"

#include "palpate/base/error.h"
#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double skin =
    1e-7;  // m: so far the ball stays off what it touches, so that rounding never takes it in
constexpr double still = 1e-7;             // m: less is no motion
constexpr std::size_t most_touching = 12;  // with normals of their own
constexpr int most_moves = 12;             // in one call; what is left of the way is for the next

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

// A face, the plane that it lies in and a disc in that which holds it: they tell most faces apart from what
// matters.
struct Flat {
    Patch::Face face;
    dvec3 up;  // unit; nothing where the face has no area, so that everything is at its height
    double level;
    dvec3 middle;
    double size;  // m, from there to the farthest corner

    Flat() = default;
    explicit Flat(const Patch::Face& f) : face(f), up(front(f)) {
        const auto& [a, b, c] = face.corners;
        const double square = glm::dot(up, up);
        up *= square > 0 ? 1 / std::sqrt(square) : 0;
        level = glm::dot(up, a);
        middle = (a + b + c) / 3.0;
        size = std::max({glm::distance(a, middle), glm::distance(b, middle), glm::distance(c, middle)});
    }

    double height(dvec3 point) const { return glm::dot(up, point) - level; }  // m

    // Whether a ball that is not above or below the disc by more than its radius can touch that.
    bool may_touch(dvec3 centre, double high, double radius) const {
        const dvec3 off = centre - middle;
        const double aside = glm::dot(off, off) - high * high;
        const double most = size + std::sqrt(std::max(radius * radius - high * high, 0.0));
        return aside <= most * most * (1 + 1e-9);
    }
};

// Whether a face can be what stops a ball of radius `off` that begins to move at the first height and ends at
// the other. Only a sheet stops what comes from behind: a solid's far side is behind too, and what has got
// into a solid by mistake shall find its way out.
bool may_stop(const Flat& flat, double begin, double end, double off) {
    if (begin >= 0) return std::min(begin, end) <= off;
    return flat.face.is_sheet && std::max(begin, end) >= -off;
}

// How much of a way, up to `most`, the ball can go before it comes within `off` of a face. The distance to a
// triangle, as to anything convex, is a convex function along a line; so Newton's steps never go beyond its
// root.
double free_part(const Patch::Face& face, dvec3 from, dvec3 way, double off, double most) {
    const double hardly = 1e-12 * glm::length(way);
    double part = 0;
    for (int i = 0; i < 40; ++i) {
        const Nearest there = nearest(face, from + part * way);
        const double closing = -glm::dot(there.normal, way), gap = there.distance - off;
        if (closing <= hardly) return most;
        if (gap <= 0.01 * skin) return part;
        part += gap / closing;
        if (part >= most) return most;
    }
    return part;
}

// ---- what is touched ----

struct Touching {
    std::array<Contact, most_touching> list;
    std::size_t count = 0;

    // Where there are too many, those stay that are most in the way of what is wanted.
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
    const double reach = radius + 2 * skin;
    Touching found;
    near.for_each(centre, reach, [&](const Flat& flat) {
        const Patch::Face& face = flat.face;
        const double high = flat.height(centre);
        if (!may_stop(flat, high, high, reach) || !flat.may_touch(centre, high, reach)) return;
        const Nearest at = nearest(face, centre);
        if (at.distance > reach) return;
        const dvec3 velocity = at.weights.x * face.velocities[0] + at.weights.y * face.velocities[1] +
                               at.weights.z * face.velocities[2];
        found.add({at.point, at.normal, velocity, face.surface, face.triangle, at.weights, 0, high < 0},
                  wanted);
    });
    return found;
}

// ---- the way that planes leave ----

// Of all ways that lead into none of the planes the nearest to the one that is wanted: that plus the normals
// of at most three planes, each times its depth.
struct Given {
    dvec3 way;
    std::array<std::size_t, 3> planes = {};
    std::array<double, 3> depths = {};
    std::size_t count = 0;
};

// With some planes to slide along; false if that is not the answer.
bool try_planes(dvec3 wanted, const Touching& all, Given& given) {
    auto normal = [&](std::size_t i) { return all.list[given.planes[i]].normal; };
    const double tiny = 1e-9 * glm::length(wanted);
    given.way = wanted;
    if (given.count == 1) {
        given.depths[0] = -glm::dot(normal(0), wanted);
    } else if (given.count > 1) {
        // Solve for depths: the way shall lie in all of them. A missing third plane is at right angles to the
        // others.
        const dvec3 a = normal(0), b = normal(1), c = given.count > 2 ? normal(2) : glm::cross(a, b);
        const double volume = glm::dot(glm::cross(a, b), c);
        if (!(std::abs(volume) > 1e-9)) return false;
        // wanted = -sum depth · normal + rest along c; by the reciprocal vectors.
        const dvec3 depths = -dvec3(glm::dot(wanted, glm::cross(b, c)), glm::dot(wanted, glm::cross(c, a)),
                                    glm::dot(wanted, glm::cross(a, b))) /
                             volume;
        for (std::size_t i = 0; i < given.count; ++i) given.depths[i] = depths[int(i)];
    }
    for (std::size_t i = 0; i < given.count; ++i) {
        if (given.depths[i] < -tiny) return false;
        given.way += given.depths[i] * normal(i);
    }
    for (std::size_t i = 0; i < all.count; ++i)
        if (glm::dot(all.list[i].normal, given.way) < -tiny) return false;
    return true;
}

Given give_way(dvec3 wanted, const Touching& all) {
    Given given{wanted};
    if (try_planes(wanted, all, given)) return given;
    const std::size_t n = all.count;
    given.count = 1;
    for (std::size_t i = 0; i < n; ++i) {
        given.planes = {i};
        if (try_planes(wanted, all, given)) return given;
    }
    given.count = 2;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j) {
            given.planes = {i, j};
            if (try_planes(wanted, all, given)) return given;
        }
    given.count = 3;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i + 1; j < n; ++j)
            for (std::size_t k = j + 1; k < n; ++k) {
                given.planes = {i, j, k};
                if (try_planes(wanted, all, given)) return given;
            }
    // Planes so nearly alike that rounding decides: it stays, against the one that is most in the way.
    given = {dvec3(0), {}, {}, 1};
    for (std::size_t i = 0; i < n; ++i)
        if (const double depth = -glm::dot(all.list[i].normal, wanted); depth > given.depths[0]) {
            given.planes[0] = i;
            given.depths[0] = depth;
        }
    return given;
}

// How much of a way can be gone before it leaves a ball. From outside, only a way that leads in.
double part_within(dvec3 from, dvec3 way, dvec3 centre, double radius) {
    if (std::isinf(radius)) return 1;
    const dvec3 off = from - centre;
    const double a = glm::dot(way, way), b = glm::dot(off, way), c = glm::dot(off, off) - radius * radius;
    const double square = b * b - a * c;
    if (!(radius > 0) || !(a > 0) || !(square >= 0) || (c >= 0 && b >= 0)) return 0;
    return std::min(1.0, (std::sqrt(square) - b) / a);
}

}  // namespace

// The faces about the ball as they lie in this tick. They are fetched once and not for each question, of
// which there are many about nearly the same place.
class Proxy::Near {
 public:
    Near(const Patch& patch, double time) : patch_(patch), time_(time) {}

    const Patch& patch() const { return patch_; }

    template <class Act>
    void for_each(dvec3 point, double reach, const Act& act) {
        if (!holds(point, reach) && !too_many_) fetch(point, reach + beyond);
        if (!holds(point, reach))
            return patch_.for_each_near(point, reach, time_,
                                        [&](const Patch::Face& face) { act(Flat(face)); });
        for (std::size_t i = 0; i < count_; ++i) act(faces_[i]);
    }

 private:
    static constexpr double beyond = 5e-4;  // m: so far the ball mostly goes in a tick
    static constexpr std::size_t room = 128;

    bool holds(dvec3 point, double reach) const { return glm::distance(point, centre_) + reach <= reach_; }

    void fetch(dvec3 point, double reach) {
        centre_ = point;
        reach_ = reach;
        count_ = 0;
        patch_.for_each_near(point, reach, time_, [&](const Patch::Face& face) {
            if (count_ < room)
                faces_[count_++] = Flat(face);
            else
                too_many_ = true;
        });
        if (too_many_) reach_ = -1;
    }

    const Patch& patch_;
    const double time_;
    dvec3 centre_ = dvec3(0);
    double reach_ = -1;      // m; nothing is held
    bool too_many_ = false;  // so that it is asked directly
    std::size_t count_ = 0;
    std::array<Flat, room> faces_;
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
    leave_what_came_over_it(near);
    const double pushed = std::max(glm::distance(before, place_) - explained, 0.0);
    if (touched) go_back_down(near);
    time_ = time;

    dvec3 goal = hand;
    const dvec3 along = given_way(near, hand);
    if (touched && count_ > 0) {
        // A spring along the surface, no stronger than friction allows, holds it back.
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
    given_way(near, hand);
    return pushed;
}

// Where the surface carries what it is touched at. A triangle that is no longer in the patch has gone on
// evenly; one that has gone farther than surfaces go is another by the same number.
void Proxy::move_with_surface(const Patch& patch, double time, double explained) {
    const Contact& held = *deepest();
    const auto face = patch.find(held.surface, held.triangle, time);
    const dvec3 now = face ? held.weights.x * face->corners[0] + held.weights.y * face->corners[1] +
                                 held.weights.z * face->corners[2]
                           : held.point + std::clamp(time - time_, 0.0, Patch::longest_guess) * held.velocity;
    if (glm::distance(now, held.point) <= explained + radius_) place_ += now - held.point;
}

// A surface that has sunk away under it has not let go of it.
void Proxy::go_back_down(Near& near) {
    if (touching(near, place_, radius_, dvec3(0)).count > 0) return;
    dvec3 sunk(0);
    for (const Contact& contact : contacts()) sunk += contact.depth * contact.normal;
    go(near, -sunk);
}

void Proxy::leave_what_came_over_it(Near& near) {
    for (int i = 0; i < most_moves; ++i) {
        double least = radius_;
        dvec3 out(0);
        near.for_each(place_, radius_, [&](const Flat& flat) {
            const double high = flat.height(place_);
            if (!may_stop(flat, high, high, radius_) || !flat.may_touch(place_, high, radius_)) return;
            const Nearest at = nearest(flat.face, place_);
            if (at.distance >= least) return;
            least = at.distance;
            out = at.normal;
        });
        if (least >= radius_) return;
        place_ += (radius_ + skin - least) * out;
    }
}

// The way towards a goal that the surfaces leave, from where it is; and what they are.
dvec3 Proxy::given_way(Near& near, dvec3 goal) {
    const Touching all = touching(near, place_, radius_, goal - place_);
    const Given given = give_way(goal - place_, all);
    count_ = 0;
    for (std::size_t i = 0; i < given.count; ++i) {
        if (!(given.depths[i] > 0)) continue;
        contacts_[count_] = all.list[given.planes[i]];
        contacts_[count_++].depth = given.depths[i];
    }
    return given.way;
}

void Proxy::approach(Near& near, dvec3 goal) {
    for (int i = 0; i < most_moves; ++i) {
        const dvec3 way = given_way(near, goal);
        if (!(glm::length(way) > still)) return;
        go(near, way);
    }
}

// Along a way, up to the first thing on it. A long one in pieces, beside which there is little to look at.
void Proxy::go(Near& near, dvec3 way) {
    way *= part_within(place_, way, near.patch().centre(), near.patch().radius() - radius_ - skin);
    const double length = glm::length(way);
    if (!(length > 0)) return;
    const double longest = std::max(radius_, 0.001), off = radius_ + skin;
    constexpr double most_pieces = 64;  // what is farther is for the next tick
    const double pieces = std::min(std::ceil(length / longest), most_pieces);
    way *= std::min(longest / length, 1 / pieces);
    for (int i = 0; i < int(pieces); ++i) {
        double part = 1;
        const dvec3 middle = place_ + 0.5 * way;
        const double reach = 0.5 * glm::length(way) + off;
        near.for_each(middle, reach, [&](const Flat& flat) {
            if (flat.may_touch(middle, flat.height(middle), reach) &&
                may_stop(flat, flat.height(place_), flat.height(place_ + part * way), off))
                part = std::min(part, free_part(flat.face, place_, way, off, part));
        });
        place_ += part * way;
        if (part < 1) return;
    }
}

}  // namespace palpate
