// Springs in a table on the backend cpu: nets and sheets of every kind move as in the reference, however
// their nodes lie in memory.
#include "palpate/body/lattice.h"
#include "palpate/solver/cpu/body_memory.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/stability.h"
#include "tests/integrators.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <random>

namespace palpate {
namespace {

std::vector<int> shuffled(std::size_t count, unsigned seed) {
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::shuffle(order.begin(), order.end(), std::mt19937(seed));
    return order;
}

Body net_of(const std::vector<vec3>& places, const std::vector<Spring>& springs) {
    std::vector<float> masses;
    for (std::size_t i = 0; i < places.size(); ++i)
        masses.push_back(i % 11 == 5 ? 0 : 0.01f * float(1 + i % 3));
    Body body = net(places, masses, springs);
    body.damping = 20;
    return body;
}

// Each node tied to those near it, of random stiffness, some of them stretched at rest.
Body random_net(int count, unsigned seed) {
    std::mt19937 random(seed);
    auto any = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    const float side = 0.01f * std::cbrt(float(count));
    std::vector<vec3> places;
    for (int i = 0; i < count; ++i) places.push_back({any(0, side), any(0, side), any(0, side)});
    std::vector<Spring> springs;
    for (int a = 0; a < count; ++a)
        for (int b = 0; b < a; ++b)
            if (const float d = glm::distance(places[std::size_t(a)], places[std::size_t(b)]);
                d > 0.002f && d < 0.014f)
                springs.push_back({a, b, any(1, 40), d * any(0.9f, 1.0f)});
    return net_of(places, springs);
}

// A hub that is tied to all others, which are tied to nothing else.
Body star(int rays) {
    std::vector<vec3> places;
    std::vector<Spring> springs;
    for (int i = 0; i < rays; ++i) {
        const float angle = 2.4f * float(i), height = (float(i) + 0.5f) / float(rays) * 2 - 1;
        const float round = std::sqrt(1 - height * height);
        places.push_back(0.05f * vec3(round * std::cos(angle), round * std::sin(angle), height));
        springs.push_back({rays, i, 2});
    }
    places.push_back(vec3(0));
    return net_of(places, springs);
}

Body chain(int links) {
    const std::vector<int> number = shuffled(std::size_t(links) + 1, 5);
    std::vector<vec3> places(number.size());
    std::vector<Spring> springs;
    for (int i = 0; i <= links; ++i) {
        places[std::size_t(number[std::size_t(i)])] = {0.002f * float(i), 0.001f * float(i % 2), 0};
        if (i > 0) springs.push_back({number[std::size_t(i)], number[std::size_t(i) - 1], 30});
    }
    return net_of(places, springs);
}

// A sheet of triangles with its vertices in no order.
Body sheet(ivec2 dims, unsigned seed) {
    const Mesh mesh = face_mesh(cloth(dims, 0.01f, linen));
    const std::vector<int> place = shuffled(mesh.positions.size(), seed);
    Mesh to;
    to.positions.resize(place.size());
    for (std::size_t i = 0; i < place.size(); ++i)
        to.positions[std::size_t(place[i])] = mesh.positions[i] + vec3(0, 0, 0.0004f * std::sin(float(i)));
    for (uvec3 t : mesh.triangles) to.triangles.push_back({place[t.x], place[t.y], place[t.z]});
    return cloth(to, linen);
}

// Many triangles around one vertex, and few around all others.
Body parasol(int ribs) {
    Mesh mesh;
    for (int i = 0; i < ribs; ++i) {
        const float angle = 6.2831853f * float(i) / float(ribs);
        mesh.positions.push_back(0.2f * vec3(std::cos(angle), std::sin(angle), 0));
        mesh.triangles.push_back({ribs, i, (i + 1) % ribs});
    }
    mesh.positions.push_back({0, 0, 0.03f});
    return cloth(mesh, linen);
}

Body hinged(Body body) {
    body.terms.push_back(bending(body, 2e-4f));
    return body;
}

// Some springs are missing: gaps in the rings around nodes.
Body torn_sheet(Body body, unsigned seed) {
    std::mt19937 random(seed);
    std::erase_if(std::get<ListedSprings>(body.terms[0]).springs,
                  [&](const Spring&) { return random() % 8 == 0; });
    for (int& neighbour : body.rings)
        if (random() % 8 == 0) neighbour = -1;
    return body;
}

std::vector<NamedBody> tables() {
    const Body organ = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 400, .material = of_springs});
    Mesh bowl = ellipsoid({0.04f, 0.04f, 0.02f}, 7);
    Mesh open = bowl;
    open.triangles.resize(open.triangles.size() * 2 / 3);
    return {{"a node", net_of({{0.01f, 0.02f, 0}}, {})},
            {"nodes without springs", net_of(std::vector<vec3>(37, vec3(0.01f)), {})},
            {"a spring", net_of({vec3(0), vec3(0.01f, 0, 0)}, {{0, 1, 20}})},
            {"two springs between two nodes",
             net_of({vec3(0), vec3(0.01f, 0, 0), vec3(0, 1, 0)}, {{0, 1, 20}, {1, 0, 3, 0.008f}})},
            {"a star", star(200)},
            {"a chain", chain(333)},
            {"a small net", random_net(37, 1)},
            {"a net", random_net(300, 2)},
            {"a larger net", random_net(900, 3)},
            {"two triangles", sheet({2, 2}, 1)},
            {"a strip", sheet({3, 17}, 2)},
            {"a sheet", sheet({31, 9}, 3)},
            {"a torn sheet", torn_sheet(sheet({19, 23}, 4), 4)},
            {"a parasol", parasol(90)},
            {"a closed sheet", cloth(bowl, linen)},
            {"a hinge", hinged(sheet({2, 2}, 1))},
            {"a strip of hinges", hinged(sheet({3, 17}, 2))},
            {"a torn sheet of hinges", hinged(torn_sheet(sheet({19, 23}, 4), 4))},
            {"a parasol of hinges", hinged(parasol(90))},
            {"an organ", without_grid(organ)},
            {"a box", without_grid(lattice({9, 7, 8}, 0.01f, of_springs))}};
}

class TableIs : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, TableIs, ::testing::ValuesIn(every_integrator()), test_name);

TEST_P(TableIs, TheReference) {
    // Explicit Euler lets what contacts stir up grow.
    const int steps = GetParam() == Integrator::explicit_euler ? 8 : 25;
    for (auto [name, body] : tables()) {
        SCOPED_TRACE(name);
        for (float link_damping : {0.0f, 1e-4f}) {
            body.link_damping = link_damping;
            expect_same(body, {}, GetParam(), Backend::cpu, steps, 1e-6);
            expect_same(body, everything(body), GetParam(), Backend::cpu, steps, 1e-5);
        }
    }
}

TEST_P(TableIs, TheSameToTheBitOnAnyNumberOfThreads) {
    for (auto [name, body] : tables()) {
        SCOPED_TRACE(name);
        body.link_damping = 1e-4f;
        const Acting on = everything(body);
        const Simulation how = simulation(body, on, GetParam(), Backend::cpu);
        auto one = make_solver(body, how);
        const Stats of_one = one->step(7 * how.step, on.influences());
        for (int threads : {2, 3}) {
            auto many = make_solver(body, simulation(body, on, GetParam(), Backend::cpu, threads));
            const Stats of_many = many->step(7 * how.step, on.influences());
            expect_same_bits(one->save(), many->save());
            EXPECT_TRUE(of_one.reactions == of_many.reactions);
            EXPECT_TRUE(of_one.pushes == of_many.pushes);
        }
    }
}

// What a solver remembers beside its state, such as what neighbours see, follows a state that is put back.
TEST_P(TableIs, SavedAndRestoredToTheBit) {
    for (auto [name, body] : tables()) {
        SCOPED_TRACE(name);
        body.link_damping = 1e-4f;
        const Acting on = everything(body);
        const Simulation how = simulation(body, on, GetParam(), Backend::cpu);
        auto first = make_solver(body, how), second = make_solver(body, how);
        second->step(3 * how.step, on.influences());
        first->step(13 * how.step, on.influences());
        second->restore(first->save());
        for (int i = 0; i < 3; ++i) {
            expect_same_bits(first->save(), second->save());
            EXPECT_TRUE(std::ranges::equal(first->nodes().normals, second->nodes().normals));
            EXPECT_TRUE(first->state().velocities == second->state().velocities);
            first->step(5 * how.step, on.influences());
            second->step(5 * how.step, on.influences());
        }
        const State before = second->save();
        second->step(2 * how.step, on.influences());
        second->undo();
        EXPECT_TRUE(second->save().positions == before.positions);
        first->step(how.step, on.influences());
        second->step(how.step, on.influences());
        EXPECT_TRUE(first->save().positions == second->save().positions);
    }
}

TEST_P(TableIs, AsItWasBeforeACallThatTearsIt) {
    for (auto body : {sheet({19, 23}, 4), star(200), random_net(300, 2)}) {
        auto solver = make_solver(
            body, {.backend = Backend::cpu, .integrator = GetParam(), .step = 1e-4, .force = true});
        solver->step(3e-4);
        State wild = solver->save();
        wild.velocities[100] = {5000, 0, 0};
        solver->restore(wild);
        EXPECT_TRUE(solver->step(5e-3).diverged);
        EXPECT_TRUE(solver->save().positions == wild.positions);
        EXPECT_TRUE(solver->save().velocities == wild.velocities);
    }
}

TEST(Tables, AreTheReferenceWithEveryInstructionSet) {
    const std::int64_t here = hwy::SupportedTargets();
    for (std::int64_t target = 1; target > 0; target <<= 1) {
        if (!(target & here)) continue;
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        SCOPED_TRACE(cpu_instructions());
        for (auto [name, body] : tables()) {
            SCOPED_TRACE(name);
            body.link_damping = 1e-4f;
            expect_same(body, everything(body), Integrator::verlet, Backend::cpu, 25, 1e-5);
        }
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

// Shares are worked into stiffness and tension: exact for none, a quarter, a half and all of a spring, and
// with three quarters off by no more than a float's rounding is anyway.
TEST(Tables, LoseNothingByTheirShares) {
    const Body grid = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 700, .material = of_springs});
    const Body body = without_grid(grid);
    EXPECT_TRUE(std::ranges::any_of(table(grid).ties, [](const Tie& tie) { return tie.share == 0.75f; }));
    const Simulation how = simulation(body, {}, Integrator::verlet, Backend::cpu);
    const double frequency = highest_frequency(body), seconds = 100 * how.step;
    auto exact = make_exact_solver(body, how, frequency), same = make_solver(grid, how),
         solver = make_solver(body, how);
    exact->step(seconds);
    same->step(seconds);
    solver->step(seconds);
    const State truth = exact->save();
    const double off = furthest_apart(solver->save().positions, truth.positions),
                 grids = furthest_apart(same->save().positions, truth.positions);
    EXPECT_LE(off, 1e-8);
    EXPECT_LE(off, 2 * grids);
}

// ---- how they lie ----

using namespace cpu;

// A record's number, read as a kernel of so many lanes does.
template <class T>
T number(const void* records, std::size_t record, std::size_t numbers, std::size_t k, std::size_t lane,
         std::size_t lanes) {
    T value;
    std::memcpy(&value,
                static_cast<const char*>(records) + ((record * numbers + k) * lanes + lane) * sizeof(T),
                sizeof(T));
    return value;
}

// The force of each node's springs is all there, in its order.
void expect_all_ties(const Body& body, int width) {
    const BodyMemory laid(body, {}, width);
    const Layout& layout = laid.layout();
    const Ties& ties = laid.view().ties;
    ASSERT_EQ(laid.view().springs, Springs::table);
    std::vector<int> taken = layout.slot;
    std::ranges::sort(taken);
    for (std::size_t i = 0; i < taken.size(); ++i) ASSERT_EQ(taken[i], int(i));  // each its own
    const Table springs = table(body);
    const auto lanes = std::size_t(width);
    for (std::size_t i = 0; i < body.count(); ++i) {
        const auto slot = std::size_t(layout.slot[i]);
        const Slice& slice = ties.slices[slot / lanes];
        std::vector<std::pair<int, float>> expected, found;
        for (const Tie& tie : springs.of(i))
            if (tie.share * tie.stiffness > 0)
                expected.push_back({layout.slot[std::size_t(tie.to)], tie.share * tie.stiffness});
        for (int l = 0; l < slice.count; ++l) {
            const std::size_t record = std::size_t(slice.first + l);
            const auto to = number<std::uint32_t>(ties.pulling, record, 6, 0, slot % lanes, lanes);
            const auto stiffness = number<float>(ties.pulling, record, 6, 4, slot % lanes, lanes);
            ASSERT_EQ(to % 4, 0u);
            ASSERT_LT(int(to / 4), layout.slots);
            if (stiffness > 0) found.push_back({int(to / 4), stiffness});
            const auto share = number<float>(ties.whole, record, 3, 0, slot % lanes, lanes),
                       whole = number<float>(ties.whole, record, 3, 1, slot % lanes, lanes);
            ASSERT_EQ(share * whole, stiffness);
        }
        ASSERT_TRUE(expected == found) << i;
    }
}

TEST(Tables, HoldEverySpringInItsOrder) {
    for (const auto& [name, body] : tables()) {
        SCOPED_TRACE(name);
        for (int lanes : {1, 4, 8, 16}) expect_all_ties(body, lanes);
    }
}

TEST(Tables, KeepNoMoreOfARingThanItsNormalNeeds) {
    const Tie a{1, 1, 1, 1}, b{2, 1, 1, 1}, c{3, 1, 1, 1}, none, again{1, 0, 0, 1}, other{4, 1, 1, 1};
    auto fan = [](std::vector<Tie> ties, int longest) { return count_ties(ties, longest).fan; };
    EXPECT_EQ(fan({a, b, c, again, again}, 5), 3);  // closed
    EXPECT_EQ(fan({a, b, c, none, none}, 5), 4);    // open
    EXPECT_EQ(fan({a, none, b, c, none}, 5), 5);    // with a gap
    EXPECT_EQ(fan({a, b, c, a, none}, 5), 5);       // twice the same spring
    EXPECT_EQ(fan({none, none}, 2), 1);
    EXPECT_EQ(fan({}, 0), 0);
    EXPECT_EQ(count_ties(std::vector{a, b, c, again, other, none, other}, 4).others, 2);
    EXPECT_EQ(count_ties(std::vector{none, other, Tie{5, 0, 1, 1}}, 0).others, 1);
}

// The nodes of a register have about as many springs, and neighbours lie near.
TEST(Tables, LieCloseWhateverTheOrder) {
    const Body body = sheet({60, 70}, 7);
    const BodyMemory laid(body, {}, 16);
    const Table springs = table(body);
    std::size_t ties = 0;
    double apart = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        for (const Tie& tie : springs.of(i))
            if (tie.to >= 0 && tie.share > 0) {
                ++ties;
                apart += std::abs(laid.layout().slot[i] - laid.layout().slot[std::size_t(tie.to)]);
            }
    const Slice& last = laid.view().ties.slices[laid.layout().slots / 16 - 1];
    EXPECT_LE(16.0 * (last.first + last.count), 1.1 * double(ties));
    EXPECT_LE(apart / double(ties), 200);  // of 4,200
}

}  // namespace
}  // namespace palpate
