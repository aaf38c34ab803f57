// How well each mapping follows a twist, a bend and a fold, and what automatic makes of it.
#include "bench/deformations.h"
#include "palpate/body/cloth.h"
#include "palpate/body/embedding.h"
#include "tests/body/turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate {
namespace {

struct Limits {
    Mapping mapping;
    Misfit twist, bend;  // what may be: rms and largest, spacings; mean and largest angle, degrees
};

void expect_within(const Carrier& c, const std::vector<Limits>& table) {
    for (const auto& [mapping, twist, bend] : table) {
        const Embedding skin = embed(c.surface, c.body, mapping);
        for (const auto& [d, most] : {std::pair(&c.twisted, &twist), std::pair(&c.bent, &bend)}) {
            const Misfit is = misfit(c, skin, *d);
            const auto where = c.name + ' ' + std::string(name_of(mapping)) + ' ' + d->name;
            EXPECT_LE(is.rms, most->rms) << where;
            EXPECT_LE(is.largest, most->largest) << where;
            EXPECT_LE(is.mean_angle, most->mean_angle) << where;
            EXPECT_LE(is.largest_angle, most->largest_angle) << where;
        }
    }
}

// Twist and bend of 90° over the body's length. The bounds lie about a quarter above what is measured
// (docs/results.md has that), and where the design has figures for such a body, near those.
TEST(Follows, AnOrganIsFollowedAsWellAsEachModeCan) {
    expect_within(organ_on_a_lattice(),
                  {{Mapping::automatic, {0.004, 0.014, 0.5, 3}, {0.010, 0.034, 0.55, 3.6}},
                   {Mapping::one_to_one, {0.55, 1.2, 20, 75}, {0.55, 1.2, 21, 70}},
                   {Mapping::constant, {0.065, 0.31, 7, 28}, {0.040, 0.30, 7.5, 52}},
                   {Mapping::interpolated, {0.045, 0.25, 9.5, 21}, {0.043, 0.31, 9.5, 50}},
                   {Mapping::normal_offset, {0.045, 0.25, 9.5, 21}, {0.048, 0.25, 10, 50}},
                   {Mapping::trilinear, {0.004, 0.014, 0.5, 3}, {0.010, 0.034, 0.55, 3.6}},
                   {Mapping::frames, {0.003, 0.024, 0.65, 3.3}, {0.0053, 0.020, 0.75, 3.5}}});
}

TEST(Follows, ASurfaceOverAClothIsFollowedAsWellAsEachModeCan) {
    const std::vector<Limits> bounds = {
        {Mapping::automatic, {0.011, 0.030, 0.95, 2.6}, {0.0070, 0.031, 0.80, 3.8}},
        {Mapping::one_to_one, {1.05, 1.6, 13, 26}, {1.05, 1.6, 13, 24}},
        {Mapping::constant, {0.055, 0.13, 4.2, 13}, {0.032, 0.08, 2.8, 9}},
        {Mapping::interpolated, {0.016, 0.040, 1.8, 5.5}, {0.013, 0.033, 0.9, 3.7}},
        {Mapping::normal_offset, {0.016, 0.040, 1.8, 5.5}, {0.013, 0.033, 0.9, 3.7}},
        {Mapping::frames, {0.011, 0.030, 0.95, 2.6}, {0.0070, 0.031, 0.80, 3.8}}};
    expect_within(quilt_on_a_cloth(), bounds);
    expect_within(quilt_on_a_triangle_cloth(), bounds);
}

TEST(Follows, MuchSurfaceOnFewNodesIsFollowedAsWellAsEachModeCan) {
    expect_within(beast_on_18_nodes(), {{Mapping::automatic, {0.039, 0.092, 8, 19}, {0.155, 0.36, 13, 31}},
                                        {Mapping::one_to_one, {0.7, 1.25, 34, 112}, {0.7, 1.2, 35, 132}},
                                        {Mapping::constant, {0.125, 0.37, 14, 46}, {0.093, 0.23, 11, 32}},
                                        {Mapping::interpolated, {0.08, 0.2, 6.7, 26}, {0.13, 0.27, 15, 34}},
                                        {Mapping::normal_offset, {0.1, 0.3, 6.7, 26}, {0.15, 0.45, 15, 34}},
                                        {Mapping::frames, {0.039, 0.092, 8, 19}, {0.155, 0.36, 13, 31}}});
}

double best_of_the_paper(const Carrier& c, const Deformation& d) {
    double best = 1e30;
    for (Mapping mode : {Mapping::one_to_one, Mapping::constant, Mapping::interpolated})
        best = std::min(best, misfit(c, embed(c.surface, c.body, mode), d).rms);
    return best;
}

TEST(Follows, AutomaticIsNeverWorseThanTheBestOfThePaper) {
    for (const Carrier& c : carriers()) {
        const Embedding skin = embed(c.surface, c.body, Mapping::automatic);
        EXPECT_LE(misfit(c, skin, c.twisted).rms, best_of_the_paper(c, c.twisted)) << c.name;
        // 90° over two springs of a solid is past what frames can tell, and what is closer there opens seams.
        if (c.name != beast_on_18_nodes().name)
            EXPECT_LE(misfit(c, skin, c.bent).rms, best_of_the_paper(c, c.bent)) << c.name;
    }
}

// What the 2005 paper shows on its dragon: where few nodes carry much surface, the interpolated basis is
// better.
TEST(Follows, OnASheetOf18NodesInterpolatedBeatsConstant) {
    const Carrier c = on_a_sheet_of_18("beast", beast());
    for (const Deformation* d : {&c.twisted, &c.bent}) {
        const Misfit flat = misfit(c, embed(c.surface, c.body, Mapping::constant), *d);
        const Misfit turned = misfit(c, embed(c.surface, c.body, Mapping::interpolated), *d);
        EXPECT_LE(turned.rms, 0.6 * flat.rms) << d->name;
        EXPECT_LE(turned.mean_angle, 0.7 * flat.mean_angle) << d->name;
    }
}

// A cloth given as any net, without a fan: its approximate normals lie within it, or cancel, and say nothing,
// as the paper warns (section 3.5).
Carrier quilt_on_a_flat_net() {
    Carrier c = quilt_on_a_cloth();
    std::vector<Spring> springs;
    for (uvec2 ends : spring_ends(c.body)) springs.push_back({int(ends.x), int(ends.y), 100});
    std::vector<uvec3> faces;
    for (const auto& f : c.body.faces) faces.emplace_back(f[0], f[1], f[2]);
    c.body = net(c.body.positions, std::vector<float>(c.body.count(), 0.01f), springs, faces);
    c.body.spacing = 0.02f;
    return c;
}

TEST(Follows, AutomaticDoesNotNeedApproximateNormals) {
    const Carrier c = quilt_on_a_flat_net();
    const Embedding skin = embed(c.surface, c.body);
    for (const Deformation* d : {&c.twisted, &c.bent}) {
        EXPECT_LE(misfit(c, skin, *d).rms, 0.01) << d->name;
        EXPECT_LE(misfit(c, skin, *d).rms, best_of_the_paper(c, *d)) << d->name;
    }
}

// Rounding alone must not give a basis its direction.
TEST(Follows, NormalsThatCancelGiveNoDirection) {
    const Carrier c = quilt_on_a_flat_net();
    std::mt19937 random(2);
    const Turn turn(random);
    const Moved moved =
        follow(embed(c.surface, c.body, Mapping::interpolated), c.body, turn.points(c.body.positions));
    for (std::size_t i = 0; i < c.surface.positions.size(); ++i)
        if (const vec3 p = c.surface.positions[i]; std::max(std::abs(p.x), std::abs(p.y)) < 0.1f)
            ASSERT_LE(glm::distance(moved.positions[i], turn.points({p})[0]), 1e-5f);
}

// A strip of cloth in the plane z = 0, two triangles on each side of the fold x = 0, and its wings turned by
// `angle` about that fold: downwards if positive.
struct FoldedStrip {
    Body body;
    std::vector<vec3> folded;
    float h = 0.1f;

    explicit FoldedStrip(float angle) {
        body = cloth(relief({2 * h, 2 * h}, {2, 2}, [](vec2) { return 0.0f; }), {.density = 0.2f});
        for (vec3 p : body.positions)
            folded.push_back({std::cos(angle) * p.x, p.y, -std::sin(angle) * std::abs(p.x)});
    }
};

// 2005, figure 5: two vertices close to each other over a fold, which hang on different triangles. With a
// basis for each triangle they part when the cloth folds away from them and swap places when it folds towards
// them; with bases that are shared they do neither.
TEST(Follows, FigureFive) {
    const float h = 0.1f, height = 0.8f * h, apart = 0.02f * h;
    Mesh pair;
    pair.positions = {{-apart / 2, 0.03f * h, height}, {apart / 2, 0.03f * h, height}};
    pair.normals = {{0, 0, 1}, {0, 0, 1}};
    const float angle = glm::radians(30.0f);
    auto gap = [&](Mapping mode, const FoldedStrip& strip) {
        const Moved moved = follow(embed(pair, strip.body, mode), strip.body, strip.folded);
        return (moved.positions[1].x - moved.positions[0].x) / apart;
    };
    const FoldedStrip ridge(angle), valley(-angle);
    const float wide = 2 * height * std::sin(angle) / apart;  // 40 times as far apart
    EXPECT_GE(gap(Mapping::constant, ridge), 0.95f * wide);
    EXPECT_LE(gap(Mapping::constant, valley), -0.95f * wide) << "they have not crossed";
    for (Mapping mode :
         {Mapping::interpolated, Mapping::normal_offset, Mapping::frames, Mapping::automatic}) {
        // The turn of 30° happens over a spacing to each side: at this height, that stretches by 0.8 × 0.52.
        EXPECT_LE(gap(mode, ridge), 2.0f) << name_of(mode);
        EXPECT_GE(gap(mode, ridge), 0.5f) << name_of(mode);
        EXPECT_LE(gap(mode, valley), 1.5f) << name_of(mode);
        EXPECT_GE(gap(mode, valley), 0.1f) << name_of(mode) << ": they have crossed or met";
    }
}

// How much the most stretched edge of the surface is longer than before.
double most_stretched(const Mesh& mesh, const Moved& moved) {
    double most = 0;
    for (uvec3 t : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            const unsigned a = t[k], b = t[(k + 1) % 3];
            const double stretch = glm::distance(moved.positions[a], moved.positions[b]) /
                                   glm::distance(mesh.positions[a], mesh.positions[b]);
            if (!(stretch <= most)) most = stretch;
        }
    return most;
}

// However finely a surface is meshed, its neighbouring vertices stay together under automatic: no edge
// stretches by much more than the deformation itself stretches space there.
TEST(Follows, AutomaticOpensNoSeam) {
    const FoldedStrip strip(glm::radians(30.0f));
    for (int parts : {50, 200}) {
        const Mesh mesh = relief({0.19f, 0.19f}, {parts, parts}, [](vec2) { return 0.08f; });
        const Embedding shared = embed(mesh, strip.body), apart = embed(mesh, strip.body, Mapping::constant);
        EXPECT_LE(most_stretched(mesh, follow(shared, strip.body, strip.folded)), 2);
        EXPECT_GE(most_stretched(mesh, follow(apart, strip.body, strip.folded)), 0.4 * parts);
    }
    for (const Carrier& c : carriers())
        for (const Deformation* d : {&c.twisted, &c.bent}) {
            const Moved exact{(*d)(c.surface.positions), {}, {}};
            const Moved moved = follow(embed(c.surface, c.body), c.body, (*d)(c.body.positions));
            EXPECT_LE(most_stretched(c.surface, moved), 1.2 * most_stretched(c.surface, exact) + 0.1)
                << c.name << ' ' << d->name;
        }
}

}  // namespace
}  // namespace palpate
