// Cells of tissue: the forces are the slope of the energy, the solid is as stiff as it is told, keeps its
// volume, and comes back from wherever it was put.
#include "bench/tissue.h"

#include "palpate/base/pipe.h"
#include "palpate/body/lattice.h"
#include "palpate/solver/forces.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate {
namespace {

using Places = std::vector<dvec3>;

Places places(const Body& body) { return {body.positions.begin(), body.positions.end()}; }

Places scattered(Places from, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> way(-size, size);
    for (dvec3& p : from) p += dvec3(way(random), way(random), way(random));
    return from;
}

Places forces(const Body& body, const Places& at) {
    Places made(at.size());
    Forces(body).at(at, made);
    return made;
}

double largest(const Places& vectors) {
    double most = 0;
    for (dvec3 v : vectors)
        if (const double length = glm::length(v); !(length <= most)) most = length;
    return most;
}

// An organ with cells of many weights.
Body ragged(float poisson, unsigned seed) {
    Material material = of_tissue;
    material.poisson = poisson;
    Body body = lattice(ellipsoid({0.02f, 0.03f, 0.025f}, 9), {.nodes = 90, .material = material});
    std::mt19937 random(seed);
    for (Term& term : body.terms)
        if (auto* cells = std::get_if<TissueCells>(&term))
            for (float& weight : cells->weights)
                weight *= std::uniform_real_distribution<float>(0.2f, 3)(random);
    return body;
}

// The energy as a textbook writes it: F from the gradients of trilinear shape functions in the middle of a
// cell, the hourglasses by their base vectors.
double energy_by_the_book(const Body& body, const Places& at) {
    const TissueCells& cells = *tissue_of(body);
    const double h = body.spacing, mu = cells.shear(), lambda = cells.lame(), modulus = cells.youngs_modulus;
    double sum = 0;
    for (std::size_t c = 0; c < body.cells.size(); ++c) {
        dmat3 f(0);
        dvec3 hourglass[4] = {};
        for (int k = 0; k < 8; ++k) {
            const dvec3 p = at[std::size_t(body.cells[c][std::size_t(k)])];
            const dvec3 xi = 2.0 * dvec3(k & 1, k >> 1 & 1, k >> 2) - 1.0;
            f += glm::outerProduct(p, xi / (4 * h));
            const double bases[] = {xi.x * xi.y, xi.x * xi.z, xi.y * xi.z, xi.x * xi.y * xi.z};
            for (int m = 0; m < 4; ++m) hourglass[m] += bases[m] * p;
        }
        const double j = glm::determinant(f), d = j - 1, least = std::min(d, 0.0);
        const double square = glm::dot(f[0], f[0]) + glm::dot(f[1], f[1]) + glm::dot(f[2], f[2]);
        const double u = std::max(square / 3 - 1, 0.0), r = 1 / (1 + 4 * u * u);
        const double density = mu / 2 * (square - 3) + r / 2 * (lambda * d * d + mu * least * least) -
                               mu * (least + std::log(std::max(j, 1.0)));
        double springs = 0;
        for (int m = 0; m < 4; ++m)
            springs += (m < 3 ? modulus * h / 48 : mu * h / 16) / 2 * glm::dot(hourglass[m], hourglass[m]);
        sum += double(cells.weights[c]) * (h * h * h * density + springs);
    }
    return sum;
}

TEST(Tissue, EnergyIsTheTextbooks) {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const Body body = ragged(0.05f + 0.022f * float(seed), seed);
        const Places at = scattered(places(body), 0.02 * seed * body.spacing, seed);
        const double expected = energy_by_the_book(body, at), found = Forces(body).energy(at);
        EXPECT_LE(std::abs(found - expected), 1e-6 * std::max(std::abs(expected), 1e-6)) << seed;
    }
}

TEST(Tissue, ForcesAreTheSlopeOfTheEnergy) {
    for (unsigned seed = 0; seed < 12; ++seed) {
        const Body body = ragged(0.05f + 0.04f * float(seed), seed);
        const Places at = scattered(places(body), 0.1 * seed * body.spacing, seed);
        const Places way = scattered(Places(at.size(), dvec3(0)), 1, seed + 100), force = forces(body, at);
        const double small = 1e-6 * body.spacing;
        Places ahead = at, behind = at;
        double expected = 0, size = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            ahead[i] += small * way[i], behind[i] -= small * way[i];
            expected -= glm::dot(force[i], way[i]);
            size += glm::length(force[i]);
        }
        const double slope =
            (energy_by_the_book(body, ahead) - energy_by_the_book(body, behind)) / (2 * small);
        EXPECT_LE(std::abs(slope - expected),
                  1e-5 * (size + 2000 * double(body.spacing) * double(body.spacing)))
            << seed;
    }
}

TEST(Tissue, StiffnessIsTheSlopeOfTheForcesAtRest) {
    for (float poisson : {0.01f, 0.25f, 0.45f, 0.49f}) {
        const Body body = ragged(poisson, 5);
        const Places at = places(body), way = scattered(Places(at.size(), dvec3(0)), 1, 9);
        const double small = 1e-7 * body.spacing;
        Places ahead = at, behind = at, stiffness(at.size());
        for (std::size_t i = 0; i < at.size(); ++i) ahead[i] += small * way[i], behind[i] -= small * way[i];
        Forces(body).stiffness_times(at, way, stiffness);
        const Places there = forces(body, ahead), back = forces(body, behind);
        double apart = 0;
        for (std::size_t i = 0; i < at.size(); ++i)
            apart = std::max(apart, glm::length(stiffness[i] + (there[i] - back[i]) / (2 * small)));
        EXPECT_LE(apart, 2e-4 * largest(stiffness)) << poisson;
    }
}

TEST(Tissue, StiffnessIsSymmetricNeverNegativeAndLetsABodyTurn) {
    for (unsigned seed = 0; seed < 10; ++seed) {
        const Body body = ragged(0.45f, seed);
        Places at = places(body);
        const dmat3 bent =
            dmat3(1) + 0.3 * dmat3(scattered(Places(1, dvec3(0)), 1, seed)[0], dvec3(0), dvec3(0.2));
        for (dvec3& p : at) p = bent * p;
        const Forces of(body);
        const Places none(at.size(), dvec3(0)), spin = [&] {
            Places turning;
            for (dvec3 p : at) turning.push_back(glm::cross(dvec3(1, -2, 3), p));
            return turning;
        }();
        Places by(at.size());
        of.stiffness_times(at, spin, by);
        Places stretch(at.size());
        of.stiffness_times(at, at, stretch);
        EXPECT_LE(largest(by), 1e-6 * largest(stretch));
        const Places crooked = scattered(at, body.spacing, seed), a = scattered(none, 1, seed + 1),
                     b = scattered(none, 1, seed + 2);
        Places of_a(at.size()), of_b(at.size());
        of.stiffness_times(crooked, a, of_a);
        of.stiffness_times(crooked, b, of_b);
        double ab = 0, ba = 0, aa = 0;
        for (std::size_t i = 0; i < at.size(); ++i)
            ab += glm::dot(a[i], of_b[i]), ba += glm::dot(b[i], of_a[i]), aa += glm::dot(a[i], of_a[i]);
        EXPECT_LE(std::abs(ab - ba), 1e-9 * std::abs(aa));
        EXPECT_GT(aa, 0);
    }
}

// A bar that is stretched a little and gets thinner as Poisson's ratio says: its sides feel nothing, and its
// ends are held by modulus x strain x area.
TEST(Tissue, BarsHaveTheirModulusAndPoissonsRatio) {
    for (int thick : {1, 2, 4, 8})
        for (float poisson : {0.25f, 0.35f, 0.45f, 0.49f}) {
            Material material = of_tissue;
            material.poisson = poisson;
            const float h = 1.0f / 256;  // so that cells are cubes to the bit
            const Body body = lattice({13, thick + 1, thick + 1}, h, material);
            const double strain = 1e-6, modulus = material.youngs_modulus;
            Places at;
            for (vec3 p : body.positions)
                at.push_back(dvec3(p) * (1.0 + strain * dvec3(1, -double(poisson), -double(poisson))));
            const Places force = forces(body, at);
            double end = 0, elsewhere = 0;
            for (std::size_t i = 0; i < at.size(); ++i) {
                const bool at_end = body.at[i].x == 0 || body.at[i].x == 12;
                if (body.at[i].x == 12) end -= force[i].x;
                elsewhere =
                    std::max(elsewhere, at_end ? std::hypot(force[i].y, force[i].z) : glm::length(force[i]));
            }
            const double area = std::pow(thick * double(h), 2), expected = modulus * strain * area;
            EXPECT_LE(std::abs(end / expected - 1), 0.005) << thick << ", " << poisson;
            // What is left over, were it Poisson's ratio that is wrong by 0.001.
            const double wrong = 0.001 * strain * modulus / (1 - 2 * double(poisson)) * double(h) * double(h);
            EXPECT_LE(elsewhere, wrong) << thick << ", " << poisson;
        }
}

// From one cell of thickness on. The wall holds the width too, of which beam theory knows nothing; `solid`:
// how far CalculiX's finest sags over that theory (docs/results.md).
TEST(Tissue, CantileversSagAsBeamsDo) {
    const std::pair<float, double> solids[] = {{0.3f, 0.991}, {0.45f, 0.979}, {0.49f, 0.973}};
    for (int cells : {1, 2, 3, 4})
        for (auto [poisson, solid] : solids)
            EXPECT_LE(std::abs(studies::tissue_sag(cells, poisson) / solid - 1), 0.06)
                << cells << ", " << poisson;
}

// Too stiffly where they are thin, since a cell knows of twisting only by its hourglasses; the excess falls
// with the square of the thickness.
TEST(Tissue, BarsTwistMoreStifflyThanSaintVenantSays) {
    const std::pair<int, double> known[] = {{1, 3.438}, {2, 1.748}, {4, 1.199}};
    for (auto [cells, torque] : known)
        EXPECT_LE(std::abs(studies::tissue_torque(cells, 0.45f) / torque - 1), 0.01) << cells;
}

TEST(Tissue, ATipFeelsWhatDimitriadisSays) {
    const studies::Indenter thick{.width = 28, .height = 20, .radius = 20, .poisson = 0.45f},
        layer{.width = 24, .height = 8, .radius = 30, .poisson = 0.45f};
    const double depths[] = {0.5};  // of cells, with a radius of contact of three and four cells
    for (const studies::Indenter& indenter : {thick, layer})
        EXPECT_LE(std::abs(studies::indent(indenter, depths)[0].over_layer - 1), 0.12) << indenter.height;
}

// The figures are CalculiX's finest of docs/results.md.
TEST(Tissue, BlocksArePressedAndBentAsFiniteElementsSay) {
    const double depths[] = {0.15, 0.3};
    const auto pressed = studies::press({.poisson = 0.49}, studies::Plate::dished, depths, 8);
    EXPECT_LE(std::abs(pressed[1].force / 0.686 - 1), 0.03);
    EXPECT_LE(std::abs(pressed[1].volume / 0.9992 - 1), 0.002);
    const auto bent = studies::bend(studies::beam, 8);
    EXPECT_LE(std::abs(bent.sag / 0.02185 - 1), 0.02);
}

TEST(Tissue, CalculiXComputesTheSameBlocks) {
    if (!has_program("ccx")) GTEST_SKIP() << "not available: ccx (Debian package calculix-ccx)";
    const studies::Block block{.poisson = 0.49};
    const double depths[] = {0.15, 0.3};
    const auto ours = studies::press(block, studies::Plate::dished, depths, 8),
               theirs = studies::press_by_elements(block, studies::Plate::dished, depths, 4);
    for (std::size_t i : {0u, 1u}) {
        EXPECT_LE(std::abs(ours[i].force / theirs[i].force - 1), 0.04);
        EXPECT_LE(std::abs(ours[i].volume / theirs[i].volume - 1), 0.002);
    }
    EXPECT_LE(
        std::abs(studies::bend(studies::beam, 8).sag / studies::bend_by_elements(studies::beam, 4).sag - 1),
        0.02);
}

TEST(Tissue, TheStepBoundIsBelowTheClosedFormForAnyFilling) {
    for (float poisson : {0.0f, 0.1f, 0.25f, 0.45f, 0.49f}) {
        Material material = of_tissue;
        material.poisson = poisson;
        const float h = 0.01f;
        for (const Body& body :
             {lattice({9, 8, 7}, h, material),
              lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.spacing = h, .material = material})}) {
            const TissueCells& cells = *tissue_of(body);
            double fill = 0;
            for (float weight : cells.weights) fill += double(weight);
            const double density = mass(body) / (fill * std::pow(double(h), 3));
            const double bound = std::sqrt((12 * double(cells.lame()) + 8 * double(cells.shear())) /
                                           (density * double(h) * double(h)));
            const double found = highest_frequency(body);
            EXPECT_LE(found, 1.001 * bound);
            EXPECT_GE(found, 0.6 * bound);
        }
    }
}

TEST(Tissue, FillsTheVolumeOfItsMesh) {
    for (int nodes : {100, 1000, 5000}) {
        const Mesh mesh = ellipsoid({0.05f, 0.03f, 0.04f}, 24);
        const Body body = lattice(mesh, {.nodes = nodes, .material = of_tissue});
        double filled = 0;
        for (float part : tissue_of(body)->filled) filled += double(part);
        EXPECT_LE(std::abs(filled * std::pow(double(body.spacing), 3) / double(volume(mesh)) - 1), 0.02)
            << nodes;
    }
}

TEST(Tissue, WeighsWhatIsLeftWhereCellsAreCut) {
    Body body = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 300, .material = of_tissue});
    auto mass_of_filling = [](const Body& of) {
        double sum = 0;
        for (float part : tissue_of(of)->filled) sum += double(part);
        return sum / mass(of);
    };
    const double before = mass_of_filling(body);
    Edit edit;
    for (int c = 0; c < int(body.cells.size()); c += 3) edit.cells.push_back(c);
    apply(body, edit);
    EXPECT_LE(std::abs(mass_of_filling(body) / before - 1), 1e-4);
    EXPECT_EQ(tissue_of(body)->weights.size(), body.cells.size());
}

TEST(Tissue, MayBeFarOut) {
    Body body = lattice({4, 4, 4}, 0.005f, of_tissue);
    for (vec3& p : body.positions) p += vec3(300, -100, 50);
    EXPECT_NO_THROW(check(body));
    auto solver = make_solver(body, {.gravity = vec3(0)});
    ASSERT_FALSE(solver->step(0.1).diverged);
    const State end = solver->state();
    for (std::size_t i = 0; i < body.count(); ++i)
        EXPECT_LE(glm::length(end.positions[i] - dvec3(body.positions[i])), 1e-4);
}

// A block that is held at its lowest layer.
Body held_block(ivec3 dims, float spacing, float poisson) {
    Material material = of_tissue;
    material.poisson = poisson;
    Body body = lattice(dims, spacing, material);
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].y == 0) body.inverse_mass[i] = 0;
    return body;
}

std::size_t inside_out(const Solver& solver) {
    return inverted_cells(solver.body(), solver.nodes().positions);
}

// Held at its lowest layer, at the automatic step.
TEST(Tissue, ComesBackFromAnyStart) {
    for (const float poisson : {0.45f, 0.49f}) {
        const Body body = held_block({7, 7, 7}, 0.01f, poisson);
        const Places rest = places(body);
        const Places starts[] = {scattered(rest, 0.02, 1),
                                 [&] {
                                     Places folded = rest;
                                     for (dvec3& p : folded) p.y = p.y > 0.03 ? 0.06 - p.y : p.y;
                                     return folded;
                                 }(),
                                 [&] {
                                     Places flat = rest;
                                     for (dvec3& p : flat) p.y = 0;
                                     return flat;
                                 }(),
                                 Places(rest.size(), dvec3(0.03, 0.01, 0.03))};
        for (std::size_t s = 0; s < std::size(starts); ++s) {
            auto solver = make_solver(body, {.gravity = vec3(0)});
            State start{starts[s], Places(rest.size(), dvec3(0)), 0};
            for (std::size_t i = 0; i < body.count(); ++i)
                if (body.inverse_mass[i] == 0) start.positions[i] = rest[i];
            solver->restore(start);
            for (int call = 0; call < 40; ++call)
                ASSERT_FALSE(solver->step(0.1).diverged) << poisson << " " << s;
            EXPECT_EQ(inside_out(*solver), 0u) << poisson << ", start " << s;
            EXPECT_LE(furthest_apart(solver->state().positions, rest), 1e-4) << poisson << ", start " << s;
        }
    }
}

// 100 presses of a ball that nobody chose: down, along and up again, at places, depths and speeds by chance.
TEST(Tissue, ComesBackFromRandomPresses) {
    for (const float poisson : {0.45f, 0.49f}) {
        const Body body = held_block({10, 6, 9}, 0.01f, poisson);
        const Places rest = places(body);
        const auto solver = make_solver(body, {.gravity = vec3(0)});
        std::mt19937 random(7);
        auto between = [&](float low, float high) {
            return std::uniform_real_distribution<float>(low, high)(random);
        };
        for (int press = 0; press < 100; ++press) {
            const float radius = between(0.015f, 0.03f), depth = between(0.005f, 0.03f);
            const vec3 start(between(0, 0.09f), 0.05f + radius, between(0, 0.08f)),
                slide(between(-0.03f, 0.03f), 0, between(-0.03f, 0.03f));
            vec3 at = start;
            for (vec3 to : {start - vec3(0, depth, 0), start - vec3(0, depth, 0) + slide, start + slide}) {
                const float seconds = between(0.02f, 0.2f);
                const Press tip{at, (to - at) / seconds, radius, between(50, 2000)};
                ASSERT_FALSE(solver->step(double(seconds), {.presses = {&tip, 1}}).diverged) << press;
                at = to;
            }
        }
        for (int call = 0; call < 30; ++call) ASSERT_FALSE(solver->step(0.1).diverged);
        EXPECT_EQ(inside_out(*solver), 0u) << poisson;
        EXPECT_LE(furthest_apart(solver->state().positions, rest), 1e-4) << poisson;
    }
}

TEST(Tissue, KeepsItsVolumeUnderAPress) {
    const studies::UnderABall block = studies::press_with_a_ball();
    EXPECT_GE(block.depth, 1 / 3.0);
    EXPECT_LE(std::abs(block.volume - 1), 0.01);
    EXPECT_EQ(block.inside_out, 0u);
}

// Nothing pumps a motion, however far the body is stretched: about the state in which a damped one rests, an
// undamped one has as much energy after three seconds as before.
TEST(Tissue, MotionDoesNotGrowWhereItIsStretched) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-1e-4, 1e-4);
    for (const float poisson : {0.0f, 0.3f, 0.45f, 0.49f})
        for (const double stretch : {1.2, 1.5, 2.0}) {
            Material material = of_tissue;
            material.poisson = poisson;
            Body body = lattice({4, 5, 9}, 0.01f, material);
            for (std::size_t i = 0; i < body.count(); ++i)
                if (body.at[i].z % 8 == 0) body.inverse_mass[i] = 0;
            Places stretched = places(body);
            for (std::size_t i = 0; i < body.count(); ++i) {
                stretched[i].z *= stretch;
                if (body.inverse_mass[i] > 0) stretched[i] += dvec3(part(random), part(random), part(random));
            }
            auto energies = [&](float damping) {
                body.damping = damping;
                auto solver = make_solver(body, {.gravity = vec3(0)});
                solver->restore({stretched, Places(body.count(), dvec3(0)), 0});
                const Energy before = energy(body, solver->state());
                for (int call = 0; call < 30; ++call) solver->step(0.1);
                const Energy after = energy(body, solver->state());
                return std::pair(before.elastic, after.kinetic + after.elastic);
            };
            const double rest = energies(20).second;
            const auto [before, after] = energies(0);
            EXPECT_LE(after - rest, 1.1 * (before - rest)) << poisson << ", " << stretch;
        }
}

// A ball that has sunk in deeper than its radius still feels the tissue, and about as much in finer cells.
TEST(Tissue, HoldsATipThatIsDeep) {
    std::vector<double> forces;
    for (int fine : {1, 2}) {
        const Body body = held_block(ivec3(10 * fine + 1), 0.01f / float(fine), of_tissue.poisson);
        const auto solver = make_solver(body, {.gravity = vec3(0)});
        Press tip{{0.05f, 0.13f, 0.05f}, {0, -0.08f, 0}, 0.03f, 3000};
        Stats stats;
        for (int part = 0; part < 12; ++part) {
            stats = solver->step(0.05, {.presses = {&tip, 1}});
            tip.centre += 0.05f * tip.velocity;
        }
        forces.push_back(stats.reactions[0].y / 0.05);
        EXPECT_EQ(inside_out(*solver), 0u);
    }
    EXPECT_GT(forces[0], 2);  // N; pushed at its hull alone it has closed behind the ball by then
    EXPECT_LE(std::abs(forces[1] / forces[0] - 1), 0.25);
}

}  // namespace
}  // namespace palpate
