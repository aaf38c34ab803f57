#include "palpate/body/lattice.h"

#include "palpate/base/error.h"
#include "palpate/body/hull.h"
#include "palpate/body/select.h"
#include "tests/forces.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace palpate {
namespace {

const Material of_springs{.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs};

// What one end of a spring says of it, the other says too.
void expect_symmetric(const Body& body) {
    const Table springs = table(body);
    for (std::size_t i = 0; i < body.count(); ++i)
        for (const Tie& tie : springs.of(i)) {
            if (tie.to < 0) {
                EXPECT_EQ(tie.share, 0);
                continue;
            }
            const auto back = springs.of(std::size_t(tie.to));
            const bool same = std::any_of(back.begin(), back.end(), [&](const Tie& other) {
                return other.to == int(i) && other.share == tie.share && other.stiffness == tie.stiffness &&
                       other.rest == tie.rest;
            });
            EXPECT_TRUE(same) << i << ' ' << tie.to;
        }
}

TEST(Lattice, CountsOfAPlainBox) {
    for (ivec3 d :
         {ivec3(1, 1, 1), ivec3(2, 1, 1), ivec3(3, 2, 1), ivec3(2, 2, 2), ivec3(7, 8, 9), ivec3(17, 3, 15)}) {
        const Body body = lattice(d, 0.01f, of_springs);
        const ivec3 c = d - 1;
        EXPECT_EQ(body.count(), std::size_t(d.x * d.y * d.z));
        EXPECT_EQ(body.cells.size(), std::size_t(c.x * c.y * c.z));
        const int along = c.x * d.y * d.z + d.x * c.y * d.z + d.x * d.y * c.z;
        const int across = 2 * (c.x * c.y * d.z + c.x * d.y * c.z + d.x * c.y * c.z);
        EXPECT_EQ(spring_ends(body).size(), std::size_t(along + across));
        expect_symmetric(body);
    }
}

TEST(Lattice, MassOfABoxIsDensityTimesItsVolume) {
    const Body body = lattice({7, 8, 9}, 0.01f, of_springs);
    EXPECT_NEAR(mass(body), 1000 * 0.06 * 0.07 * 0.08, 1e-6);
    const Body given = lattice({7, 8, 9}, 0.01f, {.youngs_modulus = 1, .mass = 2.5f});
    EXPECT_NEAR(mass(given), 2.5, 1e-5);
}

TEST(Lattice, SharesAreThoseOfTheCellsAround) {
    const Body body = lattice({3, 3, 3}, 1, of_springs);
    auto quarters = [&](ivec3 at, ivec3 offset) {
        for (std::size_t i = 0; i < body.count(); ++i)
            for (std::size_t l = 0; l < 18; ++l)
                if (body.at[i] == at && body.grid()->links[l].offset == offset)
                    return body.grid()->quarters(i, l);
        return -1;
    };
    EXPECT_EQ(quarters({1, 1, 1}, {1, 0, 0}), 4);   // inside: four of four cells
    EXPECT_EQ(quarters({0, 1, 0}, {1, 0, 0}), 2);   // on a face
    EXPECT_EQ(quarters({0, 0, 0}, {1, 0, 0}), 1);   // on an edge
    EXPECT_EQ(quarters({0, 0, 1}, {1, 1, 0}), 4);   // a diagonal between two cells
    EXPECT_EQ(quarters({0, 0, 0}, {1, 1, 0}), 2);   // a diagonal of the outside
    EXPECT_EQ(quarters({0, 0, 0}, {-1, 0, 0}), 0);  // where no node is
}

TEST(Lattice, OneNodeThickPartsKeepTheirSprings) {
    const Body sheet = lattice({4, 5, 1}, 1, of_springs);
    EXPECT_EQ(sheet.cells.size(), 0u);
    for (std::size_t i = 0; i < sheet.count(); ++i)
        for (std::size_t l = 0; l < 18; ++l)
            if (const int q = sheet.grid()->quarters(i, l)) EXPECT_EQ(q, l < 6 ? 1 : 2);
    EXPECT_NEAR(1 / sheet.inverse_mass[0], 1000.0 / 8, 1e-2);
}

TEST(Lattice, StiffnessFromTheModulus) {
    const Body body = lattice({3, 3, 3}, 0.02f, of_springs);
    EXPECT_NEAR(body.grid()->links[0].stiffness, 0.4 * 5000 * 0.02, 1e-4);
    EXPECT_NEAR(body.grid()->links[6].rest, 0.02 * std::sqrt(2), 1e-8);
}

// A homogeneous strain leaves no force on any node but those at the ends, at every thickness: the shares make
// the lattice one solid. Straight from the springs, without a solver.
TEST(Lattice, AStretchedBarIsInBalanceAndShowsItsModulus) {
    for (int n : {2, 3, 5, 11}) {
        const int length = 9;
        const float h = 0.01f;
        const Body body = lattice({length, n, n}, h, of_springs);
        const double strain = 1e-3;
        std::vector<dvec3> p;
        for (vec3 rest : body.positions)
            p.push_back(dvec3(rest) * dvec3(1 + strain, 1 - strain / 4, 1 - strain / 4));
        const std::vector<dvec3> forces = spring_forces(body, p);
        double end = 0, largest_inside = 0;
        for (std::size_t i = 0; i < body.count(); ++i) {
            const int x = body.at[i].x;
            if (x == 0) end += forces[i].x;
            if (x > 0 && x < length - 1) largest_inside = std::max(largest_inside, glm::length(forces[i]));
        }
        const double area = (n - 1) * (n - 1) * double(h) * h;
        const double modulus = end / area / strain;
        EXPECT_LE(std::abs(modulus / 5000 - 1), 1e-3) << n;  // the strain itself stiffens by 0.07 %
        EXPECT_LE(largest_inside, 1e-3 * end) << n;
    }
}

TEST(Lattice, MeetsTheNumberOfNodesAndTheMass) {
    for (int nodes : {500, 3000, 20'000}) {
        const Mesh mesh = ellipsoid({0.05f, 0.04f, 0.06f}, 60);
        const Body body = lattice(mesh, {.nodes = nodes, .material = of_springs});
        EXPECT_LE(std::abs(double(body.count()) / nodes - 1), 0.05) << nodes;
        EXPECT_LE(std::abs(mass(body) / (1000 * volume(mesh)) - 1), 0.02) << nodes;
        // The cells themselves have the mesh's volume too: mass is not merely made to fit.
        const double cells = double(body.cells.size()) * std::pow(body.spacing, 3);
        EXPECT_LE(std::abs(cells / volume(mesh) - 1), nodes < 1000 ? 0.05 : 0.02) << nodes;
        expect_symmetric(body);
    }
}

TEST(Lattice, TakesTheSpacingItIsGiven) {
    const Body body =
        lattice(block(vec3(0), vec3(0.04f, 0.03f, 0.05f)), {.spacing = 0.01f, .material = of_springs});
    EXPECT_FLOAT_EQ(body.spacing, 0.01f);
    EXPECT_EQ(body.cells.size(), 4u * 3u * 5u);
}

TEST(Lattice, NothingThinVanishes) {
    // A ball with a plate of a fifth of the spacing through it: every place of the plate has a cell, all in
    // one piece.
    const float h = 0.01f;
    const Mesh mesh =
        both(ellipsoid(vec3(0.03f), 40), block({-0.08f, -0.05f, -0.001f}, {0.08f, 0.05f, 0.001f}, 12));
    const Body body = lattice(mesh, {.spacing = h, .material = of_springs});
    for (float x = -0.079f; x < 0.08f; x += 0.004f)
        for (float y = -0.049f; y < 0.05f; y += 0.004f) {
            bool covered = false;
            for (const auto& cell : body.cells) {
                const vec3 low = body.positions[cell[0]];
                const vec3 p(x, y, 0);
                covered |= glm::all(glm::greaterThanEqual(p, low - 0.5f * h)) &&
                           glm::all(glm::lessThanEqual(p, low + 1.5f * h));
            }
            EXPECT_TRUE(covered) << x << ' ' << y;
        }
    // All nodes hang together by springs.
    const Table springs = table(body);
    std::vector<bool> seen(body.count());
    std::vector<int> open{0};
    std::size_t reached = 0;
    seen[0] = true;
    while (!open.empty()) {
        const int i = open.back();
        open.pop_back();
        ++reached;
        for (const Tie& tie : springs.of(std::size_t(i)))
            if (tie.share > 0 && !seen[std::size_t(tie.to)]) {
                seen[std::size_t(tie.to)] = true;
                open.push_back(tie.to);
            }
    }
    EXPECT_EQ(reached, body.count());
}

TEST(Lattice, AThinSheetAloneBecomesOneCellThick) {
    const Body body =
        lattice(block(vec3(0), {0.1f, 0.1f, 1e-4f}, 10), {.spacing = 0.01f, .material = of_springs});
    EXPECT_EQ(body.cells.size(), 100u);
    EXPECT_NEAR(mass(body), 1000 * 1e-6, 1e-8);
    EXPECT_GT(lattice(block(vec3(0), vec3(0.1f)), {.spacing = 1, .material = of_springs}).cells.size(), 0u);
}

TEST(Lattice, RefusesWhatCannotBeFilled) {
    Mesh flat;
    flat.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    flat.triangles = {{0, 1, 2}};
    EXPECT_THROW(lattice(flat, {.material = of_springs}), Error);
    EXPECT_THROW(lattice(ellipsoid(vec3(1), 20), {.spacing = 1e-4f, .material = of_springs}), Error);
}

TEST(Select, PinsByHeightPlaceAndBox) {
    Body body = lattice({4, 11, 4}, 0.01f, of_springs);
    EXPECT_EQ(nodes_below(body, 0.1f, {0, -1, 0}).size(), 2u * 16u);
    EXPECT_EQ(nodes_below(body, 0, {0, -1, 0}).size(), 16u);
    EXPECT_EQ(nodes_near(body, {0.0101f, 0.0202f, 0}).size(), 1u);
    EXPECT_EQ(nodes_near(body, vec3(0), 0.0101f).size(), 4u);
    const Bounds box{vec3(-0.001f), vec3(0.031f, 0.001f, 0.031f)};
    const std::vector<int> bottom = nodes_in(body, box);
    EXPECT_EQ(bottom.size(), 16u);
    pin(body, bottom);
    for (int node : bottom) EXPECT_EQ(body.inverse_mass[std::size_t(node)], 0);
}

TEST(Hull, OfABoxIsClosedAndTurnsOutward) {
    const Body body = lattice({4, 3, 5}, 0.01f, of_springs);
    const Mesh mesh = hull_mesh(body);
    EXPECT_NEAR(volume(mesh), 0.03 * 0.02 * 0.04, 1e-9);
    EXPECT_EQ(mesh.triangles.size(), 2u * 2u * (3 * 2 + 2 * 4 + 3 * 4));
}

}  // namespace
}  // namespace palpate
