#include "palpate/body/own_weight.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace palpate {
namespace {

// Of a cross-section: what a cell has of it.
struct Part {
    dvec3 middle;
    double area;  // m²
};

// All that lies between two planes.
struct Layer {
    double mass = 0;               // kg
    dvec3 mass_moment = dvec3(0);  // kg m: its mass times its centre
    std::vector<Part> parts;       // of its cross-section
    int nodes = 0, held_nodes = 0;

    bool is_held() const { return held_nodes > 0 && 2 * held_nodes >= nodes; }
};

// What a cross-section bears: a mass with its moment.
struct Load {
    double mass = 0;
    dvec3 moment = dvec3(0);

    void add(const Layer& layer) {
        mass += layer.mass;
        moment += layer.mass_moment;
    }
};

// One after the other along a direction.
std::vector<Layer> layers(const Body& body, std::span<const int> held, dvec3 along) {
    const double h = body.spacing, first = [&] {
        double least = 1e300;
        for (vec3 p : body.positions) least = std::min(least, glm::dot(dvec3(p), along));
        return least;
    }();
    std::vector<Layer> all;
    auto at = [&](dvec3 p) -> Layer& {
        const auto s = std::size_t(std::max(glm::dot(p, along) - first, 0.0) / h + 1e-3);
        if (s >= all.size()) all.resize(s + 1);
        return all[s];
    };
    const TissueCells* tissue = tissue_of(body);
    for (std::size_t c = 0; c < body.cells.size(); ++c) {
        dvec3 middle(0);
        for (int node : body.cells[c]) middle += 0.125 * dvec3(body.positions[std::size_t(node)]);
        at(middle).parts.push_back({middle, h * h * (tissue ? double(tissue->filled[c]) : 1)});
    }
    for (std::size_t i = 0; i < body.count(); ++i) {
        Layer& layer = at(dvec3(body.positions[i]));
        ++layer.nodes;
        if (!(body.inverse_mass[i] > 0)) continue;
        layer.mass += 1.0 / body.inverse_mass[i];
        layer.mass_moment += dvec3(body.positions[i]) / double(body.inverse_mass[i]);
    }
    for (int node : held) ++at(dvec3(body.positions[std::size_t(node)])).held_nodes;
    return all;
}

// The largest in a cross-section of this normal: pressed by the load's weight, and bent by its moment.
double stress(const Layer& layer, const Load& load, double h, dvec3 normal, dvec3 gravity) {
    double area = 0;
    dvec3 middle(0);
    for (const Part& part : layer.parts) {
        area += part.area;
        middle += part.area * part.middle;
    }
    if (!(area > 0 && load.mass > 0)) return 0;
    middle /= area;
    const dvec3 weight = load.mass * gravity, twist = glm::cross(load.moment / load.mass - middle, weight),
                moment = twist - glm::dot(twist, normal) * normal;
    const double pressed = std::abs(glm::dot(weight, normal)) / area, bent = glm::length(moment);
    if (!(bent > 0)) return pressed;
    const dvec3 across = glm::cross(normal, moment) / bent;
    double second = 0, outermost = 0;  // the second moment of the area, m⁴; m
    for (const Part& part : layer.parts) {
        const double out = glm::dot(part.middle - middle, across);
        second += part.area * (out * out + h * h / 12);
        outermost = std::max(outermost, std::abs(out) + h / 2);
    }
    return pressed + bent * outermost / second;
}

// The largest stress from one end on, up to where the body is held.
template <class Iterator>
double largest(Iterator from, Iterator end, double h, dvec3 normal, dvec3 gravity) {
    Load load;
    double most = 0;
    for (; from != end && !from->is_held(); ++from) {
        load.add(*from);
        most = std::max(most, stress(*from, load, h, normal, gravity));
    }
    return most;
}

bool is_held(const std::vector<Layer>& all) {
    return std::ranges::any_of(all, [](const Layer& layer) { return layer.is_held(); });
}

double largest(const std::vector<Layer>& all, double h, dvec3 normal, dvec3 gravity) {
    return std::max(largest(all.begin(), all.end(), h, normal, gravity),
                    largest(all.rbegin(), all.rend(), h, normal, gravity));
}

// From the middle of a body to that of what holds it, across gravity.
dvec3 way_aside(const Body& body, std::span<const int> held, dvec3 down) {
    dvec3 all(0), holding(0);
    for (vec3 p : body.positions) all += dvec3(p) / double(body.count());
    for (int node : held) holding += dvec3(body.positions[std::size_t(node)]) / double(held.size());
    return holding - all - glm::dot(holding - all, down) * down;
}

}  // namespace

double own_weight_stress(const Body& body, std::span<const int> held, vec3 gravity) {
    if (body.cells.empty() || !(glm::length(gravity) > 0)) return 0;
    const dvec3 down = glm::normalize(dvec3(gravity));
    std::vector<Layer> all = layers(body, held, down);
    if (held.empty()) all.back().held_nodes = all.back().nodes;
    if (is_held(all)) return largest(all, body.spacing, down, gravity);
    const dvec3 aside = way_aside(body, held, down);  // held at a side, it sticks out like a shelf
    if (!(glm::length(aside) > 1e-3 * body.spacing)) return 0;
    const dvec3 along = glm::normalize(aside);
    all = layers(body, held, along);
    return is_held(all) ? largest(all, body.spacing, along, gravity) : 0;
}

}  // namespace palpate
