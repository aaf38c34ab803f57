#include "palpate/solver/stability.h"

#include <cmath>
#include <limits>
#include <random>

namespace palpate {
namespace {

// y = M^(-1/2) K M^(-1/2) x about the rest shape, where a spring along the unit vector n resists by k n nᵀ.
class RestStiffness {
 public:
    explicit RestStiffness(const Body& body) : body_(body), ends_(neighbours(body)) {
        for (const Link& link : body.springs.links) along_.push_back(glm::normalize(dvec3(link.offset)));
        for (float inverse : body.inverse_mass) root_.push_back(std::sqrt(double(inverse)));
    }

    void apply(const std::vector<dvec3>& x, std::vector<dvec3>& y) const {
        const std::size_t links = along_.size();
        for (std::size_t i = 0; i < x.size(); ++i) {
            const dvec3 u = root_[i] * x[i];
            dvec3 force(0);
            for (std::size_t l = 0; l < links; ++l) {
                const int j = ends_[i * links + l];
                if (j < 0) continue;
                const double k = 0.25 * body_.springs.quarters(i, l) * body_.springs.links[l].stiffness;
                force += k * glm::dot(along_[l], u - root_[j] * x[j]) * along_[l];
            }
            y[i] = root_[i] * force;
        }
    }

 private:
    const Body& body_;
    std::vector<int> ends_;
    std::vector<dvec3> along_;
    std::vector<double> root_;
};

}  // namespace

double highest_frequency(const Body& body) {
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

double pressed_frequency(const Body& body, double frequency, float contact) {
    float worst = 0;
    for (std::size_t i = 0; i < body.count(); ++i)
        worst = std::max(worst, body.area[i] * body.inverse_mass[i]);
    return std::sqrt(frequency * frequency + double(contact) * worst);
}

double longest_step(Integrator integrator, double frequency, double damping) {
    const double w = frequency, c = damping;
    if (!(w > 0)) return c > 0 ? 2 / c : std::numeric_limits<double>::infinity();
    switch (integrator) {
        // z² - (2 - c dt - w² dt²) z + (1 - c dt) leaves the unit circle at z = -1, where w² dt² + 2 c dt
        // = 4.
        case Integrator::semi_implicit_euler:
            return (std::sqrt(c * c + 4 * w * w) - c) / (w * w);
        // (1 + b) z² - (2 - w² dt²) z + (1 - b) with b = c dt / 2 does so at w dt = 2, whatever the damping.
        case Integrator::verlet:
            return 2 / w;
    }
    return 0;
}

}  // namespace palpate
