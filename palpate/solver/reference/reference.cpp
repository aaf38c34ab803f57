#include "palpate/solver/reference/reference.h"

#include "palpate/solver/stability.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

#include "palpate/solver/pass.inl"

// A node with its backend's eyes: how it sees its neighbours. The physics is node.inl's.
template <class Number>
struct ReferenceNode {
    using Real = Number;
    using Real3 = glm::vec<3, Real>;

    const Pass& pass;
    const std::vector<Real3>& positions;
    const int* ends;     // this node's neighbours, one a link; itself where there is none
    const Real* shares;  // 0 to 1, one a link
    Real outside_area, outside_cover;

    Real3 toward(Real3 p, int l) const { return positions[ends[l]] - p; }
    Real share(int l) const { return shares[l]; }
    Real area() const { return outside_area; }
    Real cover() const { return outside_cover; }

    static Real max(Real a, Real b) { return a > b ? a : b; }
    static Real min(Real a, Real b) { return a < b ? a : b; }
    static Real inversesqrt(Real a) { return 1 / std::sqrt(a); }
    template <class T>
    static T select(bool c, T a, T b) {
        return c ? a : b;
    }

#define FN
#define UNROLL
#define LINKS pass.links
#include "palpate/solver/node.inl"
#undef LINKS
#undef UNROLL
#undef FN
};

template <class Real>
class Reference final : public Solver {
    using At = ReferenceNode<Real>;
    using Node = typename At::Node;
    using Real3 = typename At::Real3;

 public:
    Reference(const Body& body, const Simulation& simulation, double frequency)
        : body_(body), simulation_(simulation), frequency_(frequency), ends_(neighbours(body)) {
        for (std::size_t i = 0; i < ends_.size(); ++i) {
            const std::size_t node = i / links(), link = i % links();
            if (ends_[i] < 0) ends_[i] = int(node);
            shares_.push_back(Real(0.25f) * Real(body.springs.quarters(node, link)));
        }
        for (vec3 p : body.positions) now_.positions.push_back(Real3(p));
        now_.velocities.assign(body.count(), Real3(0));
        next_ = now_;
        fill_pass();
        publish();
    }

    Stats step(double seconds, std::span<const Press> presses) override {
        Stats stats;
        stats.reactions.assign(presses.size(), dvec3(0));
        stats.steps = steps_within(seconds, longest_step(presses));
        stats.step = seconds / stats.steps;
        const Moving before = now_;
        const double lag_before = lag_;
        for (int i = 0; i < stats.steps; ++i) {
            pass_.kick = float(kick(stats.step));
            pass_.drift = float(stats.step);
            place_tips(presses, i * stats.step);
            for (std::size_t p = 0; p < presses.size(); ++p) stats.reactions[p] -= impulse_of_tip(int(p));
            move_all();
            lag_ = staggered() ? stats.step / 2 : 0;
        }
        if (torn()) {
            stats.diverged = true;
            now_ = before;
            lag_ = lag_before;
        }
        for (Real3 v : now_.velocities)
            stats.largest_speed = std::max(stats.largest_speed, double(glm::length(v)));
        publish();
        return stats;
    }

    double longest_step(std::span<const Press> presses) const override {
        if (simulation_.step > 0) return simulation_.step;
        float contact = 0;
        for (const Press& press : presses)
            contact += pressure_per_metre(press);  // they may all meet at one node
        const double frequency = pressed_frequency(body_, frequency_, std::max(contact, simulation_.contact));
        return step_safety * palpate::longest_step(simulation_.integrator, frequency, body_.damping);
    }

    Nodes nodes() const override { return {positions_, normals_}; }

    State state() const override {
        // Staggered velocities lie `lag` behind the positions: half a kick brings them up.
        Pass pass = pass_;
        pass.kick = float(lag_ / (1 + body_.damping * lag_));
        pass.tips = 0;
        State state;
        for (std::size_t i = 0; i < body_.count(); ++i) {
            At at = node_at(i, pass);
            Node node = load(i);
            if (lag_ > 0 && node.inverse_mass > 0) node.velocity += Real(pass.kick) * at.acceleration(node);
            state.positions.push_back(dvec3(node.position));
            state.velocities.push_back(dvec3(node.velocity));
        }
        return state;
    }

 private:
    struct Moving {
        std::vector<Real3> positions, velocities;
    };

    std::size_t links() const { return body_.springs.links.size(); }
    bool staggered() const { return simulation_.integrator == Integrator::verlet; }

    void fill_pass() {
        pass_.gravity = vec4(simulation_.gravity, 0);
        pass_.damping = body_.damping;
        pass_.links = int(links());
        for (std::size_t l = 0; l < links(); ++l) {
            const Link& link = body_.springs.links[l];
            pass_.spring[l] = {0, link.stiffness, link.stiffness * link.rest, 0};
        }
        for (const Collider& collider : simulation_.colliders) {
            if (const auto* plane = std::get_if<Plane>(&collider))
                pass_.plane[pass_.planes++] = vec4(plane->normal, plane->offset);
            else if (const auto* sphere = std::get_if<Sphere>(&collider))
                pass_.sphere[pass_.spheres++] = vec4(sphere->centre, sphere->radius);
        }
    }

    // How far a step carries the velocities. Semi-implicit Euler: one step. Verlet's velocities run half a
    // step behind the positions, so a kick goes from the middle of the last step (at the start: from now) to
    // the middle of this one; damping acts on the mean of the old and the new velocity, which is what keeps
    // the order at two.
    double kick(double dt) const { return staggered() ? (lag_ + dt / 2) / (1 + body_.damping * lag_) : dt; }

    void place_tips(std::span<const Press> presses, double time) {
        assert(presses.size() <= std::size(pass_.tip));
        pass_.tips = int(presses.size());
        for (std::size_t i = 0; i < presses.size(); ++i) {
            const Press& press = presses[i];
            pass_.tip[i] = vec4(press.centre + float(time) * press.velocity, press.radius);
            pass_.tip_push[i] = vec4(pressure_per_metre(press), 0, 0, 0);
        }
    }

    // N s, that a tip gives to the nodes in this pass.
    dvec3 impulse_of_tip(int tip) const {
        dvec3 force(0);
        for (std::size_t i = 0; i < body_.count(); ++i)
            force += dvec3(node_at(i, pass_).tip_force(now_.positions[i], tip));
        return double(pass_.kick) * force;
    }

    At node_at(std::size_t i, const Pass& pass) const {
        return {pass,
                now_.positions,
                &ends_[i * links()],
                &shares_[i * links()],
                Real(body_.area[i]),
                Real(body_.cover[i])};
    }
    Node load(std::size_t i) const {
        return {now_.positions[i], now_.velocities[i], Real(body_.inverse_mass[i])};
    }

    void move_all() {
        for (std::size_t i = 0; i < body_.count(); ++i) {
            At at = node_at(i, pass_);
            const Node node = load(i), next = at.integrate(node, at.acceleration(node));
            next_.positions[i] = next.position;
            next_.velocities[i] = next.velocity;
        }
        std::swap(now_, next_);
    }

    // True if a spring is stretched to ten times its length, or a position is not a number: no tissue does
    // that, a motion that blows up soon does.
    bool torn() const {
        for (std::size_t i = 0; i < body_.count(); ++i)
            for (std::size_t l = 0; l < links(); ++l) {
                if (shares_[i * links() + l] == 0) continue;
                const Real3 along = now_.positions[ends_[i * links() + l]] - now_.positions[i];
                const Real longest = 10 * Real(body_.springs.links[l].rest);
                if (!(glm::dot(along, along) <= longest * longest)) return true;
            }
        return false;
    }

    void publish() {
        positions_.clear();
        for (Real3 p : now_.positions) positions_.push_back(vec3(p));
        normals_.clear();
        for (std::size_t i = 0; i < body_.count(); ++i)
            normals_.push_back(vec3(node_at(i, pass_).springs(now_.positions[i]).outward));
    }

    Body body_;
    Simulation simulation_;
    double frequency_;  // rad/s, the highest of the body without a press
    std::vector<int> ends_;
    std::vector<Real> shares_;
    Pass pass_{};
    double lag_ = 0;  // s, how far the velocities are behind the positions
    Moving now_, next_;
    std::vector<vec3> positions_, normals_;  // what nodes() shows
};

}  // namespace

template <class Real>
std::unique_ptr<Solver> make_reference(const Body& body, const Simulation& simulation, double frequency) {
    return std::make_unique<Reference<Real>>(body, simulation, frequency);
}

template std::unique_ptr<Solver> make_reference<float>(const Body&, const Simulation&, double);
template std::unique_ptr<Solver> make_reference<double>(const Body&, const Simulation&, double);

}  // namespace palpate
