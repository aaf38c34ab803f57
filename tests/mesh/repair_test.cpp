#include "palpate/mesh/repair.h"

#include "palpate/mesh/read.h"
#include "palpate/mesh/solid.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace palpate {
namespace {

void expect_closed(const Mesh& mesh) {
    const Soundness found = soundness(mesh);
    EXPECT_EQ(found.open_edges, 0u);
    EXPECT_EQ(found.bad_edges, 0u);
    for (vec3 p : mesh.positions) ASSERT_LE(glm::length(p), 1e9f);
}

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

TEST(KeepLargest, KeepsTheMostFaces) {
    Mesh mesh = both(both(box(vec3(0), vec3(50)), sphere(vec3(100), 1, 3)), box(vec3(-9), vec3(-8)));
    EXPECT_EQ(soundness(mesh).parts, 3u);
    EXPECT_EQ(keep_largest(mesh), 2u);
    EXPECT_EQ(mesh.triangles, sphere(vec3(0), 1, 3).triangles);
    EXPECT_EQ(soundness(mesh).parts, 1u);
    Mesh empty;
    EXPECT_EQ(keep_largest(empty), 0u);
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

TEST(Soundness, CountsPartsAndEdges) {
    Soundness found = soundness(box(vec3(0), vec3(1)));
    EXPECT_EQ(found.parts, 1u);
    EXPECT_EQ(found.open_edges, 0u);
    EXPECT_EQ(found.bad_edges, 0u);

    Mesh open = box(vec3(0), vec3(1));
    open.triangles.pop_back();
    EXPECT_EQ(soundness(open).open_edges, 3u);

    Mesh turned = box(vec3(0), vec3(1));
    std::swap(turned.triangles[0].x, turned.triangles[0].y);
    EXPECT_EQ(soundness(turned).bad_edges, 3u);

    const Mesh fan{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, -1, 0)},
                   {},
                   {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    EXPECT_EQ(soundness(fan).bad_edges, 1u);
    EXPECT_EQ(soundness(fan).open_edges, 6u);

    EXPECT_EQ(soundness(soup(box(vec3(0), vec3(1)))).parts, 12u);
    EXPECT_EQ(soundness(Mesh{}).parts, 0u);
}

// The whole way from a scan to a surface that can be used, on real data.
void expect_a_usable_surface(const char* name, float iso, double low_ml, double high_ml) {
    const std::filesystem::path path = std::string("/usr/share/mricron/templates/") + name;
    if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is not available (package mricron-data)";
    Mesh mesh = isosurface(read_volume(path), iso);
    expect_closed(mesh);
    keep_largest(mesh);
    const double before = volume(mesh);
    smooth(mesh, 5);
    EXPECT_LE(std::abs(volume(mesh) / before - 1), 0.01);
    expect_closed(mesh);
    decimate(mesh, 140'000);
    keep_largest(mesh);
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
