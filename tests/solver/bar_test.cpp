// A bar of the 18-link lattice, stretched by 0.1 % between its ends and left to come to rest, shows its
// modulus.
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/solver.h"
#include "tests/forces.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate {
namespace {

struct Pulled {
    double force;   // N, across the middle of the bar
    double strain;  // there
};

// Ends held at 1.001 times the length; force and strain are read in the middle, away from the clamps.
Pulled pull(int thick, Links links) {
    const float h = 0.01f;
    const int length = 5 * thick + 7;
    Body body = lattice({length, thick, thick}, h,
                        {.youngs_modulus = 5000, .density = 1000, .damping = 8, .links = links});
    const float stretch = 1.001f, narrow = 1 - 0.001f / 4;
    for (vec3& p : body.positions) p *= vec3(stretch, narrow, narrow);
    pin(body, nodes_in(body, {vec3(-1), vec3(0.001f, 1, 1)}));
    pin(body, nodes_in(body, {vec3((length - 1) * h, -1, -1), vec3(10, 1, 1)}));
    Simulation simulation;
    simulation.gravity = vec3(0);
    auto solver = make_solver(body, simulation);
    for (int i = 0; i < 240; ++i) solver->step(1.0 / 60);

    const std::vector<dvec3> p = solver->state().positions;
    const Table springs = table(body);
    const int middle = length / 2;
    double force = 0, left = 0, right = 0;
    for (std::size_t i = 0; i < body.count(); ++i) {
        const int x = body.at[i].x;
        if (x == middle - 2) left += p[i].x / (thick * thick);
        if (x == middle + 2) right += p[i].x / (thick * thick);
        if (x != middle) continue;
        for (std::size_t l = 0; l < 18; ++l) {
            const Tie& tie = springs.of(i)[l];
            if (tie.to < 0 || body.grid()->links[l].offset.x != 1) continue;
            const dvec3 along = p[std::size_t(tie.to)] - p[i];
            const double d = glm::length(along);
            force += double(tie.share) * tie.stiffness * (d - tie.rest) * along.x / d;
        }
    }
    return {force, (right - left) / (4 * double(h)) - 1};
}

TEST(Bar, WithSharesItShowsItsModulusAtEveryThickness) {
    for (int n : {2, 3, 5, 11}) {
        const auto [force, strain] = pull(n, Links::cells);
        const double area = std::pow((n - 1) * 0.01, 2);
        EXPECT_LE(std::abs(force / (area * strain) / 5000 - 1), 0.005) << n;
    }
}

TEST(Bar, WithEqualLinksItIsTooSoftByTheKnownDeficit) {
    const std::pair<int, double> known[] = {{2, 0.67}, {3, 0.77}, {5, 0.86}, {11, 0.94}};
    for (const auto& [n, share] : known) {
        const auto [force, strain] = pull(n, Links::equal);
        const double area = std::pow(n * 0.01, 2);
        EXPECT_LE(std::abs(force / (area * strain) / 5000 - share), 0.01) << n;
    }
}

}  // namespace
}  // namespace palpate
