#include "palpate/mesh/polygon.h"

#include <algorithm>
#include <cstdint>
#include <deque>
#include <numeric>

// Ear clipping: cuts off a convex corner whose triangle contains no other corner, until three are left.
// Whatever is clipped, the sides stay sides; so if a polygon crosses itself and no ear is left, any corner
// may be cut off.

namespace palpate {
namespace {

using Index = std::uint32_t;

// Twice the signed area of a triangle; above 0 if it is counter-clockwise.
double area(dvec2 a, dvec2 b, dvec2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// The area-weighted normal of a polygon (Newell's method).
dvec3 normal_of(std::span<const vec3> corners) {
    dvec3 sum(0);
    const dvec3 origin(corners[0]);
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += glm::cross(dvec3(corners[i]) - origin, dvec3(corners[i + 1]) - origin);
    return sum;
}

// The polygon projected along the coordinate axis nearest to its normal, counter-clockwise. A projection
// along the normal itself would give the same triangulation, but round the numbers.
std::vector<dvec2> seen(std::span<const vec3> corners) {
    dvec3 normal = normal_of(corners);
    if (normal == dvec3(0)) {  // the normal vanishes: then the projection with the largest extent
        Bounds box;
        for (vec3 p : corners) box.include(p);
        normal = 1.0 / (dvec3(box.high) - dvec3(box.low) + 1e-300);
    }
    const dvec3 size = glm::abs(normal);
    const int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    int x = (z + 1) % 3, y = (z + 2) % 3;
    if (normal[z] < 0) std::swap(x, y);
    std::vector<dvec2> flat;
    flat.reserve(corners.size());
    for (vec3 p : corners) flat.push_back({p[x], p[y]});
    return flat;
}

struct Triangle {
    dvec2 a, b, c;  // counter-clockwise

    bool is_corner(dvec2 p) const { return p == a || p == b || p == c; }
    // The least of the three (unscaled barycentric coordinates) is below 0 outside, 0 on the border.
    double inside(dvec2 p) const { return std::min({area(a, b, p), area(b, c, p), area(c, a, p)}); }
};

// Some corners of the polygon in a tree of bounding boxes, to find out whether one lies in a triangle: only
// boxes that cross the triangle's sides need a closer look.
class Places {
 public:
    Places(const std::vector<dvec2>& points, std::vector<Index> members)
        : points_(points), members_(std::move(members)), slot_(points.size(), none) {
        if (members_.empty()) return;
        boxes_.resize(4 * (members_.size() / most + 1));
        build(0, 0, Index(members_.size()));
        for (Index i = 0; i < members_.size(); ++i) slot_[members_[i]] = i;
    }

    void remove(Index point) {
        if (slot_[point] == none) return;
        Index node = 0;
        while (--boxes_[node].alive, boxes_[node].count() > most)
            node = 2 * node + (slot_[point] < boxes_[2 * node + 2].first ? 1 : 2);
        slot_[point] = none;
    }

    // Whether one lies in the triangle, but not at a corner of it; with `border`, also on its sides.
    bool any_in(const Triangle& triangle, bool border) const {
        return !members_.empty() && any_in(0, triangle, border);
    }

 private:
    static constexpr Index none = ~Index(0), most = 8;

    struct Box {
        dvec2 low, high;
        Index first, last, alive;
        Index count() const { return last - first; }
    };

    void build(Index node, Index first, Index last) {
        dvec2 low = points_[members_[first]], high = low;
        for (Index i = first; i < last; ++i) {
            low = glm::min(low, points_[members_[i]]);
            high = glm::max(high, points_[members_[i]]);
        }
        if (node >= boxes_.size()) boxes_.resize(2 * node);
        boxes_[node] = {low, high, first, last, last - first};
        if (last - first <= most) return;
        const int axis = high.x - low.x >= high.y - low.y ? 0 : 1;
        const Index half = first + (last - first) / 2;
        std::nth_element(members_.begin() + first, members_.begin() + half, members_.begin() + last,
                         [&](Index a, Index b) { return points_[a][axis] < points_[b][axis]; });
        build(2 * node + 1, first, half);
        build(2 * node + 2, half, last);
    }

    bool any_in(Index node, const Triangle& t, bool border) const {
        const Box& box = boxes_[node];
        if (box.alive == 0 || outside(box, t)) return false;
        if (box.count() > most) return any_in(2 * node + 1, t, border) || any_in(2 * node + 2, t, border);
        return std::any_of(members_.begin() + box.first, members_.begin() + box.last, [&](Index point) {
            const dvec2 p = points_[point];
            return slot_[point] != none && !t.is_corner(p) && (border ? t.inside(p) >= 0 : t.inside(p) > 0);
        });
    }

    // Whether the whole box lies beyond one of the triangle's sides.
    static bool outside(const Box& box, const Triangle& t) {
        auto beyond = [&](dvec2 a, dvec2 b) {
            const dvec2 way = b - a;  // the box's corner that is farthest to its left
            return area(a, b, {way.y > 0 ? box.low.x : box.high.x, way.x > 0 ? box.high.y : box.low.y}) < 0;
        };
        const dvec2 low = glm::min(t.a, glm::min(t.b, t.c)), high = glm::max(t.a, glm::max(t.b, t.c));
        return box.low.x > high.x || box.low.y > high.y || box.high.x < low.x || box.high.y < low.y ||
               beyond(t.a, t.b) || beyond(t.b, t.c) || beyond(t.c, t.a);
    }

    const std::vector<dvec2>& points_;
    std::vector<Index> members_;
    std::vector<Index> slot_;  // of each point among the members; none if it is not a member, or no longer
    std::vector<Box> boxes_;   // the children of box i are 2i + 1 and 2i + 2
};

class Ears {
 public:
    Ears(std::span<const vec3> corners, std::vector<uvec3>& out)
        : points_(seen(corners)),
          out_(out),
          left_(Index(points_.size())),
          before_(left_),
          after_(left_),
          turn_(left_),
          places_(points_, not_convex()) {}

    void clip() {
        // Each rule is tried on all remaining corners, and again on those whose neighbours have changed.
        for (Rule rule : {Rule::clear, Rule::touched, Rule::convex, Rule::any}) {
            for (Index i = first_, n = left_; n > 0; --n, i = after_[i]) queue(i);
            while (!queue_.empty() && left_ > 3) {
                const auto [corner, turn] = queue_.front();
                queue_.pop_front();
                if (turn == turn_[corner] && may_go(corner, rule)) cut(corner);
            }
            queue_.clear();
        }
        out_.push_back({before_[first_], first_, after_[first_]});
    }

 private:
    enum class Rule {
        clear,    // convex, and no other corner in its triangle
        touched,  // other corners only on its border
        convex,   // whatever its triangle contains
        any
    };

    std::vector<Index> not_convex() {
        std::vector<Index> found;
        for (Index i = 0; i < left_; ++i) {
            before_[i] = i == 0 ? left_ - 1 : i - 1;
            after_[i] = i + 1 == left_ ? 0 : i + 1;
            if (!(area(i) > 0)) found.push_back(i);
        }
        return found;
    }

    double area(Index i) const { return palpate::area(points_[before_[i]], points_[i], points_[after_[i]]); }

    // Earlier entries for the same corner are outdated.
    void queue(Index i) { queue_.push_back({i, ++turn_[i]}); }

    bool may_go(Index i, Rule rule) const {
        const Triangle ear{points_[before_[i]], points_[i], points_[after_[i]]};
        const double size = area(i);
        // A corner that coincides with its neighbour, or the tip of a spike of zero width: a degenerate
        // triangle does no harm.
        if (size == 0 && glm::dot(ear.b - ear.a, ear.c - ear.b) <= 0) return true;
        if (rule == Rule::any) return true;
        return size > 0 && (rule == Rule::convex || !places_.any_in(ear, rule == Rule::clear));
    }

    // Its neighbours go to the end of the queue: so ears are clipped evenly all around, and no long fans
    // arise.
    void cut(Index i) {
        const Index a = before_[i], b = after_[i];
        out_.push_back({a, i, b});
        after_[a] = b, before_[b] = a;
        places_.remove(i);
        turn_[i] = 0;
        --left_;
        first_ = b;
        for (Index neighbour : {a, b}) {
            if (area(neighbour) > 0) places_.remove(neighbour);
            queue(neighbour);
        }
    }

    std::vector<dvec2> points_;
    std::vector<uvec3>& out_;
    Index left_;       // remaining corners
    Index first_ = 0;  // one of them
    std::vector<Index> before_, after_;
    std::vector<Index> turn_;  // how often each corner was queued
    Places places_;            // of the reflex corners: if any corner lies in an ear, one of these does
    std::deque<std::pair<Index, Index>> queue_;
};

// Along the shorter diagonal, unless that inverts a triangle and the other does not.
void cut_quad(std::span<const vec3> p, std::vector<uvec3>& out) {
    const dvec3 normal = normal_of(p);
    auto sound = [&](int i) {  // the two triangles on either side of the diagonal from i
        auto turns = [&](int a, int b, int c) {
            const dvec3 from(p[std::size_t(a % 4)]);
            return glm::dot(
                       glm::cross(dvec3(p[std::size_t(b % 4)]) - from, dvec3(p[std::size_t(c % 4)]) - from),
                       normal) > 0;
        };
        return turns(i, i + 1, i + 2) && turns(i, i + 2, i + 3);
    };
    auto length = [&](std::size_t i) { return glm::distance(dvec3(p[i]), dvec3(p[i + 2])); };
    const bool other = sound(0) == sound(1) ? length(1) < length(0) : sound(1);
    if (other)
        out.insert(out.end(), {{1, 2, 3}, {1, 3, 0}});
    else
        out.insert(out.end(), {{0, 1, 2}, {0, 2, 3}});
}

}  // namespace

void triangulate(std::span<const vec3> corners, std::vector<uvec3>& out) {
    if (corners.size() == 3) out.push_back({0, 1, 2});
    if (corners.size() == 4) cut_quad(corners, out);
    if (corners.size() > 4) Ears(corners, out).clip();
}

}  // namespace palpate
