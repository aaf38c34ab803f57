// Colliders, friction, wind, drags and prescribed motion, against closed form.
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/solver.h"
#include "tests/integrators.h"
#include "tests/shapes.h"
#include "tests/solver/every_backend.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <string>

namespace palpate {
namespace {

const vec3 far_away(0, 5, 0);

// One node without springs, of 0.1 kg.
Body particle(vec3 at) { return net(std::vector<vec3>{at}, std::vector<float>{0.1f}, {}); }

Mesh box_mesh(vec3 half) { return block(-half, half); }

mat3 turned(float degrees, vec3 axis) {
    return mat3(glm::rotate(mat4(1), glm::radians(degrees), glm::normalize(axis)));
}

class Contact : public ::testing::TestWithParam<Integrator> {};
INSTANTIATE_TEST_SUITE_P(Every, Contact, ::testing::ValuesIn(every_integrator()), test_name);

std::unique_ptr<Solver> solver_for(const Body& body, Integrator integrator, double step,
                                   std::vector<Collider> colliders, vec3 gravity = {0, -9.81f, 0}) {
    return make_exact_solver(
        body, {.integrator = integrator, .step = step, .gravity = gravity, .colliders = std::move(colliders)},
        0);
}

// Thrown sideways from a height, it lands after √(2h/g), v √(2h/g) further on, and slides on for ever ...
TEST_P(Contact, DropWithoutFriction) {
    const double height = 0.2, speed = 0.7, g = double(9.81f), step = 1e-4;
    auto solver = solver_for(particle({0, float(height), 0}), GetParam(), step, {Collider{Plane{}}});
    State start = solver->state();
    start.velocities[0] = {speed, 0, 0};
    solver->restore(start);
    const double fall = std::sqrt(2 * height / g);
    solver->step(fall - 2 * step);
    EXPECT_GT(solver->state().positions[0].y, 0);
    solver->step(4 * step);
    EXPECT_LE(std::abs(solver->state().positions[0].y), 2e-6);
    solver->step(1 - fall - 2 * step);
    const State end = solver->state();
    EXPECT_LE(std::abs(end.positions[0].x - speed), 1e-5);
    EXPECT_LE(std::abs(end.positions[0].y), 1e-6);
    EXPECT_LE(std::abs(end.velocities[0].x - speed), 1e-5);
}

// ... with friction μ it loses μ √(2gh) of its speed when it lands, and what is left within v'/(μg),
// v'²/(2μg) further on. There it stays.
TEST_P(Contact, DropWithFriction) {
    const double height = 0.05, speed = 0.9, mu = 0.3f, g = double(9.81f), step = 1e-4;
    auto solver =
        solver_for(particle({0, float(height), 0}), GetParam(), step, {Collider{Plane{}, float(mu)}});
    State start = solver->state();
    start.velocities[0] = {0, 0, speed};
    solver->restore(start);
    const double fall = std::sqrt(2 * height / g), left = speed - mu * g * fall;
    ASSERT_GT(left, 0.3);
    const double stop = speed * fall + left * left / (2 * mu * g);
    solver->step(fall + 0.5 * left / (mu * g));
    EXPECT_LE(std::abs(solver->state().velocities[0].z - left / 2), 4e-3);
    solver->step(1);
    const State end = solver->state();
    EXPECT_LE(std::abs(end.positions[0].z / stop - 1), 2e-3);
    EXPECT_LE(glm::length(end.velocities[0]), 2e-3);
    solver->step(1);
    EXPECT_LE(glm::distance(solver->state().positions[0], end.positions[0]), 1e-7);
}

// On a slope of angle a, friction above tan a holds, and below it the particle runs down with g (sin a - μ
// cos a).
TEST_P(Contact, OnASlopeFrictionHoldsOrNot) {
    const float angle = 0.4f;
    const vec3 normal(std::sin(angle), std::cos(angle), 0), down(std::cos(angle), -std::sin(angle), 0);
    for (float mu : {0.3f, 0.5f}) {  // tan 0.4 = 0.42
        auto solver = solver_for(particle(vec3(0)), GetParam(), 1e-4, {Collider{Plane{normal, 0}, mu}});
        solver->step(0.5);
        const double way = glm::dot(solver->state().positions[0], dvec3(down));
        const double rate = double(9.81f) * (std::sin(double(angle)) - double(mu) * std::cos(double(angle)));
        if (rate > 0)
            EXPECT_LE(std::abs(way / (rate * 0.125) - 1), 2e-3) << mu;
        else
            EXPECT_LE(std::abs(way), 1e-5) << mu;
    }
}

// ---- every shape ----

struct Shape {
    const char* name;
    Collider collider;
    std::function<double(dvec3)> distance;  // m, from its surface, negative inside
};

double to_segment(dvec3 p, dvec3 a, dvec3 b) {
    const double t = std::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::distance(p, a + t * (b - a));
}
double to_box(dvec3 p, dvec3 half) {
    const dvec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

std::vector<Shape> shapes() {
    const vec3 from(-0.05f, 0.01f, 0.02f), to(0.06f, -0.02f, 0.0f), half(0.05f, 0.03f, 0.04f);
    const mat3 axes = turned(30, {1, 2, 3});
    const DistanceField field = distance_field(box_mesh(half), 0.002f);
    std::vector<Shape> all;
    auto add = [&](const char* name, Collider collider, std::function<double(dvec3)> distance) {
        all.push_back({name, std::move(collider), std::move(distance)});
    };
    const dvec3 aside(vec3(0.01f, 0, 0)), slanted(glm::normalize(vec3(1, 2, -1)));
    add("plane", {Plane{vec3(slanted), 0.01f}},
        [=](dvec3 p) { return glm::dot(p, slanted) - double(0.01f); });
    add("sphere", {Sphere{vec3(aside), 0.06f}},
        [=](dvec3 p) { return glm::distance(p, aside) - double(0.06f); });
    add("capsule", {Capsule{from, to, 0.03f}},
        [=](dvec3 p) { return to_segment(p, dvec3(from), dvec3(to)) - double(0.03f); });
    add("box", {Box{vec3(0), half, {axes[0], axes[1], axes[2]}}},
        [=](dvec3 p) { return to_box(glm::transpose(dmat3(axes)) * p, dvec3(half)); });
    add("round box", {Box{.centre = vec3(aside), .half = half, .rounding = 0.02f}},
        [=](dvec3 p) { return to_box(p - aside, dvec3(half)) - double(0.02f); });
    add("field", {field}, [=](dvec3 p) { return to_box(p, dvec3(half)); });
    return all;
}

// A node that is found inside comes out at the nearest point of the surface, and its inward motion is gone.
TEST(Shapes, LeadOutByTheShortestWay) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-1, 1);
    for (const Shape& shape : shapes()) {
        const bool sampled = std::string(shape.name) == "field";
        int inside = 0;
        for (int round = 0; round < 300; ++round) {
            const vec3 at = 0.07f * vec3(any(random), any(random), any(random));
            const double before = shape.distance(dvec3(at));
            // A field is exact to about half its spacing, and knows no corners.
            if (sampled && before < -0.004) continue;
            const double near = sampled ? 0.0012 : 2e-6;
            auto solver = make_exact_solver(
                particle(at), {.step = 1e-6, .gravity = vec3(0), .colliders = {shape.collider}}, 0);
            State state = solver->state();
            state.velocities[0] = dvec3(any(random), any(random), any(random));
            const dvec3 velocity = state.velocities[0];
            solver->restore(state);
            solver->step(1e-6);
            state = solver->state();
            const double moved = glm::distance(state.positions[0], dvec3(at) + 1e-6 * velocity);
            if (before > near) {
                EXPECT_LE(moved, 1e-9) << shape.name;
                EXPECT_LE(glm::distance(state.velocities[0], velocity), 1e-9) << shape.name;
            } else if (before < -near) {
                ++inside;
                EXPECT_LE(std::abs(shape.distance(state.positions[0])), near) << shape.name << ' ' << before;
                EXPECT_LE(std::abs(moved + before), 2 * near) << shape.name;
                // What is left leads along the surface or out of it.
                const dvec3 out = (state.positions[0] - dvec3(at)) / moved;
                EXPECT_GE(glm::dot(state.velocities[0], out), -(sampled ? 0.3 : 2e-3)) << shape.name;
            }
        }
        EXPECT_GT(inside, sampled ? 5 : 20) << shape.name;
    }
}

// A margin holds nodes further off; the same shapes turned and shifted by a Motion hold them there.
TEST(Shapes, MoveAsTheyAreTold) {
    const Motion motion{{0.3f, -0.1f, 0.2f}, turned(70, {3, -1, 2})};
    std::mt19937 random(6);
    std::uniform_real_distribution<float> any(-1, 1);
    for (Shape shape : shapes()) {
        if (std::string(shape.name) == "field") continue;
        shape.collider.margin = 0.01f;
        for (int round = 0; round < 100; ++round) {
            const vec3 local = 0.07f * vec3(any(random), any(random), any(random));
            if (shape.distance(dvec3(local)) > 0.0099) continue;
            const vec3 at = motion.position + motion.rotation * local;
            auto solver = make_exact_solver(
                particle(at), {.step = 1e-6, .gravity = vec3(0), .colliders = {shape.collider}}, 0);
            solver->step(1e-6, {.colliders = {&motion, 1}});
            const dvec3 back = glm::transpose(dmat3(motion.rotation)) *
                               (solver->state().positions[0] - dvec3(motion.position));
            EXPECT_LE(std::abs(shape.distance(back) - 0.01), 3e-6) << shape.name;
        }
    }
}

// A plate that rises carries what lies on it along; one that slides takes it along by friction only, one that
// turns takes it round.
TEST(Shapes, CarryWhatLiesOnThem) {
    const Collider plate{Box{{0, -0.05f, 0}, {1, 0.05f, 1}}, 0.8f};
    auto run = [&](const Collider& collider, vec3 velocity, vec3 spin) {
        auto solver = solver_for(particle({0.1f, 0, 0}), Integrator::verlet, 1e-4, {collider});
        Motion motion{vec3(0), mat3(1), velocity, spin};
        for (int i = 0; i < 60; ++i) {
            solver->step(1.0 / 60, {.colliders = {&motion, 1}});
            motion = after(motion, 1.0f / 60);
        }
        return solver->state();
    };
    EXPECT_LE(std::abs(run(plate, {0, 0.2f, 0}, vec3(0)).positions[0].y - 0.2), 1e-4);
    EXPECT_LE(std::abs(run(plate, {0.1f, 0, 0}, vec3(0)).positions[0].x - 0.2), 2e-3);
    EXPECT_LE(std::abs(run({plate.shape, 0}, {0.1f, 0, 0}, vec3(0)).positions[0].x - 0.1), 1e-6);
    const dvec3 round = run(plate, vec3(0), {0, 1, 0}).positions[0];
    EXPECT_LE(glm::distance(round, 0.1 * dvec3(std::cos(1.0), 0, -std::sin(1.0))), 2e-3);
}

// ---- thin and fast ----

// Where a particle is after one step from `from` by `way`, beside a collider that moves.
dvec3 after_one_step(vec3 from, vec3 way, const Collider& collider, const Motion& motion = {}) {
    const double step = 1e-3;
    auto solver = solver_for(particle(from), Integrator::verlet, step, {collider}, vec3(0));
    State state = solver->state();
    state.velocities[0] = dvec3(way) / step;
    solver->restore(state);
    solver->step(step, {.colliders = {&motion, 1}});
    return solver->state().positions[0];
}

class Any {
 public:
    explicit Any(unsigned seed) : random_(seed) {}
    float of(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    vec3 vector(float most) { return {of(-most, most), of(-most, most), of(-most, most)}; }
    mat3 turn() { return turned(of(-180, 180), vector(1) + vec3(0, 0, 1.5f)); }

 private:
    std::mt19937 random_;
};

// What flies through a ball in one step is stopped by the plane that touches the ball where its line first
// meets it; what passes by flies on.
TEST(Fast, BallsStopWhatMeetsThem) {
    Any any(11);
    int met = 0, missed = 0;
    for (int round = 0; round < 1000; ++round) {
        const float radius = any.of(0.001f, 0.02f), aside = any.of(0, 3) * radius;
        const mat3 axes = any.turn();
        const vec3 centre = any.vector(0.1f), from = centre + axes * vec3(aside, -any.of(0.021f, 0.3f), 0),
                   way = axes * vec3(0, any.of(0.34f, 0.6f), 0);
        const dvec3 end = after_one_step(from, way, {Sphere{centre, radius}});
        if (aside < 0.95f * radius) {
            ++met;
            const dvec3 out = glm::normalize(
                dmat3(axes) * dvec3(aside, -std::sqrt(double(radius) * radius - double(aside) * aside), 0));
            const dvec3 free = dvec3(from) + dvec3(way);
            const dvec3 expected = free + out * (radius - glm::dot(free - dvec3(centre), out));
            ASSERT_LE(glm::distance(end, expected), 1e-4) << radius << ' ' << aside;
        } else if (aside > radius + 0.02f * glm::length(way)) {
            ++missed;
            ASSERT_LE(glm::distance(end, dvec3(from) + dvec3(way)), 1e-6) << radius << ' ' << aside;
        }
    }
    EXPECT_GT(met, 300);
    EXPECT_GT(missed, 30);
}

// A plate however thin, however it lies and comes, rounded or not, keeps what it meets on its side of it.
TEST(Fast, PlatesStopWhatMeetsThem) {
    Any any(12);
    for (int round = 0; round < 1000; ++round) {
        const float half = std::pow(10.0f, any.of(-5, -2.5f)), rounding = round % 2 * any.of(0, half),
                    margin = round % 3 / 2 * 0.002f, side = round % 5 < 2 ? -1 : 1;
        const mat3 axes = any.turn();
        const Collider plate{Box{any.vector(0.1f), {0.5f, half, 0.4f}, {axes[0], axes[1], axes[2]}, rounding},
                             0, margin};
        const Box& box = std::get<Box>(plate.shape);
        const Motion motion =
            round % 4 ? Motion{.velocity = any.vector(50), .spin = any.vector(5)} : Motion{};
        const Motion later = after(motion, 1e-3f);
        // On the plate, from where the node comes to where it would go, and the same in the world.
        const vec3 before(any.of(-0.2f, 0.2f), side * any.of(half + rounding + margin + 1e-4f, 0.05f),
                          any.of(-0.2f, 0.2f)),
            behind(any.of(-0.2f, 0.2f), -side * any.of(0, 0.3f), any.of(-0.2f, 0.2f));
        const vec3 from = motion.position + motion.rotation * (box.centre + axes * before),
                   to = later.position + later.rotation * (box.centre + axes * behind);
        const dvec3 end = after_one_step(from, to - from, plate, motion);
        const dvec3 local =
            glm::transpose(dmat3(axes)) *
            (glm::transpose(dmat3(later.rotation)) * (end - dvec3(later.position)) - dvec3(box.centre));
        ASSERT_LE(std::abs(local.y * side - (half + rounding + margin)), 2e-5) << round;
        ASSERT_LE(std::hypot(local.x - behind.x, local.z - behind.z), 2e-2) << round;
    }
}

// What passes a plate's rim flies on.
TEST(Fast, PlatesLetPassWhatMissesThem) {
    Any any(13);
    for (int round = 0; round < 300; ++round) {
        const mat3 axes = any.turn();
        const float aside = 0.1f + any.of(0.01f, 0.1f);
        const vec3 from = axes * vec3(aside, any.of(0.01f, 0.1f), any.of(-0.1f, 0.1f)),
                   way = axes * vec3(any.of(0, 0.1f), -0.3f, any.of(-0.1f, 0.1f));
        const dvec3 end =
            after_one_step(from, way, {Box{vec3(0), {0.1f, 1e-4f, 0.1f}, {axes[0], axes[1], axes[2]}}});
        ASSERT_LE(glm::distance(end, dvec3(from) + dvec3(way)), 1e-6) << round;
    }
}

// A field's walls of two spacings and more stop what goes through them in one step.
TEST(Fast, FieldsStopWhatMeetsThem) {
    Any any(14);
    for (int round = 0; round < 30; ++round) {
        const float half = any.of(0.002f, 0.01f), side = round % 2 ? -1 : 1;
        const Collider plate{distance_field(box_mesh({0.05f, half, 0.05f}), half / any.of(1, 2.5f))};
        for (int node = 0; node < 20; ++node) {
            const vec3 from(any.of(-0.02f, 0.02f), side * any.of(half + 1e-4f, 0.02f), any.of(-0.02f, 0.02f)),
                to(any.of(-0.02f, 0.02f), -side * any.of(0, 0.02f), any.of(-0.02f, 0.02f));
            const dvec3 end = after_one_step(from, to - from, plate);
            ASSERT_LE(std::abs(end.y * side - half), 0.05 * half) << half << ' ' << from.y << ' ' << to.y;
        }
    }
}

// A cube that comes at 20 m/s does not pass a plate of a tenth of a millimetre, on any machine.
class FastCube : public EveryBackend {};
INSTANTIATE_TEST_SUITE_P(Every, FastCube, every_backend(), backend_name);

TEST_P(FastCube, StaysOnItsSideOfASheetOfSteel) {
    const Material material{.youngs_modulus = 3e5f, .density = 1000, .damping = 1, .link_damping = 0.002f};
    const Body body = lattice({6, 6, 6}, 0.02f, material);
    for (bool plate_comes : {false, true}) {
        auto solver = make(body, {.colliders = {{Box{{0, -0.03f, 0}, {1, 0.00005f, 1}}, 0.3f}}});
        State state = solver->state();
        if (!plate_comes)
            for (dvec3& v : state.velocities) v = {1, -20, 0};
        solver->restore(state);
        Motion motion{.velocity = {0, plate_comes ? 20.0f : 0.0f, 0}};
        for (int frame = 0; frame < 4; ++frame) {
            ASSERT_FALSE(solver->step(1.0 / 60, {.colliders = {&motion, 1}}).diverged);
            motion = after(motion, 1 / 60.0f);
            for (dvec3 p : solver->state().positions)
                ASSERT_GE(p.y, double(motion.position.y) - 0.03 + 0.00004) << frame;
        }
    }
}

// ---- open polygons ----

Polygon wall() {  // a square of 0.2 m across x = 0
    const vec3 a(0, -0.1f, -0.1f), b(0, 0.1f, -0.1f), c(0, 0.1f, 0.1f), d(0, -0.1f, 0.1f);
    return {{{a, b, c}, {a, c, d}}, 0.001f};
}

// However fast a node comes and from whichever side, it stops short of the polygon; past its edge it flies
// on.
TEST(Polygons, StopWhatComesFromEitherSide) {
    for (double speed : {0.1, 3.0, 200.0})
        for (double side : {-1.0, 1.0})
            for (float aside : {0.0f, 0.07f, 0.13f}) {
                auto solver = solver_for(particle({float(-side) * 0.05f, aside, 0.02f}), Integrator::verlet,
                                         1e-3, {Collider{wall()}}, vec3(0));
                State state = solver->state();
                state.velocities[0] = {side * speed, 0, 0};
                solver->restore(state);
                solver->step(1);
                const double x = solver->state().positions[0].x * side;
                if (aside < 0.1f)
                    EXPECT_LE(std::abs(x + 0.001), 1e-6) << speed << ' ' << side;
                else
                    EXPECT_LE(std::abs(x - (speed - 0.05)), 1e-5 * speed + 1e-6);
            }
}

// In single precision, turned any way, a node that meets the edge where two triangles join does not slip
// through.
TEST(Polygons, HaveNoSeam) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int round = 0; round < 500; ++round) {
        const mat3 turn = turned(180 * any(random), {any(random), any(random), 1});
        Polygon polygon = wall();
        for (auto& triangle : polygon.triangles)
            for (vec3& p : triangle) p = turn * p;
        const float along = 0.09f * any(random);
        auto solver =
            make_solver(particle(turn * vec3(0.02f, along, along)),  // before the diagonal of the square
                        {.backend = Backend::reference,
                         .step = 2e-3,
                         .force = true,
                         .gravity = vec3(0),
                         .colliders = {Collider{polygon}}});
        State state = solver->state();
        state.velocities[0] = dvec3(turn * vec3(-2, 0, 0));
        solver->restore(state);
        solver->step(0.1);
        const vec3 end = glm::transpose(turn) * vec3(solver->state().positions[0]);
        ASSERT_GE(end.x, 0.0009f) << round;
    }
}

// A wall that moves faster than the node still takes it along.
TEST(Polygons, SweepWhatTheyMeet) {
    auto solver = solver_for(particle({0.03f, 0, 0.01f}), Integrator::rk4, 1e-3, {Collider{wall()}}, vec3(0));
    Motion motion{.velocity = {20, 0, 0}};
    solver->step(0.1, {.colliders = {&motion, 1}});
    EXPECT_LE(std::abs(solver->state().positions[0].x - 2.001), 1e-5);
}

// ---- wind ----

// A plate of cloth without weight: the air drives it until it moves with the wind; its speed has a closed
// form.
TEST(Wind, DrivesAPlateAsItsLawSays) {
    const float density = 0.3f, air = 1.2f, wind = 6;
    const Body body = cloth({5, 4}, 0.05f, {.density = density});
    auto solver = make_exact_solver(body, {.step = 1e-4, .gravity = vec3(0), .air = air}, 0);
    solver->step(0.5, {.wind = {3, 0, wind}});  // what blows along the cloth does nothing
    // σ v' = ρ/2 (w - v)²  →  w - v = w / (1 + w ρ t / 2σ)
    const double left = wind / (1 + wind * double(air) * 0.5 / (2 * double(density)));
    for (dvec3 v : solver->state().velocities) {
        EXPECT_LE(std::abs(v.z - (wind - left)), 2e-3);
        EXPECT_LE(std::abs(v.x), 1e-5);
    }
}

// A solid feels it on the side it comes from only: half its density × speed² × the area that it sees.
TEST(Wind, PressesOnTheWindwardSideOfASolid) {
    const Body body = lattice({6, 6, 6}, 0.01f, {.youngs_modulus = 1e5f, .density = 1000});
    auto solver = make_exact_solver(body, {.step = 1e-5, .gravity = vec3(0), .air = 1.2f}, 0);
    solver->step(2e-5, {.wind = {10, 0, 0}});
    dvec3 momentum(0);
    const State state = solver->state();
    for (std::size_t i = 0; i < body.count(); ++i)
        momentum += state.velocities[i] / double(body.inverse_mass[i]);
    const double expected = 0.5 * 1.2 * 100 * 0.05 * 0.05 * 2e-5;
    // The normals at its edges and corners are slanted, so it feels a little less than a plate.
    EXPECT_LE(momentum.x / expected, 1.0);
    EXPECT_GE(momentum.x / expected, 0.6);
    EXPECT_LE(std::hypot(momentum.y, momentum.z), 1e-2 * momentum.x);
}

// ---- drag and prescribed motion ----

TEST(Drag, HoldsANodeWithItsSpring) {
    Body body = particle(vec3(0));
    body.damping = 20;
    const NodePush drag{0, {0.1f, 0, 0}, vec3(0), 50};
    auto solver = make_solver(body, {});
    Stats stats;
    for (int i = 0; i < 120; ++i) stats = solver->step(1.0 / 60, {.pushes = {&drag, 1}});
    const double sag = 0.1 * double(9.81f) / 50;
    EXPECT_LE(glm::distance(solver->state().positions[0], dvec3(0.1, -sag, 0)), 1e-4);
    EXPECT_LE(std::abs(stats.pushes[0].y * 60 + 0.1 * double(9.81f)), 1e-3);  // the hand carries its weight
}

TEST_P(Contact, PrescribedNodesArriveWhereTheyShall) {
    Body body = lattice({4, 3, 3}, 0.01f, {.youngs_modulus = 5000, .density = 1000, .damping = 60});
    std::vector<int> held = nodes_in(body, {vec3(-1), vec3(0.0001f, 1, 1)});
    pin(body, held);
    auto solver = make_solver(body, {.integrator = GetParam(), .shortest_step = 1e-6});
    std::vector<vec3> to;
    for (int frame = 1; frame <= 12; ++frame) {
        const mat3 turn = turned(3.0f * float(frame), {1, 0, 0});
        to.clear();
        for (int node : held)
            to.push_back(turn * body.positions[std::size_t(node)] + vec3(0, 0.001f * float(frame), 0));
        const Move move{held, to};
        ASSERT_FALSE(solver->step(1.0 / 60, {.moves = {&move, 1}}).diverged);
        for (std::size_t i = 0; i < held.size(); ++i)
            ASSERT_EQ(solver->nodes().positions[std::size_t(held[i])], to[i]);
    }
    // The free end has been turned along.
    const State before = solver->state();
    EXPECT_GT(glm::length(before.velocities.back()), 0.01);
    // Without a Move they stay.
    solver->step(1.0 / 60);
    for (std::size_t i = 0; i < held.size(); ++i)
        EXPECT_EQ(solver->nodes().positions[std::size_t(held[i])], to[i]);
}

// What blows up near a field does so in good order.
TEST(Field, SurvivesWhatIsNoNumber) {
    const Body body = lattice({6, 6, 6}, 0.01f, {.youngs_modulus = 5e6f, .density = 1000});
    Simulation simulation{.step = 1.5e-4, .force = true};
    simulation.colliders.push_back({distance_field(box_mesh(vec3(0.02f)), 0.004f)});
    auto solver = make_solver(body, simulation);
    bool diverged = false;
    for (int i = 0; i < 60 && !diverged; ++i) diverged = solver->step(0.1).diverged;
    EXPECT_TRUE(diverged);
    EXPECT_LE(glm::length(solver->nodes().positions[0]), 10);
}

TEST(Field, IsTheDistanceOfItsMesh) {
    const DistanceField field = distance_field(box_mesh({0.05f, 0.03f, 0.04f}), 0.004f);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-1, 1);
    for (int i = 0; i < 500; ++i) {
        const vec3 p = vec3(0.055f, 0.035f, 0.045f) * vec3(any(random), any(random), any(random));
        const double exact = to_box(dvec3(p), dvec3(vec3(0.05f, 0.03f, 0.04f)));
        if (std::abs(exact) < 0.008)
            EXPECT_LE(std::abs(field.at(p) - exact), 0.002);  // half a spacing, at its corners
    }
}

}  // namespace
}  // namespace palpate
