#include "palpate/solver/world.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

// What acts on each body from `time` seconds into a call on, with memory of its own.
class OneSlice {
 public:
    OneSlice(const Acts& acts, std::span<const Press> more, std::size_t bodies, double time, double left)
        : presses_(acts.presses.begin(), acts.presses.end()),
          pushes_(bodies),
          moves_(bodies),
          bodies_(bodies) {
        const auto t = float(time);
        for (Press& press : presses_) press = after(press, t);
        presses_.insert(presses_.end(), more.begin(), more.end());
        for (const auto& [body, push] : acts.pushes) {
            pushes_[body].push_back(push);
            pushes_[body].back().to += t * push.velocity;
        }
        for (const auto& [body, move] : acts.moves) moves_[body].push_back(move);
        for (const Motion& motion : acts.colliders) colliders_.push_back(after(motion, t));
        for (std::size_t b = 0; b < bodies; ++b)
            bodies_[b] = {presses_, pushes_[b], moves_[b], colliders_, acts.wind, left};
    }

    const Influences& on(std::size_t body) const { return bodies_[body]; }
    std::span<const Press> presses() const { return presses_; }

 private:
    std::vector<Press> presses_;
    std::vector<std::vector<NodePush>> pushes_;
    std::vector<std::vector<Move>> moves_;
    std::vector<Motion> colliders_;
    std::vector<Influences> bodies_;
};

void add(std::vector<dvec3>& sum, const std::vector<dvec3>& more) {
    sum.resize(more.size(), dvec3(0));
    for (std::size_t i = 0; i < more.size(); ++i) sum[i] += more[i];
}

// A body's stats over all slices so far.
void add(Stats& all, Stats slice) {
    slice.steps += all.steps;
    if (all.steps > 0) slice.step = std::min(slice.step, all.step);
    add(slice.reactions, all.reactions.empty() ? std::vector<dvec3>(slice.reactions.size()) : all.reactions);
    add(slice.pushes, all.pushes.empty() ? std::vector<dvec3>(slice.pushes.size()) : all.pushes);
    all = std::move(slice);
}

}  // namespace

World::World(const Simulation& simulation, const gl::Context* context, Team* team, double slice)
    : simulation_(simulation),
      context_(context),
      own_team_(team ? nullptr : std::make_unique<Team>(simulation.threads)),
      team_(team ? *team : *own_team_),
      slice_(slice) {
    if (!(slice > 0)) throw Error("a slice that is not above 0 s", "the world", "use 1/60 s or less");
}

std::size_t World::add(const Body& body, double frequency) {
    solvers_.push_back(make_solver(body, simulation_, context_, frequency, &team_));
    return solvers_.size() - 1;
}

// Does what may throw. If bodies have moved already, they go back first.
template <class Do>
auto World::or_undo(bool moved, Do act) {
    try {
        return act();
    } catch (...) {
        if (moved) undo();
        throw;
    }
}

WorldStats World::step(double seconds, const Acts& acts) {
    auto require = [&](std::size_t body) {
        if (body >= count())
            throw Error(fmt::format("body {} of {}", body, count()), "a step of the world",
                        "count bodies from 0");
    };
    for (const BodyPush& one : acts.pushes) require(one.body);
    for (const BodyMove& one : acts.moves) require(one.body);
    WorldStats stats;
    stats.bodies.resize(count());
    const int slices = steps_within(seconds, slice_);
    const double length = seconds / slices;
    slice_reactions_before_ = slice_reactions_;
    for (int s = 0; s < slices; ++s) {
        std::vector<Press> more;
        const OneSlice slice = or_undo(s > 0, [&] {
            if (acts.press_in_slice) more = acts.press_in_slice(s * length, length, slice_reactions_);
            OneSlice next(acts, more, count(), s * length, (slices - s) * length);
            for (std::size_t b = 0; b < count() && (s == 0 || !more.empty()); ++b)
                solvers_[b]->steps_for(length, next.on(b));
            return next;
        });
        slice_reactions_.assign(more.size(), dvec3(0));
        std::vector<Stats> in_slice;
        for (std::size_t b = 0; b < count() && !stats.diverged; ++b) {
            Solver& solver = *solvers_[b];
            Stats now = s == 0 ? solver.step(length, slice.on(b)) : solver.go_on(length, slice.on(b));
            if (now.diverged) stats.diverged = b;
            for (std::size_t p = 0; p < more.size() && !now.diverged; ++p)
                slice_reactions_[p] += now.reactions[acts.presses.size() + p];
            if (acts.after_slice) in_slice.push_back(now);
            now.reactions.resize(acts.presses.size(), dvec3(0));
            ::palpate::add(stats.bodies[b], now);
        }
        if (!stats.diverged && acts.after_slice)
            or_undo(true, [&] { acts.after_slice({s * length, length, slice.presses(), in_slice}); });
        if (!stats.diverged) continue;
        // All that have gone on since the call began.
        for (std::size_t b = 0; b < count(); ++b)
            if (b != *stats.diverged && (s > 0 || b < *stats.diverged)) solvers_[b]->undo();
        slice_reactions_ = slice_reactions_before_;
        return stats;
    }
    stats.reactions.assign(acts.presses.size(), dvec3(0));
    for (const Stats& one : stats.bodies) ::palpate::add(stats.reactions, one.reactions);
    std::vector<std::size_t> next(count(), 0);  // of each body's pushes
    for (const BodyPush& one : acts.pushes)
        stats.pushes.push_back(stats.bodies[one.body].pushes[next[one.body]++]);
    return stats;
}

void World::undo() {
    for (const auto& solver : solvers_) solver->undo();
    slice_reactions_ = slice_reactions_before_;
}

std::vector<State> World::save() const {
    std::vector<State> states;
    for (const auto& solver : solvers_) states.push_back(solver->save());
    return states;
}

void World::restore(const std::vector<State>& states) {
    if (states.size() != count())
        throw Error(fmt::format("states of {} bodies instead of {}", states.size(), count()), "the world",
                    "restore what was saved of the same bodies");
    for (std::size_t b = 0; b < count(); ++b) solvers_[b]->restore(states[b]);
    slice_reactions_.clear();
}

double World::shortest_step(double longest) const {
    for (const auto& solver : solvers_) longest = std::min(longest, solver->longest_step());
    return longest;
}

std::size_t World::memory() const {
    std::size_t bytes = 0;
    for (const auto& solver : solvers_) bytes += solver->memory();
    return bytes;
}

}  // namespace palpate
