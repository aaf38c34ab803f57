// The reference solver against closed form, for every integrator.
#include "palpate/base/error.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/forces.h"
#include "tests/integrators.h"
#include "tests/refusal.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace palpate {
namespace {

const Material of_springs{
    .youngs_modulus = 5000, .density = 1000, .damping = 3, .model = MaterialModel::springs};
const Material undamped{.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs};

// The same as springs and as cells.
std::array<Material, 2> as_springs_and_cells(Material material) {
    Material cells = material;
    cells.model = MaterialModel::tissue;
    return {material, cells};
}

class Motion : public ::testing::TestWithParam<Integrator> {
 protected:
    Simulation simulation(double step = 0) const {
        Simulation s;
        s.integrator = GetParam();
        s.step = step;
        return s;
    }
    Simulation weightless(double step = 0) const {
        Simulation s = simulation(step);
        s.gravity = vec3(0);
        return s;
    }
};

// Those that need no damping; explicit Euler and midpoint are tested in theory_test.cpp and every_test.cpp.
constexpr Integrator undamped_ones[] = {Integrator::semi_implicit_euler, Integrator::verlet,
                                        Integrator::verlet_midpoint, Integrator::rk4};

INSTANTIATE_TEST_SUITE_P(Every, Motion, ::testing::ValuesIn(undamped_ones), test_name);

bool first_order(Integrator integrator) { return integrator == Integrator::semi_implicit_euler; }

dvec3 momentum(const Body& body, const State& state) {
    dvec3 sum(0);
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.inverse_mass[i] > 0) sum += state.velocities[i] / double(body.inverse_mass[i]);
    return sum;
}

// Two nodes and the one spring between them.
Body pair(float stiffness, float mass, float damping, float stretch) {
    Body body = lattice({2, 1, 1}, 0.1f, {.stiffness = stiffness, .mass = 2 * mass, .damping = damping});
    body.positions[1].x += stretch;
    return body;
}

TEST_P(Motion, OneSpringHasItsPeriod) {
    const float k = 50, m = 0.2f, stretch = 0.001f;
    for (float c : {0.0f, 2.0f}) {
        const Body body = pair(k, m, c, stretch);
        // Stretch x of the pair: m x'' = -2 k x - m c x'.
        const double w = std::sqrt(2.0 * k / m - c * c / 4.0);
        auto solver = make_exact_solver(body, weightless(1.0 / 4096), 0);
        double worst = 0;
        for (int i = 1; i <= 200; ++i) {
            solver->step(1.0 / 64);
            const double t = i / 64.0;
            const double expected =
                stretch * std::exp(-c * t / 2) * (std::cos(w * t) + c / (2 * w) * std::sin(w * t));
            const State s = solver->state();
            const double x = glm::distance(s.positions[0], s.positions[1]) - 0.1;
            if (const double e = std::abs(x - expected); !(e <= worst)) worst = e;
        }
        EXPECT_LE(worst, first_order(GetParam()) ? 1e-5 : 1e-6) << c;
    }
}

TEST_P(Motion, FreeFall) {
    for (const Material& material : as_springs_and_cells(undamped)) {
        SCOPED_TRACE(name_of(material.model));
        const Body body = lattice({3, 4, 2}, 0.01f, material);
        auto solver = make_exact_solver(body, simulation(1.0 / 1024), 0);
        solver->step(0.5);
        const State s = solver->state();
        const double dt = 1.0 / 1024, g = 9.81f, t = 0.5;
        // Semi-implicit Euler falls g t dt / 2 further than the parabola: its own closed form.
        const double fallen = first_order(GetParam()) ? g * t * (t + dt) / 2 : g * t * t / 2;
        for (std::size_t i = 0; i < body.count(); ++i) {
            EXPECT_LE(std::abs(body.positions[i].y - s.positions[i].y - fallen), 1e-6);
            EXPECT_LE(std::abs(s.velocities[i].y + g * t), 1e-6);
        }
    }
}

TEST_P(Motion, TerminalSpeedUnderDamping) {
    const Body body =
        lattice({3, 3, 3}, 0.01f,
                {.youngs_modulus = 5000, .density = 1000, .damping = 20, .model = MaterialModel::springs});
    auto solver = make_solver(body, simulation());
    for (int i = 0; i < 120; ++i) solver->step(1.0 / 60);
    for (dvec3 v : solver->state().velocities) EXPECT_LE(std::abs(v.y + 9.81 / 20), 1e-4);
}

TEST_P(Motion, MomentumStaysWithoutAnOuterForce) {
    for (const Material& material : as_springs_and_cells(undamped)) {
        SCOPED_TRACE(name_of(material.model));
        const Body body = lattice({5, 7, 6}, 0.01f, material);
        auto solver = make_solver(body, weightless());
        State crooked = solver->state();
        for (std::size_t i = 0; i < body.count(); ++i) crooked.positions[i] *= 1 + 0.1 * std::sin(double(i));
        solver->restore(crooked);
        double largest = 0;
        for (int i = 0; i < 60; ++i) {
            solver->step(1.0 / 60);
            const State s = solver->state();
            double scale = 0;
            for (std::size_t n = 0; n < body.count(); ++n)
                scale += glm::length(s.velocities[n]) / double(body.inverse_mass[n]);
            largest = std::max(largest, glm::length(momentum(body, s)) / scale);
        }
        EXPECT_LE(largest, 1e-4);
    }
}

TEST_P(Motion, RestStaysAtRest) {
    const Mesh mesh = ellipsoid({0.05f, 0.04f, 0.06f}, 30);
    for (const Material& material : as_springs_and_cells(of_springs)) {
        SCOPED_TRACE(name_of(material.model));
        const Body body = lattice(mesh, {.nodes = 800, .material = material});
        auto solver = make_solver(body, weightless());
        const double step = solver->longest_step({});
        for (int i = 0; i < 100; ++i) solver->step(100 * step);  // 10,000 steps
        const State s = solver->state();
        double moved = 0, fastest = 0;
        for (std::size_t i = 0; i < body.count(); ++i) {
            if (const double d = glm::distance(s.positions[i], dvec3(body.positions[i])); !(d <= moved))
                moved = d;
            fastest = std::max(fastest, glm::length(s.velocities[i]));
        }
        EXPECT_LE(moved, 1e-6 * 0.12);
        EXPECT_LE(fastest, 10 * 0.06 * 1.2e-7 / step);  // ten roundings of a position a step
    }
}

TEST_P(Motion, APinnedNodeNeverMoves) {
    Body body = lattice({4, 4, 4}, 0.01f, of_springs);
    const std::vector<int> held = {0, 5, 17, 63};
    pin(body, held);
    Simulation s = simulation();
    s.colliders = {Collider{Plane{{0, 1, 0}, 0.02f}}, Collider{Sphere{{0.01f, 0.01f, 0.01f}, 0.02f}}};
    auto solver = make_solver(body, s);
    const Press press{{0, 0, 0}, {0.1f, 0, 0}, 0.02f, 100};
    for (int i = 0; i < 60; ++i) solver->step(1.0 / 60, {.presses = {&press, 1}});
    for (int node : held) {
        EXPECT_EQ(solver->nodes().positions[std::size_t(node)], body.positions[std::size_t(node)]);
        EXPECT_EQ(solver->state().velocities[std::size_t(node)], dvec3(0));
    }
}

TEST_P(Motion, PlaneAndSphereHoldTheBody) {
    const Body body = lattice({5, 5, 5}, 0.01f, of_springs);
    Simulation s = simulation();
    const vec3 centre(0.02f, -0.06f, 0.02f);
    s.colliders = {Collider{Plane{{0, 1, 0}, -0.05f}}, Collider{Sphere{centre, 0.05f}}};
    auto solver = make_solver(body, s);
    for (int i = 0; i < 240; ++i) {
        solver->step(1.0 / 60);
        for (vec3 p : solver->nodes().positions) {
            ASSERT_GE(p.y, -0.05f - 1e-6f);
            ASSERT_GE(glm::distance(p, centre), 0.05f - 1e-6f);
        }
    }
}

TEST_P(Motion, OnAPlaneAtRestTheGroundCarriesTheWeight) {
    // Frictionless, so only the height is held: the lowest layer stays on the plane and nothing moves any
    // more.
    const Body body =
        lattice({4, 4, 4}, 0.01f,
                {.youngs_modulus = 20000, .density = 1000, .damping = 20, .model = MaterialModel::springs});
    Simulation s = simulation();
    s.colliders = {Collider{Plane{{0, 1, 0}, 0}}};
    auto solver = make_solver(body, s);
    for (int i = 0; i < 300; ++i) solver->step(1.0 / 60);
    EXPECT_LE(solver->step(1.0 / 60).largest_speed, 1e-3);
    const std::vector<dvec3> forces = spring_forces(body, solver->state().positions);
    double up = 0;  // the springs press the lowest layer down by the weight of all that stands on it
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].y == 0) up -= forces[i].y;
    double carried = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].y > 0) carried += 9.81 / double(body.inverse_mass[i]);
    EXPECT_LE(std::abs(up / carried - 1), 0.01);
}

TEST_P(Motion, TheReactionOfAPressIsTheMomentumItGives) {
    for (float c : {0.0f, 4.0f})
        for (Material material : as_springs_and_cells(undamped)) {
            SCOPED_TRACE(name_of(material.model));
            material.damping = c;
            const Body body = lattice({6, 6, 6}, 0.01f, material);
            auto solver = make_solver(body, weightless());
            dvec3 given(0), lost(0);
            for (int i = 0; i < 30; ++i) {
                const float t = float(i) / 60;
                const Press press{
                    {0.025f + 0.02f * t, 0.065f - 0.03f * t, 0.03f}, {0.02f, -0.03f, 0}, 0.012f, 300};
                const Stats stats = solver->step(1.0 / 60, {.presses = {&press, 1}});
                given -= stats.reactions[0];
            }
            const dvec3 now = momentum(body, solver->state());
            EXPECT_GT(glm::length(given), 1e-4);
            if (c == 0) EXPECT_LE(glm::length(now - given), 1e-4 * glm::length(given));
            // With damping the body keeps only a part of it.
            if (c > 0) EXPECT_LT(glm::length(now), glm::length(given));
        }
}

TEST_P(Motion, ATipPressesAsHardAsItsStiffnessSays) {
    // A tip much wider than the block lies flat on its top, whose whole area it meets at nearly one depth.
    Body body =
        lattice({9, 3, 9}, 0.01f,
                {.youngs_modulus = 1e5f, .density = 1000, .damping = 50, .model = MaterialModel::springs});
    const float radius = 5, depth = 1e-3f;
    const Press press{{0.04f, 0.02f + radius - depth, 0.04f}, vec3(0), radius, 1e7f};
    const double pressure = 1e7 / (3.14159265 * 25);  // Pa/m
    EXPECT_NEAR(pressure_per_metre(press) / pressure, 1, 1e-6);
    auto solver = make_exact_solver(body, weightless(1e-6), 0);
    const Stats stats = solver->step(1e-6, {.presses = {&press, 1}});
    double expected = 0;
    for (std::size_t i = 0; i < body.count(); ++i) {
        const double reach =
            double(press.radius) - glm::distance(dvec3(body.positions[i]), dvec3(press.centre));
        expected += pressure * body.area[i] * std::max(0.0, reach);
    }
    const double duration =
        GetParam() == Integrator::verlet ? 0.5e-6 : 1e-6;  // Verlet's first kick is half a step
    EXPECT_LE(std::abs(stats.reactions[0].y / duration / expected - 1), 1e-4);
    // All of the top is under it: about pressure times area times depth, less where the ball curves away.
    EXPECT_GT(expected, 0.85 * pressure * 0.08 * 0.08 * depth);
    EXPECT_LT(expected, 1.3 * pressure * 0.08 * 0.08 * depth);
}

// The same block, tip and depth with lattices of two finenesses: the held force is a property of the body.
TEST_P(Motion, WhatATipFeelsDoesNotDependOnTheLattice) {
    auto held_force = [&](int cells) {
        const float h = 0.06f / float(cells);
        Body body = lattice(
            {cells + 1, cells / 2 + 1, cells + 1}, h,
            {.youngs_modulus = 8000, .density = 1000, .damping = 30, .model = MaterialModel::springs});
        pin(body, nodes_below(body, 0, {0, -1, 0}));
        auto solver = make_solver(body, weightless());
        const Press press{{0.03f, 0.03f + 0.02f - 0.006f, 0.03f}, vec3(0), 0.02f, 400};
        Stats stats;
        for (int i = 0; i < 60; ++i) stats = solver->step(1.0 / 60, {.presses = {&press, 1}});
        return stats.reactions[0].y * 60;
    };
    const double coarse = held_force(8), fine = held_force(16);
    EXPECT_GT(fine, 0.1);
    EXPECT_LE(std::abs(coarse / fine - 1), 0.1) << coarse << ' ' << fine;
}

TEST_P(Motion, TheSameRunTwiceGivesTheSameBits) {
    const Body body = lattice(ellipsoid({0.05f, 0.04f, 0.06f}, 30), {.nodes = 900, .material = of_springs});
    auto end = [&] {
        auto solver = make_solver(body, simulation());
        const Press press{{0, 0, 0.065f}, {0, 0, -0.01f}, 0.015f, 300};
        for (int i = 0; i < 30; ++i) solver->step(1.0 / 60, {.presses = {&press, 1}});
        return solver->state();
    };
    const State a = end(), b = end();
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.velocities, b.velocities);
}

// ---- stability ----

TEST(Stability, HighestFrequencyInClosedForm) {
    const Body two = pair(50, 0.2f, 0, 0);
    EXPECT_LE(std::abs(highest_frequency(two) / std::sqrt(2 * 50 / 0.2) - 1), 1e-6);
    // A thread of n equal masses: 2 √(k/m) cos(π / 2n).
    const Body thread = lattice({12, 1, 1}, 0.1f, {.stiffness = 50, .mass = 12 * 0.2f});
    const double expected = 2 * std::sqrt(50 / 0.2) * std::cos(3.14159265 / 24);
    EXPECT_LE(std::abs(highest_frequency(thread) / expected - 1), 0.01);
    // The inside of a lattice: 12 k/m; the rim, with its shares, may vibrate a little faster.
    const Body solid = lattice({12, 12, 12}, 0.01f, undamped);
    const double inside = std::sqrt(12 * 0.4 * 5000 * 0.01 / (1000 * 1e-6));
    EXPECT_GE(highest_frequency(solid) / inside, 0.95);
    EXPECT_LE(highest_frequency(solid) / inside, 1.3);
    EXPECT_EQ(highest_frequency(lattice({1, 1, 1}, 1, of_springs)), 0);
}

TEST_P(Motion, AStepAboveTheBoundIsRefusedByName) {
    const Body body = lattice({6, 6, 6}, 0.01f, of_springs);
    const double bound = longest_step(GetParam(), highest_frequency(body), body.damping);
    Simulation s = simulation((GetParam() == Integrator::rk4 ? 2 : 1.2) * bound);
    const std::string said = refusal([&] { make_solver(body, s); });
    EXPECT_NE(said.find(name_of(GetParam())), said.npos) << said;
    EXPECT_NE(said.find("--force"), said.npos) << said;
    s.force = true;
    s.gravity = vec3(0);
    Body shaken = body;
    shaken.positions[7].x += 1e-4f;
    auto solver = make_solver(shaken, s);
    bool diverged = false;
    for (int i = 0; i < 600 && !diverged; ++i) {
        const State before = solver->state();
        diverged = solver->step(1.0 / 60).diverged;
        if (diverged) EXPECT_EQ(solver->state().positions, before.positions);  // the last good state is kept
    }
    EXPECT_TRUE(diverged);
    for (vec3 p : solver->nodes().positions) EXPECT_LE(glm::length(p), 10);  // fails for NaN too
}

TEST(Stability, TooManyStepsAFrameNameTheRemedy) {
    const Body body = lattice({4, 4, 4}, 0.001f,
                              {.youngs_modulus = 1e9f, .density = 1000, .model = MaterialModel::springs});
    for (const char* word : {"verlet", "softer"}) expect_refused(word, [&] { make_solver(body, {}); });
}

TEST(Stability, TooManyCollidersAreRefused) {
    const Body body = lattice({2, 2, 2}, 0.01f, of_springs);
    Simulation s;
    s.colliders.assign(17, Collider{Plane{}});
    EXPECT_THROW(make_solver(body, s), Error);
}

// A change of the frame's length in the middle does not disturb Verlet: its kicks know how far velocities
// lag.
TEST(Verlet, KeepsItsOrderWhenTheStepChanges) {
    const Body body = pair(50, 0.2f, 1, 0.001f);
    auto error = [&](int n) {
        Simulation s;
        s.gravity = vec3(0);
        s.step = 1;
        auto solver = make_exact_solver(body, s, 0);
        double t = 0;
        for (int i = 0; i < n; ++i) {
            const double dt = (i % 3 + 1) * 0.25 / (2 * n);  // steps of three lengths, by turns
            solver->step(dt);
            t += dt;
        }
        const double w = std::sqrt(500 - 0.25);
        const double expected = 0.001 * std::exp(-t / 2) * (std::cos(w * t) + 1 / (2 * w) * std::sin(w * t));
        const State state = solver->state();
        return std::abs(glm::distance(state.positions[0], state.positions[1]) - 0.1 - expected);
    };
    EXPECT_LE(std::abs(std::log2(error(192) / error(384)) - 2), 0.4);
}

}  // namespace
}  // namespace palpate
