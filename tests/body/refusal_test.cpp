// What a caller can get wrong is an Error that says so.
#include "tests/refusal.h"

#include "palpate/base/error.h"
#include "palpate/base/team.h"
#include "palpate/body/cloth.h"
#include "palpate/body/embedding.h"
#include "palpate/body/hull.h"
#include "palpate/body/lattice.h"
#include "palpate/body/patch.h"
#include "palpate/body/select.h"
#include "palpate/files/image_file.h"
#include "palpate/files/write.h"
#include "palpate/mesh/histogram.h"
#include "palpate/mesh/relief.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/solid.h"
#include "palpate/voxels/isosurface.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace palpate {
namespace {

const Material of_springs{.youngs_modulus = 2000, .density = 1000, .model = MaterialModel::springs};
constexpr float none = std::numeric_limits<float>::quiet_NaN();

// Meshes that no function may take as they are.
std::vector<Mesh> unsound() {
    const Mesh sound = ellipsoid(vec3(0.1f), 6);
    std::vector<Mesh> all(5, sound);
    all[0].triangles[3].y = unsigned(sound.positions.size());
    all[1].positions[2].x = none;
    all[2].normals.pop_back();
    all[3].uvs.resize(3);
    all[4].tangents.resize(1);
    return all;
}

TEST(Refusal, OfMeshesThatDoNotHold) {
    const Body body = lattice({4, 4, 4}, 0.05f, of_springs);
    const Scratch scratch;
    for (const Mesh& mesh : unsound()) {
        expect_refused("the mesh", [&] { check(mesh, "the mesh"); });
        expect_refused("lattice", [&] { lattice(mesh, {.spacing = 0.05f, .material = of_springs}); });
        expect_refused("cloth", [&] { cloth(mesh, {.density = 1}); });
        expect_refused("the body", [&] { embed(mesh, body); });
        expect_refused("distance", [&] { SignedDistance(mesh, 0.05f); });
        expect_refused("mesh.stl", [&] { write_mesh(mesh, scratch / "mesh.stl"); });
    }
    Mesh plain = ellipsoid(vec3(0.1f), 6);
    expect_refused("texture coordinates", [&] { compute_tangents(plain); });
    expect_refused("tolerance", [&] { weld(plain, none); });
    expect_refused("voxel", [&] { SignedDistance(plain, 0); });
}

TEST(Refusal, OfNumbersOfWhichNothingCanBeMade) {
    const Mesh mesh = ellipsoid(vec3(0.1f), 6);
    for (const Material& odd :
         {Material{}, Material{.youngs_modulus = 1, .density = 1, .mass = 1},
          Material{.youngs_modulus = 1, .stiffness = 1, .density = 1},
          Material{.youngs_modulus = none, .density = 1}, Material{.youngs_modulus = 1, .density = -1}}) {
        expect_refused("the material", [&] { lattice(mesh, {.spacing = 0.05f, .material = odd}); });
        if (odd != Material{}) expect_refused("the material", [&] { lattice({3, 3, 3}, 0.01f, odd); });
    }
    for (const LatticeSettings& odd : {LatticeSettings{.nodes = 0, .material = of_springs},
                                       LatticeSettings{.spacing = -1, .material = of_springs},
                                       LatticeSettings{.spacing = none, .material = of_springs}})
        expect_refused("spacing", [&] { lattice(mesh, odd); });
    // A box of which nothing is said is a cage that somebody else moves.
    const Body cage = lattice({3, 3, 3}, 0.1f, {});
    for (float inverse : cage.inverse_mass) EXPECT_EQ(inverse, 0);
    EXPECT_NO_THROW(embed(mesh, cage));
    expect_refused("the material", [] { lattice({3, 3, 3}, 0.01f, SpringKinds{1, 1, 1}, {}); });
    for (ivec3 dims : {ivec3(-1, 3, 3), ivec3(0, 5, 5), ivec3(1 << 20)})
        expect_refused("nodes", [&] { lattice(dims, 0.01f, of_springs); });
    for (float spacing : {0.0f, -1.0f, none}) {
        expect_refused("spacing", [&] { lattice({3, 3, 3}, spacing, of_springs); });
        expect_refused("spacing", [&] { cloth({3, 3}, spacing, {.density = 1}); });
    }
    for (ivec2 dims : {ivec2(0, 3), ivec2(3, -1), ivec2(1 << 20)})
        expect_refused("nodes", [&] { cloth(dims, 0.01f, {.density = 1}); });
    expect_refused("density", [] { cloth({3, 3}, 0.01f, {}); });
    expect_refused("masses", [] { net(std::vector<vec3>(2), std::vector<float>{1}, {}, {}); });
    Body body = lattice({3, 3, 3}, 0.01f, of_springs);
    expect_refused("node 27 of 27", [&] { pin(body, std::vector<int>{3, 27}); });
    EXPECT_GT(body.inverse_mass[3], 0);
    expect_refused("factors", [&] { strengthen(body, std::vector<float>(3, 1)); });
    expect_refused("factor", [&] { strengthen(body, std::vector<float>(body.count(), none)); });
    expect_refused("rows", [] { normal_map(std::vector<float>(7), 3); });
    expect_refused("threads", [] { weave({0, 4}); });
    expect_refused("bins", [] { histogram(Volume{}, 10); });
    expect_refused("values", [] { isosurface(Volume{}, 0.5f); });
    expect_refused("pixels", [] { write_png({2, 2, {1, 2, 3}}, "small.png"); });
    for (int members : {0, -1, 100'000}) expect_refused("members", [&] { Team team(members); });
}

TEST(Refusal, OfTooFewNodes) {
    const Mesh mesh = ellipsoid(vec3(0.1f), 6);
    const Body body = lattice(mesh, {.spacing = 0.05f, .material = of_springs});
    const std::vector<vec3> facing = approximate_normals(body, body.positions);
    std::vector<vec3> positions, normals;
    const std::span<const vec3> few(body.positions.data(), body.count() - 1);
    for (Mapping mapping : {Mapping::trilinear, Mapping::constant, Mapping::interpolated, Mapping::frames}) {
        const Embedding skin = embed(mesh, body, mapping);
        expect_refused("nodes", [&] { deform(skin, {few, facing}, positions, normals); });
        if (mapping == Mapping::interpolated)
            expect_refused("normals", [&] { deform(skin, {body.positions, {}}, positions, normals); });
        else
            EXPECT_NO_THROW(deform(skin, {body.positions, {}}, positions, normals));
    }
    expect_refused("positions", [&] { inverted_cells(body, few); });
    expect_refused("positions", [&] { approximate_normals(body, few); });
    Body gridless = body;
    gridless.at.clear();
    gridless.terms.clear();
    expect_refused("grid", [&] { embed(mesh, gridless); });
}

TEST(Refusal, OfSurfacesThatAHandCannotTouch) {
    const Mesh mesh = ellipsoid(vec3(0.1f), 6);
    const std::vector<vec3> few(3, vec3(0));
    const std::vector<uvec3> wrong = {{0, 1, unsigned(mesh.positions.size())}};
    const Touchable no_speeds{mesh.positions, mesh.triangles, few}, no_vertex{mesh.positions, wrong};
    expect_refused("velocities", [&] { Patch patch({&no_speeds, 1}); });
    expect_refused("missing vertices", [&] { Patch patch({&no_vertex, 1}); });
}

}  // namespace
}  // namespace palpate
