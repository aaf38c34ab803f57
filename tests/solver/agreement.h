#pragma once
// What backends are held against each other with: odd bodies, all that can act on them at once, and the
// comparison.
#include "palpate/body/cloth.h"
#include "palpate/body/influences.h"
#include "palpate/body/lattice.h"
#include "palpate/solver/solver.h"

#include <string>
#include <vector>

namespace palpate {

inline const Material of_springs{
    .youngs_modulus = 2000, .density = 1000, .damping = 20, .model = MaterialModel::springs};
inline const Material of_tissue{.youngs_modulus = 2000, .density = 1000, .damping = 20};
inline const ClothSettings linen{.density = 0.3f, .damping = 20};

struct NamedBody {
    std::string name;
    Body body;
};
std::vector<NamedBody> odd_bodies();

/// What acts on a body, at its worst all at once.
struct Acting {
    std::vector<Collider> colliders;
    std::vector<Motion> motions;
    std::vector<Press> presses;
    std::vector<NodePush> pushes;
    std::vector<int> moved;
    std::vector<vec3> places;
    std::vector<Move> moves;
    vec3 wind = vec3(0);
    float air = 0;

    Influences influences() const { return {presses, pushes, moves, motions, wind}; }
};
Acting everything(const Body& body);
/// And two tips with friction, one of which has a damper too, where the one tip was.
Acting rubbing(const Body& body);
/// 20 tips and 300 pushes, several on some nodes, with forces and without springs among them.
Acting many_tools(const Body& body);

Simulation simulation(const Body& body, const Acting& on, Integrator integrator, Backend backend,
                      int threads = 1);

void expect_same_bits(const State& a, const State& b);

double furthest_apart(const std::vector<dvec3>& a, const std::vector<dvec3>& b);

/// The same steps on a backend and in the reference. Where contacts make much of little, the reference in
/// double says how much that is. `bound`: m.
void expect_same(const Body& body, const Acting& on, Integrator integrator, Backend backend, int steps,
                 double bound, const gl::Context* context = nullptr);

/// The same for a solver that was made for simulation(body, on, integrator, backend).
void expect_same(Solver& solver, const Body& body, const Acting& on, const Simulation& how, int steps,
                 double bound);

}  // namespace palpate
