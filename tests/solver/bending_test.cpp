// Bending by dihedral angles: the forces are the slope of the energy, and sheets are as stiff as plates.
#include "palpate/body/cloth.h"
#include "palpate/solver/forces.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"
#include "tests/shapes.h"
#include "tests/solver/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

using Places = std::vector<dvec3>;

class Chance {
 public:
    explicit Chance(unsigned seed) : random_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    dvec3 vector(double size) { return {between(-size, size), between(-size, size), between(-size, size)}; }
    Places vectors(std::size_t count, double size) {
        Places made(count);
        for (dvec3& v : made) v = vector(size);
        return made;
    }

 private:
    std::mt19937 random_;
};

Places places(const Body& body) { return {body.positions.begin(), body.positions.end()}; }

double dot(const Places& a, const Places& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i], b[i]);
    return sum;
}
double largest(const Places& vectors) {
    double most = 0;
    for (dvec3 v : vectors)
        if (const double length = glm::length(v); !(length <= most)) most = length;
    return most;
}
Places moved(Places from, double factor, const Places& by) {
    for (std::size_t i = 0; i < from.size(); ++i) from[i] += factor * by[i];
    return from;
}

Places forces(const Forces& of, const Places& at) {
    Places made(at.size());
    of.at(at, made);
    return made;
}
Places stiffness_times(const Forces& of, const Places& at, const Places& displacement) {
    Places made(at.size());
    of.stiffness_times(at, displacement, made);
    return made;
}

// A body with nothing but hinges.
Body only_hinges(Body body) {
    std::erase_if(body.terms, [](const Term& term) { return !std::holds_alternative<Bending>(term); });
    body.rings.clear();
    body.fan = 0;
    return body;
}

// Between two triangles with legs of `size`.
Body one_hinge(double size, double stiffness, double rest) {
    std::vector<vec3> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    for (vec3& p : corners) p *= size;
    Body body = net(corners, std::vector<float>(4, 1), {});
    body.terms = {Bending{{{0, 1, 2, 3, float(stiffness), float(rest)}}}};
    return body;
}

// A sheet of many shapes of triangles that is curved at rest.
Body bowl(float bending) {
    Mesh mesh = ellipsoid({0.04f, 0.05f, 0.02f}, 7);
    mesh.triangles.resize(mesh.triangles.size() * 3 / 4);
    Mesh open;
    std::vector<int> number(mesh.positions.size(), -1);
    for (uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) {
            int& at = number[t[k]];
            if (at < 0) at = int(open.positions.size()), open.positions.push_back(mesh.positions[t[k]]);
            t[k] = unsigned(at);
        }
        open.triangles.push_back(t);
    }
    ClothSettings settings = linen;
    settings.stiffness.flexion = 0;
    settings.bending = bending;
    return cloth(open, settings);
}

TEST(Bending, ForcesAreTheSlopeOfTheEnergy) {
    Chance chance(1);
    int tried = 0;
    while (tried < 300) {
        const double size = std::pow(10, chance.between(-4, 1)),
                     stiffness = std::pow(10, chance.between(-6, 2));
        const Body body = one_hinge(0.01 * size, stiffness, chance.between(-1.9, 1.9));
        const Places at = chance.vectors(4, size), way = chance.vectors(4, size);
        const dvec3 edge = glm::normalize(at[1] - at[0]), left = glm::cross(edge, at[2] - at[0]),
                    right = glm::cross(at[3] - at[0], edge);
        const double least = std::min(glm::length(left), glm::length(right));
        // Not so flat a triangle, nor so nearly folded shut, that the small way leads across what is bent
        // sharply.
        if (least < 0.1 * size || glm::dot(glm::normalize(left), glm::normalize(right)) < -0.99) continue;
        ++tried;
        const Forces of(body);
        const double h = 1e-6;
        const double slope = (of.energy(moved(at, h, way)) - of.energy(moved(at, -h, way))) / (2 * h);
        EXPECT_LE(std::abs(slope + dot(forces(of, at), way)), 1e-6 * stiffness * size / least);
    }
}

TEST(Bending, ForcesAreBalancedAndTurnNothing) {
    Chance chance(2);
    const Body body = only_hinges(bowl(1e-3f));
    const Forces of(body);
    for (double size : {0.001, 0.01, 0.1}) {
        const Places at = moved(places(body), 1, chance.vectors(body.count(), size));
        const Places force = forces(of, at);
        dvec3 sum(0), torque(0);
        for (std::size_t i = 0; i < at.size(); ++i) sum += force[i], torque += glm::cross(at[i], force[i]);
        EXPECT_GT(largest(force), 1e-3);
        EXPECT_LE(glm::length(sum), 1e-12 * largest(force));
        EXPECT_LE(glm::length(torque), 1e-12 * largest(force));
    }
}

TEST(Bending, StiffnessIsSymmetricAndPositiveAndLetsRigidMotionsGo) {
    Chance chance(3);
    const Body body = only_hinges(bowl(1e-3f));
    const Forces of(body);
    for (int trial = 0; trial < 20; ++trial) {
        const Places at = moved(places(body), 1, chance.vectors(body.count(), 0.002 * trial));
        const Places x = chance.vectors(body.count(), 1), y = chance.vectors(body.count(), 1),
                     of_x = stiffness_times(of, at, x);
        const double whole = dot(x, of_x);
        EXPECT_GT(whole, 0);
        EXPECT_LE(std::abs(dot(y, of_x) - dot(x, stiffness_times(of, at, y))), 1e-12 * whole);
        Places rigid = at;
        const dvec3 way = chance.vector(1), turn = chance.vector(1);
        for (dvec3& p : rigid) p = way + glm::cross(turn, p);
        EXPECT_LE(largest(stiffness_times(of, at, rigid)), 1e-12 * largest(of_x));
    }
}

TEST(Bending, StiffnessIsTheSlopeOfTheForcesAtRest) {
    Chance chance(4);
    const Body body = only_hinges(bowl(1e-3f));
    const Forces of(body);
    const Places at = places(body);
    for (int trial = 0; trial < 10; ++trial) {
        const Places way = chance.vectors(body.count(), 1), back = forces(of, moved(at, -1e-7, way)),
                     forth = forces(of, moved(at, 1e-7, way));
        const Places expected = stiffness_times(of, at, way);
        const Places found = moved(Places(at.size(), dvec3(0)), -0.5e7, moved(forth, -1, back));
        EXPECT_LE(largest(moved(found, -1, expected)), 1e-5 * largest(expected));
    }
}

TEST(Bending, ACurvedSheetAtRestFeelsNothing) {
    const Body body = only_hinges(bowl(1e-3f));
    const auto& hinges = std::get<Bending>(body.terms[0]).hinges;
    EXPECT_TRUE(std::ranges::any_of(hinges, [](const Hinge& one) { return std::abs(one.rest) > 0.5f; }));
    const Forces of(body);
    Places flat = places(body);
    for (dvec3& p : flat) p.z *= 0.5;
    EXPECT_LE(largest(forces(of, places(body))), 1e-6 * largest(forces(of, flat)));  // a float's rounding
    EXPECT_LE(std::abs(of.energy(places(body))), 1e-12 * of.energy(flat));
}

// Whatever has collapsed, or lies folded on itself, has forces that are numbers.
TEST(Bending, NothingIsTooFlat) {
    const dvec3 a(0), b(0.01, 0, 0), c(0.003, 0.01, 0), d(0.004, -0.01, 0), middle(0.005, 0, 0);
    const Places shapes[] = {{a, a, a, a}, {a, a, c, d}, {a, b, a, d},      {a, b, c, b},
                             {a, b, c, c}, {a, b, d, c}, {a, b, middle, d}, {a, b, middle, middle}};
    const Body body = one_hinge(0.01, 1, 0.3);
    const Forces of(body);
    for (const Places& at : shapes) {
        const Places way(4, dvec3(1, 2, 3));
        EXPECT_LE(largest(forces(of, at)), 10 / 0.01);
        EXPECT_LE(largest(stiffness_times(of, at, way)), 100 / (0.01 * 0.01));
        EXPECT_LE(std::abs(of.energy(at)), 10);
        for (Backend backend : {Backend::reference, Backend::cpu}) {
            auto solver = make_solver(body, {.backend = backend, .shortest_step = 0});
            solver->restore({at, Places(4, dvec3(0)), 0});
            EXPECT_FALSE(solver->step(1e-9).diverged);
        }
    }
}

// rad²/s² kg: the largest eigenvalue of a body's stiffness matrix.
double stiffest(const Forces& of, const Places& at) {
    Places x = Chance(8).vectors(at.size(), 1);
    double largest = 0;
    for (int i = 0; i < 100; ++i) {
        const double norm = std::sqrt(dot(x, x));
        for (dvec3& v : x) v /= norm;
        const Places of_x = stiffness_times(of, at, x);
        largest = dot(x, of_x);
        x = of_x;
    }
    return largest;
}

// However a sheet is pressed together in its plane.
TEST(Bending, NeverGetsMoreThanTwiceAsStiff) {
    const Body body = only_hinges(bowl(1e-3f));
    const Forces of(body);
    const double at_rest = stiffest(of, places(body));
    for (int axis = 0; axis < 3; ++axis)
        for (double part : {0.9, 0.7, 0.5, 0.3, 0.1, 0.01, 0.0}) {
            Places at = places(body);
            for (dvec3& p : at) p[axis] *= part;
            EXPECT_LE(stiffest(of, at), 2.001 * at_rest) << axis << ", " << part;
        }
}

// ---- plates ----

// Equilateral triangles with sides of 1 cm that fill a hexagon: as many edges along each of three ways.
Mesh hexagon(int rings) {
    Mesh mesh;
    std::vector<std::pair<int, int>> at;
    auto number = [&](int i, int j) { return unsigned(std::ranges::find(at, std::pair(i, j)) - at.begin()); };
    auto is_within = [&](int i, int j) {
        return std::max({std::abs(i), std::abs(j), std::abs(i + j)}) <= rings;
    };
    for (int j = -rings; j <= rings; ++j)
        for (int i = -rings; i <= rings; ++i)
            if (is_within(i, j)) {
                at.push_back({i, j});
                mesh.positions.push_back(0.01f *
                                         vec3(float(i) + 0.5f * float(j), std::sqrt(0.75f) * float(j), 0));
            }
    for (const auto& [i, j] : at) {
        if (is_within(i + 1, j) && is_within(i, j + 1))
            mesh.triangles.push_back({number(i, j), number(i + 1, j), number(i, j + 1)});
        if (is_within(i + 1, j) && is_within(i + 1, j - 1))
            mesh.triangles.push_back({number(i, j), number(i + 1, j - 1), number(i + 1, j)});
    }
    return mesh;
}

double area(const Body& body, int a, int b, int c) {
    auto at = [&](int i) { return dvec3(body.positions[std::size_t(i)]); };
    return 0.5 * glm::length(glm::cross(at(b) - at(a), at(c) - at(a)));
}

// J/m² of a sheet with a rigidity of 1 N m, bent to a height of 1/2 (x² first + y² second), m, the axes
// turned.
double energy_of_a_bend(const Body& flat, double first, double second, double turn) {
    Body body = without_grid(flat);
    const Bending hinges = bending(flat, 1);
    body.terms = {hinges};
    double whole = 0;
    for (const Hinge& one : hinges.hinges)
        whole += (area(flat, one.from, one.to, one.left) + area(flat, one.from, one.to, one.right)) / 3;
    Places at = places(body);
    for (dvec3& p : at) {
        const double x = p.x * std::cos(turn) - p.y * std::sin(turn),
                     y = p.x * std::sin(turn) + p.y * std::cos(turn);
        p.z += 0.5 * (first * x * x + second * y * y);
    }
    return Forces(body).energy(at) / whole;
}

// Of a plate that is bent as much along one axis only, J/m².
constexpr double curvature = 0.01, of_a_cylinder = 0.5 * curvature * curvature;

TEST(Bending, EquilateralTrianglesAreAPlate) {
    const Body sheet = cloth(hexagon(3), linen);
    const double poisson = -1.0 / 3;
    for (double turn : {0.0, 0.2, 0.5, 1.0, 1.3}) {
        EXPECT_NEAR(energy_of_a_bend(sheet, curvature, 0, turn) / of_a_cylinder, 1, 1e-4) << turn;
        EXPECT_NEAR(energy_of_a_bend(sheet, curvature, curvature, turn) / of_a_cylinder, 2 * (1 + poisson),
                    1e-4)
            << turn;
        EXPECT_NEAR(energy_of_a_bend(sheet, curvature, -curvature, turn) / of_a_cylinder, 2 * (1 - poisson),
                    1e-4)
            << turn;
    }
}

// Other triangles are a plate roughly. These are the figures of cloth.h.
TEST(Bending, OtherTrianglesShow) {
    Chance chance(7);
    Mesh uneven = hexagon(12);
    for (vec3& p : uneven.positions) p += 0.002f * vec3(chance.between(-1, 1), chance.between(-1, 1), 0);
    const Body sheet = cloth(uneven, linen), squares = cloth({41, 41}, 0.01f, linen);
    for (double turn : {0.0, 0.5, 1.0, 1.5, 2.0, 2.5})
        EXPECT_NEAR(energy_of_a_bend(sheet, curvature, 0, turn) / of_a_cylinder, 1.08, 0.02) << turn;
    const double pi = std::acos(-1.0);
    for (const auto& [turn, expected] :
         {std::pair(0.0, 1.0), {pi / 8, 0.8}, {pi / 4, 1}, {pi / 2, 1}, {3 * pi / 4, 3}})
        EXPECT_NEAR(energy_of_a_bend(squares, curvature, 0, turn) / of_a_cylinder, expected, 0.02) << turn;
}

// Equilateral triangles, with sides of 1 cm that lie across the strip.
Mesh strip(int rows, int columns) {
    Mesh mesh;
    auto number = [&](int row, int column) { return unsigned(row * columns + column); };
    for (int row = 0; row <= rows; ++row)
        for (int column = 0; column < columns; ++column)
            mesh.positions.push_back(
                0.01f * vec3(std::sqrt(0.75f) * float(row), float(column) + 0.5f * float(row % 2), 0));
    for (int row = 0; row < rows; ++row)
        for (int column = 0; column + 1 < columns; ++column) {
            const unsigned a = number(row, column), b = number(row, column + 1), c = number(row + 1, column),
                           d = number(row + 1, column + 1);
            if (row % 2 == 0) {
                mesh.triangles.push_back({a, c, b});
                mesh.triangles.push_back({b, c, d});
            } else {
                mesh.triangles.push_back({a, c, d});
                mesh.triangles.push_back({a, d, b});
            }
        }
    return mesh;
}

// The displacement, for which a body's stiffness holds a load, of nodes that a force can move.
Places bent_by(const Body& body, Places load) {
    const Forces of(body);
    const Places at = places(body);
    auto free = [&](Places v) {
        for (std::size_t i = 0; i < v.size(); ++i)
            if (body.inverse_mass[i] == 0) v[i] = dvec3(0);
        return v;
    };
    Places rest = free(load), way = rest, found(at.size(), dvec3(0));  // conjugate gradients
    double square = dot(rest, rest);
    const double enough = 1e-16 * square;
    while (square > enough) {
        const Places back = free(stiffness_times(of, at, way));
        const double step = square / dot(way, back), before = square;
        found = moved(found, step, way);
        rest = moved(rest, -step, back);
        square = dot(rest, rest);
        way = moved(rest, square / before, way);
    }
    return found;
}

// How far the middle of the free end sags, as a part of what a beam of the sheet's rigidity does: q L⁴ / 8 D.
double sag(int rows, int columns) {
    ClothSettings settings{.stiffness = {.structural = 100}, .bending = 1e-3f, .density = 0.3f};
    Body body = cloth(strip(rows, columns), settings);
    std::fill_n(body.inverse_mass.begin(), 2 * columns, 0.0f);  // held between its first two rows
    const double length = 0.01 * std::sqrt(0.75) * (rows - 0.5);
    Places load;
    for (float area : body.area) load.push_back({0, 0, area});
    const dvec3 end = bent_by(body, load)[std::size_t(rows * columns + columns / 2)];
    return end.z / (std::pow(length, 4) / (8 * double(settings.bending)));
}

// A wide strip bends along its length only; a narrow one may bend across as well, as Poisson's ratio says.
TEST(Bending, ACantileverSagsAsAPlateDoes) {
    EXPECT_NEAR(sag(13, 40), 1, 0.01);
    EXPECT_NEAR(sag(26, 6), 1 / (1 - 1.0 / 9), 0.02);
}

// ---- in motion ----

// By how much the energy of a sheet grows within many steps.
double growth_of_energy(const Body& body, double step) {
    auto solver = make_exact_solver(body, {.step = step, .force = true, .gravity = vec3(0)});
    State state = solver->save();
    state.velocities = Chance(5).vectors(body.count(), 1e-7);
    solver->restore(state);
    const Energy before = energy(body, solver->state());
    if (solver->step(2000 * step).diverged) return std::numeric_limits<double>::infinity();
    const Energy after = energy(body, solver->state());
    return (after.kinetic + after.elastic) / (before.kinetic + before.elastic);
}

TEST(Bending, TheStabilityBoundIsWhereItIs) {
    ClothSettings settings{.stiffness = {.structural = 1}, .bending = 1e-3f, .density = 0.3f};
    const Body stiff = cloth(hexagon(3), settings);
    settings.bending = 0;
    const double frequency = highest_frequency(stiff);
    EXPECT_GT(frequency, 3 * highest_frequency(cloth(hexagon(3), settings)));
    const double longest = longest_step(Integrator::verlet, frequency, 0, 0);
    EXPECT_LE(growth_of_energy(stiff, 0.97 * longest), 20);
    EXPECT_GT(growth_of_energy(stiff, 1.03 * longest), 1e6);
}

// Without anything outside, momentum and angular momentum stay, with dampers too.
TEST(Bending, MomentumStays) {
    Body body = bowl(1e-3f);
    body.damping = 0;
    body.link_damping = 1e-4f;
    auto solver = make_exact_solver(body, {.step = 1e-5, .force = true, .gravity = vec3(0)});
    State state = solver->save();
    state.velocities = Chance(6).vectors(body.count(), 0.1);
    solver->restore(state);
    auto momentum = [&](dvec3& spin) {
        const State now = solver->save();
        dvec3 sum(0);
        spin = dvec3(0);
        for (std::size_t i = 0; i < body.count(); ++i) {
            const dvec3 mv = now.velocities[i] / double(body.inverse_mass[i]);
            sum += mv, spin += glm::cross(now.positions[i], mv);
        }
        return sum;
    };
    dvec3 spin_before, spin_after;
    const dvec3 before = momentum(spin_before);
    EXPECT_FALSE(solver->step(0.02).diverged);
    const dvec3 after = momentum(spin_after);
    EXPECT_LE(glm::distance(before, after), 1e-10 * glm::length(before));
    EXPECT_LE(glm::distance(spin_before, spin_after), 1e-10 * glm::length(spin_before));
}

}  // namespace
}  // namespace palpate
