#include "palpate/mesh/soundness.h"

#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

const Mesh cube = box(vec3(0), vec3(1));

TEST(Soundness, OfSoundShapes) {
    struct {
        Mesh mesh;
        long euler;
    } shapes[] = {{cube, 2}, {sphere(vec3(5), 2, 4), 2}, {torus(3, 1, 17, 11), 0}};
    for (const auto& shape : shapes) {
        const Soundness found = soundness(shape.mesh);
        EXPECT_TRUE(found.closed());
        EXPECT_EQ(found.euler, shape.euler);
        EXPECT_EQ(found.parts, 1u);
        for (std::size_t fault :
             {found.crowded_edges, found.clashing_edges, found.shared_vertices, found.unused_vertices,
              found.holes, found.copied_faces, found.collapsed_faces, found.flat_faces, found.one_sided_parts,
              found.inward_parts, found.specks})
            EXPECT_EQ(fault, 0u);
        EXPECT_EQ(found.longest_hole, 0);
    }
    EXPECT_EQ(soundness(Mesh{}).parts, 0u);
}

TEST(Soundness, CountsEdges) {
    Mesh open = cube;
    open.triangles.pop_back();
    EXPECT_EQ(soundness(open).open_edges, 3u);
    EXPECT_FALSE(soundness(open).closed());

    Mesh turned = cube;
    std::swap(turned.triangles[0].x, turned.triangles[0].y);
    EXPECT_EQ(soundness(turned).bad_edges, 3u);
    EXPECT_EQ(soundness(turned).clashing_edges, 3u);

    const Mesh fan{{vec3(0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(0, 0, 1), vec3(0, -1, 0)},
                   {},
                   {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
    EXPECT_EQ(soundness(fan).bad_edges, 1u);
    EXPECT_EQ(soundness(fan).crowded_edges, 1u);
    EXPECT_EQ(soundness(fan).open_edges, 6u);

    EXPECT_EQ(soundness(soup(cube)).parts, 12u);
}

TEST(Soundness, MeasuresHoles) {
    Mesh mesh = sphere(vec3(0), 1, 5);
    std::erase_if(mesh.triangles, [&](uvec3 t) {
        return mesh.positions[t.x].z > 0.9f || mesh.positions[t.y].x > 0.7f || mesh.positions[t.z].y > 0.9f;
    });
    const Soundness found = soundness(mesh);
    EXPECT_EQ(found.holes, 3u);
    const double circle = 2 * M_PI * std::sqrt(1 - 0.49);  // its border zigzags
    EXPECT_GE(found.longest_hole, circle);
    EXPECT_LE(found.longest_hole, 2 * circle);
    EXPECT_EQ(found.euler, 2 - 3);
}

TEST(Soundness, CountsFacesAndVertices) {
    Mesh mesh = cube;
    mesh.positions.push_back(vec3(0.5f, 0, 0));
    mesh.positions.push_back(vec3(7));
    mesh.triangles.insert(mesh.triangles.end(), {{0, 8, 1}, {3, 3, 1}, {2, 1, 0}, {1, 2, 0}});
    const Soundness found = soundness(mesh);
    EXPECT_EQ(found.flat_faces, 1u);
    EXPECT_EQ(found.collapsed_faces, 1u);
    EXPECT_EQ(found.copied_faces, 2u);
    EXPECT_EQ(found.unused_vertices, 1u);
}

TEST(Soundness, SeesWhatOnlyTouches) {
    Mesh touching = both(cube, box(vec3(1), vec3(2)));
    for (uvec3& t : touching.triangles)
        for (int k = 0; k < 3; ++k)
            if (t[k] == 8) t[k] = 7;  // corner to corner
    EXPECT_EQ(soundness(touching).shared_vertices, 1u);
    EXPECT_EQ(soundness(touching).parts, 1u);
}

TEST(Soundness, TellsPartsApart) {
    EXPECT_EQ(soundness(band(0.5f, 1, 40)).one_sided_parts, 1u);
    EXPECT_EQ(soundness(band(0.5f, 2, 40)).one_sided_parts, 0u);
    const Mesh ball = sphere(vec3(0), 1, 3);
    Mesh several = both(both(ball, inside_out(sphere(vec3(0), 0.5f, 3))), inside_out(sphere(vec3(4), 1, 2)));
    several = both(several, sphere(vec3(2), 0.004f, 1));
    const Soundness found = soundness(several);
    EXPECT_EQ(found.parts, 4u);
    EXPECT_EQ(found.inward_parts, 2u);
    EXPECT_EQ(found.specks, 1u);
}

TEST(Nesting, TellsCavitiesFromShells) {
    const Mesh ball = sphere(vec3(0), 1, 4), core = sphere(vec3(0.2f), 0.3f, 3);
    struct {
        Mesh mesh;
        std::size_t inside_out, redundant, cavities;
    } cases[] = {{ball, 0, 0, 0},
                 {inside_out(ball), 1, 0, 0},
                 {both(ball, core), 0, 1, 0},
                 {both(core, ball), 0, 1, 0},
                 {both(ball, inside_out(core)), 0, 0, 1},
                 {both(inside_out(ball), core), 2, 0, 1},  // all of it is inside out
                 {both(both(ball, inside_out(core)), sphere(vec3(0.2f), 0.1f, 2)), 0, 0, 1},
                 {both(ball, sphere(vec3(3), 1, 3)), 0, 0, 0}};
    for (const auto& c : cases) {
        const Nesting found = nesting(c.mesh);
        EXPECT_EQ(found.inside_out, c.inside_out);
        EXPECT_EQ(found.redundant, c.redundant);
        EXPECT_EQ(found.cavities, c.cavities);
    }
}

}  // namespace
}  // namespace palpate
