#include "palpate/base/team.h"
#include "palpate/solver/cpu/body_memory.h"
#include "palpate/solver/machine.h"
#include "palpate/solver/pushes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace palpate {
namespace {

using namespace cpu;

class Cpu final : public Machine {
 public:
    Cpu(const Body& body, const Simulation& simulation, Team* team)
        : body_(body),
          scheme_(scheme(simulation.integrator)),
          memory_(body, simulation, kernels_.lanes),
          quiet_(make_pass(body, simulation)),
          own_team_(team ? nullptr : std::make_unique<Team>(simulation.threads)),
          team_(team ? *team : *own_team_) {
        for (StateBuffer where : {current, between, further, sum})
            if (needs(scheme_, where)) states_[where] = fields(where == between && velocities_stay());
        before_ = fields(false);
        for (StateBuffer where : {current, between, further})
            if (states_[where].x) memory_.add_neighbour_arrays(states_[where]);
        share_out();
        make_room_for_cells();
    }

    bool change(std::span<const int> nodes) override { return memory_.change(body_, nodes); }

    Findings run(const Call& call) override {
        for (const Guide& guide : call.guides) set_velocity(std::size_t(guide.node), guide.velocity);
        Findings found = go(call);
        if (scheme_.stages.size() == 1 && call.steps % 2 == 1) std::swap(states_[current], states_[between]);
        for (const Guide& guide : call.guides)
            if (guide.is_led) place(std::size_t(guide.node), guide.to);
        if (body_.count() > 0) found.first_node = place_of(0), found.first_velocity = velocity_of(0);
        return found;
    }

    void put(const State& state, const Origin&) override {
        for (std::size_t i = 0; i < body_.count(); ++i) {
            place(i, state.positions[i]);
            set_velocity(i, state.velocities[i]);
        }
    }

    State get() const override {
        State state;
        for (std::size_t i = 0; i < body_.count(); ++i) {
            state.positions.push_back(place_of(i));
            state.velocities.push_back(velocity_of(i));
        }
        return state;
    }

    void shift(dvec3 place, dvec3 velocity) override {
        const Fields& f = states_[current];
        for (int s : memory_.layout().slot) {
            f.x[s] = float(f.x[s] - place.x), f.y[s] = float(f.y[s] - place.y),
            f.z[s] = float(f.z[s] - place.z);
            f.vx[s] = float(f.vx[s] - velocity.x), f.vy[s] = float(f.vy[s] - velocity.y);
            f.vz[s] = float(f.vz[s] - velocity.z);
        }
    }

    void remember() override { copy(states_[current], before_); }
    void bring_back(const Origin&) override { copy(before_, states_[current]); }

    std::vector<dvec3> kicked(const Pass& pass) const override {
        std::vector<Array<float>> arrays;
        Fields brought_up{};
        for_each_field([&](float* Fields::*f) {
            arrays.emplace_back(memory_.layout(), int(arrays.size()));
            brought_up.*f = arrays.back().data();
        });
        const Fields states[] = {states_[current], brought_up, {}, {}};
        const Task task{memory_.view(), pass, at_now, states, {}, nullptr, ring_of(0)};
        Largest none;
        kernels_.show(task, 0, all_blocks());
        kernels_.pass(task, 0, all_blocks(), none);
        std::vector<dvec3> velocities;
        for (int s : memory_.layout().slot)
            velocities.emplace_back(brought_up.vx[s], brought_up.vy[s], brought_up.vz[s]);
        return velocities;
    }

    void show(const Origin& origin, std::vector<vec3>& positions, std::vector<vec3>& normals) const override {
        const Fields& free = states_[between];  // unused between calls
        const Task task{memory_.view(), quiet_, at_now, states_, {}};
        kernels_.show(task, 0, all_blocks());
        kernels_.normals(task, 0, all_blocks(), free.x, free.y, free.z);
        positions.resize(body_.count());
        normals.resize(body_.count());
        for (std::size_t i = 0; i < body_.count(); ++i) {
            const int s = memory_.layout().slot[i];
            positions[i] = vec3(origin.place + place_of(i));
            normals[i] = vec3(free.x[s], free.y[s], free.z[s]);
        }
    }

    std::size_t memory() const override {
        std::size_t bytes = memory_.bytes();
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
            arrays_.push_back(memory_.array());
            made.*f = arrays_.back().data();
        });
        return made;
    }

    // The blocks of each member of the team: those from parts_[member] on.
    void share_out() {
        const std::size_t blocks = memory_.layout().blocks.size();
        for (int member = 0; member <= team_.members(); ++member)
            parts_.push_back(int(blocks * std::size_t(member) / std::size_t(team_.members())));
        for (std::vector<Bounds>& bounds : moved_) bounds.resize(blocks);
    }
    // A ring for each member of the team.
    void make_room_for_cells() {
        if (!memory_.view().cells.weights) return;
        const int lanes = kernels_.lanes, needed = memory_.view().cells.reach + Block::most + lanes;
        const int size = (needed + lanes - 1) / lanes * lanes;
        for (int member = 0; member < team_.members(); ++member) {
            arrays_.emplace_back(std::size_t(12 * (size + kernels_.lanes)), member);
            rings_.push_back({arrays_.back().data(), size});
        }
    }
    CellRing ring_of(int member) const { return rings_.empty() ? CellRing{} : rings_[std::size_t(member)]; }
    int all_blocks() const { return int(memory_.layout().blocks.size()); }
    void copy(const Fields& from, const Fields& to) const {
        const std::size_t bytes = std::size_t(memory_.layout().slots) * sizeof(float);
        for_each_field([&](float* Fields::*f) { std::memcpy(to.*f, from.*f, bytes); });
    }

    // All passes of a call.
    Findings go(const Call& call) {
        const Influences& influences = call.influences;
        const bool touched = !influences.presses.empty() || !influences.pushes.empty();
        const std::vector<SlotPush> pushes = in_slots(call.pushes), each = in_slots(influences.pushes);
        std::vector<int> pushed_slots;
        for (const SlotPush& one : pushes) pushed_slots.push_back(one.slot);
        const Pushes pushing = make_pushes(pushed_slots);
        Findings found;
        found.by_pushes.assign(influences.pushes.size(), dvec3(0));
        given_.assign(influences.presses.size() * memory_.layout().blocks.size(), dvec3(0));
        std::vector<Largest> largest(std::size_t(team_.members()));
        std::atomic<bool> torn = false;

        team_.run([&](int member) {
            const int first = parts_[std::size_t(member)], end = parts_[std::size_t(member) + 1];
            Fields states[4];
            std::copy(std::begin(states_), std::end(states_), states);
            std::array<Bounds*, 4> moved;
            for (std::size_t where = 0; where < 4; ++where) moved[where] = moved_[where].data();
            const auto mine = own(pushes, first, end), mine_each = own(each, first, end);
            hold(pushing, mine);
            const Task begin{memory_.view(), call.constant, at_now, states, moved, &pushing};
            if (states[current].places) {
                kernels_.show(begin, first, end);
                team_.meet();
            }
            if (touched || !call.simulation.colliders.empty()) kernels_.find_bounds(begin, first, end);
            call.for_each_pass([&](const Pass& pass, const PassPlan& plan) {
                const Task task{memory_.view(),  pass,         plan, states, moved, &pushing,
                                ring_of(member), given_.data()};
                aim(pushing, mine, pass.time);
                if (plan.impulse > 0) {
                    if (pass.tips > 0) kernels_.give(task, first, end, given_.data());
                    give(mine_each, pass.time, plan.impulse, states[plan.at], found.by_pushes);
                }
                kernels_.pass(task, first, end, largest[std::size_t(member)]);
                team_.meet();
                if (pass.last && plan.next != current) {
                    std::swap(states[current], states[plan.next]);
                    std::swap(moved[current], moved[plan.next]);
                }
            });
            let_go(pushing, mine);
            const Task last{memory_.view(), quiet_, at_now, states, moved};
            if (kernels_.torn(last, first, end)) torn = true;
        });
        for (const Largest& of_member : largest) {
            found.largest_speed = std::max(found.largest_speed, std::sqrt(double(of_member.speed)));
            found.largest_move = std::max(found.largest_move, std::sqrt(double(of_member.move)));
        }
        found.torn = torn;
        // Block after block, so that the sums do not depend on who did which.
        const std::size_t tips = influences.presses.size();
        found.by_presses.assign(tips, dvec3(0));
        for (std::size_t g = 0; g < given_.size(); ++g) found.by_presses[g % tips] += given_[g];
        return found;
    }

    // ---- pushes: a member of the team sees to those of its own nodes, whom alone they concern ----

    struct SlotPush {
        int slot;
        std::size_t number;  // among those that were handed in
        NodePush push;
    };
    std::vector<SlotPush> in_slots(std::span<const NodePush> pushes) const {
        std::vector<SlotPush> all;
        for (std::size_t p = 0; p < pushes.size(); ++p)
            all.push_back({memory_.layout().slot[std::size_t(pushes[p].node)], p, pushes[p]});
        std::ranges::stable_sort(all, {}, &SlotPush::slot);
        return all;
    }
    std::span<const SlotPush> own(const std::vector<SlotPush>& pushes, int first_block, int end_block) const {
        if (first_block == end_block) return {};
        const auto& blocks = memory_.layout().blocks;
        const auto first = std::ranges::lower_bound(pushes, blocks[std::size_t(first_block)].first_slot, {},
                                                    &SlotPush::slot),
                   end = std::ranges::lower_bound(pushes, blocks[std::size_t(end_block) - 1].end_slot, {},
                                                  &SlotPush::slot);
        return {first, end};
    }
    // Memory for them is made when the first come.
    Pushes make_pushes(std::span<const int> slots) {
        while (!slots.empty() && push_arrays_.size() < 7) push_arrays_.push_back(memory_.array());
        if (push_arrays_.empty()) return {};
        auto array = [&](std::size_t k) { return push_arrays_[k].data(); };
        return {slots, array(0), array(1), array(2), array(3), array(4), array(5), array(6)};
    }
    static void hold(const Pushes& to, std::span<const SlotPush> pushes) {
        for (const auto& [slot, number, push] : pushes) {
            to.force_x[slot] = push.force.x, to.force_y[slot] = push.force.y, to.force_z[slot] = push.force.z;
            to.stiffness[slot] = push.stiffness;
        }
    }
    static void aim(const Pushes& to, std::span<const SlotPush> pushes, float time) {
        for (const auto& [slot, number, push] : pushes) {
            const vec3 at = target(push, time);
            to.target_x[slot] = at.x, to.target_y[slot] = at.y, to.target_z[slot] = at.z;
        }
    }
    static void let_go(const Pushes& to, std::span<const SlotPush> pushes) {
        for (const auto& [slot, number, push] : pushes)
            for (float* values : {to.force_x, to.force_y, to.force_z, to.stiffness}) values[slot] = 0;
    }
    // N s, that they give to the nodes.
    void give(std::span<const SlotPush> pushes, float time, double seconds, const Fields& at,
              std::vector<dvec3>& given) const {
        for (const auto& [slot, number, push] : pushes) {
            const dvec3 place =
                dvec3(body_.positions[std::size_t(push.node)]) + dvec3(at.x[slot], at.y[slot], at.z[slot]);
            given[number] += seconds * force_on(push, time, place);
        }
    }

    dvec3 place_of(std::size_t i) const {
        const int s = memory_.layout().slot[i];
        const Fields& f = states_[current];
        return dvec3(body_.positions[i]) + dvec3(f.x[s], f.y[s], f.z[s]);
    }
    dvec3 velocity_of(std::size_t i) const {
        const int s = memory_.layout().slot[i];
        const Fields& f = states_[current];
        return {f.vx[s], f.vy[s], f.vz[s]};
    }
    void place(std::size_t i, dvec3 p) {
        const double finest = memory_.view().finest,
                     large = 4194304 * finest;  // as the kernel does at the end of a call
        dvec3 way = p - dvec3(body_.positions[i]);
        for (int k = 0; k < 3; ++k)
            if (std::abs(way[k]) < large) way[k] = finest * std::round(way[k] / finest);
        const int s = memory_.layout().slot[i];
        const Fields& f = states_[current];
        f.x[s] = float(way.x), f.y[s] = float(way.y), f.z[s] = float(way.z);
    }
    void set_velocity(std::size_t i, dvec3 v) {
        const int s = memory_.layout().slot[i];
        const Fields& f = states_[current];
        f.vx[s] = float(v.x), f.vy[s] = float(v.y), f.vz[s] = float(v.z);
    }

    static constexpr PassPlan at_now{current, current, between, true, false, 0};

    const Body& body_;
    const Scheme& scheme_;
    const Kernels kernels_ = kernels();
    BodyMemory memory_;
    const Pass quiet_;  // nothing touches or moves it
    std::unique_ptr<Team> own_team_;
    Team& team_;
    std::vector<Array<float>> arrays_;  // what the states are made of
    Fields states_[4] = {};             // StateBuffer
    Fields before_ = {};                // as it was before the call
    std::vector<int> parts_;            // of the blocks, by members
    std::vector<Bounds> moved_[4];      // of each state and block
    std::vector<dvec3> given_;          // by tips, of each block
    std::vector<Array<float>> push_arrays_;
    std::vector<CellRing> rings_;  // of the team's members
};

}  // namespace

std::unique_ptr<Machine> make_cpu(const Body& body, const Simulation& simulation, Team* team) {
    return std::make_unique<Cpu>(body, simulation, team);
}

std::string_view cpu_instructions() { return kernels().instructions; }

}  // namespace palpate
