#include "palpate/mesh/winding_number.h"

#include "palpate/base/parallel.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace palpate {
namespace {

constexpr double whole_sphere = 4 * std::numbers::pi;
constexpr double far_off = 3;     // in radii of a plate: gives the error that the header promises
constexpr double far_around = 5;  // in radii of a ball: beyond this a linear approximation is enough

// Half the solid angle of a triangle, as a direction (along, up) in the plane: from -pi to pi (Van Oosterom
// and Strackee 1983). `up` is 0 if the solid angle is. Inlined because most of the time is spent here.
struct Half {
    double along, up;
};
[[gnu::always_inline]] inline Half half_solid_angle(dvec3 point, dvec3 a, dvec3 b, dvec3 c) {
    a -= point, b -= point, c -= point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return {la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb,
            glm::dot(a, glm::cross(b, c))};
}

// A sum of such angles with a single arc tangent: multiplies the directions as complex numbers, and counts
// full turns.
class Angles {
 public:
    void add(Half angle) {
        if (angle.up == 0) return;
        const bool was_upper = is_upper();
        const Half both{along_ * angle.along - up_ * angle.up, along_ * angle.up + up_ * angle.along};
        along_ = both.along, up_ = both.up;
        if (was_upper && angle.up > 0 && !is_upper()) ++rounds_;
        if (!was_upper && angle.up < 0 && is_upper()) --rounds_;
        const double size = std::abs(along_) + std::abs(up_);  // its value has no meaning, but must not
                                                               // overflow
        if (size > most || size < 1 / most) along_ /= size, up_ /= size;
    }
    double sum() const { return std::atan2(up_, along_) + 2 * std::numbers::pi * rounds_; }

 private:
    static constexpr double most = 1e100;  // large, so that the slow division is rare

    bool is_upper() const { return up_ > 0 || (up_ == 0 && along_ < 0); }

    double along_ = 1, up_ = 0;
    int rounds_ = 0;
};

}  // namespace

double solid_angle(dvec3 point, dvec3 a, dvec3 b, dvec3 c) {
    const Half half = half_solid_angle(point, a, b, c);
    return half.up == 0 ? 0 : 2 * std::atan2(half.up, half.along) / whole_sphere;
}

double exact_winding(const Mesh& mesh, std::span<const Index> faces, dvec3 point) {
    constexpr std::size_t at_once = 4096;
    std::vector<double> sums((faces.size() + at_once - 1) / at_once);
    parallel_for(sums.size(), 1, [&](std::size_t i) {
        Angles angles;
        for (Index face : faces.subspan(i * at_once, std::min(at_once, faces.size() - i * at_once))) {
            const uvec3 t = mesh.triangles[face];
            angles.add(half_solid_angle(point, dvec3(mesh.positions[t.x]), dvec3(mesh.positions[t.y]),
                                        dvec3(mesh.positions[t.z])));
        }
        sums[i] = 2 * angles.sum() / whole_sphere;
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
}

// The far field, and the near faces.
struct WindingNumber::Sum {
    double plates = 0;
    Angles faces{};
    double winding() const { return plates + 2 * faces.sum() / whole_sphere; }
    void add_plate(dvec3 area, dvec3 way, double squared) {
        plates += glm::dot(area, way) / (whole_sphere * squared * std::sqrt(squared));
    }
};

WindingNumber::WindingNumber(const Tree& tree)
    : tree_(tree), plates_(tree.plates()), faces_(tree.faces.size()) {
    parallel_for(faces_.size(), 4096, [&](std::size_t i) {
        const uvec3 t = tree.mesh.triangles[tree.faces[i]];
        const dvec3 a(tree.mesh.positions[t.x]), b(tree.mesh.positions[t.y]), c(tree.mesh.positions[t.z]),
            centre = (a + b + c) / 3.0;
        const double reach =
            std::max({glm::distance(centre, a), glm::distance(centre, b), glm::distance(centre, c)});
        faces_[i] = {0.5 * glm::cross(b - a, c - a), centre, far_off * far_off * reach * reach};
    });
}

WindingNumber::Ball WindingNumber::ball(dvec3 centre, double radius) const {
    Ball result{centre, radius};
    if (!tree_.nodes.empty()) gather(0, result);
    return result;
}

WindingNumber::Ball WindingNumber::ball(dvec3 centre, double radius, const Ball& around) const {
    Ball result{centre, radius, around.value + glm::dot(around.slope, centre - around.centre), around.slope};
    for (Index node : around.near) gather(node, result);
    return result;
}

// Adds a node to the far field if it is far; otherwise to the near ones, whole or, if it is large, child by
// child.
void WindingNumber::gather(Index node, Ball& ball) const {
    const Tree::Plate& plate = plates_[node];
    const dvec3 way = plate.centre - ball.centre;
    const double distance = glm::length(way);
    const bool flat = distance - ball.radius > far_off * plate.reach;
    if (flat && distance > far_around * ball.radius) {
        const double share = 1 / (whole_sphere * distance * distance * distance);
        const double seen = glm::dot(plate.area, way) * share;
        ball.value += seen;
        ball.slope += 3 * seen / (distance * distance) * way - share * plate.area;
        return;
    }
    if (const Index second = tree_.nodes[node].second; second != 0 && !flat && plate.reach > ball.radius) {
        gather(node + 1, ball);
        gather(second, ball);
    } else {
        ball.near.push_back(node);
    }
}

double WindingNumber::at(dvec3 point) const {
    Sum sum;
    if (!tree_.nodes.empty()) add(0, point, sum);
    return sum.winding();
}

double WindingNumber::at(dvec3 point, const Ball& ball) const {
    Sum sum{ball.value + glm::dot(ball.slope, point - ball.centre)};
    for (Index node : ball.near) add(node, point, sum);
    return sum.winding();
}

void WindingNumber::add(std::size_t node, dvec3 point, Sum& sum) const {
    const Tree::Plate& plate = plates_[node];
    const dvec3 way = plate.centre - point;
    const double squared = glm::dot(way, way);
    if (squared > far_off * far_off * plate.reach * plate.reach)
        return sum.add_plate(plate.area, way, squared);
    const Tree::Node& box = tree_.nodes[node];
    if (box.second != 0) {
        add(node + 1, point, sum);
        add(box.second, point, sum);
        return;
    }
    for (Index i = box.first; i < box.first + box.count; ++i) {
        const Face& face = faces_[i];
        const dvec3 to_face = face.centre - point;
        if (const double off = glm::dot(to_face, to_face); off > face.squared) {
            sum.add_plate(face.area, to_face, off);
            continue;
        }
        const uvec3 t = tree_.mesh.triangles[tree_.faces[i]];
        sum.faces.add(half_solid_angle(point, dvec3(tree_.mesh.positions[t.x]),
                                       dvec3(tree_.mesh.positions[t.y]), dvec3(tree_.mesh.positions[t.z])));
    }
}

}  // namespace palpate
