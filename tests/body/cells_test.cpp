#include "palpate/body/cells.h"

#include "palpate/body/grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

namespace palpate {
namespace {

// Connected parts among the cells of one kind, by faces or by faces, edges and corners.
int parts(const Cells& cells, bool filled, bool by_faces) {
    GridIndex part(ivec3(0), cells.dims);
    int count = 0;
    for_each_place(cells.dims, [&](ivec3 start) {
        if (cells.at(start) != filled || part.at(start) >= 0) return;
        std::vector<ivec3> open{start};
        part[start] = count;
        while (!open.empty()) {
            const ivec3 c = open.back();
            open.pop_back();
            for_each_place(ivec3(3), [&](ivec3 d) {
                d -= 1;
                if (by_faces && std::abs(d.x) + std::abs(d.y) + std::abs(d.z) != 1) return;
                if (!part.holds(c + d) || cells.at(c + d) != filled || part.at(c + d) >= 0) return;
                part[c + d] = count;
                open.push_back(c + d);
            });
        }
        ++count;
    });
    return count;
}

// A cell whose lowest `layers` of four, along z, are inside.
Samples layers(int count) { return {count == 4 ? ~0ull : (1ull << 16 * count) - 1, 0}; }

struct Sampled {
    ivec3 dims;
    std::vector<Samples> samples;
    explicit Sampled(ivec3 size) : dims(size), samples(std::size_t(size.x * size.y * size.z)) {}
    Samples& operator[](ivec3 c) { return samples[std::size_t((c.z * dims.y + c.y) * dims.x + c.x)]; }
};

TEST(Cells, HalfFullCellsAreFilledAndEmptyOnesAreNot) {
    std::mt19937_64 random(3);
    Sampled solid({9, 7, 11});
    for (Samples& s : solid.samples)
        if (random() % 2) s = {random() & random(), random()};
    const Cells cells = fill(solid.dims, solid.samples);
    for (std::size_t i = 0; i < solid.samples.size(); ++i) {
        if (std::popcount(solid.samples[i].inside) >= 32) EXPECT_TRUE(cells.filled[i]);
        if (!solid.samples[i].inside && !solid.samples[i].near) EXPECT_FALSE(cells.filled[i]);
    }
}

TEST(Cells, ThicknessIsRoundedToTheNearestCell) {
    for (int part : {0, 1, 2, 3, 4}) {
        Sampled slab({8, 8, 6});
        for_each_place({8, 8, 5}, [&](ivec3 c) {
            if (c.x > 0 && c.y > 0 && c.x < 7 && c.y < 7 && c.z > 0) slab[c] = layers(c.z == 4 ? part : 4);
        });
        const Cells cells = fill(slab.dims, slab.samples);
        EXPECT_EQ(cells.at({3, 3, 4}), part >= 2) << part;
        EXPECT_TRUE(cells.at({3, 3, 3}));
        EXPECT_FALSE(cells.at({3, 3, 5}));
    }
}

TEST(Cells, AThinSheetStaysWholeAndAttached) {
    // A block, and a sheet one layer of points thick, or thinner: only near. Its neighbours above are near as
    // well, a little, and go.
    for (bool thinner : {false, true}) {
        Sampled solid({16, 9, 9});
        for_each_place(solid.dims, [&](ivec3 c) {
            if (c.x > 0 && c.x < 6 && std::min(c.y, c.z) > 0 && std::max(c.y, c.z) < 8) solid[c] = layers(4);
            if (c.x < 6 || c.x > 14 || c.y < 1 || c.y > 7) return;
            if (c.z == 4) solid[c] = thinner ? Samples{0, layers(3).inside} : layers(1);
            if (c.z == 3) solid[c].near = 0xffffull << 48;
        });
        const Cells cells = fill(solid.dims, solid.samples);
        EXPECT_EQ(parts(cells, true, false), 1);
        for (int x = 7; x < 15; ++x)
            for (int y = 1; y < 8; ++y) {
                EXPECT_TRUE(cells.at({x, y, 4})) << x << ' ' << y;
                EXPECT_FALSE(cells.at({x, y, 3})) << x << ' ' << y;
            }
    }
}

TEST(Cells, AGapOneCellWideIsNotBridged) {
    // Two blocks; the cells between them hold a layer of points of the one, or of each.
    for (std::uint64_t rim : {0xfffull, 0xfffull | 0xfffull << 48}) {
        Sampled solid({8, 8, 9});
        for_each_place(solid.dims, [&](ivec3 c) {
            if (std::min({c.x, c.y, c.z}) == 0 || std::max({c.x, c.y}) == 7 || c.z == 8) return;
            solid[c] = c.z == 4 ? Samples{rim, 0} : layers(4);
        });
        const Cells cells = fill(solid.dims, solid.samples);
        EXPECT_EQ(parts(cells, true, false), 2);
        EXPECT_EQ(std::count(cells.filled.begin(), cells.filled.end(), 1), 2 * 6 * 6 * 3);
    }
}

// Tubes that wind at random, one point thick: the cells that are left hang together as the points do, and no
// point is far from them.
TEST(Cells, WhatHangsTogetherStaysTogether) {
    std::mt19937 random(5);
    for (int round = 0; round < 20; ++round) {
        const int size = 40;
        Sampled solid(ivec3(size / 4));
        std::vector<ivec3> points;
        ivec3 at(size / 2);
        for (int i = 0; i < 400; ++i) {
            solid[at / 4].inside |= 1ull << (at.x % 4 + 4 * (at.y % 4) + 16 * (at.z % 4));
            points.push_back(at);
            const int axis = int(random() % 3);
            at[axis] = std::clamp(at[axis] + (random() % 2 ? 1 : -1), 4, size - 5);
        }
        const Cells cells = fill(solid.dims, solid.samples);
        EXPECT_EQ(parts(cells, true, false), 1);
        for (ivec3 p : points) {
            bool close = false;
            for_each_place(ivec3(5), [&](ivec3 d) { close |= cells.at((p + d - 2) / 4); });
            EXPECT_TRUE(close);
        }
    }
}

}  // namespace
}  // namespace palpate
