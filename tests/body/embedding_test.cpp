// What holds of every mapping: rest, rigid motion, tangents, collapse, gaps.
#include "palpate/body/embedding.h"

#include "bench/deformations.h"
#include "palpate/base/team.h"
#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/mesh/triangle.h"
#include "tests/body/turn.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace palpate {
namespace {

const Material of_springs{.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs};

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

std::vector<vec3> along(const std::vector<vec4>& tangents) { return {tangents.begin(), tangents.end()}; }

TEST(Embedding, TheRestSurfaceMapsToItself) {
    std::vector<Carrier> all = carriers();
    const Mesh mesh = organ();
    for (float spacing : {0.004f, 0.011f, 0.03f})
        all.push_back({"organ", mesh, lattice(mesh, {.spacing = spacing, .material = of_springs}), {}, {}});
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

// Turns, and mirror images, of bodies whose grid lies along the axes.
std::vector<mat3> ways_to_lie() {
    std::mt19937 random(16);
    std::vector<mat3> ways = {mat3(-1, 0, 0, 0, 1, 0, 0, 0, -1), mat3(-1, 0, 0, 0, 1, 0, 0, 0, 1),
                              mat3(0, 1, 0, 1, 0, 0, 0, 0, 1), mat3(0, 0, 1, 1, 0, 0, 0, 1, 0), mat3(-1)};
    for (int i = 0; i < 4; ++i) ways.push_back(mat3(Turn(random).turn) * mat3(i % 2 == 0 ? 1.0f : -1.0f));
    return ways;
}

Mesh transformed(Mesh mesh, const mat3& way, vec3 shift) {
    const bool mirrored = glm::determinant(way) < 0;
    for (vec3& p : mesh.positions) p = way * p + shift;
    for (vec3& n : mesh.normals) n = way * n;
    for (vec4& t : mesh.tangents) t = vec4(way * vec3(t), mirrored ? -t.w : t.w);
    for (uvec3& t : mesh.triangles)
        if (mirrored) std::swap(t.y, t.z);
    return mesh;
}

// However a body lies, a surface hangs on it as on one whose grid lies along the axes.
TEST(Embedding, ABodyMayLieTurned) {
    Mesh mesh = ellipsoid({0.05f, 0.04f, 0.06f}, 16);
    give_tangents(mesh);
    const Body body = lattice(mesh, {.spacing = 0.011f, .material = of_springs});
    const Deformation bending = bend({0, 0, 1}, {1, 0, 0}, 0.12);
    for (const mat3& way : ways_to_lie()) {
        const vec3 shift(0.02f, -0.01f, 0.03f);
        const Mesh surface = transformed(mesh, way, shift);
        Body lying = body;
        for (vec3& p : lying.positions) p = way * p + shift;
        for (Mapping mode : modes_of(body)) {
            SCOPED_TRACE(name_of(mode));
            const Embedding skin = embed(surface, lying, mode);
            const Moved rest = follow(skin, lying, lying.positions);
            if (mode != Mapping::one_to_one && mode != Mapping::normal_offset) {  // see the tests around
                EXPECT_LE(farthest(rest.positions, surface.positions), 1e-6 * size_of(mesh));
                EXPECT_LE(farthest(rest.normals, surface.normals), 1e-5);
                EXPECT_LE(farthest(along(rest.tangents), along(surface.tangents)), 1e-5);
            }
            const Moved straight = follow(embed(mesh, body, mode), body, bending(body.positions));
            std::vector<vec3> nodes = bending(body.positions);
            for (vec3& p : nodes) p = way * p + shift;
            const Moved moved = follow(skin, lying, nodes);
            // Where two cells or triangles are equally near, rounding may take the other: a few vertices. And
            // in a mirror image an interpolated basis begins along another side of each triangle.
            std::size_t others = 0;
            double most = 0;
            for (std::size_t i = 0; i < moved.positions.size(); ++i) {
                const double off =
                    glm::distance(dvec3(moved.positions[i]), dvec3(way * straight.positions[i] + shift));
                others += !(off <= 1e-5 * size_of(mesh));
                if (!(off <= most)) most = off;
            }
            if (mode != Mapping::interpolated || glm::determinant(way) > 0)
                EXPECT_LE(double(others), 0.02 * double(moved.positions.size()));
            EXPECT_LE(most, 0.6 * body.spacing);
        }
    }
}

TEST(Hull, LooksOutwardsHoweverItLies) {
    const Body body = lattice(organ(), {.spacing = 0.011f, .material = of_springs});
    const Mesh straight = hull_mesh(body);
    for (const mat3& way : ways_to_lie()) {
        Body lying = body;
        for (vec3& p : lying.positions) p = way * p + vec3(0.02f, -0.01f, 0.03f);
        const Mesh mesh = hull_mesh(lying);
        EXPECT_EQ(mesh.positions.size(), straight.positions.size());
        EXPECT_NEAR(volume(mesh), volume(straight), 1e-5 * volume(straight));
        for (uvec3 t : mesh.triangles) {
            const vec3 a = mesh.positions[t.x];
            const vec3 out = glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
            for (int k = 0; k < 3; ++k) ASSERT_LE(glm::distance(mesh.normals[t[k]], out), 1e-5f);
        }
        EXPECT_EQ(inverted_cells(lying, lying.positions), 0u);
        std::vector<vec3> flat = lying.positions;
        for (vec3& p : flat) p.y = 0;
        EXPECT_EQ(inverted_cells(lying, flat), lying.cells.size());
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
                // One-to-one has the node's normal, so its tangents are upright on that one.
                const bool on_nodes = mode == Mapping::one_to_one;
                ASSERT_EQ(moved.tangents.size(), c.surface.positions.size());
                const std::vector<vec4>& upright = on_nodes ? rest.tangents : c.surface.tangents;
                EXPECT_LE(farthest(along(moved.tangents), turn.directions(along(upright))), 3e-4)
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
// The first few of an embedding's vertices.
Embedding first_of(Embedding skin, std::size_t count) {
    std::visit(
        [&](auto& vertices) {
            if constexpr (requires { vertices.vertices; })
                vertices.vertices.resize(count);
            else
                vertices.resize(count);
        },
        skin.vertices);
    skin.tangents.resize(count);
    return skin;
}

// Vertices are carried many at once: it must not matter which are beside each other, nor who carries them.
TEST(Embedding, EachVertexIsTheSameToTheBitBesideAnyOther) {
    Mesh surface = organ();
    give_tangents(surface);
    const Body body = lattice(surface, {.nodes = 900, .material = of_springs});
    std::vector<vec3> nodes;
    for (vec3 p : body.positions)
        nodes.push_back(p + 0.004f * vec3(std::sin(90 * p.y), std::cos(70 * p.z), p.x));
    const std::vector<vec3> facing = approximate_normals(body, nodes);
    for (Mapping mode : modes_of(body)) {
        SCOPED_TRACE(name_of(mode));
        const Embedding skin = embed(surface, body, mode);
        std::vector<vec3> positions, normals, some, some_normals;
        std::vector<vec4> tangents, some_tangents;
        deform(skin, {nodes, facing}, positions, normals, &tangents);
        for (std::size_t count : {0, 1, 2, 3, 7, 8, 9, 15, 16, 17, 33}) {
            deform(first_of(skin, count), {nodes, facing}, some, some_normals, &some_tangents);
            ASSERT_EQ(some.size(), count);
            EXPECT_TRUE(std::equal(some.begin(), some.end(), positions.begin())) << count;
            EXPECT_TRUE(std::equal(some_normals.begin(), some_normals.end(), normals.begin())) << count;
            EXPECT_TRUE(std::equal(some_tangents.begin(), some_tangents.end(), tangents.begin())) << count;
        }
        for (int members : {1, 2, 3, 5}) {
            Team team(members);
            deform(skin, {nodes, facing}, some, some_normals, &some_tangents, &team);
            EXPECT_TRUE(some == positions && some_normals == normals && some_tangents == tangents) << members;
        }
    }
}

// Any part of a surface moves as in the whole, to the bit.
TEST(Embedding, APartFollowsAsTheWholeDoes) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> shake(-0.003f, 0.003f);
    for (const Carrier& c : {organ_on_a_lattice(), quilt_on_a_cloth()})
        for (const auto& mapping : names(Mapping{})) {
            if (mapping.value == Mapping::trilinear && c.body.cells.empty()) continue;
            const Embedding whole = embed(c.surface, c.body, mapping.value);
            std::vector<vec3> nodes = c.body.positions;
            for (vec3& p : nodes) p += vec3(shake(random), shake(random), shake(random));
            const std::vector<vec3> normals = approximate_normals(c.body, nodes);
            std::vector<unsigned> some;
            for (unsigned v = 0; v < c.surface.positions.size(); ++v)
                if (random() % 7 == 0) some.push_back(v);
            std::ranges::shuffle(some, random);
            std::vector<vec3> all, part;
            deform(whole, {nodes, normals}, all);
            deform(part_of(whole, some), {nodes, normals}, part);
            ASSERT_EQ(part.size(), some.size());
            for (std::size_t i = 0; i < some.size(); ++i)
                ASSERT_EQ(part[i], all[some[i]]) << c.name << " " << mapping.name;
        }
}

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
    const Spring spring{0, 1, 100};
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
            const Body body = lattice(mesh, {.spacing = h, .material = of_springs});
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
    const Body body = lattice({5, 5, 5}, 0.01f, of_springs);
    const std::vector<vec3> normals = approximate_normals(body, body.positions);
    for (std::size_t i = 0; i < body.count(); ++i) {
        const vec3 out = vec3(body.at[i]) - 2.0f;
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
    body.rings.assign(positions.size(), -1);
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
    return palpate::refusal([&] { embed(organ(), body, mode); });
}

TEST(Embedding, WhatNothingCanHangOnIsRefused) {
    const Body thread = lattice({5, 1, 1}, 0.01f, of_springs);
    for (const auto& mode : names(Mapping{})) EXPECT_NE(refusal(thread, mode.value), "") << mode.name;
    const Body sheet = quilt_on_a_cloth().body;
    EXPECT_NE(refusal(sheet, Mapping::trilinear).find("trilinear"), std::string::npos);
    EXPECT_NE(refusal(sheet, Mapping::trilinear).find("frames"), std::string::npos) << "no remedy";
    EXPECT_EQ(refusal(sheet, Mapping::automatic), "");
}

}  // namespace
}  // namespace palpate
