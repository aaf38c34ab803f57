// The friction and the damper of a tip that presses: against closed form, and the same on every machine.
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/forces.h"
#include "palpate/solver/solver.h"
#include "tests/integrators.h"
#include "tests/solver/agreement.h"
#include "tests/solver/every_backend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate {
namespace {

constexpr Friction rough{0.5, 0.3}, even{0.4, 0.4};

double mass(const Body& body, std::size_t node) { return 1 / double(body.inverse_mass[node]); }

dvec3 momentum(const Body& body, const State& state) {
    dvec3 sum(0);
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.inverse_mass[i] > 0) sum += mass(body, i) * state.velocities[i];
    return sum;
}

class TipFriction : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, TipFriction, ::testing::ValuesIn(every_integrator()), test_name);

// ---- one node, in closed form ----

// Between two wide tips, each of which presses a square centimetre of it with the same force.
struct Vice {
    Body body = net(std::vector<vec3>{vec3(0)}, std::vector<float>{0.01f}, {});
    std::vector<Press> tips;

    explicit Vice(Friction one, Friction other) {
        body.area[0] = 1e-4f;
        const float radius = 4, depth = 1.0f / 1024;
        for (float side : {1.0f, -1.0f})
            tips.push_back({.centre = vec3(0, side * (radius - depth), 0),
                            .radius = radius,
                            .stiffness = 1e8f,
                            .friction = side > 0 ? one : other});
    }
    double pressed() const { return double(pressure_per_metre(tips[0])) * 1e-4 / 1024; }  // N, by each
    std::unique_ptr<Solver> solver(Integrator integrator, vec3 gravity) const {
        return make_exact_solver(body, {.integrator = integrator, .step = 1e-4, .gravity = gravity}, 0);
    }
};

TEST_P(TipFriction, HoldsANodeUntilMoreThanItsShareOfTheForcePullsAtIt) {
    for (const auto& [one, other] : {std::pair(rough, Friction{0, 0}), std::pair(even, even)}) {
        const Vice vice(one, other);
        const double in_m = vice.pressed() / mass(vice.body, 0), most = (one.still + other.still) * in_m,
                     braked = (one.sliding + other.sliding) * in_m, t = 0.01;
        for (double part : {0.5, 0.999, 1.001, 1.5}) {
            SCOPED_TRACE(part);
            const double pull = part * most, expected = part > 1 ? pull - braked : 0;
            auto solver = vice.solver(GetParam(), vec3(float(pull), 0, 0));
            solver->step(t, {.presses = vice.tips});
            const double bound = part > 1 ? 0.015 * expected : 1e-9 * pull;  // a step and a half of a hundred
            EXPECT_NEAR(solver->save().positions[0].x / (0.5 * t * t), expected, bound);
            EXPECT_NEAR(solver->save().velocities[0].x / t, expected, bound);
        }
    }
}

TEST_P(TipFriction, CarriesANodeAlong) {
    Vice vice(even, even);
    const float speed = 0.1f;
    for (Press& tip : vice.tips) tip.velocity = {0, 0, speed};
    auto solver = vice.solver(GetParam(), vec3(0));
    const Stats stats = solver->step(0.02, {.presses = vice.tips});
    const double a = 2 * even.sliding * vice.pressed() / mass(vice.body, 0);  // until it sticks
    const State end = solver->save();
    EXPECT_NEAR(end.velocities[0].z, speed, 1e-9);
    EXPECT_NEAR(end.positions[0].z, 0.02 * speed - speed * speed / (2 * a), 1e-4 * speed);
    EXPECT_NEAR(stats.reactions[0].z + stats.reactions[1].z, -speed * mass(vice.body, 0), 1e-9);
}

// ---- a soft block that lies fast below ----

Body soft_block(MaterialModel model) {
    Body body = lattice({13, 5, 13}, 0.005f,
                        {.youngs_modulus = 5000, .density = 1000, .damping = 30, .model = model});
    pin(body, nodes_below(body, 0, {0, -1, 0}));
    return body;
}

// A tip that goes down into its middle and stays there for a while.
class Stroke {
 public:
    Stroke(Integrator integrator, MaterialModel model, float radius, float depth, float stiffness,
           Friction friction)
        : body_(soft_block(model)),
          solver_(make_solver(body_, {.integrator = integrator, .gravity = vec3(0)})),
          tip_{.centre = vec3(0.03f, 0.02f + radius, 0.03f),
               .radius = radius,
               .stiffness = stiffness,
               .friction = friction} {
        go(vec3(0, -2 * depth, 0), 30);
        go(vec3(0), 30);
    }
    // N, on the tip in each of so many frames of 1/60 s.
    std::vector<dvec3> go(vec3 velocity, int frames) {
        std::vector<dvec3> forces;
        tip_.velocity = velocity;
        for (int i = 0; i < frames; ++i) {
            forces.push_back(60.0 * solver_->step(1.0 / 60, {.presses = {&tip_, 1}}).reactions[0]);
            tip_.centre += velocity / 60.0f;
        }
        return forces;
    }
    dvec3 under_it() const {
        const auto node = std::ranges::min_element(
            body_.positions, {}, [](vec3 p) { return glm::distance(p, vec3(0.03f, 0.02f, 0.03f)); });
        return solver_->state().positions[std::size_t(node - body_.positions.begin())];
    }
    dvec3 tip() const { return tip_.centre; }

 private:
    const Body body_;
    const std::unique_ptr<Solver> solver_;
    Press tip_;
};

bool is_long_in_coming(Integrator integrator) { return integrator == Integrator::explicit_euler; }

TEST_P(TipFriction, StrokesASoftBlock) {
    if (is_long_in_coming(GetParam())) return;
    for (MaterialModel model : {MaterialModel::springs, MaterialModel::tissue}) {
        SCOPED_TRACE(name_of(model));
        // Flat: all that it presses lies across. A round one ploughs too, over nodes that are 5 mm apart.
        for (const auto& [radius, depth, stiffness, bound] :
             {std::tuple(1.0f, 0.001f, 1e6f, 0.02), std::tuple(0.02f, 0.003f, 400.0f, 0.1)}) {
            SCOPED_TRACE(radius);
            Stroke stroke(GetParam(), model, radius, depth, stiffness, {0.3, 0.3});
            const std::vector<dvec3> forces = stroke.go(vec3(0.01f, 0, 0), 20);
            const dvec3 first = forces[0], last = forces.back();
            EXPECT_GT(last.y, 0.05);
            EXPECT_LT(-first.x, 0.2 * first.y);
            EXPECT_GT(-first.x, 0.01 * first.y);
            EXPECT_NEAR(-last.x / last.y, 0.3, 0.3 * bound);
        }
    }
}

TEST_P(TipFriction, HoldsWhatSticksWithoutCreep) {
    if (is_long_in_coming(GetParam())) return;
    for (MaterialModel model : {MaterialModel::springs, MaterialModel::tissue}) {
        SCOPED_TRACE(name_of(model));
        Stroke stroke(GetParam(), model, 0.02f, 0.003f, 400, {1, 1});
        const dvec3 before = stroke.under_it();
        stroke.go(vec3(0.0012f, 0, 0), 15);
        EXPECT_NEAR(stroke.under_it().x - before.x, 0.0003, 1e-6);
        stroke.go(vec3(0), 30);  // the rest of the block comes to rest
        const dvec3 held = stroke.under_it();
        const dvec3 force = stroke.go(vec3(0), 60).back();
        EXPECT_GT(-force.x, 0.05 * force.y);
        EXPECT_LE(glm::distance(stroke.under_it(), held), 2e-8) << "in a second";
    }
}

// ---- energy ----

double energy_with(const Press& tip, const Body& body, const State& state) {
    const Energy own = energy(body, state);
    double pressed = 0;
    for (std::size_t i = 0; i < body.count(); ++i) {
        const double depth =
            double(tip.radius) + double(body.cover[i]) - glm::distance(state.positions[i], dvec3(tip.centre));
        if (depth > 0) pressed += 0.5 * double(pressure_per_metre(tip)) * body.area[i] * depth * depth;
    }
    return own.kinetic + own.elastic + pressed;
}

TEST_P(TipFriction, TakesEnergyAndNeverGivesAny) {
    const bool damped = GetParam() == Integrator::explicit_euler || GetParam() == Integrator::midpoint;
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1, 1);
    for (float damping : {0.0f, 2.0f}) {
        const Body body = lattice({5, 4, 5}, 0.01f,
                                  {.youngs_modulus = 5000,
                                   .density = 1000,
                                   .damping = damped ? 2.0f : 0.0f,
                                   .model = MaterialModel::springs});
        const Press tip{.centre = {0.02f, 0.045f, 0.02f},
                        .radius = 0.02f,
                        .stiffness = 300,
                        .friction = rough,
                        .damping = damping};
        auto solver =
            make_exact_solver(body, {.integrator = GetParam(), .step = 1e-5, .gravity = vec3(0)}, 0);
        for (int start = 0; start < 4; ++start) {
            State state = solver->state();
            for (std::size_t i = 0; i < body.count(); ++i) {
                state.positions[i] =
                    dvec3(body.positions[i]) + 0.001 * dvec3(any(random), any(random), any(random));
                state.velocities[i] = 0.3 * dvec3(any(random), any(random), any(random));
            }
            state.lag = 0;
            solver->restore(state);
            const double first = energy_with(tip, body, state);
            double last = first;
            for (int i = 0; i < 20; ++i) {
                solver->step(0.001, {.presses = {&tip, 1}});
                const double now = energy_with(tip, body, solver->state());
                EXPECT_LE(now, last + 1e-4 * first);
                last = now;
            }
            EXPECT_LT(last, 0.98 * first);
        }
    }
}

// ---- the damper ----

TEST_P(TipFriction, ADamperResistsBothWaysAndNeverPulls) {
    Body body = net(std::vector<vec3>{vec3(0)}, std::vector<float>{0.0f}, {});
    body.area[0] = 1e-4f;
    const float depth = 0.001f;
    Press tip{.centre = {0, 0.01f - depth, 0}, .radius = 0.01f, .stiffness = 100, .damping = 5};
    const double part = 1e-4 / double(cross_section(tip)), spring = 100 * double(depth) * part;
    auto push = [&](float speed) {
        tip.velocity = {0, -speed, 0};
        auto solver =
            make_exact_solver(body, {.integrator = GetParam(), .step = 1e-9, .gravity = vec3(0)}, 0);
        solver->step(1e-9, {.presses = {&tip, 1}});
        return solver->step(1e-9, {.presses = {&tip, 1}}).reactions[0].y / 1e-9;
    };
    EXPECT_NEAR(push(0) / spring, 1, 1e-5);
    EXPECT_NEAR(push(0.1f), spring + 0.5 * part, 1e-5 * spring);
    EXPECT_NEAR(push(-0.01f), spring - 0.05 * part, 1e-5 * spring);
    EXPECT_NEAR(push(-0.1f), 0, 1e-12);
    EXPECT_NEAR(push(-10), 0, 1e-12);
}

TEST_P(TipFriction, IsStableHoweverStrongItIs) {
    if (is_long_in_coming(GetParam())) return;
    const Body body = soft_block(MaterialModel::tissue);
    auto solver = make_solver(body, {.integrator = GetParam()});
    Press tip{.centre = {0.03f, 0.042f, 0.03f}, .velocity = {0.01f, -0.02f, 0}, .radius = 0.02f};
    const double step = solver->longest_step({.presses = {&tip, 1}});
    tip.friction = {1000, 1000};
    tip.damping = 1e6f;
    EXPECT_EQ(solver->longest_step({.presses = {&tip, 1}}), step);
    for (int i = 0; i < 60; ++i) {
        if (i == 10) tip.velocity = vec3(0);
        const Stats stats = solver->step(1.0 / 60, {.presses = {&tip, 1}});
        ASSERT_FALSE(stats.diverged);
        EXPECT_GE(stats.reactions[0].y, 0);
        tip.centre += tip.velocity / 60.0f;
        if (i > 50) EXPECT_LE(stats.largest_speed, 0.01);
    }
}

// ---- on every machine ----

class TipFrictionOn : public EveryBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, TipFrictionOn, every_backend(), backend_name);

TEST_P(TipFrictionOn, TheReactionIsTheMomentumThatItGives) {
    std::mt19937 random(9);
    std::uniform_int_distribution<int> nodes(4, 9);
    for (Integrator integrator : {Integrator::verlet, Integrator::verlet_midpoint, Integrator::rk4})
        for (MaterialModel model : {MaterialModel::springs, MaterialModel::tissue}) {
            const ivec3 size(nodes(random), nodes(random), nodes(random));
            SCOPED_TRACE(std::string(name_of(integrator)) + ", " + std::string(name_of(model)));
            const Body body = lattice(size, 0.01f, {.youngs_modulus = 5000, .density = 1000, .model = model});
            auto solver = make(body, {.integrator = integrator, .gravity = vec3(0)});
            const vec3 over = vec3(0.005f, 0.01f, 0.005f) * vec3(size - 1) + vec3(0, 0.015f, 0);
            std::vector<Press> tips = {
                {over, {0.1f, -0.1f, 0.02f}, 0.016f, 300, rough, 0.5f},
                {over + vec3(0.004f, 0, 0.006f), {-0.02f, -0.1f, 0.1f}, 0.016f, 300, even}};
            dvec3 given(0);
            for (int i = 0; i < 10; ++i) {
                const Stats stats = solver->step(1.0 / 100, {.presses = tips});
                for (dvec3 reaction : stats.reactions) given -= reaction;
                for (Press& tip : tips) tip.centre += tip.velocity / 100.0f;
            }
            const dvec3 now = momentum(body, solver->state());
            EXPECT_GT(std::abs(given.x), 0.01 * std::abs(given.y));
            EXPECT_LE(glm::length(now - given), 1e-4 * glm::length(given));
        }
}

TEST_P(TipFrictionOn, IsThatOfTheReference) {
    const std::vector<NamedBody> bodies = odd_bodies();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
        auto [name, body] = bodies[b];
        SCOPED_TRACE(name);
        body.link_damping = 1e-4f;
        const Integrator integrator =
            every_integrator()[(b + std::size_t(GetParam())) % every_integrator().size()];
        const bool grows = integrator == Integrator::explicit_euler;
        Acting on = rubbing(body);
        if (grows) on.colliders.clear(), on.motions.clear();
        expect_same(body, on, integrator, GetParam(), grows ? 8 : 60, 1e-6, context_ ? context() : nullptr);
    }
}

TEST_P(TipFrictionOn, IsTheSameOnAnyNumberOfThreads) {
    if (on_gpu(GetParam())) return;
    const Body body = lattice({17, 9, 18}, 0.01f, of_springs);
    const Acting on = rubbing(body);
    auto end = [&](int threads) {
        auto solver = make_solver(body, simulation(body, on, Integrator::rk4, GetParam(), threads));
        const Stats stats = solver->step(0.02, on.influences());
        return std::pair(solver->save(), stats.reactions);
    };
    const auto one = end(1), three = end(3);
    expect_same_bits(one.first, three.first);
    EXPECT_TRUE(one.second == three.second);
}

}  // namespace
}  // namespace palpate
