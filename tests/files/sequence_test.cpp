// Each format is read back by a small reader of the test's own.
#include "palpate/files/sequence.h"

#include "palpate/files/read.h"
#include "palpate/files/write.h"
#include "tests/files/glb.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <bit>
#include <memory>

namespace palpate {
namespace {

Mesh ball() {
    Mesh mesh = sphere({0.1f, 0.2f, 0.3f}, 0.05f, 2);
    compute_normals(mesh);
    return mesh;
}

// The ball's vertices at a picture: each goes its own way.
std::vector<vec3> shaken(const Mesh& mesh, int picture) {
    std::mt19937 random(picture);
    std::normal_distribution<float> any(0, 0.01f);
    std::vector<vec3> positions = mesh.positions;
    for (vec3& p : positions) p += vec3(any(random), any(random), any(random));
    return positions;
}

constexpr double apart = 0.05;  // s

void write_sequence(const Mesh& mesh, const std::filesystem::path& path, int pictures, int planned) {
    const auto sequence = make_sequence(mesh, path, std::size_t(planned));
    std::vector<vec3> normals;
    for (int i = 0; i < pictures; ++i) {
        const std::vector<vec3> positions = shaken(mesh, i);
        compute_normals(positions, mesh.triangles, normals);
        sequence->add(apart * i, positions, normals);
    }
    sequence->finish();
}

TEST(Sequence, NumberedFilesAreTheMeshAtEachPicture) {
    Scratch scratch;
    const Mesh mesh = ball();
    for (const char* format : {"ply", "vtp", "stl", "obj"}) {
        write_sequence(mesh, scratch / ("a." + std::string(format)), 3, 12'345);
        for (int i = 0; i < 3; ++i) {
            Mesh moved{shaken(mesh, i), {}, mesh.triangles};
            compute_normals(moved);
            write_mesh(moved, scratch / ("single." + std::string(format)));
            EXPECT_EQ(read_text(scratch / ("a-0000" + std::to_string(i + 1) + "." + format)),
                      read_text(scratch / ("single." + std::string(format))))
                << format;
        }
    }
    EXPECT_EQ(scratch.entries(), 4u * 4 + 1);  // one more: the list of VTP files
    write_sequence(mesh, scratch / "b.ply", 1, 9999);
    EXPECT_TRUE(std::filesystem::exists(scratch / "b-0001.ply"));
}

TEST(Sequence, ThePvdListsFilesWithTheirTimes) {
    Scratch scratch;
    write_sequence(ball(), scratch / "a & b.vtp", 3, 3);
    EXPECT_EQ(read_text(scratch / "a & b.pvd"),
              "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n"
              "<DataSet timestep=\"0\" file=\"a &#38; b-0001.vtp\"/>\n"
              "<DataSet timestep=\"0.05\" file=\"a &#38; b-0002.vtp\"/>\n"
              "<DataSet timestep=\"0.1\" file=\"a &#38; b-0003.vtp\"/>\n</Collection>\n</VTKFile>\n");
    EXPECT_TRUE(std::filesystem::exists(scratch / "a & b-0003.vtp"));
}

TEST(Sequence, Pc2) {
    Scratch scratch;
    const Mesh mesh = ball();
    write_sequence(mesh, scratch / "a.pc2", 7, 100);
    const std::string file = read_text(scratch / "a.pc2");
    EXPECT_EQ(file.substr(0, 12), std::string("POINTCACHE2\0", 12));
    EXPECT_EQ(at<std::int32_t>(file, 12), 1);
    EXPECT_EQ(at<std::int32_t>(file, 16), std::int32_t(mesh.positions.size()));
    EXPECT_EQ(at<float>(file, 20), 0.0f);
    EXPECT_EQ(at<float>(file, 24), 1.0f);
    EXPECT_EQ(at<std::int32_t>(file, 28), 7);
    ASSERT_EQ(file.size(), 32 + 7 * 12 * mesh.positions.size());
    std::size_t place = 32;
    for (int i = 0; i < 7; ++i)
        for (vec3 p : shaken(mesh, i)) EXPECT_EQ(at<vec3>(file, std::exchange(place, place + 12)), p);
    EXPECT_EQ(scratch.entries(), 2u);
}

TEST(Sequence, Mdd) {
    Scratch scratch;
    const Mesh mesh = ball();
    write_sequence(mesh, scratch / "a.mdd", 7, 100);
    const std::string file = read_text(scratch / "a.mdd");
    std::size_t place = 0;
    auto whole = [&] {
        std::uint32_t number = 0;
        for (int i = 0; i < 4; ++i) number = number << 8 | std::uint8_t(file.at(place++));
        return number;
    };
    auto real = [&] { return std::bit_cast<float>(whole()); };
    EXPECT_EQ(whole(), 7u);
    EXPECT_EQ(whole(), mesh.positions.size());
    for (int i = 0; i < 7; ++i) EXPECT_EQ(real(), float(apart * i));
    for (int i = 0; i < 7; ++i)
        for (vec3 p : shaken(mesh, i))
            for (int k = 0; k < 3; ++k) EXPECT_EQ(real(), p[k]);
    EXPECT_EQ(place, file.size());
    EXPECT_EQ(scratch.entries(), 2u);
}

// The mesh beside a cache has its vertices in the cache's order.
TEST(Sequence, TheMeshBesideACacheIsTheOneAtRest) {
    Scratch scratch;
    const Mesh mesh = ball();
    write_sequence(mesh, scratch / "a.pc2", 2, 2);
    std::istringstream lines(read_text(scratch / "a.obj"));
    std::string line;
    std::size_t vertex = 0;
    while (std::getline(lines, line)) {
        vec3 p;
        if (std::sscanf(line.c_str(), "v %f %f %f", &p.x, &p.y, &p.z) != 3) continue;
        ASSERT_LT(vertex, mesh.positions.size());
        EXPECT_EQ(p, mesh.positions[vertex++]);
    }
    EXPECT_EQ(vertex, mesh.positions.size());
}

// What a player shows at a time: the base, and each target by its weight.
std::vector<vec3> played(const Gltf& gltf, const char* attribute, float time) {
    const auto& sampler = gltf.json["animations"][0]["samplers"][0];
    EXPECT_EQ(sampler["interpolation"], "LINEAR");
    const auto times = gltf.numbers<float>(sampler["input"]),
               weights = gltf.numbers<float>(sampler["output"]);
    const auto& targets = gltf.primitive()["targets"];
    EXPECT_EQ(weights.size(), times.size() * targets.size());
    const auto later = std::upper_bound(times.begin() + 1, times.end() - 1, time) - times.begin();
    const float part = (time - times[later - 1]) / (times[later] - times[later - 1]);
    std::vector<vec3> values = gltf.numbers<vec3>(gltf.primitive()["attributes"][attribute]);
    for (std::size_t t = 0; t < targets.size(); ++t) {
        const float weight =
            glm::mix(weights[(later - 1) * targets.size() + t], weights[later * targets.size() + t], part);
        const auto ways = gltf.numbers<vec3>(targets[t][attribute]);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] += weight * ways[i];
    }
    return values;
}

TEST(Sequence, GlbPlaysEachPictureAndBlendsNeighbours) {
    Scratch scratch;
    const Mesh mesh = ball();
    write_sequence(mesh, scratch / "a.glb", 5, 100);
    EXPECT_EQ(scratch.entries(), 1u);
    const Gltf gltf = read_glb(scratch / "a.glb");
    EXPECT_EQ(gltf.positions(gltf.primitive()["attributes"]["POSITION"]), mesh.positions);
    ASSERT_EQ(gltf.primitive()["targets"].size(), 5u);
    EXPECT_EQ(gltf.json["meshes"][0]["weights"], (std::vector<int>{0, 0, 0, 0, 0}));
    const auto& input = gltf.json["accessors"][gltf.json["animations"][0]["samplers"][0]["input"].get<int>()];
    EXPECT_EQ(input["min"][0].get<float>(), 0.0f);
    EXPECT_EQ(input["max"][0].get<float>(), float(4 * apart));
    for (const auto& target : gltf.primitive()["targets"]) gltf.positions(target["POSITION"]);
    std::vector<vec3> normals;
    for (int i = 0; i < 5; ++i) {
        const auto there = played(gltf, "POSITION", float(apart * i)), here = shaken(mesh, i);
        compute_normals(here, mesh.triangles, normals);
        const auto turned = played(gltf, "NORMAL", float(apart * i));
        for (std::size_t v = 0; v < here.size(); ++v) {
            EXPECT_LE(glm::distance(there[v], here[v]), 1e-7f);
            EXPECT_LE(glm::distance(turned[v], normals[v]), 1e-6f);
        }
    }
    const auto between = played(gltf, "POSITION", float(apart * 2.25));
    const auto before = shaken(mesh, 2), after = shaken(mesh, 3);
    for (std::size_t v = 0; v < between.size(); ++v)
        EXPECT_LE(glm::distance(between[v], glm::mix(before[v], after[v], 0.25f)), 1e-7f);
}

TEST(Sequence, WhatDoesNotFitIntoAGlbIsSaidBeforehand) {
    Scratch scratch;
    const Mesh mesh = ball();  // 162 vertices: 3888 bytes a picture, and 4 for each pair
    EXPECT_HAS(refusal(scratch / "a.glb", [&] { make_sequence(mesh, scratch / "a.glb", 23'000); }), "2 GB");
    make_sequence(mesh, scratch / "a.glb", 22'000);
    EXPECT_HAS(refusal(scratch / "b.glb", [&] { make_sequence({}, scratch / "b.glb", 1); }), "no triangles");
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(Sequence, UnfinishedItLeavesNothing) {
    Scratch scratch;
    const Mesh mesh = ball();
    for (const char* name : {"a.pc2", "a.mdd", "a.glb"}) {
        const auto sequence = make_sequence(mesh, scratch / name, 3);
        sequence->add(0, mesh.positions, mesh.normals);
    }
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(Sequence, RefusesPicturesThatDoNotFit) {
    Scratch scratch;
    Mesh mesh = ball();
    compute_normals(mesh);
    const std::span<const vec3> positions(mesh.positions), normals(mesh.normals);
    for (const char* name : {"a.ply", "a.pc2", "a.glb"}) {
        const auto sequence = make_sequence(mesh, scratch / name, 3);
        const auto refused = [&](double time, std::span<const vec3> p, std::span<const vec3> n) {
            return refusal(scratch / name, [&] { sequence->add(time, p, n); });
        };
        EXPECT_HAS(refused(0, positions.first(7), normals), "number of vertices");
        EXPECT_HAS(refused(0, positions, normals.first(7)), "number of vertices");
        EXPECT_HAS(refused(std::nan(""), positions, normals), "order");
        sequence->add(0.5, positions, normals);
        EXPECT_HAS(refused(0.5, positions, normals), "order");
        sequence->add(0.6, positions, normals);
        sequence->finish();
    }
}

TEST(Sequence, RefusesOtherEndings) {
    Scratch scratch;
    for (const char* name : {"a.gltf", "a.mp4", "a"})
        EXPECT_HAS(refusal(scratch / name, [&] { check_sequence_name(scratch / name); }),
                   ".pc2, .mdd or .glb");
}

}  // namespace
}  // namespace palpate
