#include "palpate/solver/stability.h"

#include "palpate/solver/forces.h"
#include "palpate/solver/scheme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

// One step of x'' = -ω² x - rate · x', seen as (x, v), by the integrator's own stages.
dvec2 one_step(const Scheme& scheme, double step, double frequency, double damping, double rate,
               dvec2 start) {
    dvec2 now = start, sum = start;
    for (const Stage& stage : scheme.stages) {
        const double a = -frequency * frequency * now.x - rate * now.y;
        const double kick = scheme.kick(stage, step, step / 2, damping);
        const dvec2 from = stage.from_sum ? sum : start;
        sum += stage.part * step * dvec2(now.y, a);
        const double v = from.y + kick * a;
        now = {from.x + stage.drift * step * (now.y + stage.lead * (v - now.y)), v};
    }
    return now;
}

}  // namespace

double highest_frequency(const Body& body) {
    const Forces terms(body);
    const std::size_t count = body.count();
    const std::vector<dvec3> rest(body.positions.begin(), body.positions.end());
    std::vector<double> root;  // of each inverse mass
    for (float inverse : body.inverse_mass) root.push_back(std::sqrt(double(inverse)));
    std::mt19937 random(1);  // the same start, and so the same answer, every time
    std::uniform_real_distribution<double> part(-1, 1);
    std::vector<dvec3> x(count), displacement(count), y(count);
    for (dvec3& v : x) v = {part(random), part(random), part(random)};

    // Power iteration on M^(-1/2) K M^(-1/2).
    double largest = 0;  // eigenvalue, rad²/s²
    for (int i = 0; i < 80; ++i) {
        double norm = 0;
        for (dvec3 v : x) norm += glm::dot(v, v);
        if (!(norm > 0)) break;
        for (std::size_t n = 0; n < count; ++n) displacement[n] = root[n] * (x[n] /= std::sqrt(norm));
        terms.stiffness_times(rest, displacement, y);
        largest = 0;
        for (std::size_t n = 0; n < count; ++n) largest += glm::dot(x[n], y[n] *= root[n]);
        std::swap(x, y);
    }
    return std::sqrt(largest);
}

double touched_frequency(const Body& body, double frequency, float contact, float pull) {
    double worst = 0;
    const float inner =
        tissue_of(body) ? body.spacing * body.spacing : 0;  // at most, m²: tip_force in node.inl
    for (std::size_t i = 0; i < body.count(); ++i) {
        const float area = body.area[i] > 0 ? body.area[i] : inner;
        worst = std::max(worst, (double(contact) * area + pull) * body.inverse_mass[i]);
    }
    return std::sqrt(frequency * frequency + worst);
}

double growth(Integrator integrator, double step, double frequency, double damping, double link_damping) {
    const Scheme& by = scheme(integrator);
    const double rate = damping + link_damping * frequency * frequency;
    const dvec2 x = one_step(by, step, frequency, damping, rate, {1, 0});
    const dvec2 v = one_step(by, step, frequency, damping, rate, {0, 1});
    const double half_trace = (x.x + v.y) / 2, determinant = x.x * v.y - x.y * v.x;
    const double discriminant = half_trace * half_trace - determinant;
    return discriminant < 0 ? std::sqrt(determinant) : std::abs(half_trace) + std::sqrt(discriminant);
}

double longest_step(Integrator integrator, double frequency, double damping, double link_damping) {
    const double rate = damping + link_damping * frequency * frequency;
    if (!(frequency > 0) && !(rate > 0)) return std::numeric_limits<double>::infinity();
    // Slow motions too must stay bounded: damping can be too fast for a step that all vibrations allow.
    auto stable = [&](double step) {
        for (double part : {0.0, 0.25, 0.5, 0.75, 1.0})
            if (!(growth(integrator, step, part * frequency, damping, link_damping) <= 1 + 1e-9))
                return false;
        return true;
    };
    // Without damping what grows at all grows at any step, however slowly.
    if (!(rate > 0) && !stable(0.05 / frequency)) return 0;
    double low = 0, high = 8 / (frequency > 0 ? frequency : rate);
    if (stable(high)) return high;
    for (int i = 0; i < 100; ++i) {
        const double middle = (low + high) / 2;
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

double frequency_reserve(const Body& body) { return tissue_of(body) ? 1.7 : std::numbers::sqrt2; }

double automatic_step(Integrator integrator, double frequency, double damping, double link_damping,
                      double reserve) {
    return std::min(0.7 * longest_step(integrator, frequency, damping, link_damping),
                    0.99 * longest_step(integrator, reserve * frequency, damping, link_damping));
}

}  // namespace palpate
