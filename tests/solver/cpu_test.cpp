// The backend cpu against the reference: the same physics, with many nodes at once and on many threads.
#include "palpate/solver/cpu/cpu.h"

#include "palpate/base/team.h"
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/cpu/layout.h"
#include "palpate/solver/reference/reference.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/integrators.h"
#include "tests/shapes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <set>

namespace palpate {
namespace {

const Material tissue{.youngs_modulus = 2000, .density = 1000, .damping = 20};
const ClothSettings linen{.density = 0.3f, .damping = 20};

// A body with many odd things: nodes pinned and of other masses, and a scattering of holes in its links.
Body battered(Body body, unsigned seed) {
    std::mt19937 random(seed);
    auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
    for (float& inverse : body.inverse_mass) inverse *= chance(0.1) ? 0.0f : chance(0.3) ? 0.5f : 1.0f;
    if (auto* stencil = std::get_if<Stencil>(&body.springs)) {
        const Table springs = table(body);
        for (std::size_t i = 0; i < body.count(); ++i)
            for (std::size_t l = 0; l < stencil->links.size(); ++l)
                if (const int to = springs.of(i)[l].to; to > int(i) && chance(0.05)) {
                    const std::size_t width = stencil->in_quarters() ? 3 : 1;
                    const std::uint64_t link = width == 3 ? 7 : 1;
                    for (std::size_t k = 0; k < stencil->links.size(); ++k) {  // the link back
                        if (stencil->links[k].offset != -stencil->links[l].offset) continue;
                        stencil->shares[i] &= ~(link << width * l);
                        stencil->shares[std::size_t(to)] &= ~(link << width * k);
                    }
                }
    }
    return body;
}

Body with_strength(Body body, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> factors(body.count());
    for (float& f : factors) f = std::uniform_real_distribution<float>(0.3f, 4.0f)(random);
    strengthen(body, factors);
    return body;
}

Body with_whole_links(Body body) {
    Stencil& stencil = std::get<Stencil>(body.springs);
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < stencil.links.size(); ++l)
            if (stencil.quarters(i, l) > 0) {
                stencil.shares[i] &= ~(std::uint64_t(7) << 3 * l);
                stencil.shares[i] |= std::uint64_t(4) << 3 * l;
            }
    return body;
}

Body turned(Body body) {
    const mat3 turn = mat3(glm::rotate(mat4(1), 0.7f, glm::normalize(vec3(1, 2, 3))));
    for (vec3& p : body.positions) p = turn * p + vec3(0.02f, 0.05f, -0.03f);
    return body;
}

struct Named {
    std::string name;
    Body body;
};

std::vector<Named> bodies() {
    const Body organ = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 700, .material = tissue});
    std::vector<vec3> corners = {
        {0, 0, 0}, {0.03f, 0, 0}, {0, 0.03f, 0}, {0, 0, 0.03f}, {0.02f, 0.02f, 0.02f}};
    std::vector<NetSpring> edges;
    for (int a = 0; a < 5; ++a)
        for (int b = 0; b < a; ++b) edges.push_back({a, b, 20});
    Body net_body = net(corners, std::vector<float>{0.01f, 0.01f, 0.01f, 0.02f, 0.0f}, edges);
    net_body.damping = 20;
    Mesh bowl = ellipsoid({0.04f, 0.04f, 0.02f}, 7);
    return {
        {"box", lattice({9, 7, 8}, 0.01f, tissue)},
        {"box with whole links", with_whole_links(lattice({8, 9, 5}, 0.01f, tissue))},
        {"battered box", battered(lattice({10, 6, 7}, 0.01f, tissue), 1)},
        {"box with strength", with_strength(lattice({7, 6, 5}, 0.01f, tissue), 2)},
        {"organ", organ},
        {"battered organ", battered(organ, 3)},
        {"organ with strength", with_strength(organ, 4)},
        {"turned box", turned(lattice({6, 5, 4}, 0.01f, tissue))},
        {"volume of 2012", lattice({7, 5, 6}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20})},
        {"volume with strength",
         with_strength(lattice({5, 5, 6}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20}), 5)},
        {"cloth", cloth({17, 9}, 0.01f, linen)},
        {"turned cloth", turned(cloth({12, 11}, 0.01f, linen))},
        {"battered cloth", battered(cloth({11, 13}, 0.01f, linen), 6)},
        {"cloth of triangles", cloth(bowl, linen)},
        {"net", net_body}};
}

// What acts on a body, at its worst all at once.
struct Acting {
    std::vector<Collider> colliders;
    std::vector<Motion> motions;
    std::vector<Press> presses;
    std::vector<Drag> drags;
    std::vector<int> moved;
    std::vector<vec3> places;
    std::vector<Move> moves;
    vec3 wind = vec3(0);
    float air = 0;

    Influences influences() const { return {presses, drags, moves, motions, wind}; }
};

Acting everything(const Body& body) {
    Acting on;
    vec3 low(1e9f), high(-1e9f);
    for (vec3 p : body.positions) low = glm::min(low, p), high = glm::max(high, p);
    const vec3 middle = 0.5f * (low + high), off = middle + vec3(0.0017f, 0.0029f, 0.0023f);
    // No node lies where the way out is left to rounding: in the middle of something, or half way between two
    // faces.
    on.colliders = {
        {Plane{{0, 1, 0}, low.y - 0.001f}, 0.4f},
        {Sphere{{high.x + 0.001f, low.y, middle.z + 0.003f}, 0.012f}, 0.3f},
        {Box{vec3(low.x, middle.y, high.z) + vec3(0.0013f, 0.0007f, 0.0009f), {0.006f, 0.005f, 0.004f}}, 0.2f,
         0.001f},
        {Capsule{off - vec3(0, 0.05f, 0), off - vec3(0.03f, 0.05f, 0), 0.01f}}};
    on.motions.assign(on.colliders.size(), Motion{});
    on.motions[1].velocity = {-0.05f, 0.02f, 0};
    on.motions[1].spin = {0, 1, 0};
    on.presses = {{middle + vec3(0, 0, high.z - middle.z + 0.006f), {0, 0, -0.1f}, 0.011f, 30}};
    on.drags = {{int(body.count() / 2), middle + vec3(0.01f, 0.02f, 0), {0.1f, 0, 0}, 3}};
    for (std::size_t i = 0; i < body.count(); i += 3)
        if (body.inverse_mass[i] == 0) {
            on.moved.push_back(int(i));
            on.places.push_back(body.positions[i] + vec3(0, 0.002f, 0.001f));
        }
    on.moves = {{on.moved, on.places}};
    on.wind = {0.5f, -0.2f, 1};
    on.air = 1.2f;
    return on;
}

Simulation simulation(const Body& body, const Acting& on, Integrator integrator, Backend backend,
                      int threads = 1) {
    float contact = 0, pull = 0;
    for (const Press& press : on.presses) contact += pressure_per_metre(press);
    for (const Drag& drag : on.drags) pull += drag.stiffness;
    const double touched = touched_frequency(body, highest_frequency(body), contact, pull);
    double step = automatic_step(integrator, touched, body.damping, body.link_damping);
    if (!(step > 0 && step < 1e-3)) step = 1e-3;
    return {.backend = backend,
            .threads = threads,
            .integrator = integrator,
            .step = step,
            .force = true,
            .air = on.air,
            .colliders = on.colliders,
            .contact = contact,
            .pull = pull,
            .frame = 1e-5};
}

double furthest_apart(const std::vector<dvec3>& a, const std::vector<dvec3>& b) {
    EXPECT_EQ(a.size(), b.size());
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (const double d = glm::distance(a[i], b[i]); !(d <= most)) most = d;
    return most;
}

// The same steps with both. Where contacts make much of little, the reference in double says how much that
// is.
void expect_same(const Body& body, const Acting& on, Integrator integrator, int steps, double bound) {
    const Simulation fast = simulation(body, on, integrator, Backend::cpu),
                     slow = simulation(body, on, integrator, Backend::reference);
    const double seconds = steps * fast.step;
    auto a = make_solver(body, fast), b = make_solver(body, slow);
    auto exact = make_reference<double>(body, slow, highest_frequency(body));
    const Stats of_a = a->step(seconds, on.influences()), of_b = b->step(seconds, on.influences()),
                of_exact = exact->step(seconds, on.influences());
    ASSERT_FALSE(of_a.diverged || of_b.diverged || of_exact.diverged);
    ASSERT_EQ(of_a.steps, of_b.steps);
    const State ends_a = a->state(), ends_b = b->state(), truth = exact->state();
    const double place = bound + 10 * furthest_apart(ends_b.positions, truth.positions),
                 speed = bound / fast.step / 4 + 10 * furthest_apart(ends_b.velocities, truth.velocities);
    EXPECT_LE(furthest_apart(ends_a.positions, truth.positions), place);
    EXPECT_LE(furthest_apart(ends_a.velocities, truth.velocities), speed);
    const Nodes seen = a->nodes(), seen_b = b->nodes();
    ASSERT_EQ(seen.positions.size(), body.count());
    for (std::size_t i = 0; i < body.count(); ++i) {
        ASSERT_LE(glm::distance(dvec3(seen.positions[i]), ends_a.positions[i]), 1e-7) << i;
        ASSERT_LE(glm::distance(seen.normals[i], seen_b.normals[i]), 1e-2 + 10 * place / body.spacing) << i;
    }
    EXPECT_LE(std::abs(of_a.largest_speed - of_exact.largest_speed), speed);
    EXPECT_LE(std::abs(of_a.largest_move - of_exact.largest_move), place);
    const double a_little = 1e-4 * seconds;  // of a tenth of a newton
    EXPECT_LE(furthest_apart(of_a.reactions, of_exact.reactions),
              a_little + 10 * furthest_apart(of_b.reactions, of_exact.reactions));
    EXPECT_LE(furthest_apart(of_a.pulls, of_exact.pulls),
              a_little + 10 * furthest_apart(of_b.pulls, of_exact.pulls));
}

class CpuIs : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, CpuIs, ::testing::ValuesIn(every_integrator()), test_name);

TEST_P(CpuIs, TheReferenceOnEveryBody) {
    for (const auto& [name, body] : bodies()) {
        SCOPED_TRACE(name);
        expect_same(body, {}, GetParam(), 100, 1e-6);
    }
}

TEST_P(CpuIs, TheReferenceWithAllThatCanAct) {
    // Explicit Euler lets what contacts stir up grow.
    const int steps = GetParam() == Integrator::explicit_euler ? 8 : 25;
    for (auto [name, body] : bodies()) {
        SCOPED_TRACE(name);
        expect_same(body, everything(body), GetParam(), steps, 1e-5);
        body.link_damping = 1e-4f;
        expect_same(body, everything(body), GetParam(), steps, 1e-5);
    }
}

TEST_P(CpuIs, TheReferenceOnOddSizes) {
    // Each of the sizes along each axis.
    const ivec3 sizes[] = {{1, 33, 9}, {2, 15, 8},  {3, 16, 2},  {7, 9, 3},    {8, 1, 17}, {9, 8, 1},
                           {15, 2, 7}, {16, 3, 15}, {17, 7, 16}, {33, 17, 33}, {1, 1, 1},  {1, 1, 7}};
    for (const ivec3 d : sizes) {
        SCOPED_TRACE(std::to_string(d.x) + " x " + std::to_string(d.y) + " x " + std::to_string(d.z));
        const Body box = lattice(d, 0.01f, tissue);
        expect_same(box, everything(box), GetParam(), 10, 1e-5);
        const Body sheet = cloth({d.x, d.y}, 0.01f, linen);
        expect_same(sheet, everything(sheet), GetParam(), 10, 1e-5);
        const Body volume =
            lattice({d.z, d.x, d.y}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20});
        expect_same(volume, everything(volume), GetParam(), 10, 1e-5);
    }
}

TEST_P(CpuIs, TheSameToTheBitOnAnyNumberOfThreads) {
    for (const auto& [name, body] : bodies()) {
        SCOPED_TRACE(name);
        const Acting on = everything(body);
        auto one = make_solver(body, simulation(body, on, GetParam(), Backend::cpu, 1));
        const double step = one->longest_step();
        const Stats of_one = one->step(7 * step, on.influences());
        for (int threads : {2, 3, 5}) {
            auto many = make_solver(body, simulation(body, on, GetParam(), Backend::cpu, threads));
            const Stats of_many = many->step(7 * step, on.influences());
            const State a = one->save(), b = many->save();
            EXPECT_TRUE(a.positions == b.positions);
            EXPECT_TRUE(a.velocities == b.velocities);
            EXPECT_TRUE(of_one.reactions == of_many.reactions);
            EXPECT_TRUE(of_one.pulls == of_many.pulls);
            EXPECT_EQ(of_one.largest_speed, of_many.largest_speed);
            EXPECT_EQ(of_one.largest_move, of_many.largest_move);
        }
    }
}

TEST_P(CpuIs, SavedAndRestoredToTheBit) {
    for (const auto& [name, body] : bodies()) {
        SCOPED_TRACE(name);
        const Acting on = everything(body);
        const Simulation how = simulation(body, on, GetParam(), Backend::cpu);
        auto first = make_solver(body, how), second = make_solver(body, how);
        first->step(13 * how.step, on.influences());
        second->restore(first->save());
        for (int i = 0; i < 3; ++i) {
            const State a = first->save(), b = second->save();
            EXPECT_TRUE(a.positions == b.positions);
            EXPECT_TRUE(a.velocities == b.velocities);
            first->step(5 * how.step, on.influences());
            second->step(5 * how.step, on.influences());
        }
    }
}

TEST_P(CpuIs, AsItWasBeforeACallThatTearsIt) {
    Body body = lattice({9, 5, 7}, 0.01f, tissue);
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
        for (const auto& [name, body] : bodies()) {
            SCOPED_TRACE(name);
            expect_same(body, everything(body), Integrator::verlet, 25, 1e-5);
        }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_FALSE(tried.empty());
    for (std::string_view name : tried) std::cout << "  with " << name << "\n";
}

TEST(Cpu, TakesABodyOfNoNodes) {
    for (const Body& body : {lattice({0, 0, 0}, 0.01f, tissue), Body{}}) {
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
    const Stencil& stencil = body.stencil();
    const Layout layout(stencil, lanes);
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
    const Body organ = lattice(ellipsoid({0.02f, 0.05f, 0.03f}, 12), {.nodes = 900, .material = tissue});
    const Mesh shell = both(ellipsoid({0.05f, 0.05f, 0.05f}, 16), [] {
        Mesh inner = ellipsoid({0.04f, 0.04f, 0.04f}, 16);
        for (uvec3& t : inner.triangles) std::swap(t.y, t.z);
        return inner;
    }());
    const Body hollow = lattice(shell, {.nodes = 6000, .material = tissue});
    for (int lanes : {1, 4, 8, 16}) {
        expect_sound(organ, lanes);
        expect_sound(hollow, lanes);
        for (ivec3 d : {ivec3(1, 1, 1), ivec3(33, 2, 5), ivec3(1, 17, 3), ivec3(7, 1, 1), ivec3(3, 4, 40)}) {
            expect_sound(lattice(d, 0.01f, tissue), lanes);
            expect_sound(lattice(d, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f}), lanes);
        }
    }
}

TEST(Layout, ABoxHasNoGapsAndRowsAreTheLongest) {
    EXPECT_EQ(Layout(lattice({27, 27, 27}, 0.01f, tissue).stencil(), 8).slots, 27 * 27 * 27 + 5);
    // A rod along z, of rows that are 40 long there and 3 long along x.
    Body rod = lattice(ellipsoid({0.012f, 0.012f, 0.2f}, 24), {.spacing = 0.01f, .material = tissue});
    const Layout layout(rod.stencil(), 8);
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
