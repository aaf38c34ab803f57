// bending.inl: a node's hinges. It stands in node.inl, in the same words; a backend supplies its hinges.
//
// A hinge is folded by bend = 2 sin(θ/2), where θ is the angle between the normals of its two triangles, and turns them back
// with the torque stiffness x (bend - rest). That is stiffness x θ while θ is small, bounded when it is not, and takes no
// arctangent (Bridson, Marino and Fedkiw 2003). Its energy is stiffness x (-4 cos(θ/2) - rest x θ), counted from that at rest;
// the forces are minus its gradient, and stiffness_times is its second derivative, but for what comes from the change of
// dθ/dx: that is nothing at rest, and elsewhere could make the whole negative.
//
// The flatter a triangle is pressed in its own plane, the quicker its angle goes with its corners, without a bound. Where
// one has less than 0.7 of its area a hinge is therefore softer than that, so that its nodes feel at most twice the
// stiffness that they do at rest, and a step that was chosen there stays good: automatic ones leave so much. (There alone the
// forces are less than the slope of the energy.)

// A vector for each of a hinge's four nodes.
struct Four {
    Real3 from, to, left, right;
};

// What a hinge's nodes have, counted from what this node has; the others are in the order of an OwnHinge.
FN Four four(int h, Real3 first, Real3 second, Real3 third) {
    Real3 none = Real3(0.0f, 0.0f, 0.0f);
    Four nodes;
    nodes.from = select(hinge_end(h), none, first);
    nodes.to = select(hinge_end(h), first, second);
    nodes.left = select(hinge_end(h), second, none);
    nodes.right = third;
    return nodes;
}

FN Real3 own_of(int h, Four nodes) { return select(hinge_end(h), nodes.from, nodes.left); }

// A hinge as it lies: its stiffness, N m; how far it is folded; and how its angle grows with the way of each node, 1/m.
struct Fold {
    Real stiffness, bend;
    Four slope;
};

FN Fold fold(int h, Real3 position) {
    Four way = four(h, hinge_toward(position, h, 0), hinge_toward(position, h, 1), hinge_toward(position, h, 2));
    Real3 edge = way.to - way.from, left = way.left - way.from, right = way.right - way.from;
    Real length_square = squared(edge), per_length = inversesqrt(length_square);
    Real3 along = per_length * edge;
    Real3 left_normal = cross(along, left), right_normal = cross(right, along);  // as long as the triangles are high
    Real left_square = squared(left_normal), right_square = squared(right_normal);
    Real left_inverse = inversesqrt(left_square), right_inverse = inversesqrt(right_square);
    Real3 apart = left_inverse * left_normal - right_inverse * right_normal;
    Real bend = dot(apart, apart) * inversesqrt(squared(apart));
    Real area_square = Real(0.25f) * length_square * min(left_square, right_square);
    Fold now;
    now.stiffness = min(Real(2.0f) * area_square / hinge_area_square(h), Real(1.0f)) * hinge_stiffness(h);
    now.bend = select(dot(left_normal, right) < Real(0.0f), -bend, bend);
    now.slope.left = (left_inverse * left_inverse) * left_normal;
    now.slope.right = (right_inverse * right_inverse) * right_normal;
    // What turns it without moving it: the ends go against the tips, each by how near a tip's foot on the edge is to it.
    Real left_foot = per_length * dot(left, along), right_foot = per_length * dot(right, along);
    now.slope.from = (left_foot - Real(1.0f)) * now.slope.left + (right_foot - Real(1.0f)) * now.slope.right;
    now.slope.to = Real(-1.0f) * (left_foot * now.slope.left + right_foot * now.slope.right);
    return now;
}

ASIDE Real3 bending_force(Real3 position) {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    for (int h = 0; h < HINGES; ++h) {
        Fold now = fold(h, position);
        force -= (now.stiffness * (now.bend - hinge_rest(h))) * own_of(h, now.slope);
    }
    return force;
}

// cos(θ/2): by how much the bend grows with the angle.
FN Real half_cosine(Real bend) {
    Real square = max(Real(1.0f) - Real(0.25f) * bend * bend, Real(0.0f));
    return square * inversesqrt(square + Real(1e-20f));
}

// N: how the force on a node resists a displacement of all nodes, which their velocities hold, m.
ASIDE Real3 bending_stiffness_times(Node node) {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    for (int h = 0; h < HINGES; ++h) {
        Fold now = fold(h, node.position);
        Four change = four(h, hinge_passing(node.velocity, h, 0), hinge_passing(node.velocity, h, 1),
                           hinge_passing(node.velocity, h, 2));
        Real turning = dot(now.slope.from, change.from) + dot(now.slope.to, change.to) +
                       dot(now.slope.left, change.left) + dot(now.slope.right, change.right);
        force += (now.stiffness * half_cosine(now.bend) * turning) * own_of(h, now.slope);
    }
    return force;
}

// J, for a stiffness of 1 N m and but for a constant.
FN Real folding_energy(Real bend, Real rest) {
    Real half_sine = max(min(Real(0.5f) * bend, Real(1.0f)), Real(-1.0f));
    return Real(-4.0f) * half_cosine(bend) - Real(2.0f) * rest * asin(half_sine);
}

// J: of a node's hinges the quarter that is its own.
ASIDE Real bending_energy(Real3 position) {
    Real energy = Real(0.0f);
    for (int h = 0; h < HINGES; ++h) {
        Real rest = hinge_rest(h);
        energy += Real(0.25f) * hinge_stiffness(h) *
                  (folding_energy(fold(h, position).bend, rest) - folding_energy(rest, rest));
    }
    return energy;
}
