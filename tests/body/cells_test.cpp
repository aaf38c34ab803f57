#include "palpate/body/cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "palpate/body/grid.h"

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

Cells touched(ivec3 dims, const std::vector<float>& inside) {
    Cells cells{dims, {}};
    for (float part : inside) cells.filled.push_back(part > 0);
    return cells;
}

TEST(Cells, HalfFullCellsAreFilledAndEmptyOnesAreNot) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> any(0, 1);
    const ivec3 dims(9, 7, 11);
    std::vector<float> inside(9 * 7 * 11);
    for (float& part : inside) part = any(random) < 0.5f ? 0 : any(random);
    const Cells cells = fill(dims, inside);
    for (std::size_t i = 0; i < inside.size(); ++i) {
        if (inside[i] >= 0.5f) EXPECT_TRUE(cells.filled[i]);
        if (inside[i] == 0) EXPECT_FALSE(cells.filled[i]);
    }
}

TEST(Cells, ThicknessIsRoundedToTheNearestCell) {
    // A slab that covers a fraction of its outermost layers: they go where the fraction is below a half.
    for (float part : {0.1f, 0.4f, 0.6f, 0.9f}) {
        const ivec3 dims(8, 8, 6);
        std::vector<float> inside(8 * 8 * 6, 0);
        for_each_place(dims, [&](ivec3 c) {
            const bool rim = c.x == 0 || c.y == 0 || c.x == 7 || c.y == 7;
            if (rim || c.z == 0 || c.z == 5) return;
            inside[std::size_t((c.z * 8 + c.y) * 8 + c.x)] = c.z == 4 ? part : 1;
        });
        const Cells cells = fill(dims, inside);
        EXPECT_EQ(cells.at({3, 3, 4}), part >= 0.5f) << part;
        EXPECT_TRUE(cells.at({3, 3, 3}));
    }
}

TEST(Cells, AThinSheetStaysWholeAndAttached) {
    // A block with a sheet that fills a third of each of its cells.
    const ivec3 dims(16, 9, 9);
    std::vector<float> inside(16 * 9 * 9, 0);
    for_each_place(dims, [&](ivec3 c) {
        float& part = inside[std::size_t((c.z * 9 + c.y) * 16 + c.x)];
        if (c.x > 0 && c.x < 6 && std::min(c.y, c.z) > 0 && std::max(c.y, c.z) < 8) part = 1;
        if (c.x >= 6 && c.x < 15 && c.y > 0 && c.y < 8 && c.z == 4) part = 0.33f;
    });
    const Cells cells = fill(dims, inside);
    EXPECT_EQ(parts(cells, true, false), 1);
    for (int x = 7; x < 15; ++x)
        for (int y = 1; y < 8; ++y) EXPECT_TRUE(cells.at({x, y, 4})) << x << ' ' << y;
}

TEST(Cells, TakingCellsAwayKeepsTheTopology) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(0, 1);
    for (int round = 0; round < 20; ++round) {
        const ivec3 dims(8, 9, 7);  // with an empty rim, so that there is one outside
        std::vector<float> inside(8 * 9 * 7, 0);
        for_each_place(dims, [&](ivec3 c) {
            const bool rim = glm::any(glm::equal(c, ivec3(0))) || glm::any(glm::equal(c, dims - 1));
            if (!rim && any(random) < 0.4f) inside[std::size_t((c.z * 9 + c.y) * 8 + c.x)] = any(random);
        });
        const Cells before = touched(dims, inside), after = fill(dims, inside);
        EXPECT_EQ(parts(after, true, false), parts(before, true, false));
        EXPECT_EQ(parts(after, false, true), parts(before, false, true));
    }
}

}  // namespace
}  // namespace palpate
