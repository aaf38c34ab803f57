// A world is its bodies, moved by the same calls: in slices, on one team, and all or none of them.
#include "palpate/solver/world.h"

#include "palpate/solver/machine.h"
#include "tests/integrators.h"
#include "tests/refusal.h"
#include "tests/solver/agreement.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

Body pinned_box() {
    Body body = lattice({6, 5, 4}, 0.01f, of_springs);
    for (std::size_t i = 0; i < body.count(); i += 6) body.inverse_mass[i] = 0;
    return body;
}

const Simulation on_cpu{.threads = 2, .step = 0.0005, .force = true};

// Everything at once on two bodies, in one slice: to the bit what two solvers do.
TEST(World, IsItsBodies) {
    const Body bodies[] = {pinned_box(), cloth({9, 7}, 0.01f, linen)};
    Simulation short_steps = on_cpu;
    short_steps.step = 0.0001;  // a cloth is light
    Team team(3);
    World world(short_steps, nullptr, &team);
    std::vector<std::unique_ptr<Solver>> alone;
    for (const Body& body : bodies) {
        world.add(body);
        alone.push_back(make_solver(body, short_steps));
    }
    const Acting first = everything(bodies[0]);
    const NodePush drags[] = {{.node = 3, .to = vec3(0.05f), .stiffness = 1},
                              {.node = 8, .stiffness = 2},
                              {.node = 40, .stiffness = 0.5f}};
    const BodyPush on_bodies[] = {{1, drags[0]}, {0, drags[1]}, {1, drags[2]}};
    const NodePush of_second[] = {drags[0], drags[2]};
    const BodyMove move{0, first.moves[0]};
    for (int call = 0; call < 5; ++call) {
        const WorldStats stats =
            world.step(0.01, {.presses = first.presses, .pushes = on_bodies, .moves = {&move, 1}});
        ASSERT_FALSE(stats.diverged);
        const Stats a = alone[0]->step(
                        0.01, {.presses = first.presses, .pushes = {&drags[1], 1}, .moves = first.moves}),
                    b = alone[1]->step(0.01, {.presses = first.presses, .pushes = of_second});
        EXPECT_EQ(stats.bodies[0].steps, a.steps);
        EXPECT_EQ(stats.reactions[0], a.reactions[0] + b.reactions[0]);
        EXPECT_TRUE(stats.pushes == std::vector<dvec3>({b.pushes[0], a.pushes[0], b.pushes[1]}));
    }
    for (std::size_t b = 0; b < 2; ++b) expect_same_bits(world.save()[b], alone[b]->save());
}

// In slices all that moves evenly through a call is where it would be: the same steps, but for rounding.
TEST(World, GoesOnInSlices) {
    const Body body = pinned_box();
    Acting on = everything(body);
    on.colliders.clear();  // contacts make much of little
    on.motions.clear();
    World whole(on_cpu), sliced(on_cpu, nullptr, nullptr, 0.002);
    for (World* world : {&whole, &sliced}) world->add(body);
    const BodyPush drag{0, on.pushes[0]};
    const BodyMove move{0, on.moves[0]};
    const Acts acts{.presses = on.presses, .pushes = {&drag, 1}, .moves = {&move, 1}};
    const WorldStats one = whole.step(0.01, acts), five = sliced.step(0.01, acts);
    EXPECT_EQ(one.bodies[0].steps, 20);
    EXPECT_EQ(five.bodies[0].steps, 20);
    const State a = whole.save()[0], b = sliced.save()[0];
    EXPECT_LE(furthest_apart(a.positions, b.positions), 1e-7);
    EXPECT_LE(furthest_apart(a.velocities, b.velocities), 1e-4);
    for (std::size_t k = 0; k < on.moved.size(); ++k)
        EXPECT_LE(glm::distance(b.positions[std::size_t(on.moved[k])], dvec3(on.places[k])), 1e-8);
    EXPECT_LE(furthest_apart(one.reactions, five.reactions), 1e-6);
    EXPECT_LE(furthest_apart(one.pushes, five.pushes), 1e-6);
    EXPECT_GT(glm::length(one.pushes[0]), 1e-4);
}

// What presses slice by slice is asked anew before each, and told what the bodies did to it.
TEST(World, AsksWhatPressesBeforeEachSlice) {
    const Body body = pinned_box();
    const Press tip{.centre = vec3(0.025f, 0.045f, 0.015f), .velocity = vec3(0, -0.2f, 0), .stiffness = 50};
    World at_once(on_cpu, nullptr, nullptr, 0.002), asked(on_cpu, nullptr, nullptr, 0.002);
    for (World* world : {&at_once, &asked}) world->add(body);
    const WorldStats all = at_once.step(0.01, {.presses = {&tip, 1}});
    std::vector<double> times;
    dvec3 sum(0);
    const Acts acts{.press_in_slice = [&](double at, double seconds, std::span<const dvec3> reactions) {
        EXPECT_LE(std::abs(seconds - 0.002), 1e-12);
        EXPECT_EQ(reactions.size(), times.empty() ? 0u : 1u);
        for (dvec3 reaction : reactions) sum += reaction;
        times.push_back(at);
        Press now = tip;
        now.centre += float(at) * tip.velocity;
        return std::vector{now};
    }};
    EXPECT_TRUE(asked.step(0.01, acts).reactions.empty());
    ASSERT_EQ(times.size(), 5u);
    expect_same_bits(asked.save()[0], at_once.save()[0]);
    // The last slice is told to the next call.
    asked.step(0.002, {.press_in_slice = [&](double, double, std::span<const dvec3> reactions) {
                   sum += reactions[0];
                   return std::vector<Press>();
               }});
    EXPECT_GT(glm::length(sum), 1e-4);
    EXPECT_LE(glm::distance(sum, all.reactions[0]), 1e-12);
}

// After each slice it is told what pressed, and what each body did: together that of the call.
TEST(World, TellsWhatASliceDid) {
    World world(on_cpu, nullptr, nullptr, 0.002);
    for (int b = 0; b < 2; ++b) world.add(pinned_box());
    const Press tip{.centre = vec3(0.025f, 0.045f, 0.015f), .velocity = vec3(0, -0.2f, 0), .stiffness = 50};
    int slices = 0;
    dvec3 of_first(0), of_later(0);
    const Acts acts{
        .presses = {&tip, 1},
        .press_in_slice = [&](double, double, std::span<const dvec3>) { return std::vector{tip}; },
        .after_slice =
            [&](const WorldSlice& slice) {
                EXPECT_LE(std::abs(slice.at - 0.002 * slices++), 1e-12);
                ASSERT_EQ(slice.presses.size(), 2u);
                EXPECT_LE(glm::distance(slice.presses[0].centre, after(tip, float(slice.at)).centre), 1e-7f);
                EXPECT_EQ(slice.presses[1].centre, tip.centre);
                ASSERT_EQ(slice.bodies.size(), 2u);
                for (const Stats& body : slice.bodies) {
                    of_first += body.reactions[0];
                    of_later += body.reactions[1];
                }
            }};
    const WorldStats stats = world.step(0.01, acts);
    EXPECT_EQ(slices, 5);
    EXPECT_GT(glm::length(of_later), 1e-4);
    EXPECT_LE(glm::distance(of_first, stats.reactions[0]), 1e-12);
    // What it throws takes the whole call back.
    const std::vector<State> before = world.save();
    EXPECT_EQ(refusal([&] {
                  world.step(0.01, {.after_slice = [](const WorldSlice& slice) {
                                 if (slice.at > 0.003) throw Error("no", "a test", "do not");
                             }});
              }),
              "no in a test; do not");
    for (std::size_t b : {0u, 1u}) expect_same_bits(world.save()[b], before[b]);
}

// What a later slice is asked to do, and cannot be done, or fails when it is asked for: then nothing has
// moved.
TEST(World, GoesBackIfALaterSliceIsRefused) {
    Simulation fixed = on_cpu;
    fixed.force = false;
    World world(fixed, nullptr, nullptr, 0.002);
    world.add(pinned_box());
    world.add(pinned_box());
    world.step(0.01);
    const std::vector<State> before = world.save();
    auto fails_with = [&](const std::vector<Press>& presses) {
        return refusal([&] {
            world.step(0.01, {.press_in_slice = [&](double at, double, std::span<const dvec3>) {
                           if (at > 0.003 && presses.empty()) throw Error("no", "a test", "do not");
                           return at > 0.003 ? presses : std::vector<Press>();
                       }});
        });
    };
    const Press stiff{.centre = vec3(0.025f, 0.035f, 0.015f), .radius = 0.02f, .stiffness = 1e7f};
    EXPECT_NE(fails_with({stiff}), "");
    for (std::size_t b : {0u, 1u}) expect_same_bits(world.save()[b], before[b]);
    EXPECT_NE(fails_with({}), "");
    for (std::size_t b : {0u, 1u}) expect_same_bits(world.save()[b], before[b]);
}

// Whoever blows up, in whichever slice: then all are as they were, to the bit.
TEST(World, GoesOnWithAllOrNone) {
    for (const double slice : {0.01, 0.001})
        for (const std::size_t wild : {0u, 1u, 2u}) {
            World world({.step = 0.0001, .force = true}, nullptr, nullptr, slice);
            for (int b = 0; b < 3; ++b) world.add(pinned_box());
            ASSERT_FALSE(world.step(0.01).diverged);
            std::vector<State> states = world.save();
            states[wild].velocities[50] = {300, 0, 0};
            world.restore(states);
            const std::vector<State> before = world.save();
            const WorldStats stats = world.step(0.01);
            ASSERT_TRUE(stats.diverged);
            EXPECT_EQ(*stats.diverged, wild);
            for (std::size_t b = 0; b < 3; ++b) expect_same_bits(world.save()[b], before[b]);
        }
}

TEST(World, UndoesACallOfManySlices) {
    World world(on_cpu, nullptr, nullptr, 0.001);
    for (int b = 0; b < 2; ++b) world.add(pinned_box());
    world.step(0.01);
    const std::vector<State> before = world.save();
    world.step(0.01);
    world.undo();
    for (std::size_t b = 0; b < 2; ++b) expect_same_bits(world.save()[b], before[b]);
}

// The first part of a call may have come before anything that could be put back.
TEST(World, ASolverThatGoesOnRemembersWhereItBegan) {
    Solver solver(pinned_box(), {.step = 0.0001, .force = true}, 0, make_reference<float>);
    State wild = solver.save();
    wild.velocities[50] = {300, 0, 0};
    solver.restore(wild);
    EXPECT_TRUE(solver.go_on(0.01).diverged);
    expect_same_bits(solver.save(), wild);
}

// What one body refuses moves none.
TEST(World, RefusesBeforeAnythingMoves) {
    World world(on_cpu);
    world.add(pinned_box());
    world.add(lattice({2, 2, 2}, 0.01f, of_springs));
    const std::vector<State> before = world.save();
    const BodyPush no_body{2, {}}, no_node{1, {.node = 8}};
    EXPECT_NE(refusal([&] {
                  world.step(0.01, {.pushes = {&no_body, 1}});
              }).find("body 2 of 2"),
              std::string::npos);
    EXPECT_NE(refusal([&] { world.step(0.01, {.pushes = {&no_node, 1}}); }), "");
    EXPECT_NE(refusal([&] { world.step(0); }), "");
    EXPECT_NE(refusal([&] { World({}, nullptr, nullptr, 0); }), "");
    EXPECT_NE(refusal([&] { world.restore({before[0]}); }), "");
    for (std::size_t b = 0; b < 2; ++b) expect_same_bits(world.save()[b], before[b]);
}

}  // namespace
}  // namespace palpate
