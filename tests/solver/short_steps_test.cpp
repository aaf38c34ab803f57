// What is advised where steps are too short: always what shortens them, never what does not.
#include "palpate/solver/short_steps.h"

#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

std::string refusal(const Body& body, const Simulation& simulation = {}) {
    return palpate::refusal([&] { make_solver(body, simulation); });
}

const char* const material = "use a softer material";

void expect_only(const std::string& said, const std::string& words) {
    for (const char* one :
         {"link_damping", "lower damping", "that press", "that drag", "weigh more alike", "stiffest springs",
          "lower its bending", "Poisson's ratio", material, "choose verlet", "ask for longer steps"})
        EXPECT_EQ(words.find(one) != words.npos, said.find(one) != said.npos) << one << ": " << said;
}

ClothSettings light() { return {.mass = 0.01f}; }

TEST(ShortSteps, LinkDamping) {
    ClothSettings settings = light();
    settings.link_damping = 0.002f;
    const Body damped = cloth({51, 51}, 0.02f, settings);
    const std::string said = refusal(damped);
    expect_only(said, "link_damping");
    // The number of steps that it promises is what the same cloth takes without.
    const Body plain = cloth({51, 51}, 0.02f, light());
    const double steps =
        std::ceil(1.0 / 60 / automatic_step(Integrator::verlet, highest_frequency(plain), 0, 0));
    EXPECT_NE(said.find("link_damping = 0.002 s: without that " + std::to_string(int(steps)) + " steps"),
              std::string::npos)
        << said << steps;
    EXPECT_EQ(refusal(plain), "");
}

// A solver learns of its tools when they come; then nothing has moved.
TEST(ShortSteps, Tools) {
    const auto solver = make_solver(cloth({11, 11}, 0.02f, light()), {});
    const State before = solver->save();
    const Press press{.radius = 0.01f, .stiffness = 1e12f * 3.14159265f * 1e-4f};
    const NodePush drag{.node = 5, .stiffness = 1e7f};
    auto said = [&](const Influences& on) { return palpate::refusal([&] { solver->step(0.01, on); }); };
    expect_only(said({.presses = {&press, 1}}), "that press");
    expect_only(said({.pushes = {&drag, 1}}), "that drag");
    expect_only(said({.presses = {&press, 1}, .pushes = {&drag, 1}}), "that press, that drag");
    EXPECT_TRUE(solver->save().positions == before.positions);
    EXPECT_EQ(said({}), "");
}

TEST(ShortSteps, OneLightNode) {
    Body body = cloth({11, 11}, 0.02f, light());
    body.inverse_mass[40] *= 1e5f;
    const std::string said = refusal(body);
    expect_only(said, "weigh more alike");
    EXPECT_NE(said.find("(1 of 121"), std::string::npos) << said;
}

TEST(ShortSteps, AHardPart) {
    Body body = lattice({8, 8, 8}, 0.01f,
                        Material{.youngs_modulus = 2000, .density = 1000, .model = MaterialModel::springs});
    std::vector<float> factors(body.count(), 1);
    for (int node : nodes_near(body, vec3(0.035f), 0.012f)) factors[std::size_t(node)] = 1e6f;
    strengthen(body, factors);
    expect_only(refusal(body), "stiffest springs");
}

TEST(ShortSteps, Bending) {
    Body body = cloth({11, 11}, 0.02f, light());
    EXPECT_EQ(refusal(body), "");
    body.terms.push_back(bending(body, 100));
    expect_only(refusal(body), "lower its bending");
}

TEST(ShortSteps, Tissue) {
    Material stiff{.youngs_modulus = 5e4f, .poisson = 0.499f, .density = 1000};
    expect_only(refusal(lattice({5, 5, 5}, 0.001f, stiff)), "Poisson's ratio");
    stiff.poisson = 0.45f;
    Body body = lattice({7, 7, 7}, 0.001f, stiff);
    EXPECT_EQ(refusal(body), "");
    for (Term& term : body.terms)
        if (auto* cells = std::get_if<TissueCells>(&term)) cells->weights[20] = 1e3f;
    expect_only(refusal(body), "stiffest springs");
}

TEST(ShortSteps, TheMaterialItselfWhereNothingElseIs) {
    const Body steel =
        lattice({4, 4, 4}, 0.001f,
                Material{.youngs_modulus = 2e11f, .density = 7800, .model = MaterialModel::springs});
    expect_only(refusal(steel), material);
    // Little of damping beside it is not to blame.
    expect_only(
        refusal(lattice(
            {4, 4, 4}, 0.001f,
            Material{
                .youngs_modulus = 2e11f, .density = 7800, .damping = 1, .model = MaterialModel::springs})),
        material);
}

TEST(ShortSteps, ExplicitEulerWithoutDampingIsToldVerlet) {
    Simulation simulation;
    simulation.integrator = Integrator::explicit_euler;
    const Body body = lattice(
        {4, 4, 4}, 0.01f, Material{.youngs_modulus = 1e5f, .density = 1000, .model = MaterialModel::springs});
    expect_only(refusal(body, simulation), "choose verlet");
    EXPECT_EQ(refusal(body, simulation).find("damping, or"), std::string::npos);
}

TEST(ShortSteps, TheIntegratorAndTheStepThatWasAskedFor) {
    Simulation simulation;
    simulation.integrator = Integrator::explicit_euler;
    const Body body = lattice(
        {4, 4, 4}, 0.01f,
        Material{.youngs_modulus = 1e5f, .density = 1000, .damping = 0.5f, .model = MaterialModel::springs});
    expect_only(refusal(body, simulation), "choose verlet");
    simulation.integrator = Integrator::verlet;
    EXPECT_EQ(refusal(body, simulation), "");
    simulation.step = 1e-6;
    expect_only(refusal(body, simulation), "ask for longer steps");
}

}  // namespace
}  // namespace palpate
