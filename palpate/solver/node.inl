// node.inl: the physics of one node, written once for every backend.
//
// The words are GLSL's; C++ and CUDA bring the same ones (dot, min, max, inversesqrt). In C++ and CUDA this file is
// included inside the backend's own struct, in GLSL at global scope, and finds there:
//   FN, UNROLL         what stands before a function, and before the loop over links
//   Real, Real3        a number, a vector: of one node, or of as many nodes as a SIMD register holds
//   select(c, a, b)    a where c holds, b elsewhere
//   LINKS              how many links a node has
//   pass               the Pass: what all nodes share
//   toward(p, l)       from p to this node's neighbour along link l, m
//   share(l)           how much of link l there is: 0 none, 1 all
//   area(), cover()    of this node's outside, m^2, and how far out of the node it lies, m
// The last four, and loading and storing nodes, are all that a backend writes itself.

struct Node {
    Real3 position;      // m
    Real3 velocity;      // m/s
    Real  inverse_mass;  // 1/kg; 0 pins the node
};

// Squared length, never quite zero: two nodes in one place feel no force, not NaN. The tiny number stands innermost,
// where a fused multiply-add takes it for nothing.
FN Real squared(Real3 a) { return a.x * a.x + (a.y * a.y + (a.z * a.z + Real(1e-20f))); }

// ---- forces ----

// What the springs of a node do to it.
struct Pull {
    Real3 force;    // N
    Real3 outward;  // sum of the unit vectors from its neighbours: the approximate normal (2005, eq. 3)
};

// Each spring pulls with stiffness x (length - rest length) towards its neighbour (2005, eq. 1 without the factor 1/2).
FN Pull springs(Real3 position) {
    Pull sum;
    sum.force = Real3(0.0f, 0.0f, 0.0f);
    sum.outward = Real3(0.0f, 0.0f, 0.0f);
    UNROLL for (int l = 0; l < LINKS; ++l) {
        Real3 along = toward(position, l);
        Real inverse = inversesqrt(squared(along));
        Real pull = Real(pass.spring[l].stiffness) - Real(pass.spring[l].tension) * inverse;
        sum.force += (share(l) * pull) * along;
        sum.outward -= (share(l) * inverse) * along;
    }
    return sum;
}

// A round tip pushes out of its centre, in proportion to the depth of the surface that the node carries.
FN Real3 tip_force(Real3 position, int i) {
    Real3 away = position - Real3(pass.tip[i].x, pass.tip[i].y, pass.tip[i].z);
    Real square = squared(away);
    Real inverse = inversesqrt(square);
    Real depth = max(Real(pass.tip[i].w) + cover() - square * inverse, Real(0.0f));
    return (Real(pass.tip_push[i].x) * area() * depth * inverse) * away;
}

FN Real3 acceleration(Node node) {
    Real3 force = springs(node.position).force;
    for (int i = 0; i < pass.tips; ++i) force += tip_force(node.position, i);
    Real3 gravity = Real3(pass.gravity.x, pass.gravity.y, pass.gravity.z);
    return node.inverse_mass * force + gravity - Real(pass.damping) * node.velocity;
}

// ---- colliders ----

// Lifts a node out by depth along a unit normal and stops its motion inward. No depth, no contact.
FN Node push_out(Node node, Real3 normal, Real depth) {
    Real inward = min(dot(node.velocity, normal), Real(0.0f));
    node.position += max(depth, Real(0.0f)) * normal;
    node.velocity -= select(depth > Real(0.0f), inward, Real(0.0f)) * normal;
    return node;
}

FN Node collide(Node node) {
    for (int i = 0; i < pass.planes; ++i) {
        Real3 normal = Real3(pass.plane[i].x, pass.plane[i].y, pass.plane[i].z);
        node = push_out(node, normal, Real(pass.plane[i].w) - dot(node.position, normal));
    }
    for (int i = 0; i < pass.spheres; ++i) {
        Real3 away = node.position - Real3(pass.sphere[i].x, pass.sphere[i].y, pass.sphere[i].z);
        Real square = squared(away);
        Real inverse = inversesqrt(square);
        node = push_out(node, inverse * away, Real(pass.sphere[i].w) - inverse * square);
    }
    return node;
}

// ---- motion ----

// One pass: the velocity goes on by kick, then the position by drift with the new velocity. What is pinned stays.
FN Node integrate(Node node, Real3 change) {
    Node next = node;
    next.velocity += Real(pass.kick) * change;
    next.position += Real(pass.drift) * next.velocity;
    next = collide(next);
    next.position = select(node.inverse_mass > Real(0.0f), next.position, node.position);
    next.velocity = select(node.inverse_mass > Real(0.0f), next.velocity, node.velocity);
    return next;
}
