// A body that lies far out, falls or flies moves as one at rest near the world's origin does.
#include "palpate/solver/forces.h"
#include "palpate/solver/stability.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"
#include "tests/solver/every_backend.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

class Far : public EveryBackend {};
INSTANTIATE_TEST_SUITE_P(On, Far, every_backend(), backend_name);

Body moved(Body body, dvec3 by) {
    for (vec3& p : body.positions) p = vec3(by + dvec3(p));
    return body;
}

// Nothing damps them: what rounding does to them stays.
std::vector<NamedBody> undamped_bodies() {
    const Body cube = lattice(
        {8, 6, 7}, 0.01f, Material{.youngs_modulus = 1e6, .density = 1000, .model = MaterialModel::springs});
    Body turned = cube;
    const mat3 turn = mat3(glm::rotate(mat4(1), 0.7f, glm::normalize(vec3(1, 2, 3))));
    for (vec3& p : turned.positions) p = turn * p;
    return {{"cube", cube},
            {"turned cube", turned},
            {"sheet", cloth({9, 7}, 0.01f, {.density = 0.15f})},
            {"triangles", cloth(ellipsoid({0.04f, 0.04f, 0.02f}, 7), {.density = 0.15f})}};
}

// m/s, of any node against the mean of all.
double shaking(const State& state) {
    dvec3 mean(0);
    for (dvec3 v : state.velocities) mean += v / double(state.velocities.size());
    double most = 0;
    for (dvec3 v : state.velocities)
        if (const double speed = glm::distance(v, mean); !(speed <= most)) most = speed;
    return most;
}

State after_frames(Solver& solver, int frames) {
    for (int f = 0; f < frames; ++f) EXPECT_FALSE(solver.step(frame_seconds).diverged);
    return solver.state();
}

// Falling for half a second, to 4.9 m/s, or lying a kilometre and 100 km out, shakes a body no more than
// rounding does that lies near in weightlessness. At 8 mm for a float's last digit, a hundredth of a metre
// can hardly be told.
TEST_P(Far, ShakesNoBodyMoreThanNear) {
    for (const auto& [name, body] : undamped_bodies()) {
        SCOPED_TRACE(name);
        const Simulation weightless{.gravity = vec3(0)};
        const double near = shaking(after_frames(*make(body, weightless), 30));
        EXPECT_LE(near, 0.005);
        const State fallen = after_frames(*make(body, {}), 30);
        EXPECT_LE(shaking(fallen), 10 * near);  // until its origin goes along
        EXPECT_NEAR(fallen.velocities[3].y, -9.81 * 0.5, 10 * near);
        for (const double far : {1e3, 1e5}) {
            const Body there = moved(body, dvec3(far, -far / 3, far / 7));
            EXPECT_LE(shaking(after_frames(*make(there, weightless), 30)), 4 * near) << far;
        }
    }
}

// All that can act, as seen from somebody who moves on at a speed, m/s, from a place, m.
struct Onlooker {
    dvec3 place, velocity;

    Acting see(Acting on, double seconds) const {
        for (Press& press : on.presses) press.centre = see(press.centre), press.velocity += vec3(velocity);
        for (NodePush& push : on.pushes) push.to = see(push.to), push.velocity += vec3(velocity);
        for (Motion& motion : on.motions)
            motion.position = see(motion.position), motion.velocity += vec3(velocity);
        for (vec3& to : on.places) to = vec3(place + seconds * velocity + dvec3(to));
        on.moves = {{on.moved, on.places}};
        on.wind += vec3(velocity);
        return on;
    }
    State see(State state) const {
        for (dvec3& p : state.positions) p += place;
        for (dvec3& v : state.velocities) v += velocity;
        return state;
    }

 private:
    vec3 see(vec3 p) const { return vec3(place + dvec3(p)); }
};

// Tips, pushes, moves, wind and obstacles at once: the same motion, if all of it moves on evenly.
TEST_P(Far, NothingTellsThatAllMovesOnEvenly) {
    for (auto [name, body] : odd_bodies()) {
        SCOPED_TRACE(name);
        body.damping = 0;  // against the world
        body.link_damping = 1e-4f;
        Acting on = everything(body);
        on.moved.clear(), on.places.clear();  // who stands still would tell
        for (std::size_t i = 0; i < body.count(); ++i)
            if (body.inverse_mass[i] == 0) {
                on.moved.push_back(int(i));
                on.places.push_back(body.positions[i] + vec3(0, 0.001f, 0.002f));
            }
        on.moves = {{on.moved, on.places}};
        const Simulation how = simulation(body, on, Integrator::verlet, GetParam());
        const double seconds = 60 * how.step;
        const Onlooker passing{{0.5, -0.25, 0.75}, {2, -1, 1.5}};
        const Acting seen = passing.see(on, seconds);

        const auto still = make(body, how), flying = make(body, how), exact = make_exact_solver(body, how, 1);
        State begin = still->save();
        flying->restore(passing.see(begin));
        const Stats a = still->step(seconds, on.influences()), b = flying->step(seconds, seen.influences()),
                    c = exact->step(seconds, on.influences());
        ASSERT_FALSE(a.diverged || b.diverged || c.diverged);
        const Onlooker at_the_end{passing.place + seconds * passing.velocity, passing.velocity};
        const State expected = at_the_end.see(still->state()), ends = flying->state(),
                    truth = at_the_end.see(exact->state());
        const double place = 1e-6 + 10 * furthest_apart(expected.positions, truth.positions),
                     speed = 1e-6 / how.step + 10 * furthest_apart(expected.velocities, truth.velocities);
        EXPECT_LE(furthest_apart(ends.positions, expected.positions), place);
        EXPECT_LE(furthest_apart(ends.velocities, expected.velocities), speed);
        EXPECT_LE(furthest_apart(b.reactions, a.reactions),
                  1e-5 + 10 * furthest_apart(a.reactions, c.reactions));
        EXPECT_LE(furthest_apart(b.pushes, a.pushes), 1e-5 + 10 * furthest_apart(a.pushes, c.pushes));
        double fastest = 0;
        for (dvec3 v : ends.velocities) fastest = std::max(fastest, glm::length(v));
        EXPECT_NEAR(b.largest_speed, fastest, 0.3 * glm::length(passing.velocity));  // by half a kick
        const Nodes shown = flying->nodes();
        for (std::size_t i = 0; i < body.count(); ++i)
            ASSERT_LE(glm::distance(dvec3(shown.positions[i]), ends.positions[i]), 1e-6);
    }
}

// Grids of which some axes are not there, and lie turned.
TEST_P(Far, AChainAndASheetLieFarOut) {
    const mat3 turn = mat3(glm::rotate(mat4(1), 0.4f, glm::normalize(vec3(2, 1, -1))));
    for (const ivec3 dims : {ivec3(1, 1, 7), ivec3(1, 6, 1), ivec3(5, 1, 4)})
        for (const bool turned : {false, true}) {
            Body body =
                lattice(dims, 0.01f,
                        Material{.youngs_modulus = 1e5, .density = 1000, .model = MaterialModel::springs});
            if (turned)
                for (vec3& p : body.positions) p = turn * p;
            const Body there = moved(body, {1000, 20, -300});
            const State state = after_frames(*make(there, {.gravity = vec3(0)}), 10);
            EXPECT_LE(shaking(state), 0.01);
            for (std::size_t i = 0; i < body.count(); ++i)
                ASSERT_LE(glm::distance(state.positions[i], dvec3(there.positions[i])), 1e-3);
        }
}

// Damping brakes a body that falls, whatever its speed is counted from: v = g/c (1 - e^(-c t)).
TEST_P(Far, AirBrakesAFall) {
    Body body = lattice({4, 3, 5}, 0.01f, of_springs);
    body.damping = 3;
    const auto falling = make(body, {.gravity = vec3(0, -10, 0)});
    const double speed = 10.0 / 3 * (1 - std::exp(-3.0)), way = 10.0 / 3 * (1 - (1 - std::exp(-3.0)) / 3);
    const State state = after_frames(*falling, 60);
    for (std::size_t i = 0; i < body.count(); ++i) {
        EXPECT_NEAR(state.velocities[i].y, -speed, 1e-4 * speed);
        EXPECT_NEAR(state.positions[i].y - double(body.positions[i].y), -way, 1e-4 * way);
    }
}

// Nodes that are held stand where they stood while the rest of the body flies off.
TEST_P(Far, WhatIsHeldStays) {
    Body body = cloth({6, 5}, 0.01f, linen);
    const std::size_t held = body.count() - 1;
    body.inverse_mass[held] = 0;
    body.damping = 0;
    GridSprings& springs = *body.grid();
    std::fill(springs.shares.begin(), springs.shares.end(), 0);  // nothing holds together
    const auto falling = make(body, {});
    const State state = after_frames(*falling, 40);
    EXPECT_LT(state.positions[0].y, -1);
    EXPECT_EQ(state.positions[held], dvec3(body.positions[held]));
    EXPECT_LE(glm::distance(falling->nodes().positions[held], body.positions[held]), 1e-6f);
}

// In flight what was saved is put back as exactly as float takes it from another origin.
TEST_P(Far, StatesAreSavedAndPutBackInFlight) {
    const Body body = lattice({5, 4, 6}, 0.01f, of_springs);
    const auto falling = make(body, {}), other = make(body, {});
    after_frames(*falling, 30);
    const State saved = falling->save();
    other->restore(saved);
    const State restored = other->save();
    EXPECT_LE(furthest_apart(restored.positions, saved.positions), 1e-8);
    EXPECT_LE(furthest_apart(restored.velocities, saved.velocities), 1e-6);
    falling->step(frame_seconds);
    falling->undo();
    expect_same_bits(falling->save(), saved);
    falling->step(frame_seconds);
    other->step(frame_seconds);
    EXPECT_LE(furthest_apart(falling->save().positions, other->save().positions), 2e-8);
}

}  // namespace
}  // namespace palpate
