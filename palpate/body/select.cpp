#include "palpate/body/select.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>
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

std::vector<int> nodes_labelled(const Body& body, const Volume& labels, float label) {
    return nodes_where(body, [&](vec3 p) {
        const vec3 in_grid = glm::transpose(labels.direction) * (p - labels.origin) / labels.spacing;
        const ivec3 v(glm::floor(in_grid + 0.5f));
        const bool inside =
            glm::all(glm::greaterThanEqual(v, ivec3(0))) && glm::all(glm::lessThan(v, labels.dims));
        return inside && labels.at(v.x, v.y, v.z) == label;
    });
}

void strengthen(Body& body, std::span<const float> factors) {
    if (factors.size() != body.count())
        throw Error(fmt::format("{} factors on the strength of {} nodes", factors.size(), body.count()),
                    name_in_errors(body), "give one a node");
    for (float factor : factors)
        if (!(factor >= 0 && std::isfinite(factor)))
            throw Error("a factor that is negative or not finite", name_in_errors(body), "use 0 or more");
    auto mean = [&](int a, int b) { return 0.5f * (factors[std::size_t(a)] + factors[std::size_t(b)]); };
    for (Term& term : body.terms)
        if (auto* grid = std::get_if<GridSprings>(&term)) {
            grid->strength.resize(body.count(), 1);
            for (std::size_t i = 0; i < factors.size(); ++i) grid->strength[i] *= factors[i];
        } else if (auto* listed = std::get_if<ListedSprings>(&term)) {
            for (Spring& spring : listed->springs) spring.stiffness *= mean(spring.a, spring.b);
        } else if (auto* cells = std::get_if<TissueCells>(&term)) {
            for (std::size_t c = 0; c < cells->weights.size(); ++c) {
                float sum = 0;
                for (int node : body.cells[c]) sum += factors[std::size_t(node)];
                cells->weights[c] *= std::max(sum / 8, 1e-6f);
            }
        } else {
            for (Hinge& hinge : std::get<Bending>(term).hinges) hinge.stiffness *= mean(hinge.from, hinge.to);
        }
}

void pin(Body& body, std::span<const int> nodes) {
    for (int node : nodes)
        if (node < 0 || std::size_t(node) >= body.count())
            throw Error(fmt::format("node {} of {}", node, body.count()), name_in_errors(body),
                        "count nodes from 0");
    for (int node : nodes) body.inverse_mass[std::size_t(node)] = 0;
}

}  // namespace palpate
