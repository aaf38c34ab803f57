// The proxy against closed form: where it is stopped, what pushes back, when it slips; and that it never
// passes.
#include "palpate/touch/proxy.h"

#include "palpate/mesh/tree.h"
#include "palpate/touch/force.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate {
namespace {

constexpr double tick = 0.001;  // s

Touchable touchable(const Mesh& mesh) { return {mesh.positions, mesh.triangles}; }

Patch all_of(const Mesh& mesh) {
    const Touchable one[] = {touchable(mesh)};
    return Patch(one);
}

// A square in the plane y = 0, seen from above, in so many parts.
Mesh floor_mesh(int parts, float half = 0.1f) {
    Mesh mesh;
    auto at = [&](int i, int j) { return unsigned(j * (parts + 1) + i); };
    for (int j = 0; j <= parts; ++j)
        for (int i = 0; i <= parts; ++i)
            mesh.positions.emplace_back(half * (2.0f * float(i) / float(parts) - 1), 0,
                                        half * (2.0f * float(j) / float(parts) - 1));
    for (int j = 0; j < parts; ++j)
        for (int i = 0; i < parts; ++i) {
            mesh.triangles.emplace_back(at(i, j), at(i, j + 1), at(i + 1, j + 1));
            mesh.triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i + 1, j));
        }
    return mesh;
}

struct Hand1 {
    Proxy proxy;
    Friction friction = {0, 0};
    double time = 0;
    Hand1(double radius, dvec3 place) : proxy(radius) { proxy.put(place); }

    void to(const Patch& patch, dvec3 place) {
        time += tick;
        proxy.follow(patch, time, place, {&friction, 1});
    }
    // Along a line at a speed, in so many ticks as that takes.
    void along(const Patch& patch, dvec3 from, dvec3 to_place, double speed) {
        const int ticks = std::max(1, int(std::ceil(glm::distance(from, to_place) / (speed * tick))));
        for (int i = 1; i <= ticks; ++i) to(patch, glm::mix(from, to_place, double(i) / ticks));
    }
    dvec3 force(dvec3 hand, Feel feel) {
        feel.friction = friction;
        return palpate::force(proxy, hand, dvec3(0), {&feel, 1});
    }
};

TEST(Proxy, IsTheHandWhereNothingIs) {
    const Mesh mesh = floor_mesh(3);
    const Patch patch = all_of(mesh), nothing;
    for (const Patch* each : {&patch, &nothing}) {
        Hand1 hand(0.005, dvec3(0, 0.1, 0));
        hand.to(*each, dvec3(0.02, 0.05, -0.01));
        EXPECT_LE(glm::distance(hand.proxy.position(), dvec3(0.02, 0.05, -0.01)), 1e-12);
        EXPECT_TRUE(hand.proxy.contacts().empty());
    }
}

TEST(Force, OnAPlaneIsThatOfTheSpring) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(-0.05, 0.05);
    for (int parts : {1, 7, 40}) {
        const Mesh mesh = floor_mesh(parts);
        const Patch patch = all_of(mesh);
        for (double radius : {0.0005, 0.003, 0.012})
            for (double depth : {1e-4, 2e-3, 0.02}) {
                const dvec3 over(any(random), radius + 0.01, any(random));
                const dvec3 sunk(over.x, radius - depth, over.z);
                Hand1 hand(radius, over);
                hand.along(patch, over, sunk, 0.5);
                const Feel feel{.stiffness = 700};
                const dvec3 f = hand.force(sunk, feel), right(0, 700 * depth, 0);
                EXPECT_LE(glm::distance(f, right), std::max(1e-3 * 700 * depth, 1e-3));
                EXPECT_LE(glm::distance(hand.proxy.position(), dvec3(over.x, radius, over.z)), 1e-6);
            }
    }
}

// The top of a sphere around the origin, so fine that its facets lean from it by no more than a
// two-thousandth.
Mesh cap(double R, int parts) {
    Mesh mesh = floor_mesh(parts, float(R * 0.0005 * parts));
    for (vec3& p : mesh.positions) p.y = float(std::sqrt(R * R - double(p.x) * p.x - double(p.z) * p.z));
    return mesh;
}

TEST(Force, OnASpherePointsAwayFromItsMiddle) {
    const double R = 0.04, radius = 0.004, depth = 0.003;
    const Mesh ball = cap(R, 240);
    const Patch patch = all_of(ball);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> any(-0.05, 0.05);
    for (int i = 0; i < 20; ++i) {
        const dvec3 way = glm::normalize(dvec3(any(random), 1, any(random)));
        Hand1 hand(radius, 0.06 * way);
        const dvec3 sunk = (R + radius - depth) * way;
        hand.along(patch, 0.06 * way, sunk, 0.3);
        for (int k = 0; k < 200; ++k) hand.to(patch, sunk);
        const dvec3 f = hand.force(sunk, {.stiffness = 500});
        EXPECT_LE(glm::distance(f, 500 * depth * way), std::max(1e-3 * 500 * depth, 1e-3));
    }
}

// Two walls that meet at an angle, hollow upwards.
Mesh valley(double half_angle) {
    Mesh mesh;
    const float s = float(std::sin(half_angle)), c = float(std::cos(half_angle)), l = 0.1f;
    mesh.positions = {{0, 0, -l},        {0, 0, l},           {l * s, l * c, -l},
                      {l * s, l * c, l}, {-l * s, l * c, -l}, {-l * s, l * c, l}};
    mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 4, 5}, {0, 5, 1}};
    return mesh;
}

TEST(Force, InAValleyIsThatOfBothWalls) {
    for (double half : {0.4, 0.7853981634, 1.2}) {
        const Mesh mesh = valley(half);
        const Patch patch = all_of(mesh);
        const double radius = 0.004;
        const dvec3 bottom(0, radius / std::sin(half), 0.01);
        const dvec3 over = bottom + dvec3(0, 0.02, 0);
        for (const dvec3 off : {dvec3(0, -0.005, 0), dvec3(0.001, -0.006, 0)}) {
            const dvec3 sunk = bottom + off;
            Hand1 hand(radius, over);
            hand.along(patch, over, sunk, 0.2);
            for (int k = 0; k < 50; ++k) hand.to(patch, sunk);
            const double lean = std::abs(off.x) / std::abs(off.y);
            if (lean > 1 / std::tan(half)) continue;  // not in the cone of both
            EXPECT_LE(glm::distance(hand.force(sunk, {.stiffness = 400}), -400.0 * off), 1e-3);
            EXPECT_EQ(hand.proxy.contacts().size(), 2u);
        }
    }
}

TEST(Force, InACornerIsThatOfThreeWalls) {
    // The inside of a box, seen from within: its triangles turned round.
    Mesh mesh = block(vec3(-0.05f), vec3(0.05f), 3);
    for (uvec3& t : mesh.triangles) std::swap(t.y, t.z);
    const Patch patch = all_of(mesh);
    const dvec3 sunk(0.06, -0.055, 0.058);
    Hand1 hand(0.005, dvec3(0));
    hand.along(patch, dvec3(0), sunk, 0.5);
    for (int k = 0; k < 20; ++k) hand.to(patch, sunk);
    const dvec3 corner(0.045, -0.045, 0.045);
    EXPECT_LE(glm::distance(hand.proxy.position(), corner), 1e-6);
    EXPECT_LE(glm::distance(hand.force(sunk, {.stiffness = 100}), 100.0 * (corner - sunk)), 1e-3);
}

TEST(Friction, HoldsWithinItsConeAndSlipsBeyond) {
    const Mesh mesh = floor_mesh(11);
    const Patch patch = all_of(mesh);
    const double radius = 0.003, depth = 0.004, k = 600;
    for (const auto& [still, sliding] : {std::pair{0.5, 0.3}, {0.2, 0.2}, {1.1, 0.7}}) {
        Hand1 hand(radius, dvec3(0, 0.02, 0));
        hand.friction = {still, sliding};
        const dvec3 down(0, radius - depth, 0);
        hand.along(patch, dvec3(0, 0.02, 0), down, 0.1);
        // Slowly aside: it holds until the force along the surface is so many times that against it.
        double largest = 0;
        dvec3 at = down;
        for (int i = 0; i < 200000 && !hand.proxy.slips(); ++i) {
            at.x += 1e-6;
            hand.to(patch, at);
            if (!hand.proxy.slips())
                largest = std::max(largest, std::abs(hand.force(at, {.stiffness = k}).x));
        }
        EXPECT_LE(std::abs(largest - still * k * depth), 0.01 * still * k * depth);
        for (int i = 0; i < 1000; ++i) {
            at.x += 1e-5;
            hand.to(patch, at);
        }
        const dvec3 f = hand.force(at, {.stiffness = k});
        EXPECT_LE(std::abs(-f.x - sliding * k * depth), 0.01 * sliding * k * depth);
        EXPECT_LE(std::abs(f.y - k * depth), 0.001 * k * depth);
    }
}

// Everything that a hand can do, fast, to a rough closed surface: the ball is never inside.
TEST(Proxy, NeverPassesThroughASurface) {
    std::mt19937 random(3);
    std::normal_distribution<float> any;
    Mesh rough = ellipsoid(vec3(0.05f, 0.04f, 0.06f), 24);
    std::vector<vec3> normals = rough.normals;
    for (std::size_t i = 0; i < rough.positions.size(); ++i)
        rough.positions[i] += 0.0015f * any(random) * normals[i];
    const Patch patch = all_of(rough);
    const Tree tree(rough);
    for (const double radius : {0.0005, 0.004})
        for (double speed : {0.05, 0.5, 2.0}) {
            dvec3 at(0.2, 0, 0);
            Hand1 hand(radius, at);
            hand.friction = {0.4, 0.3};
            for (int leg = 0; leg < 60; ++leg) {
                const dvec3 next = 0.09 * dvec3(any(random), any(random), any(random));
                const int ticks = std::max(1, int(glm::distance(at, next) / (speed * tick)));
                for (int i = 1; i <= ticks; ++i) {
                    hand.to(patch, glm::mix(at, next, double(i) / ticks));
                    const dvec3 p = hand.proxy.position();
                    ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
                    const float d = tree.distance(vec3(p), 1);
                    ASSERT_GE(d, float(radius) - 1e-6f) << "radius " << radius << " speed " << speed;
                }
                at = next;
            }
            // Outside by the solid angle of all triangles.
            double angle = 0;
            const dvec3 p = hand.proxy.position();
            for (uvec3 t : rough.triangles) {
                const dvec3 a = dvec3(rough.positions[t.x]) - p, b = dvec3(rough.positions[t.y]) - p,
                            c = dvec3(rough.positions[t.z]) - p;
                const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
                angle += 2 * std::atan2(glm::dot(a, glm::cross(b, c)), la * lb * lc + glm::dot(a, b) * lc +
                                                                           glm::dot(b, c) * la +
                                                                           glm::dot(c, a) * lb);
            }
            EXPECT_LE(std::abs(angle), 0.1);
        }
}

TEST(Proxy, ASheetStopsItOnBothSides) {
    const Mesh mesh = floor_mesh(5);
    const Touchable sheet[] = {{mesh.positions, mesh.triangles, {}, true}};
    const Patch patch(sheet);
    for (double side : {1.0, -1.0}) {
        Hand1 hand(0.002, dvec3(0.01, side * 0.03, 0));
        hand.along(patch, dvec3(0.01, side * 0.03, 0), dvec3(0.01, -side * 0.02, 0), 2);
        EXPECT_LE(std::abs(hand.proxy.position().y - side * 0.002), 1e-6);
    }
}

TEST(Proxy, FindsItsWayOutOfASolid) {
    const Mesh ball = ellipsoid(vec3(0.05f), 20);
    const Patch patch = all_of(ball);
    Hand1 hand(0.002, dvec3(0.01, 0, 0));
    hand.along(patch, dvec3(0.01, 0, 0), dvec3(0.09, 0.01, 0), 0.5);
    EXPECT_LE(glm::distance(hand.proxy.position(), dvec3(0.09, 0.01, 0)), 1e-9);
}

// A floor that rises, carries it along and sinks away.
TEST(Proxy, RidesOnWhatMoves) {
    const Mesh mesh = floor_mesh(9);
    const double radius = 0.003;
    Hand1 hand(radius, dvec3(0.012, 0.02, 0.003));
    hand.friction = {0.5, 0.4};
    const dvec3 sunk(0.012, -0.001, 0.003);
    auto patch_at = [&](double time, vec3 shift, vec3 velocity) {
        std::vector<vec3> places = mesh.positions;
        for (vec3& p : places) p += shift;
        const std::vector<vec3> speeds(places.size(), velocity);
        const Touchable one[] = {{places, mesh.triangles, speeds}};
        return Patch(one, vec3(0), 1, time);
    };
    const Patch still = all_of(mesh);
    hand.along(still, dvec3(0.012, 0.02, 0.003), sunk, 0.2);
    // A new patch each sixtieth of a second, as a simulation leaves them, with speeds that are a little
    // wrong.
    const vec3 velocity(0.02f, 0.03f, -0.01f);
    const double begin = hand.time;
    for (int frame = 0; frame < 12; ++frame) {
        const double t0 = frame / 60.0;
        const Patch patch = patch_at(begin + t0, float(t0) * velocity, 1.1f * velocity);
        for (int i = 0; i < 16; ++i) hand.to(patch, sunk);
        const double expect =
            radius + double(velocity.y) * t0 + 1.1 * double(velocity.y) * (hand.time - begin - t0);
        EXPECT_LE(std::abs(hand.proxy.position().y - expect), 1e-5);
        EXPECT_FALSE(hand.proxy.contacts().empty());
    }
}

TEST(Proxy, DoesNotLeaveWhatThePatchKnows) {
    const Mesh mesh = floor_mesh(3);
    const Touchable one[] = {touchable(mesh)};
    const Patch patch(one, vec3(0, 0.02f, 0), 0.03f);
    Hand1 hand(0.002, dvec3(0, 0.02, 0));
    hand.to(patch, dvec3(0.5, 0.02, 0));
    EXPECT_LE(std::abs(hand.proxy.position().x - 0.028), 1e-4);
    EXPECT_TRUE(hand.proxy.contacts().empty());
}

TEST(Force, NeverPulls) {
    const Mesh mesh = floor_mesh(3);
    const Patch patch = all_of(mesh);
    Hand1 hand(0.003, dvec3(0, 0.02, 0));
    const dvec3 sunk(0, 0.001, 0);
    hand.along(patch, dvec3(0, 0.02, 0), sunk, 0.2);
    const Feel feel{.stiffness = 500, .damping = 5};
    for (double speed : {-0.5, 0.0, 0.1, 0.5, 10.0}) {
        const double right = std::max(500 * 0.002 - 5 * speed, 0.0);
        const dvec3 f = force(hand.proxy, sunk, dvec3(0, speed, 0), {&feel, 1});
        EXPECT_LE(std::abs(f.y - right), 1e-3);
    }
}

// A dent that is there already takes its depth from what the hand feels.
TEST(Force, FeelsTheDentsThatStay) {
    const Mesh mesh = floor_mesh(3);
    const Patch patch = all_of(mesh);
    Hand1 hand(0.003, dvec3(0, 0.02, 0));
    const dvec3 sunk(0, -0.002, 0);
    hand.along(patch, dvec3(0, 0.02, 0), sunk, 0.2);
    const Feel feel{.stiffness = 500};
    const Dent middle{vec3(0), 0.003f, 0.01f}, aside{vec3(0.01f, 0, 0), 0.003f, 0.01f};
    EXPECT_LE(std::abs(force(hand.proxy, sunk, dvec3(0), {&feel, 1}, {&middle, 1}).y - 500 * 0.002), 1e-3);
    // At the flank the energy 1/2 k (depth - g(x))² pushes towards the dent's middle.
    const double g = 0.003 * std::exp(-0.5), slope = g * 0.01 / 0.0001;
    const dvec3 f = force(hand.proxy, sunk, dvec3(0), {&feel, 1}, {&aside, 1});
    EXPECT_LE(std::abs(f.y - 500 * (0.005 - g)), 2e-3);
    EXPECT_LE(std::abs(f.x - 500 * (0.005 - g) * slope), 2e-3);
}

TEST(Proxy, ATickIsBoundedHoweverFarTheHandIs) {
    const Mesh mesh = floor_mesh(30);
    const Patch patch = all_of(mesh);
    Hand1 hand(0.0005, dvec3(0, 0.02, 0));
    for (double far : {1e3, 1e9, 1e30}) hand.to(patch, dvec3(far, -far, far));  // hangs, or not
    EXPECT_TRUE(std::isfinite(glm::length(hand.proxy.position())));
}

// The same surface made anew, its triangles in another order: the ball stays where it is.
TEST(Proxy, IsNotCarriedAwayByTrianglesThatChangeTheirNumbers) {
    Mesh mesh = floor_mesh(21);
    Hand1 hand(0.003, dvec3(0.05, 0.02, 0.05));
    const dvec3 sunk(0.05, 0.001, 0.05);
    hand.along(all_of(mesh), dvec3(0.05, 0.02, 0.05), sunk, 0.2);
    std::reverse(mesh.triangles.begin(), mesh.triangles.end());
    hand.to(all_of(mesh), sunk);
    EXPECT_LE(glm::distance(hand.proxy.position(), dvec3(0.05, 0.003, 0.05)), 1e-6);
}

// So many sides that not all of their planes are kept: whichever way the hand leans there is a wall.
TEST(Force, InAConeOfManySides) {
    Mesh mesh;
    const int sides = 32;
    mesh.positions.push_back(vec3(0));
    for (int i = 0; i < sides; ++i) {
        const float a = 6.2831853f * float(i) / sides;
        mesh.positions.emplace_back(0.05f * std::cos(a), 0.05f, 0.05f * std::sin(a));
    }
    for (int i = 0; i < sides; ++i) mesh.triangles.emplace_back(0, 1 + (i + 1) % sides, 1 + i);
    const Patch patch = all_of(mesh);
    const double radius = 0.004;
    for (int i = 0; i < sides; ++i) {
        const double a = 0.1 + 6.2831853 * i / sides;
        const dvec3 over(0, 0.03, 0),
            sunk = dvec3(0.004 * std::cos(a), radius * std::sqrt(2.0) - 0.002, 0.004 * std::sin(a));
        Hand1 hand(radius, over);
        hand.along(patch, over, sunk, 0.1);
        for (int k = 0; k < 100; ++k) hand.to(patch, sunk);
        const dvec3 f = hand.force(sunk, {.stiffness = 300});
        EXPECT_GE(glm::length(f), 300 * 0.002) << i;
        EXPECT_LE(glm::distance(f, 300.0 * (hand.proxy.position() - sunk)), 1e-2) << i;
    }
}

TEST(Patch, GuessesForThreeFramesAndThenStandsStill) {
    const Mesh mesh = floor_mesh(1);
    const std::vector<vec3> up(mesh.positions.size(), vec3(0, 0.5f, 0)),
        mad(mesh.positions.size(), vec3(0, 100, 0));
    const Touchable one[] = {{mesh.positions, mesh.triangles, up}},
                    other[] = {{mesh.positions, mesh.triangles, mad}};
    const Patch patch(one, vec3(0), 1, 10);
    EXPECT_LE(std::abs(patch.find(0, 0, 10.02)->corners[0].y - 0.01), 1e-8);
    EXPECT_EQ(patch.find(0, 0, 10.02)->velocities[0].y, 0.5);
    EXPECT_LE(std::abs(patch.find(0, 1, 12)->corners[0].y - 0.025), 1e-8);
    EXPECT_EQ(patch.find(0, 1, 12)->velocities[0].y, 0);
    EXPECT_EQ(patch.find(0, 0, 9)->corners[0].y, 0);
    EXPECT_FALSE(patch.find(0, 2, 10));
    EXPECT_FALSE(patch.find(1, 0, 10));
    EXPECT_EQ(Patch(other).fastest(), 3);
}

TEST(Proxy, ComesBackIntoWhatThePatchKnows) {
    const Mesh mesh = floor_mesh(3);
    const Touchable one[] = {touchable(mesh)};
    const Patch patch(one, vec3(0, 0.02f, 0), 0.03f);
    Hand1 hand(0.002, dvec3(0.05, 0.02, 0));  // outside
    hand.to(patch, dvec3(0.06, 0.02, 0));
    EXPECT_EQ(hand.proxy.position().x, 0.05);
    hand.to(patch, dvec3(0, 0.02, 0));
    EXPECT_LE(std::abs(hand.proxy.position().x), 1e-9);
}

}  // namespace
}  // namespace palpate
