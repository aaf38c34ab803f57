#include "palpate/body/select.h"

#include <cmath>
#include <limits>

namespace palpate {
namespace {

template <class Chosen>
std::vector<int> nodes_where(const Body& body, Chosen chosen) {
    std::vector<int> nodes;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (chosen(body.positions[i])) nodes.push_back(int(i));
    return nodes;
}

}  // namespace

std::vector<int> nodes_below(const Body& body, float fraction, vec3 down) {
    float lowest = std::numeric_limits<float>::lowest(), highest = -lowest;  // as depth: larger is lower
    for (vec3 p : body.positions) {
        lowest = std::max(lowest, glm::dot(p, down));
        highest = std::min(highest, glm::dot(p, down));
    }
    // A hair more than asked for, so that rounding cannot cut a layer of the grid in two.
    const float limit = lowest - (fraction + 1e-5f) * (lowest - highest);
    return nodes_where(body, [&](vec3 p) { return glm::dot(p, down) >= limit; });
}

std::vector<int> nodes_near(const Body& body, vec3 point, float radius) {
    if (radius > 0) return nodes_where(body, [&](vec3 p) { return glm::distance(p, point) <= radius; });
    int nearest = -1;
    float best = std::numeric_limits<float>::max();
    for (std::size_t i = 0; i < body.count(); ++i)
        if (float d = glm::distance(body.positions[i], point); d < best) {
            best = d;
            nearest = int(i);
        }
    return nearest < 0 ? std::vector<int>{} : std::vector<int>{nearest};
}

std::vector<int> nodes_in(const Body& body, const Bounds& box) {
    return nodes_where(body, [&](vec3 p) {
        return glm::all(glm::greaterThanEqual(p, box.low)) && glm::all(glm::lessThanEqual(p, box.high));
    });
}

void pin(Body& body, std::span<const int> nodes) {
    for (int node : nodes) body.inverse_mass[node] = 0;
}

}  // namespace palpate
