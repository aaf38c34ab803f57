#pragma once
#include "palpate/solver/pass.h"
#include "palpate/solver/pushes.h"

#include <cmath>
#include <vector>

// The physics of one node, one number at a time: of the reference, and of what asks a body for its forces.

namespace palpate::reference {

/// What all nodes look at while a pass runs.
struct Surroundings {
    const Body& body;
    Table springs;  // where there is none its end is the node itself, and it pulls at nothing
    std::vector<std::vector<OwnHinge>> hinges;      // of each node
    const TissueCells* tissue = nullptr;            // of the body, if it has some,
    std::vector<OwnCells> cells = {};               // and each node's cells
    std::vector<vec3> corners = {};                 // of polygons
    std::vector<const DistanceField*> fields = {};  // of closed meshes
    std::span<const NodePush> pushes = {};          // one a node,
    std::vector<int> push_of = {};                  // and the number of each node's, or -1

    explicit Surroundings(const Body& of) : body(of) { read_terms(); }
    void read_terms() {
        hinges = own_hinges(body);
        springs = table(body);
        tissue = palpate::tissue_of(body);
        if (tissue) cells = own_cells(body);
        for (std::size_t t = 0; t < springs.ties.size(); ++t)
            if (int& to = springs.ties[t].to; to < 0) to = int(t) / springs.width;
    }
    Surroundings(const Body& of, const Simulation& simulation) : Surroundings(of) {
        corners = polygon_corners(simulation);
        fields = distance_fields(simulation);
    }
};

template <class Real>
struct NodeStates {
    std::vector<glm::vec<3, Real>> positions, velocities;
};

/// The same where they are kept elsewhere.
template <class Real>
struct NodesNow {
    const glm::vec<3, Real>*positions, *velocities;

    NodesNow(const NodeStates<Real>& states) : NodesNow(states.positions.data(), states.velocities.data()) {}
    NodesNow(const glm::vec<3, Real>* places, const glm::vec<3, Real>* speeds)
        : positions(places), velocities(speeds) {}
};

/// The physics of one node (node.inl), with access to its neighbours.
/// `with_hinges`: whether any may have some; known when compiled, so that bodies without any pay nothing.
template <class Number, bool with_hinges = true>
struct NodePhysics {
    using Real = Number;
    using Real3 = glm::vec<3, Real>;
    struct Eight;

    const Surroundings& world;
    const Pass& pass;
    const NodesNow<Real> now;
    int id;
    int links;
    const Tie* ties;                   // this node's springs,
    std::span<const OwnHinge> hinges;  // and hinges
    Real outside_area, outside_cover;
    std::span<const RoundTip> tips;
    const Eight* cell_pushes = nullptr;  // of each cell, on its corners
    double impulse = 0;                  // s, over which forces act,
    dvec3* impulses = nullptr;           // and what each tip gives by them, N s

    Real3 toward(Real3 p, int l) const { return now.positions[std::size_t(ties[l].to)] - p; }
    Real3 passing(Real3 v, int l) const { return now.velocities[std::size_t(ties[l].to)] - v; }
    Real neighbour(int l) const { return ties[l].to != id ? Real(1) : Real(0); }
    Real share(int l) const { return ties[l].share; }
    Real stiffness(int l) const { return ties[l].stiffness; }
    Real tension(int l) const { return Real(ties[l].stiffness) * Real(ties[l].rest); }
    Real longest(int l) const { return torn_at(ties[l].rest, world.body); }
    bool hinge_end(int h) const { return hinges[std::size_t(h)].is_end; }
    Real3 hinge_toward(Real3 p, int h, int n) const { return now.positions[other(h, n)] - p; }
    Real3 hinge_passing(Real3 v, int h, int n) const { return now.velocities[other(h, n)] - v; }
    std::size_t other(int h, int n) const {
        return std::size_t(hinges[std::size_t(h)].others[std::size_t(n)]);
    }
    Real hinge_stiffness(int h) const { return hinges[std::size_t(h)].stiffness; }
    Real hinge_rest(int h) const { return hinges[std::size_t(h)].rest; }
    Real hinge_area_square(int h) const { return hinges[std::size_t(h)].area_square; }
    int cell(int k) const { return world.cells[std::size_t(id)][std::size_t(k)]; }
    Real cell_weight(int k) const { return cell(k) < 0 ? 0 : world.tissue->weights[std::size_t(cell(k))]; }
    Real3 cell_corner(int k, int c) const {
        return cell(k) < 0 ? Real3(0) : now.positions[corner_node(k, c)];
    }
    Real3 cell_corner_velocity(int k, int c) const {
        return cell(k) < 0 ? Real3(0) : now.velocities[corner_node(k, c)];
    }
    Real3 cell_axis(int) const { return Real3(0); }
    std::size_t corner_node(int k, int c) const {
        return std::size_t(world.body.cells[std::size_t(cell(k))][std::size_t(c)]);
    }
    Real3 origin() const { return Real3(0); }
    Real area() const { return outside_area; }
    Real cover() const { return outside_cover; }
    RoundTip tip(int i) const { return tips[std::size_t(i)]; }
    void given(int i, Real3 force) const { impulses[i] += impulse * dvec3(force); }
    const NodePush* own_push() const {
        const int number = world.push_of[std::size_t(id)];
        return number < 0 ? nullptr : &world.pushes[std::size_t(number)];
    }
    Real3 push() const { return own_push() ? Real3(own_push()->force) : Real3(0); }
    Real3 push_target() const { return own_push() ? Real3(target(*own_push(), pass.time)) : Real3(0); }
    Real push_stiffness() const { return own_push() ? Real(own_push()->stiffness) : Real(0); }
    Real3 corner(int i) const { return Real3(world.corners[std::size_t(i)]); }
    Real distance_at(int i, Real3 p) const { return world.fields[std::size_t(i)]->at(vec3(p)); }
    Real3 uphill_at(int i, Real3 p) const { return Real3(world.fields[std::size_t(i)]->gradient(vec3(p))); }

    static Real max(Real a, Real b) { return a > b ? a : b; }
    static Real min(Real a, Real b) { return a < b ? a : b; }
    static Real inversesqrt(Real a) { return 1 / std::sqrt(a); }
    static Real asin(Real a) { return std::asin(a); }
    static Real log(Real a) { return std::log(a); }
    static bool any_node(bool c) { return c; }
    static Real select(bool c, Real a, Real b) { return c ? a : b; }
    static Real3 select(bool c, Real3 a, Real3 b) { return c ? a : b; }

#define FN [[gnu::always_inline]]  // GCC leaves the longer ones out, which costs half the speed
#define ASIDE
#define UNROLL
#define LINKS links
#define HINGES (with_hinges ? int(hinges.size()) : 0)
#define CELLS (world.tissue ? 8 : 0)
#define OWN_CELLS
#include "palpate/solver/node.inl"
#include "palpate/solver/obstacles.inl"
#undef OWN_CELLS
#undef CELLS
#undef HINGES
#undef LINKS
#undef UNROLL
#undef ASIDE
#undef FN

    // A cell is worked out once for its eight nodes.
    Real3 cells_force() const {
        Real3 force(0);
        for (int k = 0; k < 8; ++k)
            if (cell(k) >= 0) force += cell_pushes[cell(k)].c[k];
        return force;
    }
};

/// Node `i` among the others at `now`. `cell_pushes`: what each cell of tissue does to its corners.
template <class Real, bool with_hinges = true, class Eight = typename NodePhysics<Real, with_hinges>::Eight>
NodePhysics<Real, with_hinges> see(const Surroundings& all, const Pass& pass, const NodesNow<Real>& now,
                                   std::size_t i, std::span<const RoundTip> tips = {},
                                   std::span<const Eight> cell_pushes = {}) {
    return {all,
            pass,
            now,
            int(i),
            all.springs.width,
            all.springs.ties.data() + i * std::size_t(all.springs.width),
            with_hinges ? std::span(all.hinges[i]) : std::span<const OwnHinge>(),
            Real(all.body.area[i]),
            Real(all.body.cover[i]),
            tips,
            cell_pushes.data()};
}

/// Node `i` as it is in `from`.
template <class Real, bool with_hinges = true>
typename NodePhysics<Real, with_hinges>::Node load(const Surroundings& all, const NodesNow<Real>& from,
                                                   std::size_t i) {
    return {from.positions[i], from.velocities[i], Real(all.body.inverse_mass[i])};
}

/// What cell `c` of tissue does to its corners, N.
template <class Real, bool with_hinges = true>
typename NodePhysics<Real, with_hinges>::Eight cell_pushes(const Surroundings& all, const Pass& pass,
                                                           const NodesNow<Real>& now, std::size_t c) {
    const auto lowest = std::size_t(all.body.cells[c][0]);
    NodePhysics<Real, with_hinges> physics = see<Real, with_hinges>(all, pass, now, lowest);
    return physics.on_corners(physics.damped_cell_forces(0));
}

}  // namespace palpate::reference
