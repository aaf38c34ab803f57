// What a hand can touch: a patch of a PatchMaker against one that is made anew, and against all triangles.
#include "palpate/body/patch.h"

#include "palpate/mesh/triangle.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <utility>
#include <vector>

namespace palpate {
namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();
constexpr float undefined = std::numeric_limits<float>::quiet_NaN();

struct Cloth {
    std::vector<vec3> rest, positions, velocities;
    std::shared_ptr<std::vector<uvec3>> triangles = std::make_shared<std::vector<uvec3>>();
    bool is_sheet = false;
};

// A cloth of wide × deep vertices, 2 mm apart, in folds 2 cm high.
Cloth folded(int wide, int deep, vec3 middle) {
    Cloth cloth;
    for (int j = 0; j < deep; ++j)
        for (int i = 0; i < wide; ++i) {
            const float x = 0.002f * float(i - wide / 2), z = 0.002f * float(j - deep / 2);
            cloth.rest.push_back(middle + vec3(x, 0.01f * std::sin(300 * x) * std::cos(200 * z), z));
            if (i + 1 == wide || j + 1 == deep) continue;
            const auto first = unsigned(j * wide + i), next = first + unsigned(wide);
            cloth.triangles->push_back({first, first + 1, next});
            cloth.triangles->push_back({first + 1, next + 1, next});
        }
    cloth.positions = cloth.rest;
    return cloth;
}

std::vector<Touchable> touchable(const std::vector<Cloth>& cloths) {
    std::vector<Touchable> all;
    for (const Cloth& c : cloths) all.push_back({c.positions, *c.triangles, c.velocities, c.is_sheet});
    return all;
}

double distance(dvec3 point, dvec3 a, dvec3 b, dvec3 c) {
    const dvec3 weights = nearest_weights(point, a, b, c);
    return glm::distance(point, weights.x * a + weights.y * b + weights.z * c);
}

using Faces = std::map<std::pair<int, int>, Patch::Face>;

Faces within(const Patch& patch, dvec3 point, double reach, double time) {
    Faces found;
    patch.for_each_near(point, reach, time, [&](const Patch::Face& face) {
        const auto& [a, b, c] = face.corners;
        if (distance(point, a, b, c) <= reach) found.emplace(std::pair(face.surface, face.triangle), face);
    });
    return found;
}

std::size_t count_within(const std::vector<Touchable>& surfaces, dvec3 point, double reach) {
    std::size_t count = 0;
    for (const Touchable& surface : surfaces)
        for (uvec3 t : surface.triangles) {
            const vec3 a = surface.positions[t.x], b = surface.positions[t.y], c = surface.positions[t.z];
            const vec3 sum = a + b + c;
            if (!std::isfinite(sum.x + sum.y + sum.z)) continue;
            count += distance(point, a, b, c) <= reach;
        }
    return count;
}

void expect_equal(const Patch::Face& one, const Patch::Face& other) {
    EXPECT_EQ(one.corners, other.corners);
    EXPECT_EQ(one.velocities, other.velocities);
    EXPECT_EQ(one.is_sheet, other.is_sheet);
}

// Whether it is as good as a new one, in the whole ball and in small ones within it.
void expect_as_new(const Patch& patch, const std::vector<Touchable>& surfaces, vec3 centre, float radius,
                   double time, std::mt19937& random) {
    const Patch anew(surfaces, centre, radius, time);
    EXPECT_EQ(patch.centre(), anew.centre());
    EXPECT_EQ(patch.radius(), anew.radius());
    EXPECT_EQ(patch.surfaces(), anew.surfaces());
    EXPECT_GE(patch.size(), count_within(surfaces, dvec3(centre), radius));
    std::uniform_real_distribution<double> part(-0.5, 0.5);
    const double size = std::min(double(radius), 0.2);
    for (int k = 0; k < 4; ++k) {
        const dvec3 off = k == 0 ? dvec3(0) : size * dvec3(part(random), part(random), part(random));
        const dvec3 point = dvec3(centre) + off;
        const double reach = (1 - 1e-6) * (size - glm::length(off)) * (k == 0 ? 1 : 0.3);
        const Faces now = within(patch, point, reach, time), wanted = within(anew, point, reach, time);
        EXPECT_EQ(now.size(), count_within(surfaces, point, reach));
        ASSERT_EQ(now.size(), wanted.size());
        for (const auto& [key, face] : wanted) {
            ASSERT_TRUE(now.contains(key));
            expect_equal(now.at(key), face);
            const auto later = patch.find(key.first, key.second, time + 0.01);
            ASSERT_TRUE(later);
            expect_equal(*later, *anew.find(key.first, key.second, time + 0.01));
            for (dvec3 velocity : face.velocities) EXPECT_LE(glm::length(velocity), patch.fastest() + 1e-6);
        }
    }
}

// Everything that can happen to surfaces and to a hand, in an order of chance.
TEST(PatchMaker, MakesPatchesThatAreAsGoodAsNewOnes) {
    std::mt19937 random(7);
    std::normal_distribution<float> bell;
    const auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
    const auto anywhere = [&](float size) { return size * vec3(bell(random), bell(random), bell(random)); };
    std::vector<Cloth> cloths = {folded(37, 41, vec3(0)), folded(1, 9, vec3(0.01f)),
                                 folded(23, 14, vec3(0, 0.03f, 0))};
    cloths[2].is_sheet = true;
    PatchMaker maker;
    vec3 hand(0);
    for (int call = 0; call < 400; ++call) {
        SCOPED_TRACE(call);
        hand = chance(0.03) ? anywhere(0.03f) : hand + anywhere(0.0002f);
        const float radius = chance(0.03) ? infinite : chance(0.05) ? 0.03f : 0.015f;
        for (Cloth& c : cloths) {
            const vec3 shift = chance(0.03) ? anywhere(0.01f) : anywhere(0.0001f);
            for (vec3& p : c.positions) p += shift + anywhere(0.00002f);
            c.velocities.assign(chance(0.2) ? 0 : c.positions.size(), anywhere(chance(0.1) ? 9 : 0.1f));
            const auto some = std::uniform_int_distribution<std::size_t>(0, c.positions.size() - 1)(random);
            if (chance(0.05)) c.positions[some] = hand + anywhere(0.005f);
            if (chance(0.05)) c.positions[some][call % 3] = undefined;
            if (chance(0.05) && !c.velocities.empty()) c.velocities[some].y = undefined;
            if (chance(0.1)) c.positions = c.rest;
            if (chance(0.02)) c.is_sheet = !c.is_sheet;
            if (chance(0.03) && c.triangles->size() > 9) {
                c.triangles = std::make_shared<std::vector<uvec3>>(*c.triangles);
                std::rotate(c.triangles->begin(), c.triangles->begin() + 5, c.triangles->end());
                if (chance(0.5)) c.triangles->resize(c.triangles->size() - 4);
            }
        }
        if (chance(0.02)) std::swap(cloths[0], cloths[2]);
        if (chance(0.02)) cloths.push_back(folded(5, 5, hand));
        const std::vector<Touchable> surfaces = touchable(cloths);
        const Patch patch = maker.next(surfaces, hand, radius, call);
        expect_as_new(patch, surfaces, hand, radius, call, random);
        if (HasFailure()) return;
    }
}

TEST(PatchMaker, LooksAtAllTrianglesNowAndThenOnly) {
    const std::vector<Cloth> cloths = {folded(101, 101, vec3(0))};
    const std::vector<Touchable> surfaces = touchable(cloths);
    PatchMaker maker;
    int looks = 0, differ = 0;
    std::size_t last = 0, last_new = 0;
    for (int call = 0; call < 100; ++call) {
        const vec3 hand(0.0003f * float(call), 0, 0);
        const std::size_t size = maker.next(surfaces, hand, 0.02f).size();
        const std::size_t size_new = Patch(surfaces, hand, 0.02f).size();
        EXPECT_GE(size, size_new);
        looks += size != last, differ += size_new != last_new;
        last = size, last_new = size_new;
    }
    EXPECT_GE(differ, 30);
    EXPECT_LE(looks, 10);
}

TEST(Patch, FindsWhatMovesWhereItHasGone) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> part(-1, 1);
    const auto anywhere = [&] { return vec3(part(random), part(random), part(random)); };
    Cloth cloth = folded(51, 51, vec3(0));
    for (vec3 p : cloth.rest) cloth.velocities.push_back(vec3(0.3f, -10 * p.x, 0) + 0.1f * anywhere());
    const Patch patch(touchable({cloth}));
    for (double age : {0.0, 0.01, 0.05, 1.0}) {
        for (std::size_t i = 0; i < cloth.rest.size(); ++i)
            cloth.positions[i] =
                cloth.rest[i] + float(std::min(age, Patch::longest_guess)) * cloth.velocities[i];
        for (int k = 0; k < 50; ++k) {
            const dvec3 point = 0.04f * anywhere();
            EXPECT_EQ(within(patch, point, 0.006, age).size(),
                      count_within(touchable({cloth}), point, 0.006));
        }
    }
}

// A single triangle far away from a cloth under the hand.
struct Thrown {
    Thrown() {
        cloths[1].positions = {vec3(1, 0, 0), vec3(1.001f, 0, 0), vec3(1, 0, 0.001f)};
        *cloths[1].triangles = {{0, 1, 2}};
    }
    bool is_found() { return maker.next(touchable(cloths), vec3(0), 0.02f).find(1, 0, 0).has_value(); }

    std::vector<Cloth> cloths = {folded(31, 31, vec3(0)), folded(1, 1, vec3(0))};
    PatchMaker maker;
};

TEST(PatchMaker, FindsWhatComesInFromOutside) {
    for (float step : {1.0f, 0.1f, 0.001f}) {
        Thrown thrown;
        for (float x = 1; x > -0.015f; x = thrown.cloths[1].positions[0].x) {
            EXPECT_GE(thrown.is_found(), x < 0.02f);
            for (vec3& p : thrown.cloths[1].positions) p.x -= step;
        }
    }
    Thrown stretched;  // one vertex alone
    EXPECT_FALSE(stretched.is_found());
    stretched.cloths[1].positions[0].x = 0;
    EXPECT_TRUE(stretched.is_found());
}

TEST(PatchMaker, FindsWhatHadNoPositionBefore) {
    for (float lost : {undefined, infinite, -infinite})
        for (bool is_near : {true, false}) {
            Thrown thrown;
            if (is_near)
                for (vec3& p : thrown.cloths[1].positions) p.x -= 1;
            EXPECT_EQ(thrown.is_found(), is_near);
            thrown.cloths[1].positions[2].z = lost;
            for (int k = 0; k < 3; ++k) EXPECT_FALSE(thrown.is_found());
            for (vec3& p : thrown.cloths[1].positions) p.z = 0;
            EXPECT_EQ(thrown.is_found(), is_near);
            thrown.cloths[1].positions[0].x = 0;
            EXPECT_TRUE(thrown.is_found());
        }
}

// For a hand may still read it.
TEST(PatchMaker, LeavesEarlierPatchesAsTheyAre) {
    std::vector<Cloth> cloths = {folded(21, 21, vec3(0))};
    PatchMaker maker;
    const Patch first = maker.next(touchable(cloths), vec3(0), 0.01f);
    const Faces before = within(first, dvec3(0), 0.01, 0);
    ASSERT_GE(before.size(), 20u);
    for (int call = 0; call < 20; ++call) {
        for (vec3& p : cloths[0].positions) p.y += 0.0003f;
        maker.next(touchable(cloths), vec3(0), 0.01f);
    }
    const Faces after = within(first, dvec3(0), 0.01, 0);
    ASSERT_EQ(after.size(), before.size());
    for (const auto& [key, face] : before) expect_equal(after.at(key), face);
}

// Its boxes would otherwise overlap more and more.
TEST(PatchMaker, LooksAnewWhenTrianglesAreMixedUp) {
    Cloth crumbs;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> part(-0.1f, 0.1f);
    for (unsigned i = 0; i < 9000; i += 3) crumbs.triangles->push_back({i, i + 1, i + 2});
    PatchMaker maker;
    for (int call = 0; call < 3; ++call) {
        crumbs.positions.clear();
        for (int i = 0; i < 3000; ++i) {
            const vec3 p(part(random), part(random), part(random));
            crumbs.positions.insert(crumbs.positions.end(),
                                    {p, p + vec3(0.001f, 0, 0), p + vec3(0, 0.001f, 0)});
        }
        const Patch patch = maker.next(touchable({crumbs}));
        int looked_at = 0;
        patch.for_each_near(dvec3(0), 0.01, 0, [&](const Patch::Face&) { ++looked_at; });
        EXPECT_LE(looked_at, 100);
    }
}

TEST(PatchMaker, LooksAnewAtWhatItForgot) {
    std::vector<Cloth> cloths = {folded(21, 21, vec3(0))};
    PatchMaker maker;
    const std::size_t all = maker.next(touchable(cloths)).size();
    cloths[0].triangles->back() = cloths[0].triangles->front();  // changed in place
    cloths[0].positions.back().x = undefined;                    // which now belongs to no triangle
    maker.forget();
    EXPECT_EQ(maker.next(touchable(cloths)).size(), all);
}

TEST(PatchMaker, RefusesWhatAPatchRefuses) {
    const Cloth cloth = folded(5, 5, vec3(0));
    const std::vector<vec3> few(3, vec3(0));
    const std::vector<uvec3> wrong = {{0, 1, 25}};
    const Touchable sound{cloth.positions, *cloth.triangles}, no_vertex{cloth.positions, wrong},
        no_speeds{cloth.positions, *cloth.triangles, few};
    PatchMaker maker;
    for (int k = 0; k < 2; ++k) {
        expect_refused("velocities", [&] { maker.next({&no_speeds, 1}); });
        expect_refused("missing vertices", [&] { maker.next({&no_vertex, 1}); });
        EXPECT_EQ(maker.next({&sound, 1}).size(), 32u);
    }
    EXPECT_EQ(maker.next({}).size(), 0u);
}

}  // namespace
}  // namespace palpate
