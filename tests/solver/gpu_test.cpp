// The backends of the GPU against the reference: the same physics, on whatever driver this machine has.
#include "bench/studies.h"
#include "palpate/body/cloth.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/stability.h"
#include "tests/gl/hostile.h"
#include "tests/gl/with_context.h"
#include "tests/integrators.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

namespace palpate {
namespace {

using Gpu = WithContext;

class EveryGpu : public Gpu, public ::testing::WithParamInterface<Backend> {};
INSTANTIATE_TEST_SUITE_P(Backends, EveryGpu,
                         ::testing::Values(Backend::feedback, Backend::fragment, Backend::compute),
                         [](const auto& of) { return std::string(name_of(of.param)); });

using Both = std::tuple<Backend, Integrator>;
class EveryWay : public Gpu, public ::testing::WithParamInterface<Both> {
 protected:
    Backend backend() const { return std::get<Backend>(GetParam()); }
    Integrator integrator() const { return std::get<Integrator>(GetParam()); }

    // Every backend takes all cases, and every backend with every integrator takes some: the physics is one
    // text, of which a pair of a body and an integrator is tried on the CPU. `turn` deals the cases out anew.
    template <class T>
    std::vector<T> share(const std::vector<T>& cases, std::size_t turn) const {
        const std::size_t ways = every_integrator().size();
        std::vector<T> mine;
        for (std::size_t i = 0; i < cases.size(); ++i)
            if ((i + turn + std::size_t(backend())) % ways == std::size_t(integrator()))
                mine.push_back(cases[i]);
        return mine;
    }
};
INSTANTIATE_TEST_SUITE_P(Backends, EveryWay,
                         ::testing::Combine(::testing::Values(Backend::feedback, Backend::fragment,
                                                              Backend::compute),
                                            ::testing::ValuesIn(every_integrator())),
                         [](const auto& of) {
                             std::string name = std::string(name_of(std::get<Backend>(of.param))) + "_" +
                                                std::string(name_of(std::get<Integrator>(of.param)));
                             std::replace(name.begin(), name.end(), '-', '_');
                             return name;
                         });

// 1e-5 of bodies that are about 0.1 m.
TEST_P(EveryWay, IsTheReferenceOnEveryBody) {
    for (const auto& [name, body] : share(odd_bodies(), 0)) {
        SCOPED_TRACE(name);
        expect_same(body, {}, integrator(), backend(), 100, 1e-6, context());
    }
}

TEST_P(EveryWay, IsTheReferenceWithAllThatCanAct) {
    // A node that was put on a surface touches it in the next step or not, as rounding will have it, and
    // explicit Euler lets what comes of that grow: it goes without obstacles here, and for fewer steps.
    const bool grows = integrator() == Integrator::explicit_euler;
    for (auto [name, body] : share(odd_bodies(), 3)) {
        SCOPED_TRACE(name);
        body.link_damping = 1e-4f;
        Acting on = everything(body);
        if (grows) on.colliders.clear(), on.motions.clear();
        expect_same(body, on, integrator(), backend(), grows ? 8 : 100, 1e-6, context());
    }
}

TEST_P(EveryWay, IsTheReferenceOnOddSizes) {
    // Each of the sizes along each axis.
    const std::vector<ivec3> sizes{{1, 33, 9}, {2, 15, 8}, {16, 3, 15}, {17, 7, 16}, {1, 1, 1}, {1, 1, 7}};
    for (const ivec3 d : share(sizes, 0)) {
        SCOPED_TRACE(std::to_string(d.x) + " x " + std::to_string(d.y) + " x " + std::to_string(d.z));
        const Body box = lattice(d, 0.01f, of_springs);
        expect_same(box, {}, integrator(), backend(), 100, 1e-6, context());
        const Body sheet = cloth({d.x, d.y}, 0.01f, linen);
        expect_same(sheet, {}, integrator(), backend(), 100, 1e-6, context());
    }
}

// The two obstacles that everything() lacks. As there, no node lies where the way out is left to rounding: in
// the middle plane of the ellipsoid.
TEST_P(EveryWay, IsTheReferenceOnPolygonsAndFields) {
    Mesh egg = ellipsoid({0.01f, 0.02f, 0.015f}, 12);
    for (vec3& p : egg.positions) p += vec3(0.0021f, 0.0034f, -0.0019f);
    const vec3 a(-1, 0.004f, -1), b(1, -0.012f, -1), c(0, 0.003f, 1);
    const std::vector<Collider> shapes = {
        {Polygon{{{a, b, c}, {a, c, vec3(-1, 0.1f, 1)}}}, 0.5f},
        {distance_field(block({-0.02f, -0.02f, -0.02f}, {0.0312f, 0.0053f, 0.0307f}), 0.003f), 0.5f},
        {distance_field(egg, 0.002f), 0.2f, 0.001f}};
    for (const Body& body : {lattice({4, 3, 5}, 0.01f, of_springs), cloth({7, 8}, 0.01f, linen)}) {
        Acting on;
        on.colliders = shapes;
        on.motions.assign(shapes.size(), Motion{.velocity = {0.01f, 0.02f, 0}, .spin = {0, 0, 0.5f}});
        expect_same(body, on, integrator(), backend(), integrator() == Integrator::explicit_euler ? 8 : 60,
                    1e-6, context());
    }
}

// Halving the step divides the error by two to the order: of coupled nodes, against the reference in double
// with steps so fine that they are the truth.
TEST_P(EveryWay, HasItsOrder) {
    const std::map<Integrator, double> orders = {
        {Integrator::explicit_euler, 1}, {Integrator::semi_implicit_euler, 1}, {Integrator::verlet, 2},
        {Integrator::midpoint, 2},       {Integrator::verlet_midpoint, 2},     {Integrator::rk4, 4}};
    const Body chain = studies::chain(studies::dampings[1]);
    const double seconds = 0.25;
    auto swung = [&](Solver& solver) {
        solver.step(seconds);
        return solver.state().positions;
    };
    auto exact = make_exact_solver(chain, {.integrator = Integrator::rk4, .step = seconds / 4000}, 0);
    const auto truth = swung(*exact);
    auto error = [&](int steps) {
        auto solver = make_solver(
            chain, {.backend = backend(), .integrator = integrator(), .step = seconds / steps, .force = true},
            context());
        return furthest_apart(swung(*solver), truth);
    };
    const double expected = orders.at(integrator());
    const int steps = expected > 2   ? 16
                      : expected > 1 ? 48
                                     : 200;  // errors well above rounding, well below the chain
    const double order = std::log2(error(steps) / error(2 * steps));
    EXPECT_TRUE(std::abs(order - expected) <= 0.25 * expected) << order;
}

TEST_P(EveryWay, SavedAndRestoredToTheBit) {
    for (const auto& [name, body] : odd_bodies()) {
        if (name != "battered box" && name != "cloth of triangles") continue;
        SCOPED_TRACE(name);
        const Acting on = everything(body);
        const Simulation how = simulation(body, on, integrator(), backend());
        auto first = make_solver(body, how, context()), second = make_solver(body, how, context());
        first->step(13 * how.step, on.influences());
        second->restore(first->save());
        for (int i = 0; i < 3; ++i) {
            expect_same_bits(first->save(), second->save());
            first->step(5 * how.step, on.influences());
            second->step(5 * how.step, on.influences());
        }
        // And between backends and integrators, both ways.
        auto other = make_solver(body, simulation(body, on, Integrator::rk4, Backend::cpu));
        other->restore(first->save());
        EXPECT_LE(furthest_apart(other->state().velocities, first->state().velocities), 1e-4);
    }
}

TEST_P(EveryWay, UndoesACall) {
    const Body body = lattice({5, 6, 7}, 0.01f, of_springs);
    auto solver = make_solver(
        body, {.backend = backend(), .integrator = integrator(), .step = 1e-4, .force = true}, context());
    solver->step(3e-4);
    const State before = solver->save();
    const GpuNodes nodes = solver->gpu_nodes();
    solver->step(5e-4, {.wind = vec3(1)});
    EXPECT_FALSE(solver->save().positions == before.positions);
    solver->undo();
    EXPECT_TRUE(solver->save().positions == before.positions);
    EXPECT_TRUE(solver->save().velocities == before.velocities);
    EXPECT_EQ(solver->save().lag, before.lag);
    EXPECT_EQ(solver->gpu_nodes().positions, nodes.positions);
    EXPECT_LE(glm::distance(solver->nodes().positions[11], vec3(before.positions[11])), 1e-7f);
}

// ---- what a GPU has of its own ----

// In a context where others draw too, whatever they have set: the motion is the same to the bit, and they
// find all as they left it.
TEST_P(EveryGpu, AGuestLeavesTheContextAsItFindsIt) {
    const Body body = lattice({5, 6, 7}, 0.01f, of_springs);
    const Acting on = everything(body);
    const Simulation how = simulation(body, on, Integrator::rk4, GetParam());  // which looks at most
    const auto move = [&](const auto& look) {
        auto solver = make_solver(body, how, context());
        look("made");
        solver->step(5 * how.step, on.influences());
        look("stepped");
        const State stepped = solver->save();
        look("saved");
        State state = solver->state();
        look("read");
        solver->step(3 * how.step, {});
        solver->undo();
        look("undone");
        solver->restore(stepped);
        look("restored");
        EXPECT_TRUE(solver->save().positions == stepped.positions);
        state.positions.insert(state.positions.end(), solver->nodes().positions.begin(),
                               solver->nodes().positions.end());
        return state;
    };
    const State alone = move([](const char*) {});
    const Hostile application;
    const auto before = state_of_context();
    const State visited = move([&](const char* after) { expect_untouched(before, after); });
    EXPECT_TRUE(visited.positions == alone.positions);
    EXPECT_TRUE(visited.velocities == alone.velocities);
}

// What it tells those who draw is where the nodes are.
void expect_bounds(const Solver& solver) {
    Bounds box;
    for (vec3 p : solver.nodes().positions) box.include(p);
    EXPECT_EQ(solver.gpu_nodes().bounds.low, box.low);
    EXPECT_EQ(solver.gpu_nodes().bounds.high, box.high);
}

State wild(const Solver& solver) {
    State state = solver.save();
    state.velocities[100] = {5000, 0, 0};
    return state;
}

TEST_P(EveryGpu, IsAsItWasBeforeACallThatTearsIt) {
    const Body body = lattice({9, 5, 7}, 0.01f, of_springs);
    auto solver = make_solver(body, {.backend = GetParam(), .step = 1e-4, .force = true}, context());
    solver->step(3e-4);
    solver->restore(wild(*solver));
    const State before = solver->save();
    EXPECT_TRUE(solver->step(5e-3).diverged);
    EXPECT_TRUE(solver->save().positions == before.positions);
    EXPECT_TRUE(solver->save().velocities == before.velocities);
    expect_bounds(*solver);
}

// It may be given what is torn already: that is found by the next call, which leaves it so.
TEST_P(EveryGpu, TakesAStateThatIsTorn) {
    const Body body = lattice({9, 5, 7}, 0.01f, of_springs);
    auto solver = make_solver(body, {.backend = GetParam(), .step = 1e-4, .force = true}, context());
    State torn = solver->save();
    torn.positions[100] += dvec3(5, 0, 0);
    solver->restore(torn);
    EXPECT_LE(furthest_apart(solver->save().positions, torn.positions), 1e-6);
    expect_bounds(*solver);
    const State before = solver->save();
    EXPECT_TRUE(solver->step(1e-4).diverged);
    EXPECT_TRUE(solver->save().positions == before.positions);
}

TEST_P(EveryGpu, ReadsNothingBackToStep) {
    const Body body = lattice({6, 5, 4}, 0.01f, of_springs);
    const Acting on = everything(body);
    auto solver = make_solver(body, simulation(body, on, Integrator::rk4, GetParam()), context());
    const long before = context()->reads();
    for (int call = 0; call < 3; ++call) solver->step(1e-4, on.influences());
    const GpuNodes there = solver->gpu_nodes();
    EXPECT_EQ(context()->reads(), before);
    // And what is there is what nodes() reads.
    const Nodes nodes = solver->nodes();
    EXPECT_EQ(context()->reads(), before + 2);
    solver->nodes();
    EXPECT_EQ(context()->reads(), before + 2);
    ASSERT_EQ(there.count, body.count());
    std::vector<vec4> positions(body.count());
    context()->read(there.positions, std::as_writable_bytes(std::span(positions)));
    Bounds box;
    for (std::size_t i = 0; i < body.count(); ++i) {
        EXPECT_EQ(vec3(positions[i]), nodes.positions[i]);
        box.include(nodes.positions[i]);
    }
    EXPECT_EQ(there.bounds.low, box.low);
    EXPECT_EQ(there.bounds.high, box.high);
}

// Whatever it does by itself on this driver.
TEST_F(Gpu, ComputesInTilesAndWithout) {
    for (const auto& [name, body] : odd_bodies())
        for (bool tiles : {false, true}) {
            if (name != "battered organ" && name != "volume of 2012" && name != "battered cloth") continue;
            SCOPED_TRACE(name + (tiles ? ", in tiles" : ""));
            const Acting on = everything(body);
            const Simulation how = simulation(body, on, Integrator::verlet, Backend::compute);
            Solver solver(body, how, highest_frequency(body), [&](const Body& b, const Simulation& s) {
                return make_gpu(b, s, context(), tiles);
            });
            expect_same(solver, body, on, how, 25, 1e-6);
        }
}

TEST_P(EveryGpu, TakesAnyNumberOfTools) {
    for (const auto& [name, body] : odd_bodies()) {
        if (name != "organ with strength" && name != "cloth" && name != "net") continue;
        SCOPED_TRACE(name);
        expect_same(body, many_tools(body), Integrator::verlet, GetParam(), 10, 1e-5, context());
    }
}

TEST_P(EveryGpu, TakesABodyOfNoNodes) {
    for (const Body& body : {Body{}, net({}, {}, {})}) {
        auto solver = make_solver(body, {.backend = GetParam()}, context());
        EXPECT_FALSE(solver->step(0.01).diverged);
        EXPECT_TRUE(solver->nodes().positions.empty());
    }
}

// A thin ring of nodes along the diagonal of a box that is nearly empty.
TEST_P(EveryGpu, KeepsNoBoxThatIsMostlyEmpty) {
    Mesh rod = ellipsoid({0.012f, 0.012f, 0.3f}, 24);
    rotate(rod, {40, 30, 0});
    const Body body = lattice(rod, {.spacing = 0.01f, .material = of_springs});
    auto solver = make_solver(body, {.backend = GetParam()}, context());
    EXPECT_LE(double(solver->memory()), 700.0 * double(body.count()));
    expect_same(body, everything(body), Integrator::verlet, GetParam(), 20, 1e-6, context());
}

TEST_P(EveryGpu, GoesInAContextOfItsOwnToo) {
    auto solver = make_solver(lattice({3, 3, 3}, 0.01f, of_springs), {.backend = GetParam()});
    auto another = make_solver(lattice({4, 3, 3}, 0.01f, of_springs), {.backend = GetParam()});
    for (int call = 0; call < 3; ++call) {
        EXPECT_FALSE(solver->step(0.01).diverged);
        EXPECT_FALSE(another->step(0.01).diverged);
    }
    EXPECT_LT(solver->nodes().positions[0].y, -0.001f);
    EXPECT_LT(another->nodes().positions[0].y, -0.001f);
    context_->make_current();  // theirs went with them
}

}  // namespace
}  // namespace palpate
