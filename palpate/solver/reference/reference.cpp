#include "palpate/solver/reference/reference.h"

#include "palpate/solver/check.h"
#include "palpate/solver/pass.h"
#include "palpate/solver/schedule.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

// What all nodes look at while a pass runs.
struct World {
    const Body& body;
    Pass pass;  // what stays the same for all calls
    Table springs;
    std::vector<vec3> corners;                 // of polygons
    std::vector<const DistanceField*> fields;  // of closed meshes
    std::vector<int> dragged;                  // the node of each drag
};

template <class Real>
struct Moving {
    std::vector<glm::vec<3, Real>> positions, velocities;
};

// A node with its backend's eyes: how it sees its neighbours. The physics is node.inl's.
template <class Number>
struct ReferenceNode {
    using Real = Number;
    using Real3 = glm::vec<3, Real>;

    const World& world;
    const Pass& pass;
    const Moving<Real>& now;
    int id;
    const Tie* ties;  // this node's springs
    Real outside_area, outside_cover;

    Real3 toward(Real3 p, int l) const { return now.positions[std::size_t(ties[l].to)] - p; }
    Real3 passing(Real3 v, int l) const { return now.velocities[std::size_t(ties[l].to)] - v; }
    Real neighbour(int l) const { return ties[l].to != id ? Real(1) : Real(0); }
    Real share(int l) const { return ties[l].share; }
    Real stiffness(int l) const { return ties[l].stiffness; }
    Real tension(int l) const { return ties[l].stiffness * ties[l].rest; }
    Real longest(int l) const { return torn_at(ties[l].rest, world.body); }
    Real3 origin() const { return Real3(0); }
    Real area() const { return outside_area; }
    Real cover() const { return outside_cover; }
    Real held(int i) const { return world.dragged[std::size_t(i)] == id ? Real(1) : Real(0); }
    Real3 corner(int i) const { return Real3(world.corners[std::size_t(i)]); }
    Real distance_at(int i, Real3 p) const { return world.fields[std::size_t(i)]->at(vec3(p)); }
    Real3 uphill_at(int i, Real3 p) const { return Real3(world.fields[std::size_t(i)]->uphill(vec3(p))); }

    static Real max(Real a, Real b) { return a > b ? a : b; }
    static Real min(Real a, Real b) { return a < b ? a : b; }
    static Real inversesqrt(Real a) { return 1 / std::sqrt(a); }
    static bool any_node(bool c) { return c; }
    static Real select(bool c, Real a, Real b) { return c ? a : b; }
    static Real3 select(bool c, Real3 a, Real3 b) { return c ? a : b; }

#define FN [[gnu::always_inline]]  // GCC leaves the longer ones out, which costs half the speed
#define ASIDE
#define UNROLL
#define LINKS pass.links
#include "palpate/solver/node.inl"
#include "palpate/solver/obstacles.inl"
#undef LINKS
#undef UNROLL
#undef ASIDE
#undef FN
};

template <class Real>
class Reference final : public Solver {
    using At = ReferenceNode<Real>;
    using Node = typename At::Node;
    using Real3 = typename At::Real3;

 public:
    Reference(const Body& body, const Simulation& simulation, double frequency)
        : body_(body),
          simulation_(simulation),
          scheme_(scheme(simulation.integrator)),
          frequency_(frequency),
          world_{body_,
                 make_pass(body, simulation_),
                 table(body),
                 polygon_corners(simulation_),
                 distance_fields(simulation_),
                 {}} {
        // Where there is no spring its end is the node itself, and it pulls at nothing.
        for (std::size_t t = 0; t < world_.springs.ties.size(); ++t)
            if (int& to = world_.springs.ties[t].to; to < 0) to = int(t) / world_.springs.width;
        Moving<Real>& begin = states_[current];
        for (vec3 p : body.positions) begin.positions.push_back(Real3(p));
        begin.velocities.assign(body.count(), Real3(0));
        for (Where where : {between, further, sum})
            if (needs(scheme_, where)) states_[where] = begin;
        publish();
    }

    Stats step(double seconds, const Influences& influences) override {
        check(seconds, influences, body_, simulation_);
        Stats stats = about_to_do(influences, seconds, longest_.under(influences));
        before_ = save();
        knows_before_ = true;
        world_.dragged.clear();
        for (const Drag& drag : influences.drags) world_.dragged.push_back(drag.node);
        world_.pass.wind = vec4(influences.wind, simulation_.air);
        send_off(influences.moves, seconds);
        const Call call{scheme_, simulation_, influences, body_.damping, stats.step, stats.steps, lag_};
        call.for_each_pass(world_.pass, [&](const Pass& pass, const Turn& turn) {
            count_impulses(pass, turn, stats);
            pass_over_nodes(pass, turn, stats);
            if (pass.last && turn.next != current) std::swap(states_[current], states_[turn.next]);
        });
        lag_ = call.lag_after();
        if (torn()) {
            undo();
            return undone(stats);
        }
        arrive(influences.moves);
        publish();
        return stats;
    }

    double frequency() const override { return frequency_; }

    double longest_step(const Influences& influences) const override { return longest_.under(influences); }

    void undo() override {
        if (!knows_before_) refuse_undo(body_);
        restore(before_);
    }

    Nodes nodes() const override { return {positions_, normals_}; }

    State state() const override {
        State state = save();
        state.lag = 0;
        for (std::size_t i = 0; i < body_.count(); ++i) state.velocities[i] = dvec3(velocity_now(i));
        return state;
    }

    State save() const override {
        State state;
        for (Real3 p : states_[current].positions) state.positions.push_back(dvec3(p));
        for (Real3 v : states_[current].velocities) state.velocities.push_back(dvec3(v));
        state.lag = lag_;
        return state;
    }

    void restore(const State& state) override {
        check(state, body_);
        knows_before_ = false;
        for (std::size_t i = 0; i < body_.count(); ++i) {
            states_[current].positions[i] = Real3(state.positions[i]);
            states_[current].velocities[i] = Real3(state.velocities[i]);
        }
        lag_ = state.lag;
        if (lag_ > 0 && !scheme_.staggered) {  // a staggered scheme's state: this one wants velocities of now
            std::vector<Real3>& velocities = states_[between].velocities;
            for (std::size_t i = 0; i < body_.count(); ++i) velocities[i] = velocity_now(i);
            std::swap(states_[current].velocities, velocities);
            lag_ = 0;
        }
        publish();
    }

    std::size_t memory() const override {
        std::size_t bytes = world_.springs.ties.size() * sizeof(Tie);
        for (const Moving<Real>& state : states_) bytes += 2 * state.positions.size() * sizeof(Real3);
        return bytes;
    }

 private:
    // The velocity at the time of the positions: half a kick brings up what lies `lag` behind.
    Real3 velocity_now(std::size_t i) const {
        const Node node = load(states_[current], i);
        if (!(lag_ > 0 && node.inverse_mass > 0)) return node.velocity;
        const double kick = lag_ / (1 + body_.damping * lag_);
        return node.velocity + Real(kick) * see(i, states_[current], quiet_).acceleration(node);
    }

    void pass_over_nodes(const Pass& pass, const Turn& turn, Stats& stats) {
        const Moving<Real>&start = states_[turn.start], &at = states_[turn.at];
        Moving<Real>&next = states_[turn.next], &total = states_[sum];
        for (std::size_t i = 0; i < body_.count(); ++i) {
            At eyes = see(i, at, pass);
            const Node node = load(at, i);
            const Real3 change = pass.kick > 0 ? eyes.acceleration(node) : Real3(0);
            if (pass.part > 0) put(eyes.collect(load(turn.opens ? at : total, i), node, change), total, i);
            const Real3 was = states_[current].positions[i];
            const Node moved = eyes.collide(eyes.integrate(load(start, i), node, change), was);
            put(moved, next, i);
            if (!turn.ends) continue;
            stats.largest_speed = std::max(stats.largest_speed, double(glm::length(moved.velocity)));
            stats.largest_move = std::max(stats.largest_move, double(glm::distance(moved.position, was)));
        }
    }

    // N s, that tips and drags give to the nodes in this pass, and get back.
    void count_impulses(const Pass& pass, const Turn& turn, Stats& stats) const {
        if (!(turn.impulse > 0)) return;  // a stage that only drifts
        const Moving<Real>& at = states_[turn.at];
        for (std::size_t t = 0; t < stats.reactions.size(); ++t)
            for (std::size_t i = 0; i < body_.count(); ++i)
                stats.reactions[t] -=
                    turn.impulse * dvec3(see(i, at, pass).tip_force(at.positions[i], int(t)));
        for (std::size_t d = 0; d < stats.pulls.size(); ++d) {
            const std::size_t i = std::size_t(world_.dragged[d]);
            stats.pulls[d] -= turn.impulse * dvec3(see(i, at, pass).drag_force(at.positions[i], int(d)));
        }
    }

    // Gives the nodes of prescribed motion the velocities that bring them where they shall be.
    void send_off(std::span<const Move> moves, double seconds) {
        for (std::size_t i = 0; i < body_.count(); ++i)
            if (!(body_.inverse_mass[i] > 0)) states_[current].velocities[i] = Real3(0);
        for (const Move& move : moves)
            for (std::size_t k = 0; k < move.nodes.size(); ++k) {
                const std::size_t i = std::size_t(move.nodes[k]);
                if (body_.inverse_mass[i] > 0) continue;
                states_[current].velocities[i] =
                    (Real3(move.to[k]) - states_[current].positions[i]) / Real(seconds);
            }
    }

    // Takes the rounding of many steps away.
    void arrive(std::span<const Move> moves) {
        for (const Move& move : moves)
            for (std::size_t k = 0; k < move.nodes.size(); ++k)
                if (!(body_.inverse_mass[std::size_t(move.nodes[k])] > 0))
                    states_[current].positions[std::size_t(move.nodes[k])] = Real3(move.to[k]);
    }

    At see(std::size_t i, const Moving<Real>& at, const Pass& pass) const {
        return {world_,
                pass,
                at,
                int(i),
                world_.springs.ties.data() + i * std::size_t(world_.springs.width),
                Real(body_.area[i]),
                Real(body_.cover[i])};
    }
    Node load(const Moving<Real>& from, std::size_t i) const {
        return {from.positions[i], from.velocities[i], Real(body_.inverse_mass[i])};
    }
    static void put(const Node& node, Moving<Real>& into, std::size_t i) {
        into.positions[i] = node.position;
        into.velocities[i] = node.velocity;
    }

    bool torn() const {
        const Moving<Real>& at = states_[current];
        for (std::size_t i = 0; i < body_.count(); ++i)
            if (see(i, at, quiet_).torn(at.positions[i]) > 0) return true;
        return false;
    }

    void publish() {
        positions_.clear();
        for (Real3 p : states_[current].positions) positions_.push_back(vec3(p));
        normals_.clear();
        for (std::size_t i = 0; i < body_.count(); ++i)
            normals_.push_back(vec3(see(i, states_[current], quiet_).outward(states_[current].positions[i])));
    }

    const Body body_;
    const Simulation simulation_;
    const Scheme& scheme_;
    double frequency_;  // rad/s, the highest of the body with nothing touching it
    mutable LongestStep longest_{body_, simulation_, frequency_};
    World world_;
    const Pass quiet_ = world_.pass;         // nothing touches or moves it
    double lag_ = 0;                         // s, how far the velocities are behind the positions
    Moving<Real> states_[4];                 // Where
    State before_;                           // the last call
    bool knows_before_ = false;              // whether that can be put back
    std::vector<vec3> positions_, normals_;  // what nodes() shows
};

}  // namespace

template <class Real>
std::unique_ptr<Solver> make_reference(const Body& body, const Simulation& simulation, double frequency) {
    check(body, simulation);
    return std::make_unique<Reference<Real>>(body, simulation, frequency);
}

template std::unique_ptr<Solver> make_reference<float>(const Body&, const Simulation&, double);
template std::unique_ptr<Solver> make_reference<double>(const Body&, const Simulation&, double);

}  // namespace palpate
