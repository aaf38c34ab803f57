#include "palpate/solver/cpu/cpu.h"

#include "palpate/base/team.h"
#include "palpate/solver/check.h"
#include "palpate/solver/cpu/laid_body.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace palpate {
namespace {

using namespace cpu;

class Cpu final : public Solver {
 public:
    Cpu(const Body& body, const Simulation& simulation, double frequency)
        : body_(body),
          simulation_(simulation),
          scheme_(scheme(simulation.integrator)),
          frequency_(frequency),
          laid_(body_, simulation_, kernels_.lanes),
          quiet_(make_pass(body, simulation)),
          team_(simulation.threads) {
        for (Where where : {current, between, further, sum})
            if (needs(scheme_, where)) states_[where] = fields(where == between && velocities_stay());
        before_ = fields(false);
        for (std::size_t i = 0; i < body_.count(); ++i)
            if (!(body_.inverse_mass[i] > 0)) pinned_.push_back(int(i));
        share_out();
    }

    Stats step(double seconds, const Influences& influences) override {
        check(seconds, influences, body_, simulation_);
        Stats stats = about_to_do(influences, seconds, longest_.under(influences));
        copy(states_[current], before_);
        knows_before_ = true;
        send_off(influences.moves, seconds);
        const Call call{scheme_, simulation_, influences, body_.damping, stats.step, stats.steps, lag_};
        lag_before_ = std::exchange(lag_, call.lag_after());
        const bool torn = go(call, stats);
        if (scheme_.stages.size() == 1 && stats.steps % 2 == 1) std::swap(states_[current], states_[between]);
        published_ = false;
        if (torn) {
            undo();
            return undone(stats);
        }
        arrive(influences.moves);
        return stats;
    }

    void undo() override {
        if (!knows_before_) refuse_undo(body_);
        knows_before_ = false;
        copy(before_, states_[current]);
        lag_ = lag_before_;
        published_ = false;
    }

    double frequency() const override { return frequency_; }

    double longest_step(const Influences& influences) const override { return longest_.under(influences); }

    Nodes nodes() const override {
        if (!published_) publish();
        return {positions_, normals_};
    }

    State state() const override {
        State state = save();
        if (lag_ > 0) {
            state.lag = 0;
            velocities_now([&](std::size_t i, dvec3 v) { state.velocities[i] = v; });
        }
        return state;
    }

    State save() const override {
        State state;
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const int s = laid_.layout().slot[i];
            const Fields& f = states_[current];
            state.positions.push_back(dvec3(body_.positions[i]) + dvec3(f.x[s], f.y[s], f.z[s]));
            state.velocities.push_back(dvec3(f.vx[s], f.vy[s], f.vz[s]));
        }
        state.lag = lag_;
        return state;
    }

    void restore(const State& state) override {
        check(state, body_);
        knows_before_ = false;
        for (std::size_t i = 0; i < body_.count(); ++i) {
            place(i, state.positions[i]);
            set_velocity(i, state.velocities[i]);
        }
        lag_ = state.lag;
        if (lag_ > 0 && !scheme_.staggered) {  // a staggered scheme's state: this one wants velocities of now
            velocities_now([&](std::size_t i, dvec3 v) { set_velocity(i, v); });
            lag_ = 0;
        }
        published_ = false;
    }

    std::size_t memory() const override {
        std::size_t bytes = laid_.bytes();
        for (const Array<float>& array : arrays_) bytes += array.bytes();
        return bytes;
    }

 private:
    // With one pass a step a node's velocity can be written where it was read, unless its neighbours look at
    // it.
    bool velocities_stay() const { return scheme_.stages.size() == 1 && !(body_.link_damping > 0); }

    template <class Do>
    static void for_each_field(Do act) {
        for (auto f : {&Fields::x, &Fields::y, &Fields::z, &Fields::vx, &Fields::vy, &Fields::vz}) act(f);
    }

    Fields fields(bool with_velocities_of_now) {
        Fields made = states_[current];
        int number = 0;
        for_each_field([&](float* Fields::*f) {
            if (with_velocities_of_now && number++ >= 3) return;
            arrays_.push_back(laid_.array());
            made.*f = arrays_.back().data();
        });
        return made;
    }

    // The blocks of each member of the team: those from parts_[member] on.
    void share_out() {
        const std::size_t blocks = laid_.layout().blocks.size();
        for (int member = 0; member <= team_.members(); ++member)
            parts_.push_back(int(blocks * std::size_t(member) / std::size_t(team_.members())));
        for (std::vector<Bounds>& bounds : moved_) bounds.resize(blocks);
    }
    int all_blocks() const { return int(laid_.layout().blocks.size()); }
    void copy(const Fields& from, const Fields& to) const {
        const std::size_t bytes = std::size_t(laid_.layout().slots) * sizeof(float);
        for_each_field([&](float* Fields::*f) { std::memcpy(to.*f, from.*f, bytes); });
    }

    // All passes of a call. True if the body is torn then; what it was before is in before_.
    bool go(const Call& call, Stats& stats) {
        Pass constant = quiet_;
        constant.wind = vec4(call.influences.wind, simulation_.air);
        std::array<int, 8> dragged{};
        for (std::size_t d = 0; d < call.influences.drags.size(); ++d)
            dragged[d] = laid_.layout().slot[std::size_t(call.influences.drags[d].node)];
        const bool touched = !call.influences.presses.empty() || !call.influences.drags.empty();
        if (touched) given_.assign(laid_.layout().blocks.size(), {});
        std::vector<Largest> largest(std::size_t(team_.members()));
        std::atomic<bool> torn = false;

        team_.run([&](int member) {
            const int first = parts_[std::size_t(member)], end = parts_[std::size_t(member) + 1];
            Fields states[4];
            std::copy(std::begin(states_), std::end(states_), states);
            std::array<Bounds*, 4> moved;
            for (std::size_t where = 0; where < 4; ++where) moved[where] = moved_[where].data();
            if (touched)
                kernels_.find_bounds({laid_.view(), constant, at_now, states, moved, dragged}, first, end);
            call.for_each_pass(constant, [&](const Pass& pass, const Turn& turn) {
                const Sweep sweep{laid_.view(), pass, turn, states, moved, dragged};
                if (touched && turn.impulse > 0) kernels_.give(sweep, first, end, given_.data());
                kernels_.pass(sweep, first, end, largest[std::size_t(member)]);
                team_.meet();
                if (pass.last && turn.next != current) {
                    std::swap(states[current], states[turn.next]);
                    std::swap(moved[current], moved[turn.next]);
                }
            });
            const Sweep last{laid_.view(), quiet_, at_now, states, moved, dragged};
            if (kernels_.torn(last, first, end)) torn = true;
        });
        for (const Largest& of_member : largest) {
            stats.largest_speed = std::max(stats.largest_speed, std::sqrt(double(of_member.speed)));
            stats.largest_move = std::max(stats.largest_move, std::sqrt(double(of_member.move)));
        }
        if (touched) add_up(stats);
        return torn;
    }

    // Block after block, so that the sums do not depend on who did which.
    void add_up(Stats& stats) const {
        for (const Given& given : given_) {
            for (std::size_t t = 0; t < stats.reactions.size(); ++t) stats.reactions[t] -= given.by_tip[t];
            for (std::size_t d = 0; d < stats.pulls.size(); ++d) stats.pulls[d] -= given.by_drag[d];
        }
    }

    // Calls set(node, velocity) with the velocities at the time of the positions: half a kick brings them up.
    template <class Set>
    void velocities_now(Set set) const {
        Pass pass = quiet_;
        pass.kick = float(lag_ / (1 + body_.damping * lag_));
        std::vector<Array<float>> arrays;
        Fields brought_up;
        for_each_field([&](float* Fields::*f) {
            arrays.emplace_back(laid_.layout(), int(arrays.size()));
            brought_up.*f = arrays.back().data();
        });
        const Fields states[] = {states_[current], brought_up, {}, {}};
        Largest none;
        kernels_.pass({laid_.view(), pass, at_now, states, {}, {}}, 0, all_blocks(), none);
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const int s = laid_.layout().slot[i];
            set(i, dvec3(brought_up.vx[s], brought_up.vy[s], brought_up.vz[s]));
        }
    }

    // Gives the nodes of prescribed motion the velocities that bring them where they shall be.
    void send_off(std::span<const Move> moves, double seconds) {
        for (int i : pinned_) set_velocity(std::size_t(i), dvec3(0));
        for_each_moved(moves, [&](std::size_t i, dvec3 to) {
            const int s = laid_.layout().slot[i];
            const Fields& f = states_[current];
            const dvec3 from = dvec3(body_.positions[i]) + dvec3(f.x[s], f.y[s], f.z[s]);
            set_velocity(i, (to - from) / seconds);
        });
    }
    // Takes the rounding of many steps away.
    void arrive(std::span<const Move> moves) {
        for_each_moved(moves, [&](std::size_t i, dvec3 to) { place(i, to); });
    }
    template <class Do>
    void for_each_moved(std::span<const Move> moves, Do act) const {
        for (const Move& move : moves)
            for (std::size_t k = 0; k < move.nodes.size(); ++k)
                if (const auto i = std::size_t(move.nodes[k]); !(body_.inverse_mass[i] > 0))
                    act(i, dvec3(move.to[k]));
    }

    void place(std::size_t i, dvec3 p) {
        const double finest = laid_.view().finest,
                     large = 4194304 * finest;  // as the kernel does at the end of a call
        dvec3 way = p - dvec3(body_.positions[i]);
        for (int k = 0; k < 3; ++k)
            if (std::abs(way[k]) < large) way[k] = finest * std::round(way[k] / finest);
        const int s = laid_.layout().slot[i];
        const Fields& f = states_[current];
        f.x[s] = float(way.x), f.y[s] = float(way.y), f.z[s] = float(way.z);
    }
    void set_velocity(std::size_t i, dvec3 v) {
        const int s = laid_.layout().slot[i];
        const Fields& f = states_[current];
        f.vx[s] = float(v.x), f.vy[s] = float(v.y), f.vz[s] = float(v.z);
    }

    void publish() const {
        const Fields &at = states_[current], &free = states_[between];  // between calls nobody needs it
        kernels_.normals({laid_.view(), quiet_, at_now, states_, {}, {}}, 0, all_blocks(), free.x, free.y,
                         free.z);
        positions_.resize(body_.count());
        normals_.resize(body_.count());
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const int s = laid_.layout().slot[i];
            positions_[i] = body_.positions[i] + vec3(at.x[s], at.y[s], at.z[s]);
            normals_[i] = vec3(free.x[s], free.y[s], free.z[s]);
        }
        published_ = true;
    }

    static constexpr Turn at_now{current, current, between, true, false, 0};

    const Body body_;
    const Simulation simulation_;
    const Scheme& scheme_;
    const double frequency_;  // rad/s, the highest of the body with nothing touching it
    mutable LongestStep longest_{body_, simulation_, frequency_};
    const Kernels kernels_ = kernels();
    LaidBody laid_;
    const Pass quiet_;  // nothing touches or moves it
    Team team_;
    std::vector<Array<float>> arrays_;  // what the states are made of
    Fields states_[4] = {};             // Where
    Fields before_ = {};                // as it was before the call
    double lag_ = 0;                    // s, how far the velocities are behind the positions
    double lag_before_ = 0;             // the same before the call
    bool knows_before_ = false;         // whether that can be put back
    std::vector<int> pinned_;           // nodes of infinite mass
    std::vector<int> parts_;            // of the blocks, by members
    std::vector<Bounds> moved_[4];      // of each state and block
    std::vector<Given> given_;
    mutable std::vector<vec3> positions_, normals_;  // what nodes() shows
    mutable bool published_ = false;
};

}  // namespace

std::unique_ptr<Solver> make_cpu(const Body& body, const Simulation& simulation, double frequency) {
    check(body, simulation);
    return std::make_unique<Cpu>(body, simulation, frequency);
}

std::string_view cpu_instructions() { return kernels().instructions; }

}  // namespace palpate
