// Every integrator × body × collider goes on for 1,000 automatic steps.
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/solver.h"
#include "tests/integrators.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

const Material of_springs{.youngs_modulus = 2000,
                          .density = 1000,
                          .damping = 40,
                          .link_damping = 1e-4f,
                          .model = MaterialModel::springs};
const ClothSettings linen{.density = 0.3f, .damping = 40, .link_damping = 1e-4f};

// An open disc: a hub whose ring is closed, and a rim whose rings are open.
Mesh disc() {
    Mesh mesh;
    mesh.positions.push_back(vec3(0));
    for (unsigned i = 0; i < 9; ++i) {
        const float angle = 0.6981317f * float(i);
        mesh.positions.push_back(0.03f * vec3(std::cos(angle), std::sin(angle), 0));
        mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % 9});
    }
    return mesh;
}

TEST(Cloth, OpenAndClosedRingsFaceTheSameWay) {
    const Body body = cloth(disc(), linen);
    auto solver = make_solver(body, {});
    for (vec3 n : solver->nodes().normals) EXPECT_LE(glm::distance(n, vec3(0, 0, 1)), 1e-5f);
    EXPECT_EQ(body.fan, 9);  // the hub's nine; at the rim three neighbours and places that stay empty
}

std::vector<std::pair<std::string, Body>> bodies() {
    const std::vector<vec3> tetrahedron = {{0, 0, 0}, {0.03f, 0, 0}, {0, 0.03f, 0}, {0, 0, 0.03f}};
    std::vector<Spring> edges;
    for (int a = 0; a < 4; ++a)
        for (int b = 0; b < a; ++b) edges.push_back({a, b, 20});
    Body net_body = net(tetrahedron, std::vector<float>{0.01f, 0.01f, 0.01f, 0.02f}, edges);
    net_body.damping = 40;
    ClothSettings stiff_linen = linen;
    stiff_linen.bending = 1e-3f;
    Body nodule = lattice({4, 4, 4}, 0.01f, of_springs);
    std::vector<float> factors(nodule.count(), 1);
    for (int node : nodes_near(nodule, vec3(0.015f), 0.011f)) factors[std::size_t(node)] = 5;
    strengthen(nodule, factors);
    Material of_tissue = of_springs;
    of_tissue.model = MaterialModel::tissue;
    return {
        {"lattice", lattice({4, 3, 5}, 0.01f, of_springs)},
        {"lattice of a mesh",
         lattice(ellipsoid({0.02f, 0.025f, 0.03f}, 12), {.nodes = 60, .material = of_springs})},
        {"lattice with a hard part", nodule},
        {"solid", lattice({4, 5, 3}, 0.01f, of_tissue)},
        {"volume of 2012", lattice({4, 4, 3}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.05f, .damping = 40})},
        {"cloth", cloth({7, 8}, 0.01f, linen)},
        {"cloth of triangles", cloth(disc(), linen)},
        {"cloth of triangles that bends", cloth(disc(), stiff_linen)},
        {"net", net_body},
        {"single node", lattice({1, 1, 1}, 0.01f, of_springs)},
        {"empty", net({}, {}, {})}};
}

std::vector<std::pair<std::string, Collider>> colliders() {
    const vec3 a(-1, -0.01f, -1), b(1, -0.012f, -1), c(0, -0.01f, 1);
    return {
        {"none", {Plane{{0, 1, 0}, -100}}},
        {"plane", {Plane{{0, 1, 0}, 0.004f}, 0.5f}},
        {"sphere", {Sphere{{0.01f, -0.01f, 0.01f}, 0.02f}, 0.5f}},
        {"capsule", {Capsule{{-0.05f, 0, 0.01f}, {0.05f, 0.01f, 0.01f}, 0.012f}, 0.5f}},
        {"box", {Box{{0.01f, 0, 0.01f}, {0.02f, 0.01f, 0.02f}}, 0.5f}},
        {"polygon", {Polygon{{{a, b, c}}}, 0.5f}},
        {"field", {distance_field(block({-0.02f, -0.02f, -0.02f}, {0.03f, 0.005f, 0.03f}), 0.003f), 0.5f}}};
}

// 1,000 steps of whatever length the solver chooses, with a collider that moves.
void run(const std::string& name, const Body& body, Integrator integrator, const Collider& collider) {
    SCOPED_TRACE(name + ", " + std::string(name_of(integrator)));
    auto solver = make_solver(
        body, {.integrator = integrator, .shortest_step = 0, .air = 1.2f, .colliders = {collider}});
    const double step = std::min(solver->longest_step(), 1e-3);  // nothing limits the step of an empty body
    const Motion motion{.velocity = {0.01f, 0.02f, 0}, .spin = {0, 0, 0.5f}};
    Motion at = motion;
    int steps = 0;
    while (steps < 1000) {
        const Stats stats = solver->step(100 * step, {.colliders = {&at, 1}, .wind = {1, 0, 0.5f}});
        ASSERT_FALSE(stats.diverged);
        steps += stats.steps;
        at = after(at, float(100 * step));
    }
    ASSERT_EQ(solver->nodes().positions.size(), body.count());
    for (vec3 p : solver->nodes().positions) ASSERT_LE(glm::length(p), 30);  // fails for NaN too
}

class Everything : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, Everything, ::testing::ValuesIn(every_integrator()), test_name);

TEST_P(Everything, BodyTimesCollider) {
    for (const auto& [body_name, body] : bodies())
        for (const auto& [name, collider] : colliders())
            run(body_name + " on " + name, body, GetParam(), collider);
}

TEST_P(Everything, OddSizes) {
    // Each of the sizes along each axis.
    const ivec3 sizes[] = {{1, 17, 9}, {2, 15, 8}, {3, 16, 2},  {7, 9, 3},  {8, 1, 17},
                           {9, 8, 1},  {15, 2, 7}, {16, 3, 15}, {17, 7, 16}};
    const auto shapes = colliders();
    for (std::size_t i = 0; i < std::size(sizes); ++i) {
        const auto& [name, collider] = shapes[i % shapes.size()];
        const ivec3 d = sizes[i];
        run("lattice on " + name, lattice(d, 0.01f, of_springs), GetParam(), collider);
        run("cloth on " + name, cloth({d.x, d.y}, 0.01f, linen), GetParam(), collider);
        run("cloth on " + name, cloth({d.z, d.x}, 0.01f, linen), GetParam(), collider);
    }
    run("volume", lattice({3, 9, 2}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.05f, .damping = 40}),
        GetParam(), shapes[3].second);
}

}  // namespace
}  // namespace palpate
