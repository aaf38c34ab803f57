#include "palpate/solver/stability.h"

#include "palpate/solver/scheme.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

// y = M^(-1/2) K M^(-1/2) x about the rest shape, where a spring along the unit vector n resists by k n nᵀ.
class RestStiffness {
 public:
    explicit RestStiffness(const Body& body) : body_(body), springs_(table(body)) {
        for (std::size_t i = 0; i < body.count(); ++i) {
            root_.push_back(std::sqrt(double(body.inverse_mass[i])));
            for (const Tie& tie : springs_.of(i)) along_.push_back(tie.to < 0 ? dvec3(0) : direction(i, tie));
        }
    }

    void apply(const std::vector<dvec3>& x, std::vector<dvec3>& y) const {
        const std::size_t width = std::size_t(springs_.width);
        for (std::size_t i = 0; i < x.size(); ++i) {
            const dvec3 u = root_[i] * x[i];
            dvec3 force(0);
            for (std::size_t t = 0; t < width; ++t) {
                const Tie& tie = springs_.ties[i * width + t];
                if (tie.to < 0) continue;
                const dvec3 n = along_[i * width + t];
                const double k = double(tie.share) * tie.stiffness;
                force += k * glm::dot(n, u - root_[std::size_t(tie.to)] * x[std::size_t(tie.to)]) * n;
            }
            y[i] = root_[i] * force;
        }
    }

 private:
    dvec3 direction(std::size_t i, const Tie& tie) const {
        const dvec3 along = dvec3(body_.positions[std::size_t(tie.to)]) - dvec3(body_.positions[i]);
        const double length = glm::length(along);
        return length > 0 ? along / length : dvec3(1, 0, 0);
    }

    const Body& body_;
    Table springs_;
    std::vector<dvec3> along_;
    std::vector<double> root_;
};

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
    check(body);
    const RestStiffness stiffness(body);
    std::mt19937 random(1);  // the same start, and so the same answer, every time
    std::uniform_real_distribution<double> part(-1, 1);
    std::vector<dvec3> x(body.count()), y(body.count());
    for (dvec3& v : x) v = {part(random), part(random), part(random)};

    double largest = 0;  // eigenvalue, rad²/s²
    for (int i = 0; i < 80; ++i) {
        double norm = 0;
        for (dvec3 v : x) norm += glm::dot(v, v);
        if (!(norm > 0)) break;
        for (dvec3& v : x) v /= std::sqrt(norm);
        stiffness.apply(x, y);
        double quotient = 0;
        for (std::size_t n = 0; n < x.size(); ++n) quotient += glm::dot(x[n], y[n]);
        largest = quotient;
        std::swap(x, y);
    }
    return std::sqrt(largest);
}

double touched_frequency(const Body& body, double frequency, float contact, float pull) {
    double worst = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        worst = std::max(worst, (double(contact) * body.area[i] + pull) * body.inverse_mass[i]);
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

double automatic_step(Integrator integrator, double frequency, double damping, double link_damping) {
    return std::min(0.7 * longest_step(integrator, frequency, damping, link_damping),
                    0.99 * longest_step(integrator, std::sqrt(2.0) * frequency, damping, link_damping));
}

}  // namespace palpate
