// springs.inl: a node's springs. It stands in node.inl, in the same words; a backend supplies its links.
//
// The forces are minus the gradient of the energy 1/2 k (length - rest)^2, and stiffness_times is its second derivative:
// k along the spring, and across it k (1 - rest / length), which in a spring that is pressed together would be negative and
// is then left out, so that the whole stays positive.

#ifndef OWN_PULL
// N/m: the force of a spring by its length, whose square is given.
FN Real pull(int l, Real square) { return share(l) * (stiffness(l) - tension(l) * inversesqrt(square)); }
#endif

// Each spring pulls with stiffness x (length - rest length) towards its neighbour (2005, eq. 1 without the factor 1/2).
FN Real3 spring_force(Real3 position) {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    UNROLL for (int l = 0; l < SPRINGS; ++l) {
        Real3 along = toward(position, l);
        force += pull(l, squared(along)) * along;
    }
    return force;
}

// Each spring resists the speed at which it stretches: the part of Rayleigh damping that is proportional to stiffness.
ASIDE Real3 spring_damping(Node node) {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    UNROLL for (int l = 0; l < SPRINGS; ++l) {
        Real3 along = unit(toward(node.position, l));
        Real stretching = dot(passing(node.velocity, l), along);
        force += (share(l) * stiffness(l) * Real(pass.link_damping) * stretching) * along;
    }
    return force;
}

// N: how the force on a node resists a displacement of all nodes, which their velocities hold, m.
ASIDE Real3 spring_stiffness_times(Node node) {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    UNROLL for (int l = 0; l < SPRINGS; ++l) {
        Real3 along = toward(node.position, l), change = passing(node.velocity, l);
        Real inverse = inversesqrt(squared(along));
        Real3 direction = inverse * along;
        Real stretch = dot(change, direction);
        Real across = max(stiffness(l) - tension(l) * inverse, Real(0.0f));
        force -= share(l) * (stiffness(l) * stretch * direction + across * (change - stretch * direction));
    }
    return force;
}

// J: of a node's springs the half that is its own.
ASIDE Real spring_energy(Real3 position) {
    Real energy = Real(0.0f);
    UNROLL for (int l = 0; l < SPRINGS; ++l) {
        Real square = squared(toward(position, l));
        Real rest = tension(l) / max(stiffness(l), Real(1e-30f));
        Real stretch = square * inversesqrt(square) - rest;
        energy += Real(0.25f) * share(l) * stiffness(l) * stretch * stretch;
    }
    return energy;
}

// How many of a node's springs are stretched to ten times their length. No tissue does that; a motion that blows up
// soon does.
ASIDE Real torn_springs(Real3 position) {
    Real none = Real(0.0f), wrong = none;
    UNROLL for (int l = 0; l < SPRINGS; ++l) {
        Real beyond = share(l) * stiffness(l) * (squared(toward(position, l)) - longest(l));
        wrong += select(beyond <= none, none, Real(1.0f));
    }
    return wrong;
}
