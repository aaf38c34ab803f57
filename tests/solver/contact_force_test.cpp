// The force of a tip as it is asked for: that of the solver's own steps, and closed form.
#include "palpate/solver/contact_force.h"

#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/pressure_map.h"
#include "palpate/solver/solver.h"
#include "tests/refusal.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

constexpr double pi = 3.14159265358979;

const Material tissue{.youngs_modulus = 4000, .density = 1000};
const Material springs{.youngs_modulus = 4000, .density = 1000, .model = MaterialModel::springs};

std::vector<Body> pressable() {
    const Mesh ball = ellipsoid({0.03f, 0.02f, 0.025f}, 16);
    std::vector<Body> all;
    for (const Material& material : {tissue, springs}) {
        all.push_back(lattice({9, 7, 8}, 0.006f, material));
        all.push_back(lattice(ball, {.nodes = 800, .material = material}));
    }
    all.push_back(cloth({12, 9}, 0.004f, {.density = 0.2f}));
    return all;
}

// In a step that is too short for anything to move, the solver gives a tip what is asked for here.
TEST(ContactForce, IsWhatAStepDoes) {
    std::mt19937 random(7);
    auto any = [&](float from, float to) { return std::uniform_real_distribution<float>(from, to)(random); };
    int pressed = 0;
    for (const Body& body : pressable()) {
        const Bounds box = bounds(body.positions);
        auto solver = make_exact_solver(
            body, {.integrator = Integrator::semi_implicit_euler, .step = 1e-9, .gravity = vec3(0)});
        for (int trial = 0; trial < 40; ++trial) {
            Press press{.radius = any(0.003f, 0.02f), .stiffness = any(1, 1000)};
            for (int k = 0; k < 3; ++k)
                press.centre[k] = any(box.low[k] - press.radius, box.high[k] + press.radius);
            const ContactForce now = contact_force(body, body.positions, press);
            const Stats stats = solver->step(1e-9, {.presses = {&press, 1}});
            solver->undo();
            EXPECT_LE(glm::length(now.force + stats.reactions[0] / 1e-9),
                      1e-6 * glm::length(now.force) + 1e-9);
            pressed += !now.pressed.empty();
            // A tip is smooth: what it gives points along the mean of its pressures.
            EXPECT_LE(glm::distance(now.force, glm::length(now.force) * now.normal), 1e-9);
        }
    }
    EXPECT_GT(pressed, 100);
}

// A ball of radius R, d deep in a plane, presses where it is s from its centre with R - s times the pressure
// for each metre: together stiffness d² (R - d) / R².
TEST(ContactForce, OfABallInAPlaneIsAnIntegral) {
    for (float cell : {0.0012f, 0.0006f}) {
        const int along = int(std::lround(0.048 / double(cell))) + 1;
        const int down = int(std::ceil(0.005 / double(cell))) + 1;
        const Body block = lattice({along, along, down}, cell, springs);
        const double radius = 0.02, depth = 0.004, stiffness = 500, top = (down - 1) * double(cell),
                     bound = cell < 0.001f ? 0.01 : 0.02;
        const dvec3 centre(0.024, 0.024, top + radius - depth);
        const ContactForce now =
            contact_force(block, block.positions,
                          {.centre = vec3(centre), .radius = float(radius), .stiffness = float(stiffness)});
        const double force = stiffness * depth * depth * (radius - depth) / (radius * radius);
        EXPECT_LE(std::abs(now.force.z / -force - 1), bound);
        EXPECT_LE(std::abs(now.area() / (pi * depth * (2 * radius - depth)) - 1), 2 * bound);
        EXPECT_LE(std::abs(now.penetration - depth), 1e-7);
        EXPECT_LE(std::abs(now.pressure() - depth * stiffness / (pi * radius * radius)), 1);
        EXPECT_LE(glm::distance(now.place, dvec3(0.024, 0.024, top)), 1e-6);
        EXPECT_LE(glm::distance(now.normal, dvec3(0, 0, -1)), 1e-5);
    }
}

// The outside of cells is a staircase, whose area is that of a slope times 1 to √3. That is known
// (docs/touch.md): by how much nodes are pressed harder than the vertices of the surface would be.
TEST(ContactForce, IsLargerOnSlopes) {
    const Mesh ball = ellipsoid(vec3(0.03f), 60);
    const Body body = lattice(ball, {.nodes = 20'000, .material = springs});
    auto factor = [&](vec3 side) {
        const Press press{.centre = 0.038f * glm::normalize(side), .radius = 0.012f};
        const dvec3 force = contact_force(body, body.positions, press).force;
        const auto pressed = pressed_vertices(ball.positions, ball.triangles, press, force);
        const double depth =
            0.012 - glm::distance(dvec3(ball.positions[pressed[0].vertex]), dvec3(press.centre));
        return pressed[0].pressure / (depth * double(pressure_per_metre(press)));
    };
    EXPECT_NEAR(factor({1, 0, 0}), 1, 0.02);
    EXPECT_NEAR(factor({1, 1, 0}), 1.38, 0.02);
    EXPECT_NEAR(factor({1, 1, 1}), 1.70, 0.02);
}

TEST(ContactForce, IsNothingOutOfReach) {
    const Body block = lattice({5, 5, 5}, 0.01f, tissue);
    for (const Press& press : {Press{.centre = vec3(1)}, Press{.centre = vec3(0.02f), .stiffness = 0}}) {
        const ContactForce now = contact_force(block, block.positions, press);
        EXPECT_EQ(now.force, dvec3(0));
        EXPECT_EQ(now.normal, dvec3(0));
        EXPECT_EQ(now.place, dvec3(0));
        EXPECT_EQ(now.area() + now.pressure() + now.penetration, 0);
    }
}

TEST(ContactForce, RefusesWhatIsNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Body block = lattice({5, 5, 5}, 0.01f, tissue);
    const Press sound{.centre = vec3(0.02f, 0.02f, 0.045f)};
    auto of = [&](const Press& press, const std::vector<vec3>& nodes) {
        return [=, &block] { contact_force(block, nodes, press); };
    };
    Press wrong = sound;
    wrong.centre.x = nan;
    expect_refused("not finite", of(wrong, block.positions));
    wrong = sound;
    wrong.radius = 0;
    expect_refused("no radius", of(wrong, block.positions));
    std::vector<vec3> nodes = block.positions;
    nodes[7].y = nan;
    expect_refused("a node whose place is not finite", of(sound, nodes));
    nodes.pop_back();
    expect_refused("124 places for 125 nodes", of(sound, nodes));
}

}  // namespace
}  // namespace palpate
