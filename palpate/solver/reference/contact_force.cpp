#include "palpate/solver/contact_force.h"

#include "palpate/base/error.h"
#include "palpate/solver/check.h"
#include "palpate/solver/reference/node.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {

double ContactForce::area() const {
    double sum = 0;
    for (const PressedNode& one : pressed) sum += one.area;
    return sum;
}

double ContactForce::pressure() const {
    double most = 0;
    for (const PressedNode& one : pressed) most = std::max(most, one.pressure);
    return most;
}

ContactForce contact_force(const Body& body, std::span<const vec3> nodes, const Press& press) {
    check(1, {.presses = {&press, 1}}, body, {});
    if (nodes.size() != body.count())
        throw Error(fmt::format("{} places for {} nodes", nodes.size(), body.count()), name_in_errors(body),
                    "hand in one for each");
    // What a tip does to a node depends on nothing around it.
    const Body nothing;
    const reference::Surroundings around(nothing);
    const reference::NodesNow<double> others(nullptr, nullptr);
    const Pass pass = make_pass(body, {});
    std::vector<RoundTip> tips;
    place_tips(tips, {.presses = {&press, 1}}, 0);

    ContactForce sum;
    const dvec3 centre(press.centre);
    dvec3 normal(0), moment(0);
    double outside = 0;  // N, on the nodes of the outside
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const double area = body.area[i], cover = body.cover[i];
        const dvec3 place(nodes[i]);
        reference::NodePhysics<double, false> node{around,  pass, others, int(i), 0,
                                                   nullptr, {},   area,   cover,  tips};
        const dvec3 force = node.tip_force(place, 0);
        if (force == dvec3(0)) continue;
        const dvec3 away = glm::normalize(place - centre);
        const double pushed = glm::dot(force, away);
        sum.force += force;
        normal += pushed * away;
        if (!(area > 0)) continue;  // inside tissue, which a deep tip reaches too
        outside += pushed;
        moment += pushed * (place - cover * away);
        sum.pressed.push_back({int(i), pushed / area, area});
    }
    if (!std::isfinite(glm::dot(sum.force, sum.force)))
        throw Error("a node whose place is not finite", name_in_errors(body), "hand in places in m");
    if (const double length = glm::length(normal); length > 0) sum.normal = normal / length;
    if (outside > 0) sum.place = moment / outside;
    if (const double steepness = pressure_per_metre(press); steepness > 0)
        sum.penetration = sum.pressure() / steepness;
    return sum;
}

}  // namespace palpate
