// Takes files all the way to a pressed body, each in a process of its own, and prints docs/results.md's table
// of real files:
//   palpate-files FILE[=ISO] ...
// FILE is a mesh, a volume (at its suggested isovalue or ISO), or a folder with a DICOM series. Each is
// scaled to a longest side of 200 mm, filled with a lattice of about 8,000 nodes, pinned at its lowest fifth,
// and pressed at its highest point by a round tip for 1,000 steps.
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/isolated.h"
#include "palpate/base/memory.h"
#include "palpate/body/embedding.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/files/read.h"
#include "palpate/scene/surface.h"
#include "palpate/solver/solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace {

using namespace palpate;

constexpr float size = 0.2f;  // m
constexpr int steps = 1000;

BodyRecipe recipe_of(const std::string& argument) {
    BodyRecipe recipe;
    const std::size_t equals = argument.find('=');
    const std::string file = std::filesystem::absolute(argument.substr(0, equals)).string();
    (is_volume(file) ? recipe.volume : recipe.surface) = file;
    if (equals != std::string::npos) recipe.iso = std::stof(argument.substr(equals + 1));
    recipe.name = std::filesystem::path(file).filename().string();
    recipe.largest = !recipe.volume.empty();
    recipe.faces = 150'000;
    recipe.size = size;
    recipe.centre = true;
    return recipe;
}

struct Pressed {
    double seconds = 0, force = 0;  // force: N, the largest
    bool sound = true;              // all finite, nothing diverged
};

// The tip gets as deep as a twentieth of the size.
Pressed press(const Body& body, const Mesh& mesh, const Embedding& skin) {
    const vec3 top = *std::max_element(mesh.positions.begin(), mesh.positions.end(),
                                       [](vec3 a, vec3 b) { return a.y < b.y; });
    Press tip{.centre = top + vec3(0, 0.02f, 0), .radius = 0.02f, .stiffness = 500};
    const auto solver = make_solver(body, {.gravity = vec3(0)});
    const double step = solver->longest_step({.presses = {&tip, 1}});
    tip.velocity = {0, float(-0.05 * size / (steps * step)), 0};
    Pressed result;
    const double start = now();
    for (int i = 0; i < steps; ++i) {
        const Stats stats = solver->step(step, {.presses = {&tip, 1}});
        result.sound &= !stats.diverged;
        result.force = std::max(result.force, glm::length(stats.reactions[0]) / step);
        tip.centre += float(step) * tip.velocity;
    }
    result.seconds = now() - start;
    std::vector<vec3> positions, normals;
    deform(skin, solver->nodes(), positions, normals);
    for (vec3 p : positions) result.sound &= std::isfinite(p.x + p.y + p.z);
    result.sound &= result.force > 0;
    return result;
}

std::string row(const std::string& argument) {
    const BodyRecipe recipe = recipe_of(argument);
    const double start = now();
    const CleanSurface surface = make_surface(recipe, {});
    const double seconds = now() - start;
    const std::size_t memory = peak_memory();

    Body body = lattice(
        surface.mesh, {.nodes = 8000, .material = {.youngs_modulus = 2e4f, .density = 1000, .damping = 20}});
    pin(body, nodes_below(body, 0.2f, {0, -1, 0}));
    const Embedding skin = embed(surface.mesh, body);
    const Pressed pressed = press(body, surface.mesh, skin);

    std::string repairs;
    for (std::size_t i = 1; i + 1 < surface.steps.size(); ++i)
        repairs += (repairs.empty() ? "" : "; ") + surface.steps[i];
    return fmt::format("| {} | {} | {} | {}, {} | {:.1f} | {} | {} | {:.2f} N, {} |\n", recipe.name,
                       surface.steps.front(), repairs, surface.mesh.positions.size(),
                       surface.mesh.triangles.size(), seconds, memory >> 20, body.count(), pressed.force,
                       pressed.sound ? "sound" : "DIVERGED");
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 2) {
        fmt::print(stderr, "usage: palpate-files FILE[=ISO] ...\n");
        return 2;
    }
    fmt::print(
        "| file | read | mended | vertices, faces | s | MB | nodes | 1,000 steps of pressing |\n"
        "| --- | --- | --- | --- | --- | --- | --- | --- |\n");
    constexpr std::size_t most = std::size_t(16) << 30;  // also for what sandboxed readers write
    bool all = true;
    for (int i = 1; i < count; ++i) try {
            const Written line =
                isolated("palpate-files", arguments[i], {.seconds = 600, .bytes = most, .output = most},
                         [&](std::FILE* out) { fmt::print(out, "{}", row(arguments[i])); });
            fmt::print("{}", std::string_view(line.bytes().data(), line.bytes().size()));
            all &= std::string_view(line.bytes().data(), line.bytes().size()).find("DIVERGED") ==
                   std::string_view::npos;
        } catch (const Error& error) {
            fmt::print("| {} | {} |\n", arguments[i], error.what());
            all = false;
        }
    return all ? 0 : 1;
}
