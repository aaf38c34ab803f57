#pragma once
#include "palpate/base/names.h"
#include "palpate/body/collider.h"

#include <span>
#include <vector>

namespace palpate {

enum class Backend {
    reference,  // one node after the other on one CPU core: the truth that other backends are held against
};

enum class Integrator {
    semi_implicit_euler,  // called "implicit Euler" in the 2012 paper, eq. 7; order 1, symplectic
    verlet,               // 2012, eq. 6, in its velocity form; order 2, symplectic
};

inline std::span<const Named<Backend>> names(Backend) {
    static constexpr Named<Backend> all[] = {{Backend::reference, "reference"}};
    return all;
}

inline std::span<const Named<Integrator>> names(Integrator) {
    static constexpr Named<Integrator> all[] = {{Integrator::semi_implicit_euler, "semi-implicit-euler"},
                                                {Integrator::verlet, "verlet"}};
    return all;
}

/// How a body is moved.
struct Simulation {
    Backend backend = Backend::reference;
    Integrator integrator = Integrator::verlet;
    double step = 0;                    // s; 0 chooses 0.7 of the stability bound
    bool force = false;                 // accept a step above the bound
    vec3 gravity = vec3(0, -9.81f, 0);  // m/s²
    std::vector<Collider> colliders;
    float contact = 0;        // Pa/m, of all presses to come (pressure_per_metre), for the stability bound
    double frame = 1.0 / 60;  // s, the longest time that one call of Solver::step is asked for
};

}  // namespace palpate
