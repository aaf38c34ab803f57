#include "palpate/files/read.h"
#include "palpate/mesh/repair.h"
#include "palpate/voxels/isosurface.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace palpate {
namespace {

TEST(Weld, MakesASoupABoxAgain) {
    Mesh mesh = soup(box(vec3(0), vec3(1)));
    mesh.normals.resize(mesh.positions.size());
    EXPECT_EQ(weld(mesh), 28u);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(volume(mesh), 1);
    expect_closed(mesh);
    EXPECT_EQ(weld(mesh), 0u);
}

TEST(Weld, MinusZeroIsZero) {
    Mesh mesh{{vec3(0.0f), vec3(-0.0f), vec3(1e-30f)}, {}, {{0, 1, 2}}};
    EXPECT_EQ(weld(mesh), 1u);
    EXPECT_EQ(mesh.triangles[0], uvec3(0, 0, 1));
}

TEST(Weld, WithinToleranceAlsoAcrossCells) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-1, 1);
    for (float tolerance : {0.01f, 0.1f, 0.5f}) {
        Mesh mesh;
        for (int i = 0; i < 1500; ++i) mesh.positions.push_back({any(random), any(random), any(random)});
        for (unsigned i = 0; i + 2 < 1500; i += 3) mesh.triangles.push_back({i, i + 1, i + 2});
        const Mesh before = mesh;
        weld(mesh, tolerance);
        for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
            for (int k = 0; k < 3; ++k)
                EXPECT_LE(glm::distance(mesh.positions[mesh.triangles[f][k]],
                                        before.positions[before.triangles[f][k]]),
                          tolerance);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_GT(glm::distance(mesh.positions[i], mesh.positions[j]), tolerance);
    }
}

TEST(Weld, ToleratesExtremes) {
    for (float tolerance : {1e-38f, 1e30f}) {
        Mesh mesh = soup(sphere(vec3(1e6f), 1, 2));
        weld(mesh, tolerance);
        EXPECT_EQ(mesh.positions.size() == 1, tolerance > 1);
    }
}

TEST(DropCollapsed, DropsWhatIsNoFaceOfItsOwn) {
    Mesh mesh = box(vec3(0), vec3(1));
    mesh.positions.push_back(vec3(9));  // unused
    mesh.triangles.insert(mesh.triangles.end(),
                          {{1, 1, 2}, {3, 3, 3}, {2, 1, 0}});  // collapsed, collapsed, a copy
    mesh.normals.resize(mesh.positions.size());
    EXPECT_EQ(drop_collapsed(mesh), 3u);
    EXPECT_EQ(mesh.positions.size(), 8u);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_EQ(volume(mesh), 1);
    expect_closed(mesh);
}

TEST(DropCollapsed, WeldingABallsCapKeepsItClosed) {
    Mesh mesh = sphere(vec3(0), 1, 5);
    EXPECT_GT(weld(mesh, 0.1f), 0u);
    EXPECT_GT(drop_collapsed(mesh), 0u);
    EXPECT_EQ(soundness(mesh).open_edges, 0u);
}

TEST(DropUnused, KeepsTheOthersInOrder) {
    Mesh mesh{{vec3(0), vec3(1), vec3(2), vec3(3), vec3(4)}, {}, {{4, 1, 2}}};
    EXPECT_EQ(drop_unused(mesh), 2u);
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{vec3(1), vec3(2), vec3(4)}));
    EXPECT_EQ(mesh.triangles[0], uvec3(2, 0, 1));
}

TEST(DropCrumbs, KeepsSoManyOfTheLargest) {
    const Mesh hollow = both(box(vec3(0), vec3(50)), inside_out(box(vec3(20), vec3(30))));
    Mesh mesh = both(both(hollow, sphere(vec3(100), 1, 3)), box(vec3(-9), vec3(-8)));
    EXPECT_EQ(drop_crumbs(mesh, 4).parts, 0u);
    EXPECT_EQ(drop_crumbs(mesh, 2).parts, 2u);
    EXPECT_EQ(mesh.triangles, hollow.triangles);
}

TEST(FillCavities, FillsTheSmallOnes) {
    const Mesh ball = sphere(vec3(0), 1, 3), large = inside_out(sphere({0.3f, 0, 0}, 0.2f, 3));
    Mesh mesh = both(both(ball, large), inside_out(sphere({-0.3f, 0, 0}, 0.05f, 2)));
    const double before = volume(mesh);
    const Dropped filled = fill_cavities(mesh, 0.001);
    EXPECT_EQ(filled.parts, 1u);
    EXPECT_TRUE(std::abs(volume(mesh) - before - filled.volume) <= 1e-7);
    EXPECT_EQ(mesh.triangles, both(ball, large).triangles);
    EXPECT_EQ(fill_cavities(mesh, 0.001).parts, 0u);
}

TEST(Smooth, KeepsTheVolumeOfABall) {
    Mesh mesh = sphere(vec3(0), 1, 5);
    const double before = volume(mesh);
    smooth(mesh, 20);
    EXPECT_LE(std::abs(volume(mesh) / before - 1), 0.01);
}

TEST(Smooth, RemovesTheStaircaseAndKeepsTheVolume) {
    // A ball of filled voxels without a soft edge has the worst staircase there is.
    Mesh mesh =
        isosurface(volume_of(ivec3(41), [](vec3 p) { return float(glm::distance(p, vec3(20)) < 15); }), 0.5f);
    auto roughness = [&] {  // how far the normals stray from the ball's, root mean square
        compute_normals(mesh);
        double sum = 0;
        for (std::size_t i = 0; i < mesh.normals.size(); ++i)
            sum += std::pow(glm::distance(mesh.normals[i], glm::normalize(mesh.positions[i] - vec3(20))), 2);
        return std::sqrt(sum / double(mesh.normals.size()));
    };
    const double rough = roughness(), before = volume(mesh);
    smooth(mesh, 10);
    EXPECT_TRUE(mesh.normals.empty());
    EXPECT_LE(roughness(), 0.65 * rough);
    EXPECT_LE(std::abs(volume(mesh) / before - 1), 0.01);
    expect_closed(mesh);
}

TEST(Smooth, ABorderStaysALine) {
    // A square sheet with ripples: its border is smoothed along itself and does not creep inwards.
    Mesh mesh;
    const unsigned n = 21;
    for (unsigned y = 0; y < n; ++y)
        for (unsigned x = 0; x < n; ++x) mesh.positions.push_back({x, y, (x + y) % 2 * 0.5f});
    for (unsigned y = 0; y + 1 < n; ++y)
        for (unsigned x = 0; x + 1 < n; ++x) {
            const unsigned i = y * n + x;
            mesh.triangles.insert(mesh.triangles.end(), {{i, i + 1, i + n + 1}, {i, i + n + 1, i + n}});
        }
    smooth(mesh, 5);
    for (unsigned i = 3; i + 3 < n; ++i) {
        EXPECT_LE(std::abs(mesh.positions[i].y), 0.02f);
        EXPECT_LE(std::abs(mesh.positions[i * n].x), 0.02f);
        EXPECT_LE(std::abs(mesh.positions[i].z - 0.25f), 0.05f);
    }
}

TEST(Decimate, LeavesASmallMeshAlone) {
    Mesh mesh = sphere(vec3(0), 1, 2);
    mesh.normals.resize(mesh.positions.size());
    EXPECT_EQ(decimate(mesh, mesh.triangles.size()), 0u);
    EXPECT_FALSE(mesh.normals.empty());
    Mesh empty;
    EXPECT_EQ(decimate(empty, 0), 0u);
}

TEST(Decimate, KeepsABallABall) {
    Mesh mesh = sphere(vec3(0), 1, 6);
    const std::size_t before = mesh.triangles.size();
    const std::size_t went = decimate(mesh, 2000);
    EXPECT_EQ(went, before - mesh.triangles.size());
    EXPECT_LE(mesh.triangles.size(), 2010u);
    EXPECT_GE(mesh.triangles.size(), 1900u);
    EXPECT_LE(std::abs(volume(mesh) / (4.0 / 3 * M_PI) - 1), 0.01);
    expect_closed(mesh);
    EXPECT_EQ(soundness(mesh).parts, 1u);
}

TEST(Decimate, AClosedMeshStaysClosed) {
    // Rubble is all tunnels and thin necks: whatever collapsing an edge can break, it breaks here.
    for (unsigned seed = 0; seed < 12; ++seed) {
        Mesh mesh = isosurface(rubble({13, 17, 11}, seed), 0.3f + 0.04f * float(seed));
        expect_closed(mesh);
        for (std::size_t faces : {4000, 1500, 400, 50, 4}) {
            decimate(mesh, faces);
            expect_closed(mesh);
        }
    }
}

TEST(WeldBorder, ClosesASeamAndLeavesAllElseAlone) {
    // A box cut in two halves that lie a hair apart, and two spheres as near to each other as that.
    Mesh mesh = soup(box(vec3(0), vec3(1)));
    for (vec3& p : mesh.positions) p += 1e-4f * p;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 2) mesh.positions[i] += 1e-5f;
    const Mesh near = both(sphere(vec3(3), 0.5f, 2), sphere(vec3(4.00001f, 3, 3), 0.5f, 2));
    mesh = both(mesh, near);
    EXPECT_EQ(weld_border(mesh, 1e-4f), 28u);
    EXPECT_EQ(soundness(mesh).parts, 3u);
    expect_closed(mesh);
}

TEST(DropFlaps, DropsPairsOnly) {
    Mesh mesh = box(vec3(0), vec3(1));
    mesh.triangles.insert(mesh.triangles.end(), {{0, 1, 7}, {1, 0, 7}, {2, 5, 7}});
    EXPECT_EQ(drop_flaps(mesh), 2u);
    EXPECT_EQ(mesh.triangles.size(), 13u);
    EXPECT_EQ(mesh.triangles.back(), uvec3(2, 5, 7));
    EXPECT_EQ(drop_copies(mesh), 0u);
    mesh.triangles.push_back({5, 2, 7});
    EXPECT_EQ(drop_copies(mesh), 1u);
}

// A sphere some of whose edges have a vertex in or near their middle, so that a face beside it is a cap; and
// some of whose vertices are two, so that two faces between them are needles.
Mesh with_flat_faces(unsigned seed, int* how_many) {
    Mesh mesh = sphere(vec3(0.5f, -1, 2), 1, 4);
    std::mt19937 random(seed);
    *how_many = 0;
    for (int i = 0; i < 40; ++i) {
        // One face becomes three about a vertex on one of its sides, one of them flat.
        const std::size_t face = random() % mesh.triangles.size();
        const uvec3 t = mesh.triangles[face];
        const float along = i % 2 ? 0.5f : 1e-5f;
        const auto v = unsigned(mesh.positions.size());
        mesh.positions.push_back(glm::mix(mesh.positions[t.x], mesh.positions[t.y], along));
        mesh.triangles[face] = {t.x, t.y, v};
        mesh.triangles.push_back({t.y, t.z, v});
        mesh.triangles.push_back({t.z, t.x, v});
        ++*how_many;
    }
    return mesh;
}

TEST(DropFlatFaces, AClosedMeshStaysClosed) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        int flat = 0;
        Mesh mesh = with_flat_faces(seed, &flat);
        const double before = volume(mesh);
        expect_closed(mesh);
        ASSERT_GE(soundness(mesh).flat_faces, std::size_t(flat) / 2);
        EXPECT_GT(drop_flat_faces(mesh), 0u);
        expect_closed(mesh);
        EXPECT_EQ(soundness(mesh).flat_faces, 0u);
        EXPECT_LE(std::abs(volume(mesh) / before - 1), 1e-3);
        EXPECT_EQ(drop_flat_faces(mesh), 0u);
    }
}

TEST(DropSpecks, DropsThousandsAndKeepsTheLarge) {
    Mesh mesh = both(sphere(vec3(0), 1, 4), box(vec3(2), vec3(2.5f)));
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(-3, 3);
    Mesh specks;
    for (int i = 0; i < 3000; ++i) {
        const vec3 p(any(random), any(random), any(random));
        const auto first = unsigned(specks.positions.size());
        for (vec3 q : box(p, p + 0.01f).positions) specks.positions.push_back(q);
        for (uvec3 t : box(p, p + 0.01f).triangles) specks.triangles.push_back(t + first);
    }
    Mesh all = both(mesh, specks);
    EXPECT_EQ(drop_specks(all, 0.01f).parts, 3000u);
    EXPECT_EQ(all.positions, mesh.positions);
    EXPECT_EQ(all.triangles, mesh.triangles);
}

TEST(TurnFaces, MostDecide) {
    for (unsigned seed = 0; seed < 5; ++seed) {
        const Mesh whole = torus(2, 0.7f, 23, 13);
        Mesh mesh = whole;
        std::mt19937 random(seed);
        std::size_t turned = 0;
        for (uvec3& t : mesh.triangles)
            if (random() % 3 == 0) std::swap(t.y, t.z), ++turned;
        EXPECT_EQ(turn_faces(mesh), turned);
        EXPECT_EQ(mesh.triangles, whole.triangles);
    }
    Mesh moebius = band(0.5f, 1, 30);
    turn_faces(moebius);
    EXPECT_GT(soundness(moebius).clashing_edges, 0u);
}

TEST(TurnParts, LeavesCavities) {
    const Mesh hollow = both(sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.5f, 3)));
    Mesh mesh = both(hollow, inside_out(box(vec3(2), vec3(3))));
    EXPECT_EQ(turn_parts(mesh), 1u);
    EXPECT_EQ(mesh.triangles, both(hollow, box(vec3(2), vec3(3))).triangles);
    Mesh all = inside_out(hollow);
    EXPECT_EQ(turn_parts(all), 2u);
    EXPECT_EQ(all.triangles, hollow.triangles);
}

TEST(DropNested, KeepsWhatPartsInsideFromOutside) {
    const Mesh ball = sphere(vec3(0), 1, 4), cavity = inside_out(sphere(vec3(0), 0.6f, 4)),
               island = sphere(vec3(0), 0.3f, 3);
    Mesh mesh = both(both(both(ball, cavity), island), sphere(vec3(0), 0.8f, 3));
    EXPECT_EQ(drop_nested(mesh).dropped, 3u) << "a shell in the wall fills the cavity, and so all is full";
    Mesh onion = both(both(ball, cavity), island);
    EXPECT_EQ(drop_nested(onion).dropped, 0u);
}

TEST(CloseHoles, ClosesWhatRandomlyDroppedFacesLeave) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        Mesh mesh = torus(2, 0.7f, 60, 30);
        const double before = volume(mesh);
        std::mt19937 random(seed);
        std::erase_if(mesh.triangles, [&](uvec3) { return random() % 12 == 0; });
        const std::size_t holes = close_holes(mesh);
        EXPECT_GE(holes, 20u);
        separate_sheets(mesh);
        drop_unused(mesh);
        expect_closed(mesh);
        EXPECT_LE(std::abs(volume(mesh) / before - 1), 0.01);
    }
}

TEST(CloseHoles, APlaneOverHalfABall) {
    for (int level : {4, 6, 7}) {  // holes short and long
        Mesh mesh = sphere(vec3(0), 1, level);
        std::erase_if(mesh.triangles, [&](uvec3 t) {
            return mesh.positions[t.x].z + mesh.positions[t.y].z + mesh.positions[t.z].z > 0;
        });
        EXPECT_EQ(close_holes(mesh), 1u);
        drop_unused(mesh);
        expect_closed(mesh);
        EXPECT_LE(std::abs(volume(mesh) / (2.0 / 3 * M_PI) - 1), 0.02);
    }
}

TEST(PartSheets, TwoCubesThatShareAnEdge) {
    Mesh mesh = both(box(vec3(0), vec3(1)), box(vec3(1, 1, 0), vec3(2, 2, 1)));
    EXPECT_EQ(weld(mesh), 2u);
    EXPECT_EQ(soundness(mesh).crowded_edges, 1u);
    EXPECT_EQ(separate_sheets(mesh), 2u);
    expect_closed(mesh);
    EXPECT_EQ(soundness(mesh).parts, 2u) << "matter is on the far sides of the edge";
    EXPECT_EQ(soundness(mesh).shared_vertices, 0u);
    EXPECT_EQ(volume(mesh), 2);
}

TEST(PartSheets, AnEdgeWithAThousandSheets) {
    Mesh mesh{{vec3(0), vec3(0, 0, 1)}, {}, {}};
    for (unsigned i = 0; i < 2000; ++i) {  // wedges of matter with gaps between
        const float angle = float(i) * float(M_PI) / 1000;
        mesh.positions.push_back({std::cos(angle), std::sin(angle), 0.5f});
        const unsigned here = i + 2;
        mesh.triangles.push_back(i % 2 ? uvec3(0, 1, here) : uvec3(1, 0, here));
        if (i % 2) mesh.triangles.insert(mesh.triangles.end(), {{0, here, here - 1}, {1, here - 1, here}});
    }
    EXPECT_EQ(separate_sheets(mesh), 2 * 999u);
    expect_closed(mesh);
    EXPECT_EQ(soundness(mesh).parts, 1000u);
    for (uvec3 t : mesh.triangles) ASSERT_LT(std::max({t.x, t.y, t.z}), mesh.positions.size());
}

// The whole way from a scan to a surface that can be used, on real data.
void expect_a_usable_surface(const char* name, float iso, double low_ml, double high_ml) {
    const std::filesystem::path path = std::string("/usr/share/mricron/templates/") + name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not available (package mricron-data)";
    Mesh mesh = isosurface(read_volume(path), iso);
    expect_closed(mesh);
    keep_largest(mesh);
    fill_cavities(mesh, 0.001);
    const double before = volume(mesh);
    smooth(mesh, 5);
    EXPECT_LE(std::abs(volume(mesh) / before - 1), 0.01);
    expect_closed(mesh);
    decimate(mesh, 140'000);
    drop_crumbs(mesh, 1);
    EXPECT_LE(std::abs(volume(mesh) / before - 1), 0.01);
    EXPECT_GE(volume(mesh) * 1e6, low_ml);
    EXPECT_LE(volume(mesh) * 1e6, high_ml);
    expect_closed(mesh);
    EXPECT_EQ(soundness(mesh).parts, 1u);
    EXPECT_GE(mesh.triangles.size(), 138'000u);
    EXPECT_LE(mesh.triangles.size(), 140'000u);
}

TEST(RealData, ABrain) { expect_a_usable_surface("ch2bet.nii.gz", 60.5f, 1500, 1700); }
TEST(RealData, AHeadCutAtTheNeck) { expect_a_usable_surface("ch2.nii.gz", 30.5f, 3000, 5000); }

}  // namespace
}  // namespace palpate
