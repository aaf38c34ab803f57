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

// All that lies between two planes across gravity.
struct Layer {
    double mass = 0;               // kg
    dvec3 mass_moment = dvec3(0);  // kg m: its mass times its centre
    std::vector<Part> parts;       // of its cross-section
    bool is_held = false;
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

std::vector<Layer> layers(const Body& body, std::span<const int> held, dvec3 down) {
    const double h = body.spacing, top = [&] {
        double least = 1e300;
        for (vec3 p : body.positions) least = std::min(least, glm::dot(dvec3(p), down));
        return least;
    }();
    std::vector<Layer> all;
    auto at = [&](dvec3 p) -> Layer& {
        const auto s = std::size_t(std::max(glm::dot(p, down) - top, 0.0) / h + 1e-3);
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
        if (!(body.inverse_mass[i] > 0)) continue;
        Layer& layer = at(dvec3(body.positions[i]));
        layer.mass += 1.0 / body.inverse_mass[i];
        layer.mass_moment += dvec3(body.positions[i]) / double(body.inverse_mass[i]);
    }
    for (int node : held) at(dvec3(body.positions[std::size_t(node)])).is_held = true;
    return all;
}

double stress(const Layer& layer, const Load& load, double h, dvec3 down, double gravity) {
    double area = 0;
    dvec3 middle(0);
    for (const Part& part : layer.parts) {
        area += part.area;
        middle += part.area * part.middle;
    }
    if (!(area > 0 && load.mass > 0)) return 0;
    middle /= area;
    dvec3 arm = load.moment / load.mass - middle;
    arm -= glm::dot(arm, down) * down;
    const double length = glm::length(arm), weight = load.mass * gravity;
    if (!(length > 0)) return weight / area;
    double second = 0, outermost = 0;  // the second moment of the area along the arm, m⁴; m
    for (const Part& part : layer.parts) {
        const double out = glm::dot(part.middle - middle, arm) / length;
        second += part.area * (out * out + h * h / 12);
        outermost = std::max(outermost, std::abs(out) + h / 2);
    }
    return weight / area + weight * length * outermost / second;
}

// The largest stress from one end on, up to where the body is held.
template <class Iterator>
double largest(Iterator from, Iterator end, double h, dvec3 down, double gravity) {
    Load load;
    double most = 0;
    for (; from != end && !from->is_held; ++from) {
        load.add(*from);
        most = std::max(most, stress(*from, load, h, down, gravity));
    }
    return most;
}

}  // namespace

double own_weight_stress(const Body& body, std::span<const int> held, vec3 gravity) {
    const double strength = glm::length(gravity);
    if (body.cells.empty() || !(strength > 0)) return 0;
    const dvec3 down = dvec3(gravity) / strength;
    std::vector<Layer> all = layers(body, held, down);
    if (held.empty()) all.back().is_held = true;
    return std::max(largest(all.begin(), all.end(), body.spacing, down, strength),
                    largest(all.rbegin(), all.rend(), body.spacing, down, strength));
}

}  // namespace palpate
