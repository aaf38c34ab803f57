// With the core alone: a mesh becomes a lattice with an embedded surface, which falls onto a table. Using a
// part that was left out throws an Error that names it.
#include "palpate/base/error.h"
#include "palpate/body/collider.h"
#include "palpate/body/embedding.h"
#include "palpate/body/lattice.h"
#include "palpate/mesh/repair.h"
#include "palpate/solver/solver.h"

#include <cstdio>
#include <functional>
#include <string>
#include <utility>

using namespace palpate;

namespace {

int failures = 0;

void expect(bool right, const char* what) {
    if (right) return;
    std::fprintf(stderr, "failed: %s\n", what);
    ++failures;
}

// A cube whose faces are divided into squares.
Mesh block(float size, int squares) {
    Mesh mesh;
    for (int side = 0; side < 6; ++side) {
        const int axis = side / 2, first = int(mesh.positions.size());
        const bool up = side % 2 == 1;
        for (int v = 0; v <= squares; ++v)
            for (int u = 0; u <= squares; ++u) {
                vec3 p;
                p[axis] = up ? size : 0;
                p[(axis + 1) % 3] = size * float(u) / float(squares);
                p[(axis + 2) % 3] = size * float(v) / float(squares);
                mesh.positions.push_back(p);
            }
        auto at = [&](int u, int v) { return unsigned(first + v * (squares + 1) + u); };
        for (int v = 0; v < squares; ++v)
            for (int u = 0; u < squares; ++u) {
                uvec3 low(at(u, v), at(u + 1, v), at(u + 1, v + 1)),
                    high(at(u, v), at(u + 1, v + 1), at(u, v + 1));
                if (!up) std::swap(low.y, low.z), std::swap(high.y, high.z);
                mesh.triangles.insert(mesh.triangles.end(), {low, high});
            }
    }
    return mesh;
}

std::string refusal(const std::function<void()>& act) {
    try {
        act();
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

bool has(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

}  // namespace

int main() try {
    Mesh mesh = block(0.1f, 12);
    repair(mesh);
    expect(soundness(mesh).closed(), "the walls are mended");
    const Body body = lattice(
        mesh, {.spacing = 0.0125f, .material = {.youngs_modulus = 20e3f, .density = 1000, .damping = 4}});
    expect(body.count() == 9 * 9 * 9, "the block is filled");
    const Embedding skin = embed(mesh, body);

    Simulation simulation{.backend = Backend::cpu};
    simulation.colliders.push_back({.shape = Plane{{0, 1, 0}, -0.05f}});
    auto solver = make_solver(body, simulation);
    for (int frame = 0; frame < 60; ++frame)
        expect(!solver->step(1.0 / 60).diverged, "it moves as it should");
    const Bounds before = bounds(mesh);
    deform(skin, solver->nodes(), mesh.positions, mesh.normals);
    const Bounds after = bounds(mesh);
    expect(after.low.y < before.low.y - 0.045f && after.low.y > before.low.y - 0.055f,
           "it lies on the table");
    std::printf("%zu nodes; the surface fell by %.1f mm\n", body.count(),
                1000 * (before.low.y - after.low.y));

    const std::string gpu = refusal([&] { make_solver(body, {.backend = Backend::compute}); });
    expect(has(gpu, "without its part opengl") && has(gpu, "PALPATE_PARTS"), "the GPU's part is named");
    const std::string voxels = refusal([&] { repair(mesh, {.solid = SolidBy::voxels}); });
    expect(has(voxels, "without its part voxels") && has(voxels, "PALPATE_PARTS"),
           "the voxels' part is named");
    return failures;
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
