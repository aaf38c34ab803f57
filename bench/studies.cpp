#include "bench/studies.h"

#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/solver/forces.h"
#include "palpate/solver/solver.h"
#include "palpate/solver/stability.h"

#include <algorithm>
#include <cmath>

namespace palpate::studies {

Body chain(const Damping& damping) {
    std::vector<vec3> positions;
    std::vector<float> masses;
    std::vector<Spring> springs;
    for (int i = 0; i < 9; ++i) {
        positions.push_back({0.1f * float(i), 0, 0});
        masses.push_back(i == 0 ? 0 : 0.02f + 0.002f * float(i));
        if (i > 0) springs.push_back({i - 1, i, 60, 0.095f});
    }
    Body body = net(positions, masses, springs);
    body.damping = damping.of_nodes;
    body.link_damping = damping.of_links;
    return body;
}

Body tissue_chain(const Damping& damping) {
    Body body = lattice({3, 2, 2}, 1, {.youngs_modulus = 1e6f, .density = 1000});
    pin(body, nodes_in(body, {vec3(-1), vec3(0.1f, 2, 2)}));
    body.damping = damping.of_nodes;
    body.link_damping = damping.of_links;
    return body;
}

namespace {

constexpr double pi = 3.14159265358979;

State swing(const Body& body, Integrator integrator, int steps) {
    const double seconds = 0.25;
    Simulation simulation{.integrator = integrator, .step = seconds / steps};
    auto solver = make_exact_solver(body, simulation, 0);
    solver->step(seconds);
    return solver->state();
}

// The largest difference between positions, or between velocities scaled by the time of a swing, m.
double distance(const State& a, const State& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.positions.size(); ++i)
        most = std::max({most, glm::distance(a.positions[i], b.positions[i]),
                         0.02 * glm::distance(a.velocities[i], b.velocities[i])});
    return most;
}

Body held_box(const Material& material, const Damping& damping) {
    Body body = lattice({4, 3, 5}, 0.01f, material);
    body.damping = damping.of_nodes * 20;
    body.link_damping = damping.of_links;
    pin(body, nodes_in(body, {vec3(-1), vec3(0.001f, 1, 1)}));  // otherwise it would rotate for ever
    return body;
}

void shake(Body& body, float by) {
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.inverse_mass[i] > 0)
            body.positions[i] += by * vec3(std::sin(7.0f * i), std::cos(5.0f * i), std::sin(3.0f * i));
}

// The largest distance of a node from its position at rest, m.
double amplitude(const Body& rest, const State& state) {
    double most = 0;
    for (std::size_t i = 0; i < rest.count(); ++i)
        most = std::max(most, glm::distance(state.positions[i], dvec3(rest.positions[i])));
    return most;
}

// Whether a shaken lattice is unstable: its amplitude is larger in the last quarter of 6,000 steps than in
// the second, or reaches twenty times the first. A motion that has decayed to rounding errors does not count.
bool grows(const Body& rest, Integrator integrator, double step) {
    const float slightly = 1e-7f;
    Body body = rest;
    shake(body, slightly);
    auto solver = make_exact_solver(body, {.integrator = integrator, .step = step, .gravity = vec3(0)}, 0);
    double largest[4] = {};
    for (int i = 0; i < 60; ++i) {
        if (solver->step(100 * step).diverged) return true;
        const double now = amplitude(rest, solver->state());
        if (!(now < 20 * slightly)) return true;
        largest[i / 15] = std::max(largest[i / 15], now);
    }
    return largest[3] > 1e-5 * slightly && !(largest[3] < 1.3 * largest[1]);
}

}  // namespace

Body small_lattice(const Damping& damping) {
    return held_box({.youngs_modulus = 5000, .density = 1000, .model = MaterialModel::springs}, damping);
}

Body small_tissue(const Damping& damping) {
    return held_box({.youngs_modulus = 2000, .density = 1000}, damping);
}

double order(Studied made, Integrator integrator, const Damping& damping, int steps) {
    const Body body = made(damping);
    const State truth = swing(body, Integrator::rk4, 16 * steps);
    return std::log2(distance(swing(body, integrator, steps), truth) /
                     distance(swing(body, integrator, 2 * steps), truth));
}

bool grows(Studied made, Integrator integrator, const Damping& damping, double part) {
    const Body body = made(damping);
    return grows(body, integrator,
                 part * longest_step(integrator, highest_frequency(body), body.damping, body.link_damping));
}

Limit stability_limit(Integrator integrator, const Damping& damping) {
    const Body body = small_lattice(damping);
    const double frequency = highest_frequency(body);
    const double predicted = longest_step(integrator, frequency, body.damping, body.link_damping);
    double low = 0.5 * predicted, high = 2 * predicted;
    while (high > 1.005 * low) {
        const double middle = std::sqrt(low * high);
        (grows(body, integrator, middle) ? high : low) = middle;
    }
    return {std::sqrt(low * high), predicted, frequency};
}

Growth growth_per_step(Integrator integrator, double step) {
    // A pair of nodes vibrates with one frequency only, so its growth can be measured.
    Body body = lattice({2, 1, 1}, 0.1f, {.stiffness = 50, .mass = 0.4f});
    const double frequency = highest_frequency(body), seconds = step / frequency;
    body.positions[1].x += 1e-6f;
    auto solver = make_exact_solver(
        body, {.integrator = integrator, .step = seconds, .force = true, .gravity = vec3(0)}, frequency);
    auto size = [&] {  // of the vibration: displacement and velocity together
        const State s = solver->state();
        const double x = glm::distance(s.positions[0], s.positions[1]) - double(0.1f);
        const double v = s.velocities[1].x - s.velocities[0].x;
        return std::hypot(x, v / frequency);
    };
    const int steps = 50;
    const double before = size();
    solver->step(steps * seconds);
    return {std::pow(size() / before, 1.0 / steps) - 1, growth(integrator, seconds, frequency, 0, 0) - 1};
}

double pulse_speed(bool shear) {
    const float h = 0.01f, width = 4 * h, height = 1e-4f * h;
    // Wide enough that waves from its free sides reach the middle only after the pulse has passed. A shear
    // pulse along y does not disturb the sides across z.
    const ivec3 dims = shear ? ivec3(64, 65, 3) : ivec3(64, 25, 25);
    const int middle = dims.x / 2;
    const double modulus = 5000, density = 1000;
    Body body = lattice(
        dims, h,
        {.youngs_modulus = float(modulus), .density = float(density), .model = MaterialModel::springs});
    const double k = 0.4 * modulus * h;
    const double speed = std::sqrt((shear ? 1 : 3) * k / (h * density));
    for (vec3& p : body.positions) {
        const float x = (p.x - float(middle) * h) / width;
        p[shear ? 1 : 0] += height * std::exp(-0.5f * x * x);
    }
    // The pulse splits in two; the right one is located by its centroid before waves from the sides reach the
    // axis.
    const double seconds = 11 * h / speed;
    auto solver = make_exact_solver(body, {.step = seconds / 200, .gravity = vec3(0)}, 0);
    solver->step(seconds);
    const State state = solver->state();
    double sum = 0, weight = 0;
    for (std::size_t i = 0; i < body.count(); ++i) {
        const ivec3 at = body.at[i];
        if (at.y != dims.y / 2 || at.z != dims.z / 2 || at.x <= middle) continue;
        const double rest = double(h * float(at[shear ? 1 : 0]));
        const double u = state.positions[i][shear ? 1 : 0] - rest;
        sum += u * u * (at.x - middle) * double(h);
        weight += u * u;
    }
    return sum / weight / (speed * seconds);
}

double cantilever_sag(int cells) {
    const float h = 0.01f, modulus = 1e5f, density = 1000;
    const int length = 10 * cells;
    const double thick = cells * double(h), far = length * double(h);
    // Gravity so weak that the sag is a thousandth of the length: the theory is linear.
    const double inertia = std::pow(thick, 4) / 12, shear_modulus = 0.4 * modulus, shape = 12.5 / 14.75;
    auto sag_of = [&](double gravity) {
        const double load = density * gravity * thick * thick;  // N/m
        return load * std::pow(far, 4) / (8 * modulus * inertia) +
               load * far * far / (2 * shape * shear_modulus * thick * thick);
    };
    const double gravity = 1e-3 * far / sag_of(1);
    // Its lowest mode is damped critically.
    const double slowest = 3.516 / (far * far) * std::sqrt(modulus * inertia / (density * thick * thick));
    Body body = lattice({length + 1, cells + 1, cells + 1}, h,
                        {.youngs_modulus = modulus,
                         .density = density,
                         .damping = float(2 * slowest),
                         .model = MaterialModel::springs});
    pin(body, nodes_in(body, {vec3(-1), vec3(0.1f * h, 1, 1)}));
    Simulation simulation{.gravity = vec3(0, -gravity, 0)};
    auto solver = make_exact_solver(body, simulation, highest_frequency(body));
    solver->step(1.6 * 2 * pi / slowest);
    const State state = solver->state();
    double sag = 0;
    int ends = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        if (body.at[i].x == length) {
            sag += double(body.positions[i].y) - state.positions[i].y;
            ++ends;
        }
    return sag / ends / sag_of(gravity);
}

Swing energy_swing(Integrator integrator, int steps, MaterialModel model) {
    const Body body = lattice({3, 2, 3}, 0.01f, {.youngs_modulus = 5000, .density = 1000, .model = model});
    const double frequency = highest_frequency(body);
    auto solver = make_exact_solver(body, {.integrator = integrator, .gravity = vec3(0)}, frequency);
    State stretched = solver->state();
    for (std::size_t i = 0; i < body.count(); ++i)
        stretched.positions[i] = dvec3(body.positions[i] * vec3(1.02f, 0.99f, 1.01f));
    solver->restore(stretched);
    const double step = solver->longest_step();
    const Energy e = energy(body, solver->state());
    const double first = e.kinetic + e.elastic;
    const int parts = 1000;
    Swing swing{1, 1, 0};
    double early = 0, late = 0;
    for (int i = 0; i < parts; ++i) {
        solver->step(steps / parts * step);
        const Energy now = energy(body, solver->state());
        const double ratio = (now.kinetic + now.elastic) / first;
        if (!(ratio >= swing.least)) swing.least = ratio;
        if (!(ratio <= swing.largest)) swing.largest = ratio;
        if (i < parts / 10) early += ratio;
        if (i >= parts - parts / 10) late += ratio;
    }
    swing.drift = late / early - 1;
    return swing;
}

}  // namespace palpate::studies
