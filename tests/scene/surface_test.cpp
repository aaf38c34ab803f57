// What make_surface() makes of one recipe.
#include "palpate/scene/surface.h"

#include "palpate/base/files.h"
#include "palpate/files/write.h"
#include "tests/refusal.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace palpate {
namespace {

float longest_side(const Mesh& mesh) {
    const vec3 size = bounds(mesh).size();
    return std::max({size.x, size.y, size.z});
}

TEST(Surface, IsScaledToItsSizeAndCentred) {
    Scratch scratch;
    BodyRecipe recipe;
    recipe.surface = "ball.ply";
    recipe.size = 0.2f;
    recipe.centre = true;
    recipe.move = {1, 2, 3};
    for (const float radius : {0.004f, 3.0f, 700.0f}) {
        write_mesh(ellipsoid(vec3(radius), 12), scratch / "ball.ply");
        const Mesh made = make_surface(recipe, scratch / "").mesh;
        EXPECT_NEAR(longest_side(made), 0.2f, 1e-6f);
        EXPECT_LT(glm::distance(bounds(made).centre(), vec3(1, 2, 3)), 1e-6f);
    }
}

TEST(Surface, LengthsForItsMendingCountAfterScaling) {
    Scratch scratch;
    BodyRecipe recipe;
    recipe.surface = "ball.ply";
    recipe.size = 0.2f;
    recipe.repair.solid = SolidBy::voxels;
    recipe.repair.voxel = 0.02f;
    std::vector<std::size_t> faces;
    for (const float radius : {0.1f, 50.0f}) {
        write_mesh(ellipsoid(vec3(radius), 40), scratch / "ball.ply");
        faces.push_back(make_surface(recipe, scratch / "").mesh.triangles.size());
    }
    EXPECT_EQ(faces[0], faces[1]);
    EXPECT_GT(faces[0], 400u);  // ten voxels across
    EXPECT_LT(faces[0], 1200u);
}

// Two boxes that overlap, 1.5 together, and one of 0.3 far from them.
Mesh two_and_a_third() {
    Mesh mesh = both(block(vec3(0), vec3(1), 1), block({0.5f, 0, 0}, {1.5f, 1, 1}, 1));
    mesh = both(mesh, block({5, 0, 0}, {5.3f, 1, 1}, 8));
    mesh.normals.clear();
    return mesh;
}

bool is_said(const std::vector<std::string>& lines, const std::string& words) {
    return std::ranges::any_of(lines, [&](const std::string& line) { return line.find(words) != line.npos; });
}

TEST(Surface, OfManyPartsThoseThatOverlapAreKeptAndWhatIsDroppedIsSaid) {
    Scratch scratch;
    write_mesh(two_and_a_third(), scratch / "boxes.ply");
    BodyRecipe recipe;
    recipe.surface = "boxes.ply";
    recipe.repair.voxel = 0.02f;
    const CleanSurface made = make_surface(recipe, scratch / "");
    EXPECT_TRUE(std::abs(volume(made.mesh) / 1.5 - 1) <= 0.02) << volume(made.mesh);
    EXPECT_TRUE(is_said(made.steps, "smaller parts dropped: 1 (17 % of the volume, 3e+05 ml)"))
        << ::testing::PrintToString(made.steps);
    EXPECT_TRUE(is_said(made.notes, "smaller parts dropped: 1 (17 % of the volume, 3e+05 ml)"));

    recipe.largest = false;
    EXPECT_FALSE(is_said(make_surface(recipe, scratch / "").steps, "dropped"));
}

TEST(Surface, LessThanAHundredthIsNoNote) {
    Scratch scratch;
    write_mesh(both(ellipsoid(vec3(1), 12), block(vec3(4), vec3(4.2f), 1)), scratch / "ball.ply");
    BodyRecipe recipe;
    recipe.surface = "ball.ply";
    const CleanSurface made = make_surface(recipe, scratch / "");
    EXPECT_TRUE(is_said(made.steps, "smaller parts dropped: 1 (0.2 % of the volume"))
        << ::testing::PrintToString(made.steps);
    EXPECT_FALSE(is_said(made.notes, "dropped"));
    recipe.size = 0.2f;  // of what is kept
    const std::vector<std::string> steps = make_surface(recipe, scratch / "").steps;
    EXPECT_TRUE(is_said(steps, " % of the volume, 8 ml)")) << ::testing::PrintToString(steps);
}

// The number of a vertex of `mesh` in this place, or none.
std::optional<std::size_t> at(const Mesh& mesh, vec3 place) {
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (glm::distance(mesh.positions[i], place) <= 1e-6f) return i;
    return {};
}

TEST(Surface, WithMapsTheFilesOwnIsDrawnWhereTheMendedOneLies) {
    Scratch scratch;
    write_text(scratch / "cube.obj", textured_cube());
    BodyRecipe recipe;
    recipe.surface = "cube.obj";
    recipe.rotate = {20, 30, 40};
    recipe.size = 0.2f;
    recipe.centre = true;
    recipe.move = {1, 2, 3};
    const CleanSurface plain = make_surface(recipe, scratch / "");
    EXPECT_TRUE(plain.drawn.positions.empty());
    recipe.normal_map = "any.png";
    const CleanSurface made = make_surface(recipe, scratch / "");
    EXPECT_EQ(made.mesh.positions, plain.mesh.positions);
    EXPECT_EQ(made.mesh.triangles, plain.mesh.triangles);
    EXPECT_EQ(made.mesh.positions.size(), 8u);
    ASSERT_EQ(made.drawn.positions.size(), 24u);
    ASSERT_EQ(made.drawn.uvs.size(), 24u);
    ASSERT_EQ(made.drawn.normals.size(), 24u);
    for (std::size_t i = 0; i < 24; ++i) {
        const auto same = at(made.mesh, made.drawn.positions[i]);
        ASSERT_TRUE(same) << i;
        EXPECT_LE(glm::distance(made.drawn.normals[i], made.mesh.normals[*same]), 1e-6f);
        // A cube's corner, seen by three faces alike.
        const vec3 out = glm::normalize(made.drawn.positions[i] - recipe.move);
        EXPECT_LE(glm::distance(made.drawn.normals[i], out), 1e-5f);
    }
    EXPECT_NEAR(volume(made.drawn), volume(made.mesh), 1e-7);
}

TEST(Surface, WhatIsDrawnIsTheLargestPartTheRightWayOut) {
    Scratch scratch;
    std::string text = textured_cube();
    for (std::size_t line = text.find("\nf"); line != std::string::npos; line = text.find("\nf", line + 1)) {
        std::size_t end = text.find('\n', line + 1);  // the corners the other way round
        std::string turned, word;
        for (std::size_t i = line + 3; i <= end; ++i)
            if (text[i] == ' ' || text[i] == '\n')
                turned = ' ' + word + turned, word.clear();
            else
                word += text[i];
        text.replace(line + 2, end - line - 2, turned);
    }
    text += "v 5 5 5\nv 6 5 5\nv 5 6 5\nf 9/1 10/2 11/3\n";
    write_text(scratch / "cube.obj", text);
    BodyRecipe recipe;
    recipe.surface = "cube.obj";
    recipe.weave = {4, 4};
    const CleanSurface made = make_surface(recipe, scratch / "");
    EXPECT_EQ(made.drawn.triangles.size(), 12u);
    EXPECT_EQ(made.drawn.positions.size(), 24u);
    EXPECT_NEAR(volume(made.drawn), 1, 1e-6);
    EXPECT_NEAR(volume(made.mesh), 1, 1e-6);
}

TEST(Surface, WhatIsDrawnIsAllThatOverlaps) {
    Scratch scratch;
    // A cube, another moved by half of itself, and a third that is neither larger nor near.
    std::string text;
    int first = 0;
    for (const double x : {0.0, 0.5, 9.0}) {
        std::istringstream lines(textured_cube());
        for (std::string line; std::getline(lines, line);) {
            std::istringstream words(line);
            std::string kind, word;
            words >> kind;
            text += kind;
            if (kind == "v") {
                double at = 0;
                words >> at;
                text += ' ' + std::to_string(at + x);
            }
            while (words >> word) {
                if (kind == "f") {
                    const std::size_t slash = word.find('/');
                    word = std::to_string(std::stoi(word) + 8 * first) + '/' +
                           std::to_string(std::stoi(word.substr(slash + 1)) + 24 * first);
                }
                text += ' ' + word;
            }
            text += '\n';
        }
        ++first;
    }
    write_text(scratch / "cubes.obj", text);
    BodyRecipe recipe;
    recipe.surface = "cubes.obj";
    recipe.weave = {4, 4};
    recipe.repair.voxel = 0.05f;
    const CleanSurface made = make_surface(recipe, scratch / "");
    EXPECT_EQ(made.drawn.triangles.size(), 24u);
    EXPECT_TRUE(std::abs(volume(made.mesh) / 1.5 - 1) <= 0.05) << volume(made.mesh);
}

TEST(Surface, MapsWantTextureCoordinates) {
    Scratch scratch;
    write_text(scratch / "cube.obj", textured_cube(false));
    BodyRecipe recipe;
    recipe.surface = "cube.obj";
    recipe.colour_map = "any.png";
    for (const char* words : {"no texture coordinates", "cube.obj; "})
        expect_refused(words, [&] { make_surface(recipe, scratch / ""); });
}

}  // namespace
}  // namespace palpate
