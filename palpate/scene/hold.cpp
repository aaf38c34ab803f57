#include "palpate/scene/hold.h"

#include "palpate/base/error.h"
#include "palpate/body/lattice.h"
#include "palpate/body/own_weight.h"
#include "palpate/body/select.h"
#include "palpate/body/simulation.h"
#include "palpate/files/read.h"
#include "palpate/scene/reading.h"
#include "palpate/scene/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace palpate {

vec3 down(const Scene& scene) {
    const vec3 gravity = scene.simulation.gravity;
    return glm::length(gravity) > 0 ? glm::normalize(gravity) : vec3(0, -1, 0);
}

std::vector<int> chosen(const Body& body, const Choice& choice, const Scene& scene, const Lines& lines,
                        const std::string& where, const std::string& key, std::vector<std::string>& notes) {
    std::vector<int> all;
    auto add = [&](const char* which, const std::vector<int>& nodes) {
        if (nodes.empty()) notes.push_back(fmt::format("{}: {}{} selects no node", where, key, which));
        all.insert(all.end(), nodes.begin(), nodes.end());
    };
    if (choice.below) add("below", nodes_below(body, *choice.below, down(scene)));
    if (choice.near) add("near", nodes_near(body, *choice.near, choice.radius));
    if (choice.near && choice.radius == 0 && !all.empty()) {
        const float far = glm::distance(*choice.near, body.positions[std::size_t(all.back())]);
        if (far > glm::length(bounds(body.positions).size()))
            notes.push_back(
                fmt::format("{}: {}near is {:.3g} m from the nearest node; is it in m?", where, key, far));
    }
    if (!choice.box.empty()) add("box", nodes_in(body, bounds(choice.box)));
    for (int node : choice.nodes)
        if (node < 0 || node >= int(body.count()))
            throw Error(fmt::format("{}: {}nodes names node {}, and there are {} nodes", where, key, node,
                                    body.count()),
                        lines.where(key + "nodes", scene.file), "count nodes from 0");
    all.insert(all.end(), choice.nodes.begin(), choice.nodes.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

Material first_material(const BodyRecipe& recipe) {
    Material material = recipe.material;
    if (recipe.bears_its_weight()) material.youngs_modulus = 1e4f;
    return material;
}

namespace {

// `where` names the region in notes.
Volume read_labels(const Region& region, const BodyRecipe& recipe, const Scene& scene,
                   const std::string& where, std::vector<std::string>& notes) {
    std::vector<std::string> of_file;
    Volume labels = reading(scene, where, region.lines, "labels", [&] {
        return read_volume(find_data(region.labels, scene.folder), recipe.units, &of_file);
    });
    for (const std::string& note : of_file) notes.push_back(where + ", labels: " + note);
    const mat3 turned = turn(recipe.rotate);
    labels.origin = turned * labels.origin + recipe.move;
    labels.direction = turned * labels.direction;
    return labels;
}

// The factor of a region's stiffness over the body's.
float factor_of(const Region& region, const Body& body) {
    if (region.factor > 0) return region.factor;
    if (const TissueCells* cells = tissue_of(body)) return region.youngs_modulus / cells->youngs_modulus;
    const float stiffness =
        region.stiffness > 0 ? region.stiffness : 0.4f * region.youngs_modulus * body.spacing;
    return stiffness / body.grid()->links[0].stiffness;
}

void strengthen_regions(Body& body, const BodyRecipe& recipe, const Scene& scene,
                        std::vector<std::string>& notes) {
    std::vector<float> factors(body.count(), 1);
    for (std::size_t r = 0; r < recipe.regions.size(); ++r) {
        const Region& region = recipe.regions[r];
        const std::string where = fmt::format("body {}, region {}", recipe.name, r + 1);
        std::vector<int> nodes = chosen(body, region.choice, scene, region.lines, where, "", notes);
        if (!region.labels.empty()) {
            const auto labelled =
                nodes_labelled(body, read_labels(region, recipe, scene, where, notes), *region.label);
            if (labelled.empty()) notes.push_back(where + ": label selects no node");
            nodes.insert(nodes.end(), labelled.begin(), labelled.end());
        }
        for (int node : nodes) factors[std::size_t(node)] = factor_of(region, body);
    }
    if (!recipe.regions.empty()) strengthen(body, factors);
}

// The modulus of cells at which a frame takes 500 automatic steps of Verlet, which leaves half of the limit
// to tools and to harder regions: (12 λ + 8 µ) / (ρ h²) is above the square of every frequency.
double stiffest_in_time(const Body& body, TissueCells cells) {
    constexpr double frequency = 1.16 * 500 / frame_seconds;  // automatic_step() takes 1.16 / frequency
    cells.youngs_modulus = 1;
    double volume = 0;
    for (float part : cells.filled) volume += double(part) * std::pow(double(body.spacing), 3);
    const double of_one = double(12 * cells.lame() + 8 * cells.shear()) * volume /
                          (mass(body) * body.spacing * body.spacing);  // its frequency squared
    return frequency * frequency / of_one;
}

double to_two_digits(double a) {
    const double unit = std::pow(10.0, std::floor(std::log10(a)) - 1);
    return std::round(a / unit) * unit;
}

// The modulus at which its own weight on Earth strains a body by three hundredths, to two digits; or more
// than that, where steps would be too short.
void stiffen_to_bear(Body& body, const std::string& name, std::span<const int> held, vec3 down,
                     std::vector<std::string>& notes) {
    constexpr double strain = 0.03, earth = 9.81;
    const double stress = own_weight_stress(body, held, float(earth) * down);
    for (Term& term : body.terms) {
        auto* cells = std::get_if<TissueCells>(&term);
        if (!cells) continue;
        const double enough = stress > 0 ? stress / strain : cells->youngs_modulus,
                     allowed = stiffest_in_time(body, *cells);
        cells->youngs_modulus = float(to_two_digits(std::min(enough, allowed)));
        const std::string why =
            stress > 0 ? fmt::format("at which its own weight strains it by {:.0f} %{}",
                                     100 * stress / double(cells->youngs_modulus),
                                     enough > allowed ? " (less would take more than 500 steps a frame)" : "")
                       : "since it is not known what it has to bear";
        notes.push_back(fmt::format("body {}: it is given youngs_modulus = {:.2g} Pa, {}; say another", name,
                                    cells->youngs_modulus, why));
    }
}

}  // namespace

void hold(Body& body, const BodyRecipe& recipe, const Scene& scene, std::vector<std::string>& notes) {
    const std::vector<int> held =
        chosen(body, recipe.pin, scene, recipe.lines, "body " + recipe.name, "pin.", notes);
    if (recipe.bears_its_weight()) stiffen_to_bear(body, recipe.name, held, down(scene), notes);
    strengthen_regions(body, recipe, scene, notes);
    if (held.size() == body.count())
        notes.push_back(fmt::format("body {}: pin holds all its {} nodes, so it will not move; pin fewer",
                                    recipe.name, held.size()));
    pin(body, held);
}

}  // namespace palpate
