#include "palpate/body/embedding.h"

#include "bench/deformations.h"
#include "palpate/base/error.h"
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/mesh/triangle.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

const Material tissue{.youngs_modulus = 5000, .density = 1000};

// The mappings that a body can bear.
std::vector<Mapping> modes_of(const Body& body) {
    std::vector<Mapping> modes;
    for (const auto& mode : names(Mapping{}))
        if (mode.value != Mapping::trilinear || !body.cells.empty()) modes.push_back(mode.value);
    return modes;
}

// The largest distance between two lists of points; not a number if any is.
double farthest(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    if (a.size() != b.size()) return 1e30;
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (const double d = glm::distance(dvec3(a[i]), dvec3(b[i])); !(d <= most)) most = d;
    return most;
}

double size_of(const Mesh& mesh) { return glm::length(bounds(mesh).size()); }

Mesh organ() { return ellipsoid({0.05f, 0.04f, 0.06f}, 40); }

// Any tangents at right angles with the normals, of both hands.
void give_tangents(Mesh& mesh) {
    mesh.tangents.clear();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        const vec3 n = mesh.normals[i];
        const vec3 t = glm::normalize(glm::cross(n, vec3(0.3f, 0.5f, -0.8f)));
        mesh.tangents.emplace_back(t, i % 3 == 0 ? -1.0f : 1.0f);
    }
}

struct Turn {
    glm::mat4 turn;
    vec3 shift;
    explicit Turn(std::mt19937& random) {
        std::uniform_real_distribution<float> any(-1, 1);
        const vec3 axis = glm::normalize(vec3(any(random), any(random), any(random)) + vec3(1e-3f));
        turn = glm::rotate(glm::mat4(1), 3 * any(random), axis);
        shift = vec3(any(random), any(random), any(random));
    }
    vec3 direction(vec3 v) const { return vec3(turn * vec4(v, 0)); }
    std::vector<vec3> points(const std::vector<vec3>& list) const {
        std::vector<vec3> out;
        for (vec3 p : list) out.push_back(direction(p) + shift);
        return out;
    }
    std::vector<vec3> directions(const std::vector<vec3>& list) const {
        std::vector<vec3> out;
        for (vec3 v : list) out.push_back(direction(v));
        return out;
    }
};

TEST(Embedding, TheRestSurfaceMapsToItself) {
    std::vector<Carrier> all = carriers();
    const Mesh mesh = organ();
    for (float spacing : {0.004f, 0.011f, 0.03f})
        all.push_back({"organ", mesh, lattice(mesh, {.spacing = spacing, .material = tissue}), {}, {}});
    for (const Carrier& c : all)
        for (Mapping mode : modes_of(c.body)) {
            if (mode == Mapping::one_to_one) continue;  // see the next test
            // What reaches past the rim of a sheet lies aside of all its normals (section 3.5 gives that up).
            if (mode == Mapping::normal_offset && c.body.fan > 0 && c.body.count() == 18) continue;
            const Moved moved = follow(embed(c.surface, c.body, mode), c.body, c.body.positions);
            EXPECT_LE(farthest(moved.normals, c.surface.normals), 1e-5) << c.name << ' ' << name_of(mode);
            if (mode == Mapping::normal_offset && !c.body.cells.empty()) {
                // In the corners of a voxel hull a vertex may lie on the normal of no place: a few, by
                // little.
                int off = 0;
                for (std::size_t i = 0; i < c.surface.positions.size(); ++i) {
                    const float d = glm::distance(moved.positions[i], c.surface.positions[i]);
                    EXPECT_LE(d, 0.1f * c.body.spacing) << c.name;
                    off += !(d <= 1e-6 * size_of(c.surface));
                }
                EXPECT_LE(off, 0.005 * double(c.surface.positions.size())) << c.name;
                continue;
            }
            EXPECT_LE(farthest(moved.positions, c.surface.positions), 1e-6 * size_of(c.surface))
                << c.name << ' ' << name_of(mode);
        }
}

// One-to-one, each vertex lies on the nearest node of the outside, with that node's approximate normal.
TEST(Embedding, OneToOneTakesTheNearestNode) {
    for (const Carrier& c : carriers()) {
        std::vector<bool> outside(c.body.count(), false);
        for (const HullTriangle& t : hull(c.body))
            for (int node : t.nodes) outside[std::size_t(node)] = true;
        for (const auto& face : c.body.faces)
            for (int node : face) outside[std::size_t(node)] = true;
        const std::vector<vec3> approximate = approximate_normals(c.body, c.body.positions);
        const Moved moved = follow(embed(c.surface, c.body, Mapping::one_to_one), c.body, c.body.positions);
        int others = 0;
        for (std::size_t i = 0; i < c.surface.positions.size(); ++i) {
            const vec3 v = c.surface.positions[i];
            std::size_t node = c.body.count();
            float least = 1e30f;
            for (std::size_t k = 0; k < c.body.count(); ++k) {
                if (!outside[k]) continue;
                least = std::min(least, glm::distance(v, c.body.positions[k]));
                if (glm::distance(moved.positions[i], c.body.positions[k]) < 1e-6f) node = k;
            }
            ASSERT_LT(node, c.body.count()) << c.name << ": not on a node of the outside";
            if (glm::length(approximate[node]) > 0.1f)
                EXPECT_LE(glm::distance(moved.normals[i], glm::normalize(approximate[node])), 1e-5f)
                    << c.name;
            others += glm::distance(v, c.body.positions[node]) > least + 1e-6f;
        }
        // Some choose a farther one, because the nearest lies on faces that look the other way.
        EXPECT_LE(others, 0.1 * double(c.surface.positions.size())) << c.name;
    }
}

TEST(Embedding, ARigidMotionMovesItRigidly) {
    std::mt19937 random(11);
    for (Carrier& c : carriers()) {
        give_tangents(c.surface);
        for (Mapping mode : modes_of(c.body)) {
            const Embedding skin = embed(c.surface, c.body, mode);
            const Moved rest = follow(skin, c.body, c.body.positions);
            for (int round = 0; round < 3; ++round) {
                const Turn turn(random);
                const Moved moved = follow(skin, c.body, turn.points(c.body.positions));
                EXPECT_LE(farthest(moved.positions, turn.points(rest.positions)), 1e-5 * size_of(c.surface))
                    << c.name << ' ' << name_of(mode);
                EXPECT_LE(farthest(moved.normals, turn.directions(rest.normals)), 2e-4)
                    << c.name << ' ' << name_of(mode);
            }
        }
    }
}

TEST(Embedding, AnyAffineMotionIsExactInCellsAndInFrames) {
    const mat3 affine(vec3(1.2f, 0.1f, 0), vec3(-0.3f, 0.8f, 0.2f), vec3(0.1f, 0, 1.1f));
    auto affinely = [&](const std::vector<vec3>& points) {
        std::vector<vec3> out;
        for (vec3 p : points) out.push_back(affine * p);
        return out;
    };
    for (const Carrier& c : {organ_on_a_lattice(), beast_on_18_nodes()})
        for (Mapping mode : {Mapping::automatic, Mapping::trilinear, Mapping::frames}) {
            if (mode == Mapping::trilinear && c.body.cells.empty()) continue;
            std::vector<vec3> normals;
            for (vec3 n : c.surface.normals)
                normals.push_back(glm::normalize(glm::transpose(glm::inverse(affine)) * n));
            const Moved moved = follow(embed(c.surface, c.body, mode), c.body, affinely(c.body.positions));
            EXPECT_LE(farthest(moved.positions, affinely(c.surface.positions)), 1e-6 * size_of(c.surface))
                << c.name << ' ' << name_of(mode);
            EXPECT_LE(farthest(moved.normals, normals), 2e-5) << c.name << ' ' << name_of(mode);
        }
}

// The closed forms that all below is held against: their normals are those of the surface that they make.
TEST(Embedding, TheClosedFormsHaveTheRightNormals) {
    for (const Carrier& c : carriers())
        for (const Deformation* d : {&c.twisted, &c.bent}) {
            Mesh moved = c.surface;
            moved.positions = (*d)(c.surface.positions);
            compute_normals(moved);
            double mean = 0;
            for (std::size_t i = 0; i < moved.positions.size(); ++i)
                mean +=
                    glm::distance(moved.normals[i], d->normal(c.surface.positions[i], c.surface.normals[i]));
            EXPECT_LE(mean / double(moved.positions.size()), 0.01) << c.name << ' ' << d->name;
        }
}

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
TEST(Embedding, AnOrganIsFollowedAsWellAsEachModeCan) {
    expect_within(organ_on_a_lattice(),
                  {{Mapping::automatic, {0.004, 0.014, 0.5, 3}, {0.010, 0.034, 0.55, 3.6}},
                   {Mapping::one_to_one, {0.55, 1.2, 20, 75}, {0.55, 1.2, 21, 70}},
                   {Mapping::constant, {0.065, 0.31, 7, 28}, {0.040, 0.30, 7.5, 52}},
                   {Mapping::interpolated, {0.045, 0.25, 9.5, 21}, {0.043, 0.31, 9.5, 50}},
                   {Mapping::normal_offset, {0.045, 0.25, 9.5, 21}, {0.048, 0.25, 10, 50}},
                   {Mapping::trilinear, {0.004, 0.014, 0.5, 3}, {0.010, 0.034, 0.55, 3.6}},
                   {Mapping::frames, {0.003, 0.024, 0.65, 3.3}, {0.0053, 0.020, 0.75, 3.5}}});
}

TEST(Embedding, ASurfaceOverAClothIsFollowedAsWellAsEachModeCan) {
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

TEST(Embedding, MuchSurfaceOnFewNodesIsFollowedAsWellAsEachModeCan) {
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

TEST(Embedding, AutomaticIsNeverWorseThanTheBestOfThePaper) {
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
TEST(Embedding, OnASheetOf18NodesInterpolatedBeatsConstant) {
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
    std::vector<NetSpring> springs;
    for (uvec2 ends : spring_ends(c.body)) springs.push_back({int(ends.x), int(ends.y), 100});
    std::vector<uvec3> faces;
    for (const auto& f : c.body.faces) faces.emplace_back(f[0], f[1], f[2]);
    c.body = net(c.body.positions, std::vector<float>(c.body.count(), 0.01f), springs, faces);
    c.body.spacing = 0.02f;
    return c;
}

TEST(Embedding, AutomaticDoesNotNeedApproximateNormals) {
    const Carrier c = quilt_on_a_flat_net();
    const Embedding skin = embed(c.surface, c.body);
    for (const Deformation* d : {&c.twisted, &c.bent}) {
        EXPECT_LE(misfit(c, skin, *d).rms, 0.01) << d->name;
        EXPECT_LE(misfit(c, skin, *d).rms, best_of_the_paper(c, *d)) << d->name;
    }
}

// Rounding alone must not give a basis its direction.
TEST(Embedding, NormalsThatCancelGiveNoDirection) {
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
TEST(Embedding, FigureFive) {
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
TEST(Embedding, AutomaticOpensNoSeam) {
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

// No solver and no springs in use: a formula says where the nodes are at each time.
TEST(Embedding, AnAnimationDrivesIt) {
    const Carrier c = quilt_on_a_cloth();
    const Embedding frames = embed(c.surface, c.body),
                    bases = embed(c.surface, c.body, Mapping::interpolated);
    for (double time : {0.0, 0.2, 0.7, 1.9}) {
        // A wave that runs along x, 0.6 m long and 0.02 m high.
        const double k = 2 * M_PI / 0.6, a = 0.02;
        auto wave = [=](dvec3 p) { return dvec3(p.x, p.y, p.z + a * std::sin(k * p.x - 3 * time)); };
        auto gradient = [=](dvec3 p) {
            dmat3 f(1);
            f[0].z = a * k * std::cos(k * p.x - 3 * time);
            return f;
        };
        const Deformation d = of_a_sheet({"wave", wave, gradient});
        std::vector<vec3> normals;
        for (std::size_t i = 0; i < c.surface.positions.size(); ++i)
            normals.push_back(d.normal(c.surface.positions[i], c.surface.normals[i]));
        const std::vector<vec3> nodes = d(c.body.positions);

        Moved moved;
        deform(frames, {nodes, {}}, moved.positions, moved.normals);  // needs positions only
        Misfit is = misfit(moved, d(c.surface.positions), normals, c.body.spacing);
        EXPECT_LE(is.rms, 0.006) << time;
        EXPECT_LE(is.mean_angle, 1.0) << time;

        const std::vector<vec3> approximate = approximate_normals(c.body, nodes);
        deform(bases, {nodes, approximate}, moved.positions, moved.normals);
        is = misfit(moved, d(c.surface.positions), normals, c.body.spacing);
        EXPECT_LE(is.rms, 0.015) << time;
        EXPECT_LE(is.mean_angle, 2.0) << time;
    }
}

void expect_upright(const Moved& moved, const Mesh& mesh, const std::string& where) {
    ASSERT_EQ(moved.tangents.size(), mesh.tangents.size()) << where;
    for (std::size_t i = 0; i < moved.tangents.size(); ++i) {
        const vec3 tangent(moved.tangents[i]);
        ASSERT_LE(std::abs(glm::length(tangent) - 1), 1e-5f) << where;
        ASSERT_LE(std::abs(glm::dot(tangent, moved.normals[i])), 1e-5f) << where;
        ASSERT_EQ(moved.tangents[i].w, mesh.tangents[i].w) << where;
    }
}

TEST(Embedding, TangentsStayUprightAndKeepTheirHand) {
    for (Carrier& c : carriers()) {
        give_tangents(c.surface);
        for (Mapping mode : modes_of(c.body))
            for (const Deformation* d : {&c.twisted, &c.bent})
                expect_upright(follow(embed(c.surface, c.body, mode), c.body, (*d)(c.body.positions)),
                               c.surface, c.name + ' ' + std::string(name_of(mode)));
    }
}

TEST(Embedding, TangentsFollowATurnExactly) {
    std::mt19937 random(5);
    for (Carrier& c : carriers()) {
        give_tangents(c.surface);
        for (Mapping mode : modes_of(c.body)) {
            const Embedding skin = embed(c.surface, c.body, mode);
            const Moved rest = follow(skin, c.body, c.body.positions);
            const Turn turn(random);
            const Moved moved = follow(skin, c.body, turn.points(c.body.positions));
            float worst = 0;
            for (std::size_t i = 0; i < rest.tangents.size(); ++i) {
                // One-to-one has the node's normal, so its tangents are upright on that one.
                const vec3 from =
                    mode == Mapping::one_to_one ? vec3(rest.tangents[i]) : vec3(c.surface.tangents[i]);
                const float off = glm::distance(vec3(moved.tangents[i]), turn.direction(from));
                if (!(off <= worst)) worst = off;
            }
            EXPECT_LE(worst, 3e-4f) << c.name << ' ' << name_of(mode);
        }
    }
}

// In cells and frames tangents go by the gradient itself: along the stretched material.
TEST(Embedding, TangentsFollowAStretchInCellsAndFrames) {
    Carrier c = organ_on_a_lattice();
    give_tangents(c.surface);
    const mat3 affine(vec3(1.4f, 0.3f, 0), vec3(-0.3f, 0.8f, 0.2f), vec3(0.1f, 0, 1.1f));
    std::vector<vec3> nodes;
    for (vec3 p : c.body.positions) nodes.push_back(affine * p);
    for (Mapping mode : {Mapping::trilinear, Mapping::frames}) {
        const Moved moved = follow(embed(c.surface, c.body, mode), c.body, nodes);
        for (std::size_t i = 0; i < moved.tangents.size(); ++i)
            ASSERT_LE(
                glm::distance(vec3(moved.tangents[i]), glm::normalize(affine * vec3(c.surface.tangents[i]))),
                3e-5f)
                << name_of(mode);
    }
}

TEST(Embedding, WithoutTangentsThereAreNone) {
    const Carrier c = quilt_on_a_cloth();
    for (Mapping mode : modes_of(c.body))
        EXPECT_TRUE(follow(embed(c.surface, c.body, mode), c.body, c.body.positions).tangents.empty());
}

// Also where the nodes' normals are no help.
TEST(Embedding, CollapsedNodesGiveNoNaN) {
    for (Carrier& c : carriers()) {
        give_tangents(c.surface);
        const std::vector<vec3> point(c.body.count(), vec3(0.01f, 0.02f, 0.03f));
        std::vector<vec3> line, plane, half = c.body.positions;
        for (vec3 p : c.body.positions) {
            line.push_back({p.x, 0, 0});
            plane.push_back({p.x, 0, p.z});
        }
        for (vec3& p : half) p.x = std::max(p.x, 0.0f);
        for (const auto& nodes : {point, line, plane, half})
            for (Mapping mode : modes_of(c.body)) {
                const Embedding skin = embed(c.surface, c.body, mode);
                const std::vector<vec3> nothing(c.body.count(), vec3(0));
                Moved unsaid;
                deform(skin, {nodes, nothing}, unsaid.positions, unsaid.normals, &unsaid.tangents);
                for (const Moved& moved : {follow(skin, c.body, nodes), unsaid}) {
                    expect_upright(moved, c.surface, c.name + ' ' + std::string(name_of(mode)));
                    for (std::size_t i = 0; i < moved.positions.size(); ++i) {
                        ASSERT_LE(glm::length(moved.positions[i]), 1) << name_of(mode);  // fails for NaN too
                        ASSERT_LE(std::abs(glm::length(moved.normals[i]) - 1), 1e-3) << name_of(mode);
                    }
                }
            }
    }
}

// Nodes that lie in one place, or a face without an area, at rest already.
TEST(Embedding, ABodyCollapsedAtRestGivesNoNaN) {
    const std::vector<vec3> positions = {{0, 0, 0}, {0.1f, 0, 0}, {0.2f, 0, 0}, {0.2f, 0, 0}};
    const NetSpring spring{0, 1, 100};
    const std::vector<uvec3> faces = {{0, 1, 2}, {1, 2, 3}, {2, 3, 2}};
    const Body body = net(positions, std::vector<float>(4, 1), {&spring, 1}, faces);
    Mesh mesh = ellipsoid({0.1f, 0.1f, 0.1f}, 10);
    give_tangents(mesh);
    for (Mapping mode : modes_of(body)) {
        const Embedding skin = embed(mesh, body, mode);
        for (const auto& nodes : {positions, std::vector<vec3>(4, vec3(1, 0, 0)),
                                  std::vector<vec3>{{0, 0, 0}, {0, 0.1f, 0}, {0, 0.2f, 0}, {0.1f, 0, 0}}}) {
            const Moved moved = follow(skin, body, nodes);
            expect_upright(moved, mesh, std::string(name_of(mode)));
            for (vec3 p : moved.positions) ASSERT_LE(glm::length(p), 3) << name_of(mode);
            for (vec3 n : moved.normals) ASSERT_LE(std::abs(glm::length(n) - 1), 1e-3) << name_of(mode);
        }
        if (mode != Mapping::one_to_one)
            EXPECT_LE(farthest(follow(skin, body, positions).positions, mesh.positions),
                      mode == Mapping::normal_offset ? 0.2 : 1e-6)
                << name_of(mode);
    }
}

// Two slabs with a gap of about a cell, at many positions in the grid: moving one must not move the other's
// surface.
TEST(Embedding, NoVertexHangsAcrossAGap) {
    const float h = 0.01f;
    for (float gap : {1.05f, 1.4f, 2.0f})
        for (float shift : {0.0f, 0.2f, 0.5f, 0.77f}) {
            const Mesh left = block({0, 0, 0}, {0.033f, 0.06f, 0.06f}, 12);
            const float from = 0.033f + gap * h;
            const Mesh right = block({from, 0, 0}, {from + 0.03f + shift * h, 0.06f, 0.06f}, 12);
            const Mesh mesh = both(left, right);
            const Body body = lattice(mesh, {.spacing = h, .material = tissue});
            // If the two share no node they can be told apart by the middle of the gap.
            const float middle = 0.033f + 0.5f * gap * h;
            std::vector<vec3> nodes = body.positions;
            for (vec3& p : nodes)
                if (p.x > middle) p.x += 1;
            for (Mapping mode : modes_of(body)) {
                const Embedding skin = embed(mesh, body, mode);
                const Moved rest = follow(skin, body, body.positions), moved = follow(skin, body, nodes);
                for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
                    const float went = moved.positions[i].x - rest.positions[i].x;
                    const float should = mesh.positions[i].x > middle ? 1.0f : 0.0f;
                    ASSERT_LE(std::abs(went - should), 1e-4f)
                        << name_of(mode) << " gap " << gap << " shift " << shift << " vertex " << i;
                }
            }
        }
}

TEST(Embedding, ApproximateNormalsPointOutward) {
    const Body body = lattice({5, 5, 5}, 0.01f, tissue);
    const std::vector<vec3> normals = approximate_normals(body, body.positions);
    for (std::size_t i = 0; i < body.count(); ++i) {
        const vec3 out = vec3(body.stencil().at[i]) - 2.0f;
        const bool inside = glm::all(glm::lessThan(glm::abs(out), vec3(1.5f)));
        if (inside)
            EXPECT_LE(glm::length(normals[i]), 1e-5);
        else
            EXPECT_GT(glm::dot(glm::normalize(normals[i]), glm::normalize(out)), 0.8f);
    }
}

// The nearest of many triangles is found, whatever their sizes, also from afar.
TEST(Embedding, TheNearestFaceIsFound) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-1, 1);
    std::vector<vec3> positions = {{-9, -9, -2}, {9, -9, -2}, {0, 9, -2}};
    for (int i = 0; i < 1500; ++i) positions.push_back({any(random), any(random), 0.2f * any(random)});
    for (int i = 3; i < 1503; i += 3)  // small ones beside one large one
        for (int k = 1; k < 3; ++k) positions[i + k] = positions[i] + 0.05f * positions[i + k];
    std::vector<uvec3> faces;
    for (unsigned i = 0; i < positions.size(); i += 3) faces.emplace_back(i, i + 1, i + 2);
    Body body = net(positions, std::vector<float>(positions.size(), 1), {}, faces);
    body.fan = 1;  // a sheet: both sides alike. Nothing else looks at it here
    body.springs = Table{1, std::vector<Tie>(positions.size())};
    Mesh points;
    for (int i = 0; i < 300; ++i)
        points.positions.push_back(vec3(any(random), any(random), any(random)) * (i % 3 == 0 ? 30.0f : 1.5f));
    points.normals.assign(points.positions.size(), vec3(0, 0, 1));
    const Embedding skin = embed(points, body, Mapping::constant);
    const auto& vertices = std::get<std::vector<OnTriangle>>(skin.vertices);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        float least = 1e30f;
        for (uvec3 f : faces) {
            const vec3 a = positions[f.x], b = positions[f.y], c = positions[f.z];
            const vec3 w = nearest_weights(points.positions[i], a, b, c);
            least = std::min(least, glm::distance(points.positions[i], w.x * a + w.y * b + w.z * c));
        }
        EXPECT_LE(glm::length(vertices[i].offset), least * 1.0001f + 1e-6f) << i;
    }
}

TEST(Embedding, AnEmptySurfaceIsEmpty) {
    for (const Carrier& c : carriers())
        for (Mapping mode : modes_of(c.body)) {
            const Embedding skin = embed(Mesh{}, c.body, mode);
            Moved moved{{vec3(1)}, {vec3(1)}, {vec4(1)}};
            deform(skin, {c.body.positions, {}}, moved.positions, moved.normals, &moved.tangents);
            EXPECT_TRUE(moved.positions.empty() && moved.normals.empty() && moved.tangents.empty());
        }
}

std::string refusal(const Body& body, Mapping mode) {
    try {
        embed(organ(), body, mode);
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

TEST(Embedding, WhatNothingCanHangOnIsRefused) {
    const Body thread = lattice({5, 1, 1}, 0.01f, tissue);
    for (const auto& mode : names(Mapping{})) EXPECT_NE(refusal(thread, mode.value), "") << mode.name;
    const Body sheet = quilt_on_a_cloth().body;
    EXPECT_NE(refusal(sheet, Mapping::trilinear).find("trilinear"), std::string::npos);
    EXPECT_NE(refusal(sheet, Mapping::trilinear).find("frames"), std::string::npos) << "no remedy";
    EXPECT_EQ(refusal(sheet, Mapping::automatic), "");
}

}  // namespace
}  // namespace palpate
