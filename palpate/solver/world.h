#pragma once
#include "palpate/base/team.h"
#include "palpate/solver/solver.h"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace palpate {

/// What acts on one body of a world alone.
struct BodyPush {
    std::size_t body = 0;  // its number
    NodePush push;
};
struct BodyMove {
    std::size_t body = 0;
    Move move;
};

/// What a world has done in one slice of a call of World::step.
struct WorldSlice {
    double at = 0, seconds = 0;      // s: when it began, from the start of the call; its length
    std::span<const Press> presses;  // as it began: Acts::presses, then what press_in_slice returned
    std::span<const Stats> bodies;   // of this slice alone; their reactions are one for each of these
};

/// What acts in a world during one call of World::step, besides gravity.
struct Acts {
    std::span<const Press> presses = {};  // all bodies feel them
    std::span<const BodyPush> pushes = {};
    std::span<const BodyMove> moves = {};
    std::span<const Motion> colliders = {};  // as in Influences
    vec3 wind = vec3(0);                     // m/s
    /// Called before each slice, if given, `at` seconds after the call began: returns further presses for the
    /// next `seconds`. Here hands answer that feel the bodies where they are now. `reactions`: N s, to each
    /// of those that it returned for the slice before, in this call or the last; none after restore().
    std::function<std::vector<Press>(double at, double seconds, std::span<const dvec3> reactions)>
        press_in_slice = {};
    /// Called after each slice in which no body diverged, if given.
    std::function<void(const WorldSlice&)> after_slice = {};
};

/// What one call of World::step did.
struct WorldStats {
    std::vector<Stats> bodies;
    std::optional<std::size_t> diverged;  // the body that blew up; then all are as they were before
    std::vector<dvec3> reactions;  // N s, one of Acts::presses each, of all bodies together: as in Stats
    std::vector<dvec3> pushes;     // N s, one a push
};

/// Bodies that move together: in common slices of time, on one team of threads.
class World {
 public:
    /// On a GPU, bodies live in `context`, or in contexts of their own. Both, if given, must outlive the
    /// world; it makes a team of Simulation::threads where it is given none. `slice`: s, for how long one
    /// body goes on before the others do.
    explicit World(const Simulation& simulation, const gl::Context* context = nullptr, Team* team = nullptr,
                   double slice = frame_seconds);

    /// The next body; returns its number. `frequency` and errors: as in make_solver().
    std::size_t add(const Body& body, double frequency = 0);

    /// Moves all bodies on by `seconds`. Throws Error as Solver::step() does, and nothing has moved, or where
    /// an act names a body that there is not.
    WorldStats step(double seconds, const Acts& acts = {});

    /// Puts back what was before the last call of step().
    void undo();

    std::vector<State> save() const;
    void restore(const std::vector<State>& states);

    std::size_t count() const { return solvers_.size(); }
    const Solver& solver(std::size_t body) const { return *solvers_[body]; }
    Team& team() { return team_; }

    /// The shortest step that any body takes by itself, s; `longest` where there is none.
    double shortest_step(double longest) const;

    /// Bytes that all moving states take.
    std::size_t memory() const;

 private:
    template <class Do>
    auto or_undo(bool moved, Do act);

    const Simulation simulation_;
    const gl::Context* context_;
    std::unique_ptr<Team> own_team_;
    Team& team_;
    const double slice_;
    std::vector<std::unique_ptr<Solver>> solvers_;
    std::vector<dvec3> slice_reactions_,
        slice_reactions_before_;  // N s, to what pressed in the last slice; before this call
};

}  // namespace palpate
