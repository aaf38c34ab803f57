// What a caller can get wrong is an Error that says so, before anything moves.
#include "tests/refusal.h"

#include "palpate/base/error.h"
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/solver/solver.h"
#include "tests/solver/every_backend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace palpate {
namespace {

const Material of_springs{
    .youngs_modulus = 2000, .density = 1000, .damping = 40, .model = MaterialModel::springs};
constexpr float none = std::numeric_limits<float>::quiet_NaN(),
                endless = std::numeric_limits<float>::infinity();

class Refuses : public EveryBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, Refuses, every_backend(), backend_name);

TEST_P(Refuses, WhatCannotActOnABodyOrBePutBack) {
    Body body = lattice({4, 3, 5}, 0.01f, of_springs);
    body.inverse_mass[0] = 0;
    const int last = int(body.count()) - 1;
    auto solver = make(body, {.colliders = {{Sphere{vec3(5)}}}});
    expect_refused("no step", [&] { solver->undo(); });
    State state = solver->save();
    solver->step(0.001);
    solver->undo();
    expect_refused("no step", [&] { solver->undo(); });
    solver->step(0.001);
    solver->restore(state);
    expect_refused("no step", [&] { solver->undo(); });
    state.velocities.pop_back();
    expect_refused("another number of nodes", [&] { solver->restore(state); });
    solver->step(0.001);
    const State before = solver->save();
    const auto refused = [&](const std::string& word, const Influences& influences, double seconds = 0.001) {
        expect_refused(word, [&] { solver->step(seconds, influences); });
    };
    for (double seconds : {0.0, -1.0, double(none), double(endless)}) refused("above 0 s", {}, seconds);
    refused("step by less", {}, 1e9);

    for (const Press& press :
         {Press{.centre = vec3(0, none, 0)}, Press{.velocity = vec3(endless)}, Press{.radius = 0},
          Press{.radius = -1}, Press{.radius = none}, Press{.stiffness = -1}, Press{.stiffness = none},
          Press{.friction = {-1, -1}}, Press{.friction = {none, 0}}, Press{.friction = {0.2, 0.3}},
          Press{.friction = {endless, 0}}, Press{.damping = -1}, Press{.damping = none}})
        refused("a press", {.presses = {&press, 1}});

    for (const NodePush& drag : {NodePush{.node = -1}, NodePush{.node = last + 1}, NodePush{.node = 1 << 30}})
        refused("does not have", {.pushes = {&drag, 1}});
    for (const NodePush& drag : {NodePush{.to = vec3(none)}, NodePush{.velocity = vec3(none)},
                                 NodePush{.stiffness = -2}, NodePush{.force = vec3(none)}})
        refused("a push", {.pushes = {&drag, 1}});

    const std::vector<int> nodes = {0, last}, wrong = {0, last + 1};
    const std::vector<vec3> places(2, vec3(0)), odd = {vec3(0), vec3(none)};
    for (const auto& [word, move] :
         {std::pair<std::string, Move>{"for each", {nodes, std::span(places).first(1)}},
          {"does not have", {wrong, places}},
          {"not finite", {nodes, odd}}})
        refused(word, {.moves = {&move, 1}});

    const std::vector<Motion> two(2), turned = {Motion{.rotation = mat3(none)}};
    refused("another number of colliders", {.colliders = two});
    refused("a collider's motion", {.colliders = turned});
    refused("a wind", {.wind = vec3(0, 0, endless)});

    EXPECT_TRUE(solver->save().positions == before.positions);
    EXPECT_TRUE(solver->save().velocities == before.velocities);
    if (on_gpu(GetParam())) return;  // its programs for tools take a second to compile
    const std::vector<Press> many(30);
    const std::vector<NodePush> all(100, NodePush{.node = last, .stiffness = 0.1f});
    EXPECT_FALSE(solver->step(0.001, {.presses = many, .pushes = all}).diverged);
}

TEST(Refusal, OfBodiesThatDoNotHold) {
    const Body sound = lattice({4, 3, 5}, 0.01f, of_springs), sheet = cloth({5, 4}, 0.01f, {.density = 1});
    const Body written = without_grid(sound);
    auto listed = [](Body& b) -> std::vector<Spring>& { return std::get<ListedSprings>(b.terms[0]).springs; };
    const auto refused = [&](const std::string& word, Body body, auto spoil) {
        spoil(body);
        for (Backend backend : {Backend::reference, Backend::cpu, Backend::compute})
            expect_refused(word, [&] { make_solver(body, {.backend = backend}); });
    };
    refused("another length", sound, [](Body& b) { b.inverse_mass.pop_back(); });
    refused("another length", sound, [](Body& b) { b.area.clear(); });
    refused("another length", sound, [](Body& b) { b.cover.push_back(0); });
    refused("not finite", sound, [](Body& b) { b.positions[3].y = none; });
    refused("negative", sound, [](Body& b) { b.inverse_mass[3] = -1; });
    refused("not finite", sound, [](Body& b) { b.inverse_mass[3] = endless; });
    refused("spacing", sound, [](Body& b) { b.spacing = 0; });
    refused("damping", sound, [](Body& b) { b.damping = -1; });
    refused("damping", sound, [](Body& b) { b.link_damping = none; });
    refused("places in the grid", sound, [](Body& b) { b.at.pop_back(); });
    refused("without one", sound, [](Body& b) { b.at.clear(); });
    refused("shares", sound, [](Body& b) { b.grid()->shares.clear(); });
    refused("strengths", sound, [](Body& b) { b.grid()->strength = {1, 2}; });
    refused("not its first term", sound, [](Body& b) { b.terms.push_back(b.terms[0]); });
    refused("two nodes at one place", sound, [](Body& b) { b.at[1] = ivec3(0); });
    refused("too large a box", sound, [](Body& b) { b.at[1] = ivec3(1 << 30); });
    refused("a link", sound, [](Body& b) { b.grid()->links[2].stiffness = none; });
    refused("32 links", sound, [](Body& b) { b.grid()->links.resize(33, {ivec3(1), 1, 1}); });
    refused("a spring to a node", written, [&](Body& b) { listed(b)[0].a = 60; });
    refused("a spring to a node", written, [&](Body& b) { listed(b)[0].b = -1; });
    refused("a spring to a node", written, [&](Body& b) { listed(b)[0].rest = none; });
    Body bending_sheet = sheet;
    bending_sheet.terms.push_back(bending(sheet, 1));
    auto hinges = [](Body& b) -> std::vector<Hinge>& { return std::get<Bending>(b.terms[1]).hinges; };
    auto cells = [](Body& b) -> TissueCells& { return std::get<TissueCells>(b.terms[1]); };
    const Body organ = lattice({3, 4, 3}, 0.01f, {.youngs_modulus = 2000, .poisson = 0.45f, .density = 1000});
    refused("without a Young's modulus", organ, [&](Body& b) { cells(b).youngs_modulus = 0; });
    refused("a Poisson's ratio", organ, [&](Body& b) { cells(b).poisson = 0.5f; });
    refused("a Poisson's ratio", organ, [&](Body& b) { cells(b).poisson = none; });
    refused("a weight above zero for each cell", organ, [&](Body& b) { cells(b).weights.pop_back(); });
    refused("a weight above zero for each cell", organ, [&](Body& b) { cells(b).weights[2] = 0; });
    refused("a weight above zero for each cell", organ, [&](Body& b) { cells(b).filled.pop_back(); });
    refused("two cells in one place", organ, [&](Body& b) { b.cells[1] = b.cells[0]; });
    refused("tissue twice", organ, [&](Body& b) { b.terms.push_back(b.terms[1]); });
    refused("not cubes at rest", organ, [&](Body& b) { std::swap(b.at[0], b.at[1]); });
    refused("not cubes at rest", organ, [&](Body& b) { b.positions[7].x += 0.004f; });
    refused("not cubes at rest", organ, [&](Body& b) {
        for (vec3& p : b.positions) p.z = -p.z;
    });
    refused("a hinge whose", bending_sheet, [&](Body& b) { hinges(b)[0].from = 20; });
    refused("a hinge whose", bending_sheet, [&](Body& b) { hinges(b)[0].right = -1; });
    refused("a hinge whose", bending_sheet, [&](Body& b) { hinges(b)[0].left = hinges(b)[0].to; });
    refused("a hinge whose", bending_sheet, [&](Body& b) { hinges(b)[0].stiffness = none; });
    refused("half a turn", bending_sheet, [&](Body& b) { hinges(b)[0].rest = none; });
    refused("half a turn", bending_sheet, [&](Body& b) { hinges(b)[0].rest = -2.1f; });
    refused("rings", without_grid(sheet), [](Body& b) { b.rings.pop_back(); });
    refused("a ring", without_grid(sheet), [](Body& b) { b.rings[3] = 20; });
    refused("cells without a grid", written, [&](Body& b) { b.cells = sound.cells; });
    refused("a fan", sheet, [](Body& b) { b.fan = 13; });
    refused("a fan", sheet, [](Body& b) { b.fan = -1; });
    refused("a cell", sound, [](Body& b) { b.cells[0][7] = 60; });
    refused("a face", sheet, [](Body& b) { b.faces[0][0] = -1; });
}

TEST(Refusal, OfSimulationsThatCannotBe) {
    const Body body = lattice({4, 3, 5}, 0.01f, of_springs);
    const auto refused = [&](const std::string& word, const Simulation& simulation) {
        expect_refused(word, [&] { make_solver(body, simulation); });
    };
    for (int threads : {0, -1, 257}) refused("threads", {.threads = threads});
    for (double step : {-1.0, double(none), double(endless)}) refused("step", {.step = step});
    refused("integrator", {.integrator = Integrator(77), .step = 1e-4});
    refused("gravity", {.gravity = vec3(none)});
    refused("air", {.air = -1});
    for (double shortest : {-1.0, double(none)}) refused("shortest step", {.shortest_step = shortest});
    const auto collider = [&](const std::string& word, const Collider& one) {
        refused(word, {.colliders = {one}});
    };
    collider("a plane", {Plane{vec3(0)}});
    collider("a sphere", {Sphere{vec3(0), -1}});
    collider("a capsule", {Capsule{vec3(none)}});
    collider("a box", {Box{.half = vec3(-1)}});
    collider("a polygon", {Polygon{{{vec3(0), vec3(1), vec3(none)}}}});
    collider("a distance field", {DistanceField{}});
    collider("a distance field", {DistanceField{vec3(0), 0.1f, ivec3(2), std::vector<float>(7, 0.0f)}});
    collider("a friction", {Sphere{}, -0.5f});
    refused("colliders", {.colliders = std::vector<Collider>(17)});
    Simulation unknown;
    unknown.backend = Backend(9);
    expect_refused("backend", [&] { make_solver(body, unknown); });
}

}  // namespace
}  // namespace palpate
