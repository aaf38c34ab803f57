#include "palpate/mesh/winding_number.h"

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr double whole_sphere = 4 * std::numbers::pi;
constexpr double far_off = 3;     // in reaches of a plate: for the error that the header promises
constexpr double far_around = 5;  // in radii of a ball, as far as a slope is enough

}  // namespace

double solid_angle(dvec3 point, dvec3 a, dvec3 b, dvec3 c) {
    // Van Oosterom and Strackee (1983).
    a -= point, b -= point, c -= point;
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    const double up = glm::dot(a, glm::cross(b, c));
    const double along = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
    return up == 0 ? 0 : 2 * std::atan2(up, along) / whole_sphere;
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

// Adds a node to what is far if it is, or else to what is near: whole, or in halves if it is large.
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

double WindingNumber::at(dvec3 point, const Ball& ball) const {
    double sum = ball.value + glm::dot(ball.slope, point - ball.centre);
    for (Index node : ball.near) sum += look(node, point);
    return sum;
}

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
