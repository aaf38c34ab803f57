// The stress that its own weight causes in a body, against the theory of beams.
#include "palpate/body/own_weight.h"

#include "palpate/base/pose.h"
#include "palpate/body/edit.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

constexpr float h = 0.01f, density = 1000;
constexpr double earth = 9.81;
const vec3 gravity(0, -float(earth), 0);
const Material jelly{.youngs_modulus = 1e4f, .density = density};

void expect_within(double found, double expected, double part) {
    EXPECT_TRUE(std::abs(found / expected - 1) <= part) << found << " for " << expected;
}

// A column stands on its lowest layer: density x gravity x height, less half a layer that the held nodes
// bear.
TEST(OwnWeight, OfAColumn) {
    for (int n : {2, 5, 11, 30}) {
        const Body column = lattice({4, n + 1, 3}, h, jelly);
        const double height = (n - 0.5) * h;
        const std::vector<int> feet = nodes_below(column, 0, {0, -1, 0}),
                               top = nodes_below(column, 0, {0, 1, 0});
        expect_within(own_weight_stress(column, feet, gravity), density * earth * height, 1e-6);
        expect_within(own_weight_stress(column, top, gravity), density * earth * height, 1e-6);
        expect_within(own_weight_stress(column, {}, gravity), density * earth * height, 1e-6);
        EXPECT_EQ(own_weight_stress(column, feet, vec3(0)), 0);
    }
}

// It is the same however gravity and the body are turned together.
TEST(OwnWeight, InAnyDirection) {
    Body column = lattice({3, 12, 4}, h, jelly);
    const std::vector<int> feet = nodes_below(column, 0, {0, -1, 0});
    const double upright = own_weight_stress(column, feet, gravity);
    const glm::quat turned = glm::angleAxis(0.7f, glm::normalize(vec3(1, 2, -0.5f)));
    for (vec3& p : column.positions) p = turned * p + vec3(0.2f, -0.1f, 3);
    expect_within(own_weight_stress(column, feet, turned * gravity), upright, 1e-3);
}

// A mast of a x a with an arm to one side: pressed, and bent by the arm's weight: W/A + M c / I, I = a^4
// / 12.
TEST(OwnWeight, OfWhatStandsAside) {
    Body body = lattice({21, 31, 3}, h, jelly);
    Edit away;  // all but the mast, x below 2 h, and the arm, y above 28 h
    for (std::size_t c = 0; c < body.cells.size(); ++c) {
        vec3 low = body.positions[std::size_t(body.cells[c][0])];
        if (low.x > 1.5f * h && low.y < 27.5f * h) away.cells.push_back(int(c));
    }
    apply(body, away);
    const std::vector<int> feet = nodes_below(body, 0, {0, -1, 0});
    const double a = 2 * h, cell = density * earth * h * h * h;
    const double mast = 30 * 4 * cell, arm = 18 * 2 * 2 * cell, lever = 10 * h;
    const double stress = (mast + arm) / (a * a) + arm * lever * (a / 2) / (std::pow(a, 4) / 12);
    expect_within(own_weight_stress(body, feet, gravity), stress, 0.05);
}

// Held at one end, a beam of length L is bent by 3 density x gravity x L^2 / a, whatever lies across.
TEST(OwnWeight, OfAShelf) {
    for (int axis : {0, 2})
        for (int thick : {4, 7}) {
            ivec3 dims(thick + 1);
            dims[axis] = 61;
            const Body shelf = lattice(dims, h, jelly);
            std::vector<int> wall;
            for (std::size_t i = 0; i < shelf.count(); ++i)
                if (shelf.at[i][axis] == 0) wall.push_back(int(i));
            const double length = 59.5 * double(h), a = thick * double(h);
            expect_within(own_weight_stress(shelf, wall, gravity), 3 * density * earth * length * length / a,
                          0.03);
            const std::vector<int> corner = {wall[0]};
            EXPECT_EQ(own_weight_stress(shelf, corner, gravity), 0);
        }
}

}  // namespace
}  // namespace palpate
