// Which parts of a mesh are one piece, how large it is, and which piece is kept.
#include "palpate/mesh/pieces.h"

#include "palpate/mesh/repair.h"
#include "tests/mesh/shapes.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr double ball_volume = 4.0 / 3 * M_PI;

std::size_t count_pieces(const Mesh& mesh) { return pieces(mesh, parts(mesh)).volume.size(); }

Mesh all(std::initializer_list<Mesh> meshes) {
    Mesh mesh;
    for (const Mesh& one : meshes) mesh = both(mesh, one);
    return mesh;
}

void expect_volume(const Mesh& mesh, double expected, double tolerance = 1e-5) {
    EXPECT_TRUE(std::abs(volume(mesh) / expected - 1) <= tolerance) << volume(mesh) << " for " << expected;
}

const Mesh cube = box(vec3(0), vec3(1));

TEST(Pieces, PartsThatTouchAreOne) {
    EXPECT_EQ(count_pieces(both(cube, box({1, 0, 0}, {2, 1, 1}))), 1u) << "side upon side";
    EXPECT_EQ(count_pieces(both(cube, box({1, 0.3f, 0.3f}, {2, 0.6f, 0.6f}))), 1u) << "a foot on a side";
    EXPECT_EQ(count_pieces(both(cube, box({1, 1, 1}, {2, 2, 2}))), 1u) << "corner upon corner";
    EXPECT_EQ(count_pieces(both(box({0, 0, 0}, {3, 1, 1}), box({1, -1, 1}, {2, 2, 2}))), 1u) << "a cross";
    EXPECT_EQ(count_pieces(both(box({-3, 0, 0}, {3, 1, 1}), box({-0.1f, 0.9f, -2}, {0.1f, 1.1f, 3}))), 1u)
        << "a rod through an edge";
    EXPECT_EQ(count_pieces(both(cube, box({1.001f, 0, 0}, {2, 1, 1}))), 2u) << "a gap of a thousandth";
    EXPECT_EQ(count_pieces(both(cube, box({1, 1.001f, 0}, {2, 2, 1}))), 2u) << "askew";
}

TEST(Pieces, PartsThatOverlapOrLieInEachOtherAreOne) {
    EXPECT_EQ(count_pieces(both(cube, box(vec3(0.5f), vec3(1.5f)))), 1u);
    EXPECT_EQ(count_pieces(both(cube, box({0.5f, 0, 0}, {1.5f, 1, 1}))), 1u) << "walls in one plane";
    EXPECT_EQ(count_pieces(both(box(vec3(0.4f), vec3(0.6f)), cube)), 1u) << "one in the other";
    const Mesh hollow = both(sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.5f, 3)));
    EXPECT_EQ(count_pieces(hollow), 1u) << "a cavity";
    EXPECT_EQ(count_pieces(both(hollow, sphere(vec3(0), 0.2f, 3))), 2u) << "loose in a cavity";
    EXPECT_EQ(count_pieces(both(hollow, sphere({0.75f, 0, 0}, 0.2f, 3))), 1u) << "in its wall";
    const Mesh stone = both(sphere(vec3(0), 0.2f, 3), inside_out(sphere(vec3(0), 0.1f, 2)));
    EXPECT_EQ(count_pieces(both(hollow, stone)), 2u) << "hollow itself";
}

TEST(Pieces, VolumesAreThoseOfWhatIsUnited) {
    const Mesh far = box({9, 9, 9}, {10, 10, 10});
    auto first = [&](const Mesh& mesh) {
        const Mesh two = both(mesh, far);
        const Pieces found = pieces(two, parts(two));
        EXPECT_EQ(found.volume.size(), 2u);
        EXPECT_TRUE(std::abs(found.volume.back() - 1) <= 1e-5);
        return found.volume.front();
    };
    EXPECT_TRUE(std::abs(first(both(cube, box({0.1f, 0, 0}, {1.1f, 1, 1}))) - 1.1) <= 0.03);
    EXPECT_TRUE(std::abs(first(both(sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.5f, 4)))) /
                             (ball_volume * 7 / 8) -
                         1) <= 0.01);
    Mesh open = sphere(vec3(0), 1, 4);  // half of it is not there: the lid that closes it best is flat
    std::erase_if(open.triangles, [&](uvec3 t) {
        return open.positions[t.x].z + open.positions[t.y].z + open.positions[t.z].z > 0;
    });
    EXPECT_TRUE(std::abs(first(open) / (ball_volume / 2) - 1) <= 0.2) << first(open);
}

TEST(Pieces, TheLargestIsSoByVolume) {
    Mesh mesh = both(sphere(vec3(5), 0.5f, 5), sphere(vec3(0), 1, 2));  // not by its faces
    Dropped went = keep_largest(mesh);
    EXPECT_EQ(went.parts, 1u);
    EXPECT_TRUE(std::abs(went.volume / (ball_volume / 8) - 1) <= 0.01);
    EXPECT_EQ(mesh.triangles, sphere(vec3(0), 1, 2).triangles);

    // Two that make 1.5 together, each smaller than the third.
    mesh = all({cube, box({5, 0, 0}, {6.3f, 1, 1}), box({0.5f, 0.1f, 0}, {1.5f, 1.1f, 1})});
    EXPECT_EQ(keep_largest(mesh).parts, 1u);
    expect_volume(mesh, 2);  // as they are still two
    mesh = all({cube, inside_out(box({1, 0, 0}, {2, 1, 1})), box({5, 0, 0}, {6.3f, 1, 1})});
    EXPECT_EQ(keep_largest(mesh).parts, 1u) << "which way out they are does not matter";
    EXPECT_EQ(mesh.triangles.size(), 24u);

    // Two that share most of what they are, and are less together than the third.
    mesh = all({cube, box({0.1f, 0, 0}, {1.1f, 1, 1}), box({5, 0, 0}, {6.3f, 1, 1})});
    went = keep_largest(mesh);
    EXPECT_EQ(went.parts, 2u);
    EXPECT_TRUE(std::abs(went.volume / 1.1 - 1) <= 0.03) << went.volume;
    expect_volume(mesh, 1.3);

    // A large one that is mostly hollow.
    mesh = all({sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.95f, 4)), sphere(vec3(5), 0.7f, 4)});
    EXPECT_EQ(keep_largest(mesh).parts, 2u);
    expect_volume(mesh, volume(sphere(vec3(5), 0.7f, 4)));
}

TEST(Pieces, ACavityStaysWithWhatItIsIn) {
    const Mesh hollow = both(sphere(vec3(0), 1, 4), inside_out(sphere(vec3(0), 0.5f, 4)));
    Mesh mesh = both(hollow, sphere(vec3(3), 0.5f, 4));
    EXPECT_EQ(keep_largest(mesh).parts, 1u);
    EXPECT_EQ(mesh.triangles, hollow.triangles);
    mesh = both(hollow, sphere(vec3(0), 0.2f, 3));
    EXPECT_EQ(keep_largest(mesh).parts, 1u) << "but not what is loose in it";
    EXPECT_EQ(mesh.triangles, hollow.triangles);
}

TEST(Pieces, OfSheetsTheLargestIsSoByArea) {
    const Mesh small{{vec3(5), vec3(6, 5, 5), vec3(5, 6, 5), vec3(6, 6, 5)}, {}, {{0, 1, 2}, {1, 3, 2}}};
    const Mesh large{{vec3(0), vec3(3, 0, 0), vec3(0, 3, 0)}, {}, {{0, 1, 2}}};
    const Mesh speck{{vec3(9), vec3(9.02f, 9, 9), vec3(9, 9.02f, 9)}, {}, {{0, 1, 2}}};
    Mesh mesh = all({small, large, speck});
    const std::vector<Repair> steps = repair(mesh, {.specks = 0.01f, .largest = true, .sheet = true});
    EXPECT_EQ(mesh.triangles.size(), 1u);
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(steps[0].what, "specks dropped");
    EXPECT_TRUE(std::abs(steps[0].share / (2e-4 / 5.5) - 1) <= 1e-3) << steps[0].share;
    EXPECT_EQ(steps[1].count, 1u);
    EXPECT_TRUE(std::abs(steps[1].share - 1 / 5.5) <= 1e-4) << steps[1].share;
    EXPECT_EQ(in_words(steps[1]), "smaller parts dropped: 1 (18 % of the area)");
}

}  // namespace
}  // namespace palpate
