#include "palpate/mesh/repair.h"

#include "palpate/base/error.h"
#include "palpate/mesh/intersections.h"
#include "tests/mesh/shapes.h"
#include "tests/refusal.h"

#include <gtest/gtest.h>

#include <functional>
#include <string>

namespace palpate {
namespace {

constexpr double ball_volume = 4.0 / 3 * M_PI;

std::size_t count(const std::vector<Repair>& steps, const std::string& what) {
    std::size_t sum = 0;
    for (const Repair& step : steps)
        if (step.what.find(what) != std::string::npos) sum += step.count;
    return sum;
}

std::string told(const std::vector<Repair>& steps) {
    std::string text;
    for (const Repair& step : steps) text += std::to_string(step.count) + " " + step.what + "; ";
    return text;
}

void expect_sound(const Mesh& mesh) {
    const Soundness found = soundness(mesh);
    EXPECT_TRUE(found.closed());
    EXPECT_EQ(found.shared_vertices, 0u);
    EXPECT_EQ(found.unused_vertices, 0u);
    EXPECT_TRUE(volume(mesh) > 0);
    for (vec3 p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
    for (std::size_t size : {mesh.normals.size(), mesh.uvs.size(), mesh.tangents.size()})
        EXPECT_TRUE(size == 0 || size == mesh.positions.size());
}

std::string refusal(Mesh mesh, RepairSettings settings = {}) {
    settings.name = "FILE";
    const std::string said = palpate::refusal([&] { repair(mesh, settings); });
    EXPECT_NE(said.find("FILE"), said.npos) << said;
    return said;
}

// ---- what is sound stays as it is ----

TEST(Repair, ASoundMeshStaysAsItIs) {
    const Mesh touching = both(box(vec3(0), vec3(1)), box(vec3(1), vec3(2)));
    const Mesh hollow = both(sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.5f, 3)));
    for (Mesh mesh : {box(vec3(0), vec3(1)), sphere(vec3(7e5f), 31, 4), torus(2e-20f, 1e-20f, 30, 20),
                      torus(2e30f, 1e30f, 30, 20), touching, hollow}) {
        compute_normals(mesh);
        const Mesh before = mesh;
        const std::vector<Repair> steps = repair(mesh);
        EXPECT_TRUE(steps.empty()) << told(steps);
        EXPECT_EQ(mesh.positions, before.positions);
        EXPECT_EQ(mesh.normals, before.normals);
        EXPECT_EQ(mesh.triangles, before.triangles);
    }
}

// ---- random damage ----

struct Damage {
    const char* name;
    std::function<void(Mesh&, std::mt19937&)> do_to;
};

const Damage damages[] = {
    {"faces of their own", [](Mesh& mesh, std::mt19937&) { mesh = soup(mesh); }},
    {"faces deleted",
     [](Mesh& mesh, std::mt19937& random) {
         std::erase_if(mesh.triangles, [&](uvec3) { return random() % 40 == 0; });
     }},
    {"faces flipped",
     [](Mesh& mesh, std::mt19937& random) {
         for (uvec3& t : mesh.triangles)
             if (random() % 2) std::swap(t.y, t.z);
     }},
    {"inside out", [](Mesh& mesh, std::mt19937&) { mesh = inside_out(mesh); }},
    {"faces twice",
     [](Mesh& mesh, std::mt19937& random) {
         const std::vector<uvec3> once = mesh.triangles;
         for (uvec3 t : once)
             if (random() % 3 == 0) mesh.triangles.push_back({t.y, t.z, t.x});
     }},
    {"both sides written",
     [](Mesh& mesh, std::mt19937&) {
         const std::vector<uvec3> other = inside_out(mesh).triangles;
         mesh.triangles.insert(mesh.triangles.end(), other.begin(), other.end());
     }},
    {"seams a hair wide",
     [](Mesh& mesh, std::mt19937& random) {
         mesh = soup(mesh);
         std::uniform_real_distribution<float> hair(-1e-6f, 1e-6f);
         for (vec3& p : mesh.positions) p += vec3(hair(random), hair(random), hair(random));
     }},
    {"flat and collapsed faces",
     [](Mesh& mesh, std::mt19937& random) {
         for (int i = 0; i < 30; ++i) {
             const std::size_t face = random() % mesh.triangles.size();
             const uvec3 t = mesh.triangles[face];
             const auto v = unsigned(mesh.positions.size());
             mesh.positions.push_back(0.5f * (mesh.positions[t.x] + mesh.positions[t.y]));
             mesh.triangles[face] = {t.x, t.y, v};
             mesh.triangles.insert(mesh.triangles.end(), {{t.y, t.z, v}, {t.z, t.x, v}, {v, v, t.x}});
         }
     }},
    {"T-junctions",
     [](Mesh& mesh, std::mt19937& random) {
         for (int i = 0; i < 20; ++i) {  // a face in two, not so its neighbour
             const std::size_t face = random() % mesh.triangles.size();
             const uvec3 t = mesh.triangles[face];
             const auto v = unsigned(mesh.positions.size());
             mesh.positions.push_back(0.5f * (mesh.positions[t.x] + mesh.positions[t.y]));
             mesh.triangles[face] = {t.x, v, t.z};
             mesh.triangles.push_back({v, t.y, t.z});
         }
     }},
    {"fins and specks",
     [](Mesh& mesh, std::mt19937& random) {
         for (int i = 0; i < 20; ++i) {
             const uvec3 t = mesh.triangles[random() % mesh.triangles.size()];
             const auto v = unsigned(mesh.positions.size());
             mesh.positions.push_back(1.2f * mesh.positions[t.x]);
             mesh.triangles.push_back({t.x, t.y, v});
             mesh = both(mesh, sphere(1.5f * mesh.positions[t.z], 0.003f, 1));
         }
     }},
};

TEST(Repair, RandomDamageIsMendedByTheWalls) {
    const Mesh shapes[] = {sphere(vec3(0), 1, 4), torus(1, 0.4f, 60, 30), [] {
                               Mesh cube = block(vec3(-0.8f), vec3(0.8f), 9);
                               cube.normals.clear();
                               weld(cube);
                               return cube;
                           }()};
    for (const Mesh& shape : shapes)
        for (const Damage& damage : damages)
            for (unsigned seed = 0; seed < 3; ++seed) {
                SCOPED_TRACE(damage.name);
                std::mt19937 random(seed);
                Mesh mesh = shape;
                damage.do_to(mesh, random);
                const std::vector<Repair> steps = repair(mesh);
                SCOPED_TRACE(told(steps));
                EXPECT_FALSE(steps.empty());
                EXPECT_EQ(count(steps, "voxels"), 0u);
                expect_sound(mesh);
                EXPECT_EQ(soundness(mesh).parts, 1u);
                EXPECT_EQ(soundness(mesh).euler, soundness(shape).euler);
                EXPECT_TRUE(std::abs(volume(mesh) / volume(shape) - 1) <= 0.005);
                const Mesh mended = mesh;
                EXPECT_TRUE(repair(mesh).empty());
                EXPECT_EQ(mesh.positions, mended.positions);
                EXPECT_EQ(mesh.triangles, mended.triangles);
            }
}

TEST(Repair, AllDamageAtOnce) {
    for (unsigned seed = 0; seed < 6; ++seed) {
        std::mt19937 random(seed);
        Mesh mesh = sphere(vec3(0), 1, 5);
        for (const char* name :
             {"flat and collapsed faces", "fins and specks", "faces flipped", "faces deleted", "faces twice"})
            for (const Damage& damage : damages)
                if (std::string(damage.name) == name) damage.do_to(mesh, random);
        const std::vector<Repair> steps = repair(mesh);
        SCOPED_TRACE(told(steps));
        expect_sound(mesh);
        EXPECT_TRUE(std::abs(volume(mesh) / ball_volume - 1) <= 0.03) << volume(mesh);
    }
}

// ---- what the walls cannot give ----

TEST(Repair, OverlappingBallsAreJoinedByVoxels) {
    const vec3 off(0.97f, 0.23f, 0.05f);
    Mesh mesh = both(sphere(vec3(0), 1, 5), inside_out(sphere(off, 1, 5)));
    const std::size_t before = mesh.triangles.size();
    const std::vector<Repair> steps = repair(mesh, {.voxel = 0.03f});
    EXPECT_GT(count(steps, "made by voxels, because"), 0u) << told(steps);
    EXPECT_GT(count(steps, "cut through each other"), 0u) << told(steps);
    expect_sound(mesh);
    EXPECT_LE(mesh.triangles.size(), before);
    const double apart = double(glm::length(off)),
                 shared = M_PI * (4 + apart) * (2 - apart) * (2 - apart) / 12;
    EXPECT_TRUE(std::abs(volume(mesh) / (2 * ball_volume - shared) - 1) <= 0.01);
    EXPECT_EQ(soundness(mesh).parts, 1u);
    EXPECT_TRUE(intersections(mesh).faces.empty());
}

TEST(Repair, CubesWithAlignedWallsAreJoinedToo) {
    // Side upon side and edge upon edge: no face passes through another.
    Mesh mesh = both(box(vec3(0), vec3(1)), box(vec3(0.5f, 0, 0), vec3(1.5f, 1, 1)));
    const std::vector<Repair> steps = repair(mesh);
    EXPECT_GT(count(steps, "partly inside others"), 0u) << told(steps);
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) / 1.5 - 1) <= 0.01);
    Mesh bricks = both(box(vec3(0), vec3(1)), box(vec3(1, 0, 0), vec3(2, 1, 1)));
    EXPECT_TRUE(repair(bricks).empty()) << "they only touch";
}

TEST(Repair, ATetrahedronWithoutOneFaceIsCompleted) {
    Mesh mesh{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1)}, {}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}};
    repair(mesh);
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) - 1.0 / 6) <= 1e-6);
}

TEST(Repair, VoxelsAtOnceWhereAsked) {
    Mesh mesh = sphere(vec3(0), 1, 5);
    const std::vector<Repair> steps = repair(mesh, {.solid = SolidBy::voxels, .voxel = 0.05f});
    EXPECT_GT(count(steps, "made by voxels"), 0u);
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) / ball_volume - 1) <= 0.01);
}

TEST(Repair, AKleinBottleIsASolidOrAnError) {
    // The figure-of-eight immersion: closed, one-sided, cutting through itself.
    Mesh mesh;
    const unsigned n = 48, m = 24;
    for (unsigned i = 0; i < n; ++i)
        for (unsigned j = 0; j < m; ++j) {
            const float u = 2 * float(M_PI) * float(i) / n, v = 2 * float(M_PI) * float(j) / m;
            const float across = std::cos(u / 2) * std::sin(v) - std::sin(u / 2) * std::sin(2 * v);
            const float up = std::sin(u / 2) * std::sin(v) + std::cos(u / 2) * std::sin(2 * v);
            mesh.positions.push_back({(2 + across) * std::cos(u), (2 + across) * std::sin(u), up});
            auto at = [&](unsigned a, unsigned b) {  // after one round, v runs backwards
                return a == n ? (m - b % m) % m : a * m + b % m;
            };
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    EXPECT_EQ(soundness(mesh).one_sided_parts, 1u);
    try {
        const std::vector<Repair> steps = repair(mesh, {.voxel = 0.06f});
        EXPECT_GT(count(steps, "1 part has one side only"), 0u);
        expect_sound(mesh);
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("no inside"), std::string::npos);
    }
}

TEST(Repair, WhatHasNoInsideIsAnErrorThatSaysWhatToDo) {
    std::mt19937 random(1);
    Mesh line, point;
    for (unsigned i = 0; i < 100; ++i) {
        line.positions.push_back(vec3(1, 2, 3) * float(random() % 1000));
        point.positions.push_back(vec3(4, 5, 6));
    }
    for (unsigned i = 0; i + 2 < 100; ++i) {
        line.triangles.push_back({i, i + 1, i + 2});
        point.triangles.push_back({i, i + 1, i + 2});
    }
    Mesh sheet;
    for (unsigned y = 0; y < 20; ++y)
        for (unsigned x = 0; x < 20; ++x) {
            sheet.positions.push_back({x, y, 0.1f * float(x)});
            const unsigned i = 20 * y + x;
            if (x < 19 && y < 19)
                sheet.triangles.insert(sheet.triangles.end(), {{i, i + 1, i + 21}, {i, i + 21, i + 20}});
        }
    const Mesh one{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)}, {}, {{0, 1, 2}}};
    for (const Mesh& mesh : {Mesh{}, one, line, point, sheet, band(0.4f, 1, 60), band(0.4f, 3, 80)})
        for (float scale : {1.0f, 1e-20f, 1e25f}) {
            Mesh scaled = mesh;
            for (vec3& p : scaled.positions) p *= scale;
            const vec3 size = bounds(scaled).size();
            const std::string said = refusal(scaled, {.voxel = std::max({size.x, size.y, size.z}) / 60});
            EXPECT_NE(said.find("sheet = true"), std::string::npos) << said;
        }
    Mesh broken = box(vec3(0), vec3(1));
    broken.positions[3].y = NAN;
    EXPECT_NE(refusal(broken).find("not finite"), std::string::npos);
}

TEST(Repair, ASheetStaysOne) {
    Mesh moebius = soup(band(0.5f, 1, 50));
    moebius.uvs.resize(moebius.positions.size());
    moebius.tangents.resize(moebius.positions.size());
    const std::vector<Repair> steps = repair(moebius, {.sheet = true});
    EXPECT_EQ(count(steps, "welded"), 200u) << told(steps);
    EXPECT_EQ(moebius.triangles.size(), 100u);
    EXPECT_TRUE(moebius.uvs.empty() && moebius.tangents.empty());
    Mesh square{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 1, 0)}, {}, {{0, 1, 2}, {1, 2, 3}}};
    repair(square, {.sheet = true});
    EXPECT_EQ(soundness(square).bad_edges, 0u);
    EXPECT_EQ(soundness(square).open_edges, 4u);
}

// ---- single cases ----

TEST(Repair, BallInBall) {
    const Mesh ball = sphere(vec3(0), 1, 4), core = sphere(vec3(0.1f), 0.5f, 4);
    Mesh mesh = both(ball, core);
    EXPECT_EQ(count(repair(mesh), "inside another"), 1u);
    EXPECT_EQ(mesh.triangles, ball.triangles);
    mesh = both(ball, inside_out(core));
    EXPECT_TRUE(repair(mesh).empty());
    mesh = inside_out(mesh);
    repair(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) - volume(ball) + volume(core)) <= 1e-6);
}

TEST(Repair, KeepsTheLargestPartWhereAsked) {
    Mesh mesh = both(sphere(vec3(0), 1, 3), sphere(vec3(5), 1, 4));
    EXPECT_EQ(count(repair(mesh, {.largest = true}), "smaller parts dropped"), 1u);
    EXPECT_EQ(mesh.triangles, sphere(vec3(5), 1, 4).triangles);
}

const Repair& step_of(const std::vector<Repair>& steps, const std::string& what) {
    static const Repair none;
    for (const Repair& step : steps)
        if (step.what == what) return step;
    ADD_FAILURE() << "no " << what << " in " << told(steps);
    return none;
}

TEST(Repair, WhatIsDroppedIsSaidWithItsShare) {
    for (const float scale : {1e-20f, 1.0f, 1e9f}) {
        Mesh mesh = both(box(vec3(0), vec3(1)), both(box(vec3(2), vec3(2.5f)), box(vec3(4), vec3(4.02f))));
        for (vec3& p : mesh.positions) p *= scale;
        const std::vector<Repair> steps = repair(mesh, {.specks = 0.03f, .largest = true});
        const double whole = 1.125 + 0.02 * 0.02 * 0.02, unit = std::pow(double(scale), 3);
        const Repair &parts = step_of(steps, "smaller parts dropped"),
                     &specks = step_of(steps, "specks dropped");
        EXPECT_TRUE(std::abs(parts.share - 0.125 / whole) <= 1e-5) << parts.share;
        EXPECT_TRUE(std::abs(parts.volume / unit / 0.125 - 1) <= 1e-5) << parts.volume;
        EXPECT_TRUE(std::abs(specks.share / (8e-6 / whole) - 1) <= 0.01) << specks.share;
        EXPECT_EQ(mesh.triangles.size(), 12u);
    }
    EXPECT_EQ(in_words({"specks dropped", 3, 4.1e-7, 0.002}),
              "specks dropped: 3 (0.2 % of the volume, 0.41 ml)");
    EXPECT_EQ(in_words({"vertices welded", 214}), "vertices welded: 214");
}

TEST(Repair, AnOrganOfManyPartsStaysWhole) {
    // Five boxes in a row that overlap, each smaller than the box beside them, which has most faces.
    Mesh mesh = both(sphere({0, 5, 0}, 0.7f, 4), box(vec3(0), vec3(1)));
    for (int i = 1; i < 5; ++i) mesh = both(mesh, box({0.9f * float(i), 0, 0}, {0.9f * float(i) + 1, 1, 1}));
    const std::vector<Repair> steps = repair(mesh, {.largest = true, .voxel = 0.04f});
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) / 4.6 - 1) <= 0.02) << volume(mesh);
    EXPECT_EQ(soundness(mesh).parts, 1u);
    const double ball = volume(sphere(vec3(0), 0.7f, 4));
    EXPECT_TRUE(std::abs(step_of(steps, "smaller parts dropped").share / (ball / (4.6 + ball)) - 1) <= 0.02);
}

TEST(Repair, LidsAndSheetsAreSaidByTheirArea) {
    Mesh mesh = box(vec3(0), vec3(1));
    mesh.triangles.resize(10);  // without the side at x = 1
    mesh = both(mesh, Mesh{{vec3(3), vec3(4, 3, 3), vec3(3, 4, 3)}, {}, {{0, 1, 2}}});
    const std::vector<Repair> steps = repair(mesh);
    EXPECT_TRUE(std::abs(step_of(steps, "holes closed").share - 1.5 / 7) <= 1e-5)
        << step_of(steps, "holes closed").share;  // one on the triangle, too
    EXPECT_TRUE(std::abs(step_of(steps, "sheets dropped that enclose nothing").share - 1 / 7.0) <= 1e-5);
    expect_sound(mesh);
}

TEST(Repair, WeldsAsFarAsTold) {
    Mesh mesh = soup(sphere(vec3(0), 1, 4));
    std::mt19937 random(2);
    std::uniform_real_distribution<float> any(-1e-3f, 1e-3f);
    for (vec3& p : mesh.positions) p += vec3(any(random), any(random), any(random));
    EXPECT_GT(count(repair(mesh, {.weld = 4e-3f}), "welded"), 0u);
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) / ball_volume - 1) <= 0.02);
}

TEST(Repair, ABowlOfAnySize) {
    for (float scale : {1e-20f, 1.0f, 1e30f}) {
        Mesh mesh = sphere(vec3(0.2f), 1, 5);
        std::erase_if(mesh.triangles, [&](uvec3 t) {
            return mesh.positions[t.x].z + mesh.positions[t.y].z + mesh.positions[t.z].z > 0.6f;
        });
        for (vec3& p : mesh.positions) p *= scale;
        const std::vector<Repair> steps = repair(mesh);
        EXPECT_EQ(count(steps, "holes closed"), 1u) << told(steps);
        expect_sound(mesh);
        const double unit = double(scale) * double(scale) * double(scale);
        EXPECT_TRUE(std::abs(volume(mesh) / unit / (ball_volume / 2) - 1) <= 0.02);
    }
}

TEST(Repair, AVertexOfFiveThousandFaces) {
    // A cone: 5,000 faces around its tip, and as many around the middle of its base.
    Mesh mesh{{vec3(0, 0, 1), vec3(0)}, {}, {}};
    const unsigned n = 5000;
    for (unsigned i = 0; i < n; ++i) {
        const float a = 2 * float(M_PI) * float(i) / n;
        mesh.positions.push_back({std::cos(a), std::sin(a), 0});
        const unsigned here = 2 + i, next = 2 + (i + 1) % n;
        mesh.triangles.insert(mesh.triangles.end(), {{0, here, next}, {1, next, here}});
    }
    const Mesh cone = mesh;
    std::vector<Repair> steps = repair(mesh);
    EXPECT_EQ(steps.size(), 1u) << told(steps);
    EXPECT_EQ(count(steps, "faces too crowded to be searched for cuts"), 2 * n) << told(steps);
    EXPECT_TRUE(mesh.positions == cone.positions && mesh.triangles == cone.triangles);
    mesh.triangles.resize(mesh.triangles.size() / 2);  // half of it is gone
    steps = repair(mesh);
    EXPECT_EQ(count(steps, "holes closed"), 1u) << told(steps);
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) / (M_PI / 6) - 1) <= 0.01) << volume(mesh);
}

TEST(Repair, TheCapsOfAHugePrism) {
    // The walls alone, so that both caps are holes of 50,000 sides.
    Mesh mesh;
    const unsigned n = 50'000;
    for (unsigned i = 0; i < n; ++i) {
        const float a = 2 * float(M_PI) * float(i) / n;
        mesh.positions.push_back({std::cos(a), std::sin(a), 0});
        mesh.positions.push_back({std::cos(a), std::sin(a), 1});
        const unsigned next = 2 * ((i + 1) % n);
        mesh.triangles.insert(mesh.triangles.end(), {{2 * i, next, next + 1}, {2 * i, next + 1, 2 * i + 1}});
    }
    const std::vector<Repair> steps = repair(mesh);
    EXPECT_EQ(count(steps, "holes closed"), 2u) << told(steps);
    expect_sound(mesh);
    EXPECT_TRUE(std::abs(volume(mesh) / M_PI - 1) <= 0.01);
}

}  // namespace
}  // namespace palpate
