#include "bench/tissue.h"

#include "palpate/base/error.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

namespace palpate::studies {
namespace {

constexpr double pi = 3.14159265358979;

using Vectors = std::vector<dvec3>;  // one a node

Material tissue(double modulus, double poisson) {
    return {.youngs_modulus = float(modulus), .poisson = float(poisson), .density = float(density)};
}

double shear_modulus(double modulus, double poisson) { return modulus / (2 * (1 + poisson)); }

// ---- small deformations ----

double dot(const Vectors& a, const Vectors& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i], b[i]);
    return sum;
}

// The displacement of a body in equilibrium under small forces, by conjugate gradients on its stiffness at
// rest. `free` is 1 for the components that move by themselves, 0 for those that stay as they are given.
Vectors displaced(const Body& body, Vectors displacement, const Vectors& free, const Vectors& force) {
    const Forces terms(body);
    const Vectors rest(body.positions.begin(), body.positions.end());
    Vectors stiff(rest.size());
    terms.stiffness_times(rest, displacement, stiff);
    Vectors left(rest.size()), along;
    for (std::size_t i = 0; i < rest.size(); ++i) left[i] = free[i] * (force[i] - stiff[i]);
    along = left;
    const double first = dot(left, left);
    double square = first;
    for (int round = 0; square > 1e-16 * first; ++round) {
        if (round == 20'000) throw Error("conjugate gradients do not converge");
        terms.stiffness_times(rest, along, stiff);
        const double step = square / dot(along, stiff), before = square;
        for (std::size_t i = 0; i < rest.size(); ++i) {
            displacement[i] += step * along[i];
            left[i] -= step * free[i] * stiff[i];
        }
        square = dot(left, left);
        for (std::size_t i = 0; i < rest.size(); ++i) along[i] = left[i] + square / before * along[i];
    }
    return displacement;
}

// Of a square cantilever that is twelve times as long as thick; `pull`: its weight, m/s².
double timoshenko_sag(double thick, double modulus, double poisson, double pull) {
    const double far = 12 * thick, load = density * thick * thick * pull,
                 shape = 10 * (1 + poisson) / (12 + 11 * poisson);
    return load * std::pow(far, 4) / (8 * modulus * std::pow(thick, 4) / 12) +
           load * far * far / (2 * shape * shear_modulus(modulus, poisson) * thick * thick);
}

}  // namespace

double tissue_sag(int cells, float poisson) {
    const float h = 1.0f / 256;  // so that cells are cubes to the bit
    const int length = 12 * cells;
    const double modulus = 2000, pull = 1e-3;  // m/s²
    const Body body = lattice({length + 1, cells + 1, cells + 1}, h, tissue(modulus, poisson));
    Vectors free(body.count(), dvec3(1)), weight;
    for (std::size_t i = 0; i < body.count(); ++i) {
        weight.push_back(dvec3(0, -pull / double(body.inverse_mass[i]), 0));
        if (body.at[i].x == 0) free[i] = dvec3(0);
    }
    const Vectors moved = displaced(body, Vectors(body.count(), dvec3(0)), free, weight);
    double sag = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].x == length) sag -= moved[i].y / std::pow(cells + 1, 2);
    return sag / timoshenko_sag(cells * double(h), modulus, double(poisson), pull);
}

double solid_sag(double poisson) {
    const double thick = 0.01, modulus = 2000, pull = 1e-3;
    const Block block{
        .size = dvec3(12, 1, 1) * thick, .youngs_modulus = modulus, .poisson = poisson, .gravity = pull};
    return bend_by_elements(block, 4).sag / timoshenko_sag(thick, modulus, poisson, pull);
}

double tissue_torque(int cells, float poisson) {
    const float h = 1.0f / 256;
    const int length = 8 * cells;
    const double modulus = 2000, turn = 1e-6, thick = cells * double(h);
    const Body body = lattice({length + 1, cells + 1, cells + 1}, h, tissue(modulus, poisson));
    Vectors free(body.count(), dvec3(1)), moved(body.count(), dvec3(0)), from_axis;
    for (std::size_t i = 0; i < body.count(); ++i) {
        from_axis.push_back(dvec3(0, body.positions[i].y, body.positions[i].z) -
                            dvec3(0, thick, thick) / 2.0);
        const int end = body.at[i].x;
        if (end != 0 && end != length) continue;
        free[i] = dvec3(1, 0, 0);
        if (end == length) moved[i] = glm::cross(dvec3(turn, 0, 0), from_axis[i]);
    }
    free[0] = dvec3(0);  // or it could move along its axis
    moved = displaced(body, moved, free, Vectors(body.count(), dvec3(0)));
    Vectors force(body.count());
    const Vectors rest(body.positions.begin(), body.positions.end());
    Forces(body).stiffness_times(rest, moved, force);
    double torque = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].x == length) torque += glm::cross(from_axis[i], force[i]).x;
    const double far = length * double(h);
    return torque / (shear_modulus(modulus, double(poisson)) * 0.1406 * std::pow(thick, 4) * turn / far);
}

// ---- damped motion ----

namespace {

double shear_speed(const Body& body) { return std::sqrt(double(tissue_of(body)->shear()) / density); }

std::unique_ptr<Solver> solver_of(Body body, double damping, double gravity = 0) {
    body.damping = float(damping);
    return make_solver(body, {.shortest_step = 0, .gravity = {0, -float(gravity), 0}});
}

// What is measured again and again until it stays within a fraction.
template <class Measure>
double settled(double fraction, Measure measure) {
    double before = measure();
    for (int round = 0; round < 100; ++round) {
        const double now = measure();
        if (std::abs(now - before) <= fraction * std::abs(now)) return now;
        before = now;
    }
    throw Error("a study of tissue does not come to rest");
}

// Of the cells, by their mean edges; over that at rest.
double volume_ratio(const Body& body, const Vectors& positions) {
    double volume = 0;
    for (const std::array<int, 8>& cell : body.cells) {
        dmat3 edges(0);
        for (std::size_t k = 0; k < 8; ++k)
            for (int axis = 0; axis < 3; ++axis)
                edges[axis] += (k >> axis & 1 ? 0.25 : -0.25) * positions[std::size_t(cell[k])];
        volume += glm::determinant(edges);
    }
    return volume / (double(body.cells.size()) * std::pow(double(body.spacing), 3));
}

std::size_t node_at(const Body& body, ivec3 place) {
    return std::size_t(std::find(body.at.begin(), body.at.end(), place) - body.at.begin());
}

// ---- a tip ----

Body on_the_ground(ivec3 cells, float spacing, const Material& material) {
    Body body = lattice(cells + 1, spacing, material);
    pin(body, nodes_below(body, 0, {0, -1, 0}));
    return body;
}

// Moves a tip down, and returns the force on it when the body has come to rest.
double push_down(Solver& solver, Press& tip, double way, double seconds) {
    tip.velocity = {0, -float(way / seconds), 0};
    solver.step(seconds, {.presses = {&tip, 1}});
    tip.centre += float(seconds) * tip.velocity;
    tip.velocity = vec3(0);
    return settled(5e-4, [&] {
        return solver.step(seconds, {.presses = {&tip, 1}}).reactions[0].y / seconds;
    });
}

// Hertz, on a half-space.
double hertz_force(double modulus, double nu, double radius, double depth) {
    return 4 / 3.0 * modulus / (1 - nu * nu) * std::sqrt(radius) * std::pow(depth, 1.5);
}

// By how much more a bonded layer resists: Dimitriadis, Horkay, Maresca, Kachar and Chadwick 2002.
double layer_factor(double nu, double radius, double depth, double height) {
    const double a = -(1.2876 - 1.4678 * nu + 1.3442 * nu * nu) / (1 - nu),
                 b = (0.6387 - 1.0277 * nu + 1.5164 * nu * nu) / (1 - nu),
                 x = std::sqrt(radius * depth) / height, cube = std::pow(a, 3);
    return 1 - 2 * a / pi * x + 4 * a * a / (pi * pi) * x * x -
           8 / std::pow(pi, 3) * (cube + 4 * pi * pi / 15 * b) * std::pow(x, 3) +
           16 * a / std::pow(pi, 4) * (cube + 3 * pi * pi / 5 * b) * std::pow(x, 4);
}

}  // namespace

std::vector<Indentation> indent(const Indenter& of, std::span<const double> depths) {
    const double h = 0.001, modulus = 2000, nu = double(of.poisson), radius = of.radius * h,
                 height = of.height * h;
    const Body body = on_the_ground({of.width, of.height, of.width}, float(h), tissue(modulus, nu));
    const double wave = height / shear_speed(body);  // s, from top to bottom
    const auto solver = solver_of(body, pi / wave);  // critical for the slowest shear wave
    const std::size_t apex = node_at(body, {of.width / 2, of.height, of.width / 2});
    // So stiff that the tip sinks in by hundredths of what it presses, and the step stays about as long.
    const TissueCells& cells = *tissue_of(body);
    const double pressure = 4 * double(cells.lame() + cells.shear()) / h;
    Press tip{body.positions[apex] + vec3(0, float(radius), 0), vec3(0), float(radius),
              float(pressure * pi * radius * radius)};
    std::vector<Indentation> found;
    double deep = 0;
    for (double depth : depths) {
        const double force = push_down(*solver, tip, (depth - std::exchange(deep, depth)) * h, wave);
        const double sunk = double(body.positions[apex].y) - solver->state().positions[apex].y;
        const double over_hertz = force / hertz_force(modulus, nu, radius, sunk);
        found.push_back({sunk / h, std::sqrt(radius * sunk) / h, over_hertz,
                         over_hertz / layer_factor(nu, radius, sunk, height)});
    }
    return found;
}

UnderABall press_with_a_ball() {
    const float h = 0.005f, radius = 0.03f;
    const ivec3 cells(18, 12, 18);
    const Body body = on_the_ground(cells, h, tissue(2000, 0.49));
    const auto solver = solver_of(body, 20);
    Press tip{h * vec3(cells) * vec3(0.5f, 1, 0.5f) + vec3(0, radius, 0), vec3(0), radius, 30'000};
    push_down(*solver, tip, 0.022, 1);
    const State state = solver->state();
    const double height = cells.y * double(h);
    double lowest = height;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].y == cells.y) lowest = std::min(lowest, state.positions[i].y);
    return {1 - lowest / height, volume_ratio(body, state.positions),
            inverted_cells(body, solver->nodes().positions)};
}

// ---- a block and a beam ----

namespace {

Body body_of(const Block& block, int cells) {
    const double spacing = block.size.y / cells;
    return lattice(ivec3(glm::round(block.size / spacing)) + 1, float(spacing),
                   tissue(block.youngs_modulus, block.poisson));
}

double force_on(const Body& body, const std::vector<int>& nodes, const Vectors& positions) {
    Vectors forces(body.count());
    Forces(body).at(positions, forces);
    double up = 0;
    for (int node : nodes) up += forces[std::size_t(node)].y;
    return up;
}

}  // namespace

dvec3 pressed_to(const Block& block, Plate plate, double depth, dvec3 place) {
    auto dish = [](double part) { return std::pow(std::sin(pi * part), 2); };
    if (plate == Plate::dished) depth *= dish(place.x / block.size.x) * dish(place.z / block.size.z);
    return place - dvec3(0, depth * block.size.y, 0);
}

std::vector<PressedBlock> press(const Block& block, Plate plate, std::span<const double> depths, int cells) {
    Body body = body_of(block, cells);
    const std::vector<int> top = nodes_below(body, 0, {0, 1, 0});
    pin(body, nodes_below(body, 0, {0, -1, 0}));
    pin(body, top);
    const double wave = block.size.y / shear_speed(body);
    const auto solver = solver_of(body, 2 * pi / wave, block.gravity);
    std::vector<PressedBlock> found;
    for (double depth : depths) {
        std::vector<vec3> places;
        for (int i : top)
            places.push_back(pressed_to(block, plate, depth, dvec3(body.positions[std::size_t(i)])));
        const Move down{top, places};
        const double force = settled(1e-5, [&] {
            solver->step(wave, {.moves = {&down, 1}});
            return force_on(body, top, solver->state().positions);
        });
        const Vectors positions = solver->state().positions;
        const double energy = Forces(body).energy(positions);
        found.push_back({depth, force, volume_ratio(body, positions), energy, energy});
    }
    return found;
}

BentBeam bend(const Block& of, int cells) {
    Body body = body_of(of, cells);
    pin(body, nodes_below(body, 0, {-1, 0, 0}));
    const std::size_t end = node_at(body, body.at.back() / ivec3(1, 2, 2));
    // Euler and Bernoulli's, of a beam that is held at one end.
    const double slowest =
        3.516 / (of.size.x * of.size.x) * of.size.y * std::sqrt(of.youngs_modulus / (12 * density));
    const auto solver = solver_of(body, 2 * slowest, of.gravity);
    const double sag = settled(1e-5, [&] {
        solver->step(1 / slowest);
        return double(body.positions[end].y) - solver->state().positions[end].y;
    });
    return {sag, volume_ratio(body, solver->state().positions)};
}

// ---- the laws alone ----

Laws::Laws(double youngs_modulus, double poisson)
    : shear(shear_modulus(youngs_modulus, poisson)),
      bulk(youngs_modulus / (3 * (1 - 2 * poisson))),
      cell_(lattice(ivec3(2), 1, studies::tissue(youngs_modulus, poisson))) {}

double Laws::tissue(const dmat3& gradient) const {
    Vectors corners;
    for (vec3 corner : cell_.positions) corners.push_back(gradient * dvec3(corner));
    return terms_.energy(corners);
}

double Laws::calculix(const dmat3& gradient) const {
    const double j = glm::determinant(gradient);
    const double square = glm::dot(gradient[0], gradient[0]) + glm::dot(gradient[1], gradient[1]) +
                          glm::dot(gradient[2], gradient[2]);
    return shear / 2 * (square * std::pow(j, -2 / 3.0) - 3) + bulk / 2 * (j - 1) * (j - 1);
}

namespace {

using Law = std::function<double(const dmat3& gradient)>;

dmat3 stretched(double along, double across) { return {along, 0, 0, 0, across, 0, 0, 0, across}; }

// How wide a bar gets whose sides are free: so that its energy is least.
double width_of_a_bar(const Law& law, double along) {
    double low = 0.8, high = 2;
    while (high - low > 1e-6) {
        const double third = (high - low) / 3;
        if (law(stretched(along, low + third)) < law(stretched(along, high - third)))
            high -= third;
        else
            low += third;
    }
    return low;
}

double stress_in_a_bar(const Law& law, double along) {
    const double across = width_of_a_bar(law, along), small = 1e-4;
    return (law(stretched(along + small, across)) - law(stretched(along - small, across))) / (2 * small);
}

}  // namespace

double bar_over_calculix(double poisson, double shortening) {
    const Laws laws(1, poisson);
    return stress_in_a_bar([&](const dmat3& f) { return laws.tissue(f); }, 1 - shortening) /
           stress_in_a_bar([&](const dmat3& f) { return laws.calculix(f); }, 1 - shortening);
}

double frequency_when_pressed(double poisson, double shortening) {
    const Laws laws(2000, poisson);
    const dmat3 press = stretched(
        1 - shortening, width_of_a_bar([&](const dmat3& f) { return laws.tissue(f); }, 1 - shortening));
    const Body body = lattice(ivec3(9), 0.01f, tissue(2000, poisson));
    const Forces terms(body);
    Vectors pressed, way, ahead(body.count()), behind(body.count());
    for (std::size_t i = 0; i < body.count(); ++i) {
        pressed.push_back(press * dvec3(body.positions[i]));
        way.push_back({std::sin(7.0 * double(i)), std::cos(5.0 * double(i)), std::sin(3.0 * double(i))});
    }
    auto forces_beside = [&](double by, Vectors& forces) {
        Vectors places = pressed;
        for (std::size_t i = 0; i < places.size(); ++i) places[i] += by * way[i];
        terms.at(places, forces);
    };
    double square = 0;  // by power iteration on the derivative of the accelerations
    for (int round = 0; round < 300; ++round) {
        const double size = std::sqrt(dot(way, way)), small = 1e-6 / size;
        forces_beside(small, ahead);
        forces_beside(-small, behind);
        for (std::size_t i = 0; i < way.size(); ++i)
            way[i] = double(body.inverse_mass[i]) / (2 * small) * (behind[i] - ahead[i]);
        square = std::sqrt(dot(way, way)) / size;
        for (dvec3& w : way) w /= square * size;
    }
    return std::sqrt(square) / highest_frequency(body);
}

}  // namespace palpate::studies
