#include "palpate/solver/machine.h"
#include "palpate/solver/reference/node.h"

#include <algorithm>

namespace palpate {
namespace {

using namespace reference;

template <class Real, bool with_hinges>
class Reference final : public Machine {
    using Physics = NodePhysics<Real, with_hinges>;
    using Node = typename Physics::Node;
    using Real3 = typename Physics::Real3;

 public:
    Reference(const Body& body, const Simulation& simulation)
        : body_(body), around_(body_, simulation), quiet_(make_pass(body, simulation)) {
        for (StateBuffer where : {current, between, further, sum})
            if (needs(scheme(simulation.integrator), where))
                states_[where] = {std::vector<Real3>(body.count()), std::vector<Real3>(body.count())};
    }

    bool change(std::span<const int>) override {
        around_.read_terms();
        return true;
    }

    Findings run(const Call& call) override {
        Findings found{.by_presses = std::vector<dvec3>(call.influences.presses.size()),
                       .by_pushes = std::vector<dvec3>(call.influences.pushes.size())};
        around_.pushes = call.pushes;
        around_.push_of.assign(call.pushes.empty() ? 0 : body_.count(), -1);
        for (std::size_t p = 0; p < call.pushes.size(); ++p)
            around_.push_of[std::size_t(call.pushes[p].node)] = int(p);
        for (const Guide& guide : call.guides)
            states_[current].velocities[std::size_t(guide.node)] = Real3(guide.velocity);
        call.for_each_pass([&](const Pass& pass, const PassPlan& plan) {
            count_impulses(call.influences, pass, plan, found);
            pass_over_nodes(pass, plan, found);
            if (pass.last && plan.next != current) std::swap(states_[current], states_[plan.next]);
        });
        for (const Guide& guide : call.guides)
            if (guide.is_led) states_[current].positions[std::size_t(guide.node)] = Real3(guide.to);
        found.torn = torn();
        if (body_.count() > 0) {
            found.first_node = dvec3(states_[current].positions[0]);
            found.first_velocity = dvec3(states_[current].velocities[0]);
        }
        return found;
    }

    void put(const State& state, const Origin&) override {
        for (std::size_t i = 0; i < body_.count(); ++i) {
            states_[current].positions[i] = Real3(state.positions[i]);
            states_[current].velocities[i] = Real3(state.velocities[i]);
        }
    }

    State get() const override {
        State state;
        for (Real3 p : states_[current].positions) state.positions.push_back(dvec3(p));
        for (Real3 v : states_[current].velocities) state.velocities.push_back(dvec3(v));
        return state;
    }

    void shift(dvec3 place, dvec3 velocity) override {
        for (Real3& p : states_[current].positions) p = Real3(dvec3(p) - place);
        for (Real3& v : states_[current].velocities) v = Real3(dvec3(v) - velocity);
    }

    void remember() override { before_ = states_[current]; }
    void bring_back(const Origin&) override { states_[current] = before_; }

    std::vector<dvec3> kicked(const Pass& pass) const override {
        std::vector<dvec3> velocities;
        const auto pushes = cell_pushes(states_[current], pass);
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const Node node = load(states_[current], i);
            const Real3 change = node.inverse_mass > 0
                                     ? see(i, states_[current], pass, {}, pushes).acceleration(node)
                                     : Real3(0);
            velocities.push_back(dvec3(node.velocity + Real(pass.kick) * change));
        }
        return velocities;
    }

    void show(const Origin& origin, std::vector<vec3>& positions, std::vector<vec3>& normals) const override {
        positions.clear();
        normals.clear();
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const Real3 p = states_[current].positions[i];
            positions.push_back(vec3(origin.place + dvec3(p)));
            normals.push_back(vec3(see(i, states_[current], quiet_).outward(p)));
        }
    }

    std::size_t memory() const override {
        std::size_t bytes = around_.springs.ties.size() * sizeof(Tie);
        for (const auto& hinges : around_.hinges) bytes += hinges.size() * sizeof(OwnHinge);
        bytes += around_.cells.size() * sizeof(OwnCells);
        for (const NodeStates<Real>& state : states_) bytes += 2 * state.positions.size() * sizeof(Real3);
        return bytes;
    }

 private:
    void pass_over_nodes(const Pass& pass, const PassPlan& plan, Findings& found) {
        const NodeStates<Real>&start = states_[plan.start], &at = states_[plan.at];
        NodeStates<Real>&next = states_[plan.next], &total = states_[sum];
        std::vector<typename Physics::Eight> pushes;
        if (pass.kick > 0) pushes = cell_pushes(at, pass);
        for (std::size_t i = 0; i < body_.count(); ++i) {
            Physics physics = see(i, at, pass, plan, pushes);
            physics.impulse = plan.impulse;
            physics.impulses = found.by_presses.data();
            const Node node = load(at, i), from = load(start, i);
            const Real3 change =
                pass.kick > 0 ? physics.resisted(from, node.position, physics.acceleration(node)) : Real3(0);
            if (pass.part > 0)
                store(physics.collect(load(plan.opens ? at : total, i), node, change), total, i);
            const Real3 was = states_[current].positions[i];
            const Node moved = physics.collide(physics.integrate(from, node, change), was);
            store(moved, next, i);
            if (!plan.ends) continue;
            const Real3 along(pass.origin_speed);
            found.largest_speed = std::max(found.largest_speed, double(glm::length(moved.velocity + along)));
            found.largest_move = std::max(
                found.largest_move, double(glm::length(moved.position - was + Real(pass.duration) * along)));
        }
    }

    // N s, that tips and pushes give to the nodes in this pass.
    void count_impulses(const Influences& influences, const Pass& pass, const PassPlan& plan,
                        Findings& found) const {
        if (!(plan.impulse > 0)) return;  // a stage that only drifts
        const NodeStates<Real>& at = states_[plan.at];
        for (std::size_t t = 0; t < found.by_presses.size(); ++t)
            for (std::size_t i = 0; i < body_.count(); ++i)
                found.by_presses[t] +=
                    plan.impulse * dvec3(see(i, at, pass, plan).tip_force(at.positions[i], int(t)));
        for (std::size_t p = 0; p < found.by_pushes.size(); ++p) {
            const NodePush& push = influences.pushes[p];
            found.by_pushes[p] +=
                plan.impulse * dvec3(force_on(push, pass.time, at.positions[std::size_t(push.node)]));
        }
    }

    // Of each cell of tissue.
    std::vector<typename Physics::Eight> cell_pushes(const NodeStates<Real>& at, const Pass& pass) const {
        std::vector<typename Physics::Eight> pushes(around_.tissue ? body_.cells.size() : 0);
        for (std::size_t c = 0; c < pushes.size(); ++c)
            pushes[c] = reference::cell_pushes<Real, with_hinges>(around_, pass, at, c);
        return pushes;
    }

    Physics see(std::size_t i, const NodeStates<Real>& at, const Pass& pass, const PassPlan& plan = {},
                std::span<const typename Physics::Eight> pushes = {}) const {
        return reference::see<Real, with_hinges>(around_, pass, at, i, plan.tips, pushes);
    }
    Node load(const NodeStates<Real>& from, std::size_t i) const {
        return reference::load<Real, with_hinges>(around_, from, i);
    }
    static void store(const Node& node, NodeStates<Real>& into, std::size_t i) {
        into.positions[i] = node.position;
        into.velocities[i] = node.velocity;
    }

    bool torn() const {
        const NodeStates<Real>& at = states_[current];
        for (std::size_t i = 0; i < body_.count(); ++i)
            if (see(i, at, quiet_).torn(at.positions[i]) > 0) return true;
        return false;
    }

    const Body& body_;
    Surroundings around_;
    const Pass quiet_;            // nothing touches or moves it
    NodeStates<Real> states_[4];  // StateBuffer
    NodeStates<Real> before_;     // the call
};

}  // namespace

template <class Real>
std::unique_ptr<Machine> make_reference(const Body& body, const Simulation& simulation) {
    if (has_hinges(body)) return std::make_unique<Reference<Real, true>>(body, simulation);
    return std::make_unique<Reference<Real, false>>(body, simulation);
}

template std::unique_ptr<Machine> make_reference<float>(const Body&, const Simulation&);
template std::unique_ptr<Machine> make_reference<double>(const Body&, const Simulation&);

}  // namespace palpate
