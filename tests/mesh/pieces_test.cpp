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

// Copies of a mesh no longer than 1, in a cubic grid.
Mesh crumbs(const Mesh& one, int across) {
    Mesh mesh;
    for (int i = 0; i < across * across * across; ++i) {
        const vec3 at(i % across, i / across % across, i / across / across);
        const auto first = unsigned(mesh.positions.size());
        for (vec3 p : one.positions) mesh.positions.push_back(p + 2.0f * at);
        for (uvec3 t : one.triangles) mesh.triangles.push_back(t + first);
    }
    return mesh;
}

// These would take minutes if time went with the square of their number, or with what is beside a part.
TEST(Pieces, MayBeTensOfThousands) {
    const int across = 27;
    const Mesh many = crumbs(cube, across);
    const Index count = across * across * across;
    const Pieces found = pieces(many, parts(many));
    ASSERT_EQ(found.volume.size(), count);
    for (double one : found.volume) ASSERT_TRUE(std::abs(one - 1) <= 1e-4) << one;
    Mesh mesh = both(many, inside_out(box(vec3(-1), vec3(2 * across))));  // they lie loose in a cavity
    EXPECT_EQ(count_pieces(mesh), count + 1);
    mesh = both(many, box(vec3(-1), vec3(2 * across)));
    EXPECT_EQ(count_pieces(mesh), 1u);
}

TEST(Pieces, ManyOpenOnesAreMeasuredToo) {
    Mesh open = cube;
    open.triangles.pop_back();
    const Mesh mesh = both(crumbs(open, 10), box(vec3(-9), vec3(-2)));
    const Pieces found = pieces(mesh, parts(mesh));
    ASSERT_EQ(found.volume.size(), 10u * 10 * 10 + 1);
    for (Index i = 0; i + 1 < found.volume.size(); ++i)
        ASSERT_TRUE(0.8 <= found.volume[i] && found.volume[i] <= 1) << found.volume[i];
    EXPECT_TRUE(std::abs(found.volume.back() / 343 - 1) <= 1e-4);
}

// A square in the plane z = 0, of so many squares along a side.
Mesh sheet(unsigned across, float side) {
    Mesh mesh;
    for (unsigned y = 0; y <= across; ++y)
        for (unsigned x = 0; x <= across; ++x) {
            mesh.positions.push_back(side / float(across) * vec3(x, y, 0));
            const unsigned i = y * (across + 1) + x, above = i + across + 1;
            if (x < across && y < across)
                mesh.triangles.insert(mesh.triangles.end(), {{i, i + 1, above}, {i + 1, above + 1, above}});
        }
    return mesh;
}

// Two sheets so nearly flat that points as far apart as in a cube of their volume would be countless.
TEST(Pieces, MayBeAlmostFlat) {
    for (float noise : {1e-8f, 1e-13f, 0.0f})
        for (int axis = 0; axis < 3; ++axis) {
            const Mesh flat = sheet(12, 0.1f);
            std::mt19937 random(7);
            std::uniform_real_distribution<float> off(-noise, noise);
            auto turned = [&](vec3 at) {
                Mesh mesh = flat;
                for (vec3& p : mesh.positions) {
                    p.z = noise > 0 ? off(random) : 0;
                    p = at + (axis == 0 ? vec3(p.z, p.x, p.y) : axis == 1 ? vec3(p.y, p.z, p.x) : p);
                }
                return mesh;
            };
            const vec3 aside(axis != 0, axis == 0, 0);
            const Mesh two = both(turned(vec3(0)), turned(aside));
            const Pieces found = pieces(two, parts(two));
            ASSERT_EQ(found.volume.size(), 2u);
            for (double one : found.volume)
                EXPECT_TRUE(0 <= one && one <= 0.01 * 2.01 * double(noise)) << one << " of noise " << noise;
        }
    // A box as thin has its volume, though but a single layer of points is counted in it.
    const Mesh plate = both(box(vec3(0), {1, 1, 1e-9f}), box({0.5f, 0, 0}, {1.5f, 1, 1e-9f}));
    const Mesh rod = box({3, 0, 0}, {4, 1e-6f, 1e-6f});
    const Mesh both_thin = both(plate, both(rod, box({3.5f, 0, 0}, {5, 1e-6f, 1e-6f})));
    const Pieces found = pieces(both_thin, parts(both_thin));
    ASSERT_EQ(found.volume.size(), 2u);
    EXPECT_TRUE(std::abs(found.volume[0] / 1.5e-9 - 1) <= 0.02) << found.volume[0];
    EXPECT_TRUE(std::abs(found.volume[1] / 2e-12 - 1) <= 0.02) << found.volume[1];
}

TEST(Pieces, TooCrowdedToBeLookedAtAreSaid) {
    // Two fans of long thin faces: every box overlaps all others, and each face lies across one of the other
    // fan, in whose middle is its own.
    Mesh mesh = box({5, 5, 5}, {6, 6, 6});
    for (const vec3 off : {vec3(0), vec3(0.1f, -0.1f, 0)}) {
        const auto tip = unsigned(mesh.positions.size());
        mesh.positions.push_back(off - 1.0f);
        for (unsigned i = 0; i < 3500; ++i) {
            const float a = 2 * float(M_PI) * float(i) / 3500;
            const vec3 end = vec3(1 + 0.1f * std::cos(a), 1 + 0.1f * std::sin(a), 1) - 0.5f * off;
            mesh.positions.insert(mesh.positions.end(), {end, end + vec3(1e-3f, 0, 0)});
            mesh.triangles.push_back({tip, tip + 2 * i + 1, tip + 2 * i + 2});
        }
    }
    const std::size_t faces = mesh.triangles.size();
    EXPECT_FALSE(pieces(mesh, parts(mesh)).all);
    const Dropped went = keep_largest(mesh);
    EXPECT_EQ(went.parts, 0u);
    EXPECT_EQ(went.crowded, faces);
    EXPECT_EQ(mesh.triangles.size(), faces);
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
