#include "palpate/mesh/winding_number.h"

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr double whole_sphere = 4 * std::numbers::pi;
constexpr double far_off = 3;  // in reaches of a plate: for the error that the header promises

}  // namespace

double solid_angle(dvec3 point, dvec3 a, dvec3 b, dvec3 c) {
    // Van Oosterom and Strackee (1983).
    a -= point, b -= point, c -= point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double up = glm::dot(a, glm::cross(b, c));
    const double along = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return up == 0 ? 0 : 2 * std::atan2(up, along) / whole_sphere;
}

double WindingNumber::at(dvec3 point) const { return tree_.nodes.empty() ? 0 : look(0, point); }

double WindingNumber::look(std::size_t node, dvec3 point) const {
    const Tree::Plate& plate = plates_[node];
    const dvec3 way = plate.centre - point;
    const double distance = glm::length(way);
    if (distance > far_off * plate.reach)
        return glm::dot(plate.area, way) / (whole_sphere * distance * distance * distance);
    const Tree::Node& box = tree_.nodes[node];
    if (box.second != 0) return look(node + 1, point) + look(box.second, point);
    double sum = 0;
    for (Index i = box.first; i < box.first + box.count; ++i) {
        const uvec3 t = tree_.mesh.triangles[tree_.faces[i]];
        sum += solid_angle(point, dvec3(tree_.mesh.positions[t.x]), dvec3(tree_.mesh.positions[t.y]),
                           dvec3(tree_.mesh.positions[t.z]));
    }
    return sum;
}

}  // namespace palpate
