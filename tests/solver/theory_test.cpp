// The integrators and the bodies of the reference solver against theory (bench/studies.h).
#include "bench/studies.h"
#include "palpate/base/error.h"
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/forces.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace palpate {
namespace {

using namespace studies;

constexpr Damping none = dampings[0], of_velocities = dampings[1], along_springs = dampings[2];

// Of so many steps that neither the next order nor rounding shows: masses and steps are floats.
int steps_for(Studied* body) { return body == &chain ? 256 : 128; }

TEST(Theory, OrdersOfConvergence) {
    const std::pair<Integrator, int> orders[] = {
        {Integrator::explicit_euler, 1}, {Integrator::semi_implicit_euler, 1}, {Integrator::verlet, 2},
        {Integrator::midpoint, 2},       {Integrator::verlet_midpoint, 2},     {Integrator::rk4, 4}};
    for (const auto& [integrator, expected] : orders)
        for (const Damping& damping : {none, of_velocities})
            for (Studied* body : {&chain, &tissue_chain})
                EXPECT_LE(std::abs(order(body, integrator, damping, steps_for(body)) - expected), 0.15)
                    << name_of(integrator) << ", damping " << damping.name;
}

// Dampers along the springs need the velocities of neighbours, which Verlet's schemes know only half a step
// late: those schemes fall to order 1, as docs/integrators.md derives; the Runge-Kutta schemes do not.
TEST(Theory, OrdersWithDampersAlongTheSprings) {
    const std::pair<Integrator, int> orders[] = {{Integrator::explicit_euler, 1},
                                                 {Integrator::semi_implicit_euler, 1},
                                                 {Integrator::midpoint, 2},
                                                 {Integrator::rk4, 4}};
    for (Studied* body : {&chain, &tissue_chain}) {
        for (const auto& [integrator, expected] : orders)
            EXPECT_LE(std::abs(order(body, integrator, along_springs, steps_for(body)) - expected), 0.15)
                << name_of(integrator);
        for (Integrator integrator : {Integrator::verlet, Integrator::verlet_midpoint})
            EXPECT_LE(std::abs(order(body, integrator, along_springs, 2048) - 1), 0.15)
                << name_of(integrator);
    }
}

TEST(Theory, TheStabilityBoundIsWhereItIs) {
    for (const auto& [integrator, name] : names(Integrator{}))
        for (const Damping& damping : dampings) {
            const bool none_at_all =  // the closed forms below say so
                (integrator == Integrator::explicit_euler || integrator == Integrator::midpoint) &&
                damping.of_nodes + damping.of_links == 0;
            if (none_at_all) continue;
            for (Studied* body : {&small_lattice, &small_tissue}) {
                EXPECT_FALSE(grows(body, integrator, damping, 0.97)) << name << ", " << damping.name;
                EXPECT_TRUE(grows(body, integrator, damping, 1.03)) << name << ", " << damping.name;
            }
        }
}

// In closed form, where there is one.
TEST(Theory, TheStabilityBoundInClosedForm) {
    const double w = 700, c = 90, b = 3e-4;
    auto near = [](double a, double exact) { EXPECT_LE(std::abs(a / exact - 1), 1e-4) << a << ' ' << exact; };
    near(longest_step(Integrator::explicit_euler, w, c), c / (w * w));
    near(longest_step(Integrator::explicit_euler, w, c, b), c / (w * w) + b);
    near(longest_step(Integrator::semi_implicit_euler, w, 0), 2 / w);
    near(longest_step(Integrator::semi_implicit_euler, w, c), (std::sqrt(c * c + 4 * w * w) - c) / (w * w));
    near(longest_step(Integrator::verlet, w, c), 2 / w);
    near(longest_step(Integrator::verlet_midpoint, w, c), 2 / w);
    near(longest_step(Integrator::verlet, w, 0, b), std::sqrt(b * b + 4 / (w * w)) - b);
    near(longest_step(Integrator::rk4, w, 0), std::sqrt(8.0) / w);
    near(longest_step(Integrator::explicit_euler, 0, c), 2 / c);
    near(longest_step(Integrator::rk4, 0, c), 2.785293563405282 / c);
    EXPECT_EQ(longest_step(Integrator::explicit_euler, w, 0), 0);
    EXPECT_EQ(longest_step(Integrator::midpoint, w, 0), 0);
}

TEST(Theory, WithoutDampingSomeGrowAsPredicted) {
    for (Integrator integrator : {Integrator::explicit_euler, Integrator::midpoint}) {
        const Growth g = growth_per_step(integrator, 0.5);
        EXPECT_GT(g.predicted, 0.005);
        EXPECT_LE(std::abs(g.measured / g.predicted - 1), 0.01) << name_of(integrator);
        EXPECT_THROW(
            make_solver(lattice({3, 3, 3}, 0.01f,
                                {.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs}),
                        {.integrator = integrator}),
            Error);
    }
}

TEST(Theory, PulsesRunAsInAnIsotropicSolid) {
    EXPECT_LE(std::abs(pulse_speed(false) - 1), 0.03);
    EXPECT_LE(std::abs(pulse_speed(true) - 1), 0.03);
}

// A lattice of N cells is too stiff in bending by about 1 + 1/N², because its outer links lie at its surface.
TEST(Theory, ACantileverSagsAsTimoshenkoSays) {
    EXPECT_LE(std::abs(cantilever_sag(1) - 0.54), 0.03);
    EXPECT_LE(std::abs(cantilever_sag(2) - 0.80), 0.03);
    for (int cells : {4, 5})
        EXPECT_LE(std::abs(cantilever_sag(cells) * (1 + 1.0 / (cells * cells)) - 1), 0.01) << cells;
}

TEST(Theory, EnergyStaysBoundedOverAMillionSteps) {
    for (Integrator integrator : {Integrator::verlet, Integrator::verlet_midpoint}) {
        const Swing s = energy_swing(integrator, 1'000'000);
        EXPECT_GE(s.least, 0.7) << name_of(integrator);
        EXPECT_LE(s.largest, 1.4) << name_of(integrator);
        EXPECT_LE(std::abs(s.drift), 0.002) << name_of(integrator);
    }
    EXPECT_LE(std::abs(energy_swing(Integrator::semi_implicit_euler, 200'000).drift), 0.02);
    const Swing of_tissue = energy_swing(Integrator::verlet, 1'000'000, MaterialModel::tissue);
    EXPECT_GE(of_tissue.least, 0.6);
    EXPECT_LE(of_tissue.largest, 1.4);
    EXPECT_LE(std::abs(of_tissue.drift), 0.002);
}

// ---- springs of a kind ----

double elastic(const Body& body, const std::vector<dvec3>& positions) {
    return energy(body, {positions, std::vector<dvec3>(body.count(), dvec3(0))}).elastic;
}

template <class Move>
std::vector<dvec3> moved(const Body& body, Move move) {
    std::vector<dvec3> positions;
    for (ivec3 at : body.at) positions.push_back(move(at));
    return positions;
}

// Each kind of spring resists its own stress, as 2012 says; and those that shall not, do not.
TEST(Kinds, EachResistsItsOwnStress) {
    const float h = 0.02f, k = 80;
    const ivec2 dims(8, 7);
    const ClothSettings only[] = {{.stiffness = {k, 0, 0}, .density = 0.2f},
                                  {.stiffness = {0, k, 0}, .density = 0.2f},
                                  {.stiffness = {0, 0, k}, .density = 0.2f}};
    const double s = 0.03, turn = 0.05, lean = 0.04;
    auto stretched = [&](ivec3 p) { return double(h) * dvec3((1 + s) * p.x, p.y, 0); };
    // A rhombus: its sides keep their length, so do rows and columns.
    auto sheared = [&](ivec3 p) {
        return double(h) * dvec3(p.x + std::sin(lean) * p.y, std::cos(lean) * p.y, 0);
    };
    // Rolled up along x: each column turns a little further than the last, and all sides keep their length.
    auto bent = [&](ivec3 p) {
        dvec3 at(0, h * p.y, 0);
        for (int i = 0; i < p.x; ++i) at += double(h) * dvec3(std::cos(turn * i), 0, std::sin(turn * i));
        return at;
    };
    double stretch[3], shear[3], bending[3];
    for (int kind = 0; kind < 3; ++kind) {
        const Body body = cloth(dims, h, only[kind]);
        stretch[kind] = elastic(body, moved(body, stretched));
        shear[kind] = elastic(body, moved(body, sheared));
        bending[kind] = elastic(body, moved(body, bent));
    }
    auto half_k = [&](int springs, double extension) { return 0.5 * k * springs * extension * extension; };
    const int rows = dims.y, columns = dims.x;
    EXPECT_LE(std::abs(stretch[0] / half_k((columns - 1) * rows, s * h) - 1), 1e-5);
    const double long_way = std::sqrt(2 + 2 * std::sin(lean)) - std::sqrt(2.0),
                 short_way = std::sqrt(2 - 2 * std::sin(lean)) - std::sqrt(2.0);
    const int squares = (columns - 1) * (rows - 1);
    EXPECT_LE(std::abs(shear[1] / (half_k(squares, long_way * h) + half_k(squares, short_way * h)) - 1),
              1e-5);
    EXPECT_LE(std::abs(bending[2] / half_k((columns - 2) * rows, 2 * h * (1 - std::cos(turn / 2))) - 1),
              1e-3);
    for (int other : {0, 2}) EXPECT_LE(shear[other], 1e-9 * shear[1]);
    for (int other : {0, 1}) EXPECT_LE(bending[other], 1e-9 * stretch[0]);
}

TEST(Kinds, TheVolumeOf2012Has32Springs) {
    const Body body = lattice({5, 5, 5}, 0.01f, SpringKinds{100, 50, 20}, {.mass = 1});
    const Table springs = table(body);
    EXPECT_EQ(springs.width, 32);
    int whole = 0;
    double stiffness = 0;
    for (const Tie& tie : springs.of(2 * 25 + 2 * 5 + 2)) whole += tie.share == 1, stiffness += tie.stiffness;
    EXPECT_EQ(whole, 32);
    EXPECT_NEAR(stiffness, 6 * 100 + 20 * 50 + 6 * 20, 1e-3);
    EXPECT_NEAR(mass(body), 1, 1e-5);
}

// ---- regions ----

// Two halves in a row, one four times as stiff: their compliances add up.
TEST(Region, AHardHalfStretchesLess) {
    const float h = 0.01f;
    Body body =
        lattice({33, 5, 5}, h,
                {.youngs_modulus = 5000, .density = 1000, .damping = 30, .model = MaterialModel::springs});
    std::vector<float> factors(body.count(), 1);
    for (int node : nodes_in(body, {vec3(-1), vec3(0.155f, 1, 1)})) factors[std::size_t(node)] = 4;
    strengthen(body, factors);
    for (vec3& p : body.positions) p.x *= 1.002f;
    pin(body, nodes_in(body, {vec3(-1), vec3(0.0001f, 1, 1)}));
    pin(body, nodes_in(body, {vec3(0.32f, -1, -1), vec3(1)}));
    auto solver = make_solver(body, {.gravity = vec3(0)});
    for (int i = 0; i < 180; ++i) solver->step(1.0 / 60);
    double at[3] = {};
    const State state = solver->state();
    for (std::size_t i = 0; i < body.count(); ++i)
        for (int k = 0; k < 3; ++k)
            if (body.at[i].x == 4 + 12 * k) at[k] += state.positions[i].x / 25;
    const double hard = (at[1] - at[0]) / 0.12 - 1, soft = (at[2] - at[1]) / 0.12 - 1;
    // The middle of the bar lies in its hard half by half a spacing; the softer link leads to x = 16.
    EXPECT_LE(std::abs(soft / hard / 4 - 1), 0.08) << soft << ' ' << hard;
}

TEST(Region, OfATableToo) {
    const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}, {{0, 1, 2}, {0, 2, 3}}};
    Body body = cloth(square, {.stiffness = {.structural = 10}, .bending = 1, .density = 1});
    const auto hinge = [&] { return std::get<Bending>(body.terms[1]).hinges.at(0); };
    const float whole = hinge().stiffness;
    strengthen(body, std::vector<float>{3, 5, 1, 1});
    EXPECT_EQ(hinge().stiffness, 2 * whole);  // the mean of its edge's ends
    const Table springs = table(body);
    for (const Tie& tie : springs.of(0))
        if (tie.stiffness > 0)
            EXPECT_EQ(tie.stiffness, tie.to == 1 ? 40 : 20) << tie.to;  // the mean of its ends'
}

// ---- bodies as tables ----

// A net of a cloth's springs and masses moves as the cloth does.
TEST(Net, TheSameSpringsInATableMoveAlike) {
    Body grid = cloth({6, 5}, 0.02f, {.stiffness = {90, 40, 15}, .density = 0.3f, .damping = 1});
    const Table springs = table(grid);
    std::vector<Spring> ties;
    std::vector<float> masses;
    for (std::size_t i = 0; i < grid.count(); ++i) {
        masses.push_back(1 / grid.inverse_mass[i]);
        for (const Tie& tie : springs.of(i))
            if (tie.to > int(i)) ties.push_back({int(i), tie.to, tie.stiffness, tie.rest});
    }
    Body written = net(grid.positions, masses, ties);
    written.damping = grid.damping;
    for (Body* body : {&grid, &written}) pin(*body, std::vector<int>{0, 5});
    auto a = make_exact_solver(grid, {.step = 1e-4}, 0), b = make_exact_solver(written, {.step = 1e-4}, 0);
    ASSERT_FALSE(a->step(0.2).diverged);
    ASSERT_FALSE(b->step(0.2).diverged);
    const State one = a->state(), other = b->state();
    for (std::size_t i = 0; i < grid.count(); ++i)
        EXPECT_LE(glm::distance(one.positions[i], other.positions[i]), 1e-6);
    EXPECT_GT(glm::distance(one.positions[29], dvec3(grid.positions[29])), 1e-4);
}

TEST(Net, RefusesWhatNamesNoNode) {
    const std::vector<vec3> positions(2, vec3(0));
    const std::vector<float> masses(2, 1.0f);
    EXPECT_THROW(net(positions, masses, std::vector<Spring>{{0, 2, 1}}), Error);
    EXPECT_THROW(net(positions, masses, std::vector<Spring>{{-1, 1, 1}}), Error);
    EXPECT_THROW(net(positions, masses, {}, std::vector<uvec3>{{0, 1, 7}}), Error);
}

TEST(Cloth, RefusesWhatIsNoSheet) {
    EXPECT_THROW(cloth({3, 3}, 0.01f, {.bending = 1, .density = 1}), Error);  // of no triangles
    const ClothSettings settings{.density = 1};
    const std::vector<vec3> five = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {-1, 0, 0}};
    EXPECT_THROW(cloth(Mesh{five, {}, {{0, 1, 2}}}, settings), Error);                        // lone vertices
    EXPECT_THROW(cloth(Mesh{five, {}, {{0, 1, 2}, {0, 4, 3}}}, settings), Error);             // a bow tie
    EXPECT_THROW(cloth(Mesh{five, {}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}}, settings), Error);  // a fin
}

// ---- state ----

TEST(State, SavedAndRestoredExactly) {
    for (const auto& [integrator, name] : names(Integrator{}))
        for (const MaterialModel model : {MaterialModel::springs, MaterialModel::tissue}) {
            SCOPED_TRACE(name_of(model));
            Body body = lattice({4, 5, 3}, 0.01f,
                                {.youngs_modulus = 2000, .density = 1000, .damping = 60, .model = model});
            pin(body, std::vector<int>{0, 1});
            const Simulation simulation{.integrator = integrator, .shortest_step = 1e-6};
            auto solver = make_solver(body, simulation);
            solver->step(0.011);
            const State kept = solver->save();
            solver->step(0.017);
            solver->step(0.003);
            const State end = solver->save();

            solver->restore(kept);
            solver->step(0.017);
            solver->step(0.003);
            EXPECT_EQ(solver->save().positions, end.positions) << name;
            EXPECT_EQ(solver->save().velocities, end.velocities) << name;
            auto fresh = make_solver(body, simulation);
            fresh->restore(kept);
            EXPECT_EQ(fresh->nodes().positions[7], vec3(kept.positions[7])) << name;
            fresh->step(0.017);
            fresh->step(0.003);
            EXPECT_EQ(fresh->save().positions, end.positions) << name;
        }
}

// A change of the integrator in mid flight keeps the motion: state() of one is a start for another.
TEST(State, CarriesOverToAnotherIntegrator) {
    const Body body =
        lattice({4, 3, 3}, 0.01f, {.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs});
    auto verlet = make_exact_solver(body, {.step = 1e-5}, 0);
    State thrown = verlet->state();
    for (std::size_t i = 0; i < thrown.velocities.size(); ++i)
        thrown.velocities[i] = {1 + 5 * thrown.positions[i].y, 2, 0};
    verlet->restore(thrown);
    auto rk4 = make_exact_solver(body, {.integrator = Integrator::rk4, .step = 1e-5}, 0);
    verlet->step(0.01);
    rk4->restore(verlet->state());
    verlet->step(0.01);
    rk4->step(0.01);
    const State a = verlet->state(), b = rk4->state();
    for (std::size_t i = 0; i < body.count(); ++i) {
        EXPECT_LE(glm::distance(a.positions[i], b.positions[i]), 1e-8);
        EXPECT_LE(glm::distance(a.velocities[i], b.velocities[i]), 1e-5);
    }
}

// Straight from the raw state too, though Verlet's velocities lie half a step behind.
TEST(State, VerletsOwnStateStartsAnyOther) {
    const Body particle = net(std::vector<vec3>{{0, 0, 0}}, std::vector<float>{1}, {});
    for (const auto& [integrator, name] : names(Integrator{})) {
        auto verlet = make_exact_solver(particle, {.step = 0.01, .gravity = {0, -10, 0}}, 0);
        auto other =
            make_exact_solver(particle, {.integrator = integrator, .step = 0.01, .gravity = {0, -10, 0}}, 0);
        verlet->step(0.1);
        other->restore(verlet->save());
        EXPECT_LE(std::abs(other->state().velocities[0].y + 1), 1e-6) << name;
        other->step(0.1);
        EXPECT_LE(std::abs(other->state().velocities[0].y + 2), 1e-6) << name;
    }
}

TEST(Solver, RefusesWhatIsNotFinite) {
    Body body =
        lattice({2, 2, 2}, 0.01f, {.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs});
    body.inverse_mass[3] = std::numeric_limits<float>::infinity();
    EXPECT_THROW(make_solver(body, {}), Error);
    const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}, {{0, 1, 2}}};
    EXPECT_THROW(cloth(flat, {.density = 1}), Error);
}

// A spring without a rest length is no torn one.
TEST(Solver, ASpringOfNoLengthHolds) {
    const std::vector<vec3> both(2, vec3(0));
    Body body = net(both, std::vector<float>{0, 1}, std::vector<Spring>{{0, 1, 100}});
    body.spacing = 0.1f;
    body.damping = 5;
    auto solver = make_solver(body, {});
    for (int i = 0; i < 300; ++i) ASSERT_FALSE(solver->step(1.0 / 60).diverged);
    EXPECT_LE(std::abs(solver->state().positions[1].y + 0.0981), 1e-3);
}

TEST(Solver, NoSpringsAtAll) {
    const Body dust = net(std::vector<vec3>(3, vec3(0)), std::vector<float>(3, 1.0f), {});
    EXPECT_TRUE(spring_ends(dust).empty());
    EXPECT_FALSE(make_solver(dust, {})->step(1.0 / 60).diverged);
}

}  // namespace
}  // namespace palpate
