#include "palpate/solver/reference/reference.h"

#include "palpate/solver/pass.h"
#include "palpate/solver/scheme.h"
#include "palpate/solver/stability.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpate {
namespace {

// What all nodes look at while a pass runs.
struct World {
    Pass pass;
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
    using Real4 = glm::vec<4, Real>;

    const World& world;
    const Pass& pass;
    const Moving<Real>& now;
    int id;
    const Tie* ties;  // this node's springs
    Real outside_area, outside_cover;

    Real3 toward(Real3 p, int l) const { return now.positions[std::size_t(ties[l].to)] - p; }
    Real3 passing(Real3 v, int l) const { return now.velocities[std::size_t(ties[l].to)] - v; }
    Real share(int l) const { return ties[l].share; }
    Real stiffness(int l) const { return ties[l].stiffness; }
    Real tension(int l) const { return ties[l].stiffness * ties[l].rest; }
    Real area() const { return outside_area; }
    Real cover() const { return outside_cover; }
    Real held(int i) const { return world.dragged[std::size_t(i)] == id ? Real(1) : Real(0); }
    Real3 corner(int i) const { return Real3(world.corners[std::size_t(i)]); }
    Real4 distance_at(int i, Real3 p) const {
        const DistanceField& field = *world.fields[std::size_t(i)];
        const float h = 0.5f * field.spacing;
        auto at = [&](float x, float y, float z) { return field.at(vec3(p) + vec3(x, y, z)); };
        return {at(h, 0, 0) - at(-h, 0, 0), at(0, h, 0) - at(0, -h, 0), at(0, 0, h) - at(0, 0, -h),
                at(0, 0, 0)};
    }

    static Real max(Real a, Real b) { return a > b ? a : b; }
    static Real min(Real a, Real b) { return a < b ? a : b; }
    static Real inversesqrt(Real a) { return 1 / std::sqrt(a); }
    static bool any_node(bool c) { return c; }
    static Real select(bool c, Real a, Real b) { return c ? a : b; }
    static Real3 select(bool c, Real3 a, Real3 b) { return c ? a : b; }

#define FN [[gnu::always_inline]]  // GCC leaves the longer ones out, which costs half the speed
#define UNROLL
#define LINKS pass.links
#include "palpate/solver/node.inl"
#include "palpate/solver/obstacles.inl"
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
        : body_(body),
          simulation_(simulation),
          scheme_(scheme(simulation.integrator)),
          frequency_(frequency) {
        world_ = {make_pass(body, simulation_),
                  table(body),
                  polygon_corners(simulation_),
                  distance_fields(simulation_),
                  {}};
        // Where there is no spring its end is the node itself, and it pulls at nothing.
        for (std::size_t t = 0; t < world_.springs.ties.size(); ++t)
            if (int& to = world_.springs.ties[t].to; to < 0) to = int(t) / world_.springs.width;
        for (vec3 p : body.positions) now_.positions.push_back(Real3(p));
        now_.velocities.assign(body.count(), Real3(0));
        first_ = second_ = sum_ = now_;
        publish();
    }

    Stats step(double seconds, const Influences& influences) override {
        assert(seconds > 0 && names_nodes(influences));
        Stats stats;
        stats.reactions.assign(influences.presses.size(), dvec3(0));
        stats.pulls.assign(influences.drags.size(), dvec3(0));
        stats.steps = steps_within(seconds, longest_step(influences));
        stats.step = seconds / stats.steps;
        const State before = save();
        world_.dragged.clear();
        for (const Drag& drag : influences.drags) world_.dragged.push_back(drag.node);
        world_.pass.wind = vec4(influences.wind, simulation_.air);
        send_off(influences.moves, seconds);
        for (int i = 0; i < stats.steps; ++i) one_step(i * stats.step, stats, influences);
        if (torn()) {
            restore(before);
            stats.diverged = true;
            std::fill(stats.reactions.begin(), stats.reactions.end(), dvec3(0));
            std::fill(stats.pulls.begin(), stats.pulls.end(), dvec3(0));
            return stats;
        }
        arrive(influences.moves);
        for (std::size_t i = 0; i < body_.count(); ++i) {
            stats.largest_speed = std::max(stats.largest_speed, double(glm::length(now_.velocities[i])));
            // After a step, first_ holds where it began.
            const Real way = glm::distance(now_.positions[i], first_.positions[i]);
            stats.largest_move = std::max(stats.largest_move, double(way));
        }
        publish();
        return stats;
    }

    double longest_step(const Influences& influences) const override {
        if (simulation_.step > 0) return simulation_.step;
        float contact = 0, pull = 0;  // they may all meet at one node
        for (const Press& press : influences.presses) contact += pressure_per_metre(press);
        for (const Drag& drag : influences.drags) pull += drag.stiffness;
        const double frequency = touched_frequency(body_, frequency_, std::max(contact, simulation_.contact),
                                                   std::max(pull, simulation_.pull));
        return automatic_step(simulation_.integrator, frequency, body_.damping, body_.link_damping);
    }

    Nodes nodes() const override { return {positions_, normals_}; }

    State state() const override {
        State state = save();
        state.lag = 0;
        const Pass pass = untouched();
        for (std::size_t i = 0; i < body_.count(); ++i) state.velocities[i] = dvec3(velocity_now(i, pass));
        return state;
    }

    State save() const override {
        State state;
        for (Real3 p : now_.positions) state.positions.push_back(dvec3(p));
        for (Real3 v : now_.velocities) state.velocities.push_back(dvec3(v));
        state.lag = lag_;
        return state;
    }

    void restore(const State& state) override {
        assert(state.positions.size() == body_.count() && state.velocities.size() == body_.count());
        for (std::size_t i = 0; i < body_.count(); ++i) {
            now_.positions[i] = Real3(state.positions[i]);
            now_.velocities[i] = Real3(state.velocities[i]);
        }
        lag_ = state.lag;
        if (lag_ > 0 && !scheme_.staggered) {  // a staggered scheme's state: this one wants velocities of now
            const Pass pass = untouched();
            for (std::size_t i = 0; i < body_.count(); ++i) first_.velocities[i] = velocity_now(i, pass);
            std::swap(now_.velocities, first_.velocities);
            lag_ = 0;
        }
        publish();
    }

 private:
    bool names_nodes(const Influences& influences) const {
        auto known = [&](int node) { return node >= 0 && std::size_t(node) < body_.count(); };
        for (const Drag& drag : influences.drags)
            if (!known(drag.node)) return false;
        for (const Move& move : influences.moves)
            if (move.nodes.size() != move.to.size() ||
                !std::all_of(move.nodes.begin(), move.nodes.end(), known))
                return false;
        return true;
    }

    // The pass with tips, drags and wind gone.
    Pass untouched() const {
        Pass pass = world_.pass;
        pass.tips = pass.drags = 0;
        pass.wind.w = 0;
        return pass;
    }

    // The velocity at the time of the positions: half a kick brings up what lies `lag` behind.
    Real3 velocity_now(std::size_t i, const Pass& pass) const {
        const Node node = load(now_, i);
        if (!(lag_ > 0 && node.inverse_mass > 0)) return node.velocity;
        const double kick = lag_ / (1 + body_.damping * lag_);
        return node.velocity + Real(kick) * see(i, now_, pass).acceleration(node);
    }

    // One step, stage after stage: the neighbours move too. It ends in now_, and first_ holds where it began.
    void one_step(double time, Stats& stats, const Influences& influences) {
        Pass& pass = world_.pass;
        const double step = stats.step;
        double reached = 0;  // by the last stage, in steps
        if (scheme_.stages[0].part > 0) sum_ = now_;
        const Moving<Real>* at = &now_;
        for (const Stage& stage : scheme_.stages) {
            const bool last = &stage == &scheme_.stages.back();
            pass.kick = float(scheme_.kick(stage, step, lag_, body_.damping));
            pass.drift = float(stage.drift * step);
            pass.lead = float(stage.lead);
            pass.part = float(stage.part * step);
            place_tools(pass, influences, time + reached * step);
            count_impulses(*at, last ? scheme_.reach(stage, step, lag_) : stage.part * step, stats);
            reached = last ? 1 : stage.drift;
            pass.last = last;
            pass.duration = float(reached * step);
            place_obstacles(pass, simulation_, influences, time + reached * step);
            Moving<Real>& next = at == &first_ ? second_ : first_;
            pass_over_nodes(stage.from_sum ? sum_ : now_, *at, next);
            at = &next;
        }
        if (at == &second_) std::swap(first_, second_);
        std::swap(now_, first_);
        lag_ = scheme_.staggered ? step / 2 : 0;
    }

    void pass_over_nodes(const Moving<Real>& start, const Moving<Real>& at, Moving<Real>& next) {
        const Pass& pass = world_.pass;
        for (std::size_t i = 0; i < body_.count(); ++i) {
            At eyes = see(i, at, pass);
            const Node node = load(at, i);
            const Real3 change = pass.kick > 0 ? eyes.acceleration(node) : Real3(0);
            if (pass.part > 0) {
                const Node sum = eyes.collect(load(sum_, i), node, change);
                sum_.positions[i] = sum.position;
                sum_.velocities[i] = sum.velocity;
            }
            const Node moved = eyes.collide(eyes.integrate(load(start, i), node, change), now_.positions[i]);
            next.positions[i] = moved.position;
            next.velocities[i] = moved.velocity;
        }
    }

    // N s, that tips and drags give to the nodes in this pass, and get back.
    void count_impulses(const Moving<Real>& at, double seconds, Stats& stats) const {
        const Pass& pass = world_.pass;
        if (!(seconds > 0)) return;  // a stage that only drifts
        for (std::size_t t = 0; t < stats.reactions.size(); ++t)
            for (std::size_t i = 0; i < body_.count(); ++i)
                stats.reactions[t] -= seconds * dvec3(see(i, at, pass).tip_force(at.positions[i], int(t)));
        for (std::size_t d = 0; d < stats.pulls.size(); ++d) {
            const std::size_t i = std::size_t(world_.dragged[d]);
            stats.pulls[d] -= seconds * dvec3(see(i, at, pass).drag_force(at.positions[i], int(d)));
        }
    }

    // Gives the nodes of prescribed motion the velocities that bring them where they shall be.
    void send_off(std::span<const Move> moves, double seconds) {
        for (std::size_t i = 0; i < body_.count(); ++i)
            if (!(body_.inverse_mass[i] > 0)) now_.velocities[i] = Real3(0);
        for (const Move& move : moves)
            for (std::size_t k = 0; k < move.nodes.size(); ++k) {
                const std::size_t i = std::size_t(move.nodes[k]);
                if (body_.inverse_mass[i] > 0) continue;
                now_.velocities[i] = (Real3(move.to[k]) - now_.positions[i]) / Real(seconds);
            }
    }

    // Takes the rounding of many steps away.
    void arrive(std::span<const Move> moves) {
        for (const Move& move : moves)
            for (std::size_t k = 0; k < move.nodes.size(); ++k)
                if (!(body_.inverse_mass[std::size_t(move.nodes[k])] > 0))
                    now_.positions[std::size_t(move.nodes[k])] = Real3(move.to[k]);
    }

    At see(std::size_t i, const Moving<Real>& now, const Pass& pass) const {
        return {world_,
                pass,
                now,
                int(i),
                world_.springs.ties.data() + i * std::size_t(world_.springs.width),
                Real(body_.area[i]),
                Real(body_.cover[i])};
    }
    Node load(const Moving<Real>& from, std::size_t i) const {
        return {from.positions[i], from.velocities[i], Real(body_.inverse_mass[i])};
    }

    // True if a spring is stretched to ten times its length, or a position is not a number: no tissue does
    // that, a motion that blows up soon does.
    bool torn() const {
        for (std::size_t i = 0; i < body_.count(); ++i) {
            if (!std::isfinite(glm::dot(now_.positions[i], now_.positions[i]))) return true;
            for (const Tie& tie : world_.springs.of(i)) {
                if (!(tie.share * tie.stiffness > 0)) continue;
                const Real3 along = now_.positions[std::size_t(tie.to)] - now_.positions[i];
                const Real longest = 10 * Real(std::max(tie.rest, body_.spacing));
                if (!(glm::dot(along, along) <= longest * longest)) return true;
            }
        }
        return false;
    }

    void publish() {
        positions_.clear();
        for (Real3 p : now_.positions) positions_.push_back(vec3(p));
        normals_.clear();
        for (std::size_t i = 0; i < body_.count(); ++i)
            normals_.push_back(vec3(see(i, now_, world_.pass).springs(now_.positions[i]).outward));
    }

    const Body body_;
    const Simulation simulation_;
    const Scheme& scheme_;
    double frequency_;  // rad/s, the highest of the body with nothing touching it
    World world_;
    double lag_ = 0;                           // s, how far the velocities are behind the positions
    Moving<Real> now_, first_, second_, sum_;  // the state; those between stages, by turns; the sum over them
    std::vector<vec3> positions_, normals_;    // what nodes() shows
};

}  // namespace

template <class Real>
std::unique_ptr<Solver> make_reference(const Body& body, const Simulation& simulation, double frequency) {
    return std::make_unique<Reference<Real>>(body, simulation, frequency);
}

template std::unique_ptr<Solver> make_reference<float>(const Body&, const Simulation&, double);
template std::unique_ptr<Solver> make_reference<double>(const Body&, const Simulation&, double);

}  // namespace palpate
