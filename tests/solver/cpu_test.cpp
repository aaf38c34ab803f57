// The backend cpu against the reference: the same physics, with many nodes at once and on many threads.
#include "palpate/base/team.h"
#include "palpate/body/select.h"
#include "palpate/solver/cpu/body_memory.h"
#include "palpate/solver/cpu/layout.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/body/turn.h"
#include "tests/integrators.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <set>

namespace palpate {
namespace {

class CpuIs : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, CpuIs, ::testing::ValuesIn(every_integrator()), test_name);

TEST_P(CpuIs, TheReferenceOnEveryBody) {
    for (const auto& [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        expect_same(body, {}, GetParam(), Backend::cpu, 100, 1e-6);
    }
}

TEST_P(CpuIs, TheReferenceWithAllThatCanAct) {
    // Explicit Euler lets what contacts stir up grow.
    const int steps = GetParam() == Integrator::explicit_euler ? 8 : 25;
    for (auto [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        expect_same(body, everything(body), GetParam(), Backend::cpu, steps, 1e-5);
        body.link_damping = 1e-4f;
        expect_same(body, everything(body), GetParam(), Backend::cpu, steps, 1e-5);
    }
}

TEST_P(CpuIs, TheReferenceOnOddSizes) {
    // Each of the sizes along each axis.
    const ivec3 sizes[] = {{1, 33, 9}, {2, 15, 8},  {3, 16, 2},  {7, 9, 3},    {8, 1, 17}, {9, 8, 1},
                           {15, 2, 7}, {16, 3, 15}, {17, 7, 16}, {33, 17, 33}, {1, 1, 1},  {1, 1, 7}};
    for (const ivec3 d : sizes) {
        SCOPED_TRACE(std::to_string(d.x) + " x " + std::to_string(d.y) + " x " + std::to_string(d.z));
        const Body box = lattice(d, 0.01f, of_springs);
        expect_same(box, everything(box), GetParam(), Backend::cpu, 10, 1e-5);
        const Body sheet = cloth({d.x, d.y}, 0.01f, linen);
        expect_same(sheet, everything(sheet), GetParam(), Backend::cpu, 10, 1e-5);
        const Body volume =
            lattice({d.z, d.x, d.y}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20});
        expect_same(volume, everything(volume), GetParam(), Backend::cpu, 10, 1e-5);
    }
}

TEST_P(CpuIs, TheSameToTheBitOnAnyNumberOfThreads) {
    for (const auto& [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        const Acting on = everything(body);
        auto one = make_solver(body, simulation(body, on, GetParam(), Backend::cpu, 1));
        const double step = one->longest_step();
        const Stats of_one = one->step(7 * step, on.influences());
        for (int threads : {2, 3, 5}) {
            auto many = make_solver(body, simulation(body, on, GetParam(), Backend::cpu, threads));
            const Stats of_many = many->step(7 * step, on.influences());
            expect_same_bits(one->save(), many->save());
            EXPECT_TRUE(of_one.reactions == of_many.reactions);
            EXPECT_TRUE(of_one.pushes == of_many.pushes);
            EXPECT_EQ(of_one.largest_speed, of_many.largest_speed);
            EXPECT_EQ(of_one.largest_move, of_many.largest_move);
        }
    }
}

TEST_P(CpuIs, SavedAndRestoredToTheBit) {
    for (const auto& [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        const Acting on = everything(body);
        const Simulation how = simulation(body, on, GetParam(), Backend::cpu);
        auto first = make_solver(body, how), second = make_solver(body, how);
        first->step(13 * how.step, on.influences());
        second->restore(first->save());
        for (int i = 0; i < 3; ++i) {
            expect_same_bits(first->save(), second->save());
            first->step(5 * how.step, on.influences());
            second->step(5 * how.step, on.influences());
        }
    }
}

TEST_P(CpuIs, AsItWasBeforeACallThatTearsIt) {
    Body body = lattice({9, 5, 7}, 0.01f, of_springs);
    body.inverse_mass[3] = 0;
    const int held[] = {3};
    const vec3 to[] = {body.positions[3] + vec3(0, 0.01f, 0)};
    const Move move{held, to};
    auto solver =
        make_solver(body, {.backend = Backend::cpu, .integrator = GetParam(), .step = 1e-4, .force = true});
    solver->step(3e-4);
    State wild = solver->save();
    wild.velocities[100] = {5000, 0, 0};
    solver->restore(wild);
    const State before = solver->save();
    const Stats stats = solver->step(5e-3, {.moves = {&move, 1}});
    EXPECT_TRUE(stats.diverged);
    EXPECT_TRUE(solver->save().positions == before.positions);
    EXPECT_TRUE(solver->save().velocities == before.velocities);
}

// All that this machine has, and plain C++; others are chosen in the same way where they are.
TEST(Cpu, IsTheReferenceWithEveryInstructionSet) {
    const std::int64_t here = hwy::SupportedTargets();
    std::set<std::string_view> tried;
    for (std::int64_t target = 1; target > 0; target <<= 1) {
        if (!(target & here)) continue;
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        if (!tried.insert(cpu_instructions()).second) continue;
        SCOPED_TRACE(cpu_instructions());
        for (const auto& [name, body] : odd_bodies()) {
            SCOPED_TRACE(name);
            for (const Acting& on : {everything(body), rubbing(body)})
                expect_same(body, on, Integrator::verlet, Backend::cpu, 25, 1e-5);
        }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_FALSE(tried.empty());
    for (std::string_view name : tried) std::cout << "  with " << name << "\n";
}

// Bodies of every grid that has a kernel of its own.
std::vector<Body> grids() {
    const Body organ = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 700, .material = of_springs});
    std::vector<float> factors(organ.count());
    for (std::size_t i = 0; i < factors.size(); ++i) factors[i] = organ.positions[i].x > 0 ? 1.0f : 3.0f;
    Body hard = organ;
    strengthen(hard, factors);
    Body whole = lattice({7, 6, 5}, 0.01f, {.stiffness = 20, .density = 1000, .damping = 20});
    return {organ, hard, whole, cloth({12, 9}, 0.01f, linen),
            lattice({7, 5, 6}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20})};
}

// How a body lies makes no difference: it moves as an unturned one does that is turned afterwards, takes as
// long steps and no slower kernel.
TEST(Cpu, ATurnedBodyMovesAsAnUnturnedOne) {
    std::mt19937 random(16);
    for (const Body& body : grids())
        for (int trial = 0; trial < 4; ++trial) {
            SCOPED_TRACE(trial);
            ::Turn turn(random);
            turn.shift *= 0.1f;
            if (trial == 1) turn.turn = glm::rotate(mat4(1), glm::radians(180.0f), vec3(0, 1, 0));
            if (trial >= 2) turn.turn = turn.turn * glm::scale(mat4(1), vec3(-1, 1, 1));
            Body other = body;
            other.positions = turn.points(body.positions);
            EXPECT_NE(cpu::BodyMemory(other, {}, 4).view().springs, cpu::Springs::table);
            EXPECT_EQ(mass(other), mass(body));
            EXPECT_NEAR(highest_frequency(other), highest_frequency(body), 2e-2 * highest_frequency(body));

            const vec3 pull(0.3f, 0.1f, 0.2f);
            const NodePush drag{int(body.count() / 3), body.positions[body.count() / 3] + 0.1f * pull, pull,
                                3},
                turned_drag{drag.node, turn.direction(drag.to) + turn.shift, turn.direction(pull), 3};
            Simulation how{.step = 2e-4, .force = true, .gravity = {1, -9, 2}};
            auto straight = make_solver(body, how);
            how.gravity = turn.direction(how.gravity);
            auto turned = make_solver(other, how);
            straight->step(0.02, {.pushes = {&drag, 1}});
            turned->step(0.02, {.pushes = {&turned_drag, 1}});
            const Nodes is = turned->nodes();
            const std::vector<vec3> begins = other.positions,
                                    ends = turn.points({straight->nodes().positions.begin(),
                                                        straight->nodes().positions.end()});
            double most = 0, moved = 0;
            for (std::size_t i = 0; i < ends.size(); ++i) {
                const double off = glm::distance(dvec3(is.positions[i]), dvec3(ends[i]));
                if (!(off <= most)) most = off;
                moved = std::max(moved, glm::distance(dvec3(begins[i]), dvec3(ends[i])));
            }
            EXPECT_GT(moved, 1e-3);
            EXPECT_LE(most, 2e-6);
            EXPECT_EQ(inverted_cells(other, is.positions), inverted_cells(body, straight->nodes().positions));
        }
}

// Found once and kept, or found again: the longest step is what stability says of what acts just now.
TEST(Step, FollowsWhatActs) {
    const Body body = lattice({6, 5, 7}, 0.01f, of_springs);
    const double frequency = highest_frequency(body);
    const Press soft{.stiffness = 50}, hard{.stiffness = 5000};
    const NodePush drag{.stiffness = 200};
    auto solver = make_solver(body, {});
    for (const Influences& on :
         {Influences{}, Influences{.presses = {&soft, 1}}, Influences{.presses = {&hard, 1}}, Influences{},
          Influences{.pushes = {&drag, 1}}, Influences{.presses = {&hard, 1}, .pushes = {&drag, 1}},
          Influences{.presses = {&soft, 1}}}) {
        float contact = 0, pull = 0;
        for (const Press& press : on.presses) contact += pressure_per_metre(press);
        for (const NodePush& one : on.pushes) pull += one.stiffness;
        const double touched = touched_frequency(body, frequency, contact, pull);
        for (int twice = 0; twice < 2; ++twice)
            EXPECT_EQ(solver->longest_step(on),
                      automatic_step(Integrator::verlet, touched, body.damping, body.link_damping));
    }
    // Pulls on one node add up; those on several do not.
    const NodePush twice[] = {{.node = 3, .stiffness = 200}, {.node = 3, .stiffness = 200}},
                   apart[] = {{.node = 3, .stiffness = 200}, {.node = 5, .stiffness = 200}};
    const NodePush strong{.stiffness = 400};
    EXPECT_EQ(solver->longest_step({.pushes = twice}), solver->longest_step({.pushes = {&strong, 1}}));
    EXPECT_EQ(solver->longest_step({.pushes = apart}), solver->longest_step({.pushes = {&drag, 1}}));
}

TEST_P(CpuIs, TheReferenceWithAnyNumberOfTools) {
    for (auto [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        expect_same(body, many_tools(body), GetParam(), Backend::cpu, 10, 1e-5);
    }
}

// What is pushed alone moves as it is pushed: momentum given is momentum received, however many push a node.
TEST(Cpu, GivesNodesWhatPushesThem) {
    Body body = net(std::vector<vec3>(5, vec3(1)), std::vector<float>(5, 0.5f), {});
    const NodePush pushes[] = {{.node = 1, .force = {3, 0, 0}},
                               {.node = 1, .force = {0, -2, 0}},
                               {.node = 4, .to = {1, 2, 1}, .stiffness = 0.5f},
                               {.node = 4, .to = {1, 1, 3}, .stiffness = 1.5f},
                               {.node = 4, .force = {0, 0, 1}}};
    for (Backend backend : {Backend::reference, Backend::cpu}) {
        auto solver = make_solver(body, {.backend = backend,
                                         .integrator = Integrator::semi_implicit_euler,
                                         .step = 1e-3,
                                         .gravity = vec3(0)});
        const Stats stats = solver->step(0.1, {.pushes = pushes});
        const State state = solver->state();
        dvec3 given(0), received(0);
        for (dvec3 push : stats.pushes) given -= push;
        for (dvec3 v : state.velocities) received += 0.5 * v;
        EXPECT_LE(glm::distance(given, received), 1e-6) << name_of(backend);
        EXPECT_LE(glm::distance(state.velocities[1], dvec3(0.6, -0.4, 0)), 1e-6);
        // x'' = (2 (1, 5/4, 5/2) + (0, 0, 1) - 2 x) / 0.5: a swing about (1, 5/4, 3) with 2 rad/s.
        const double swung = 1 - std::cos(0.2);
        EXPECT_LE(glm::distance(state.positions[4], dvec3(1, 1 + 0.25 * swung, 1 + 2 * swung)), 1e-3);
        for (int i : {0, 2, 3}) EXPECT_EQ(state.velocities[std::size_t(i)], dvec3(0));
    }
}

TEST(Cpu, TakesABodyOfNoNodes) {
    for (const Body& body : {Body{}, net({}, {}, {})}) {
        auto solver = make_solver(body, {.backend = Backend::cpu, .threads = 2});
        EXPECT_FALSE(solver->step(0.01).diverged);
        EXPECT_TRUE(solver->nodes().positions.empty());
    }
}

// A node far from where it began, and a place for it that a float could not hold.
TEST(Cpu, KeepsPlacesFinerThanAFloatOfTheWorld) {
    const Body body = net(std::vector<vec3>{{10, 20, 30}}, std::vector<float>{1}, {});
    auto solver = make_solver(body, {.backend = Backend::cpu, .step = 1e-3, .gravity = vec3(0)});
    State state = solver->save();
    state.velocities[0] = {1e-6, 0, 0};
    solver->restore(state);
    solver->step(1);  // a micrometre, a tenth of what floats tell apart at 10 m
    EXPECT_LE(std::abs(solver->save().positions[0].x - 10.000001), 1e-9);
}

// ---- where nodes lie ----

using cpu::Layout;
using cpu::Run;

int covered(const Layout& layout) {
    int slots = 0;
    for (const Run& run : layout.runs) slots += run.count;
    return slots;
}

void expect_sound(const Body& body, int lanes) {
    const GridSprings& stencil = *body.grid();
    const Layout layout(body, lanes);
    std::set<int> taken(layout.slot.begin(), layout.slot.end());
    EXPECT_EQ(taken.size(), body.count());  // each its own
    EXPECT_EQ(covered(layout), layout.slots);
    const Table springs = table(body);
    std::vector<int> run_of(std::size_t(layout.slots));
    for (std::size_t r = 0; r < layout.runs.size(); ++r) {
        const Run run = layout.runs[r];
        EXPECT_EQ(run.first % lanes, 0);
        EXPECT_EQ(run.count % lanes, 0);
        std::fill_n(run_of.begin() + run.first, run.count, int(r));
    }
    const std::size_t links = stencil.links.size();
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < links; ++l) {
            const int slot = layout.slot[i];
            const int there = slot + layout.offsets[std::size_t(run_of[std::size_t(slot)]) * links + l];
            ASSERT_GE(there, -layout.margin);
            ASSERT_LT(there, layout.slots + layout.margin);
            if (const Tie& tie = springs.of(i)[l]; tie.to >= 0 && tie.share > 0)
                ASSERT_EQ(there, layout.slot[std::size_t(tie.to)]);
        }
}

TEST(Layout, EveryLinkLeadsToItsNeighbour) {
    const Body organ = lattice(ellipsoid({0.02f, 0.05f, 0.03f}, 12), {.nodes = 900, .material = of_springs});
    const Mesh shell = both(ellipsoid({0.05f, 0.05f, 0.05f}, 16), [] {
        Mesh inner = ellipsoid({0.04f, 0.04f, 0.04f}, 16);
        for (uvec3& t : inner.triangles) std::swap(t.y, t.z);
        return inner;
    }());
    const Body hollow = lattice(shell, {.nodes = 6000, .material = of_springs});
    for (int lanes : {1, 4, 8, 16}) {
        expect_sound(organ, lanes);
        expect_sound(hollow, lanes);
        for (ivec3 d : {ivec3(1, 1, 1), ivec3(33, 2, 5), ivec3(1, 17, 3), ivec3(7, 1, 1), ivec3(3, 4, 40)}) {
            expect_sound(lattice(d, 0.01f, of_springs), lanes);
            expect_sound(lattice(d, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f}), lanes);
        }
    }
}

TEST(Layout, ABoxHasNoGapsAndRowsAreTheLongest) {
    EXPECT_EQ(Layout(lattice({27, 27, 27}, 0.01f, of_springs), 8).slots, 27 * 27 * 27 + 5);
    // A rod along z, of rows that are 40 long there and 3 long along x.
    Body rod = lattice(ellipsoid({0.012f, 0.012f, 0.2f}, 24), {.spacing = 0.01f, .material = of_springs});
    const Layout layout(rod, 8);
    EXPECT_LE(layout.slots, 1.5 * double(rod.count()));
}

// ---- threads ----

TEST(Team, MeetsAgainAndAgain) {
    for (int members : {1, 2, 4}) {
        Team team(members);
        std::vector<int> counts(std::size_t(members), 0);
        for (int call = 0; call < 50; ++call)
            team.run([&](int member) {
                for (int i = 0; i < 20; ++i) {
                    ++counts[std::size_t(member)];
                    team.meet();
                    for (int other : counts) EXPECT_EQ(other, counts[std::size_t(member)]);
                    team.meet();
                }
            });
        for (int count : counts) EXPECT_EQ(count, 1000);
    }
}

}  // namespace
}  // namespace palpate
