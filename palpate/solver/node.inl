// node.inl: the physics of one node, written once for every machine; what a body's terms do is in terms/, a file for each
// law, what a node may not enter in obstacles.inl.
//
// The words are GLSL's; C++ and CUDA bring the same ones (dot, cross, max, min, inversesqrt, asin). In C++ and CUDA this
// file is included inside the backend's own struct, in GLSL at global scope, and finds there:
//   FN, ASIDE, UNROLL  what stands before a function, before one that few bodies need, and before a loop over links
//   Real, Real3        a number, a vector: of one node, or of as many nodes as a SIMD register holds
//   select(c, a, b)    a where c holds, b elsewhere
//   any_node(c)        whether c holds for any of the nodes at hand
//   LINKS, HINGES, CELLS   how many links and hinges a node has; 8 cells around it in a body of tissue, else 0
//   pass               the Pass: what all nodes share
//   toward(p, l)       from p to this node's neighbour along link l, m
//   passing(v, l)      from v to that neighbour's velocity, m/s
//   neighbour(l)       1 where there is one along link l, which may be without a spring; else 0
//   share(l)           how much of link l there is: 0 none, 1 all
//   stiffness(l), tension(l)   of a whole link, N/m; stiffness x rest length, N
//   longest(l)         ten times its rest length, squared, m^2
//   hinge_end(h)       whether this node is an end of the edge of its hinge h; else it is the tip of a triangle
//   hinge_toward(p, h, n), hinge_passing(v, h, n)   as toward and passing, for the three others: OwnHinge says which
//   hinge_stiffness(h), hinge_rest(h), hinge_area_square(h)   as an OwnHinge says
//   cell_weight(k)     of the cell of which this node is corner k, 0 where there is none
//   cell_corner(k, c), cell_corner_velocity(k, c)   of its corner c: position, as a Node's, and velocity
//   cell_axis(axis)    where positions count from places at rest: the direction of its edges at rest; else 0
//   origin()           what this node's position counts from: the world's, or its own place at rest, m
//   area(), cover()    of this node's outside, m^2, and how far out of the node it lies, m
//   tip(i)             the RoundTip i
//   given(i, force)    takes note of what tip i gave to this node besides its tip_force, N
//   push(), push_target(), push_stiffness()   what pushes this node: a force, N; where a spring draws it, m; its stiffness
//   corner(i)          corner i of all polygons, m
//   distance_at(i, p), uphill_at(i, p)   field i at p: the distance, m, and which way it grows
// These, and loading and storing nodes, are all that a backend writes itself. It may also define OWN_PULL and bring the
// same pull(l, square) in another form, if it has the pieces of the sum at hand; and OWN_CELLS and bring
// cells_force(), if it works out damped_cell_forces() once for each cell. And what it knows of a pass when it is compiled
// it may define in place of these, so that what never acts is left out (SPRINGS: how many of the links pull):
#ifndef FAN
#define FAN pass.fan
#endif
#ifndef SPRINGS
#define SPRINGS LINKS
#endif
#ifndef TIPS
#define TIPS pass.tips
#endif
#ifndef RESISTANCE
#define RESISTANCE (pass.resistance > 0)
#endif
#ifndef PUSHES
#define PUSHES pass.pushes
#endif
#ifndef OBSTACLES
#define OBSTACLES pass.obstacles
#endif
#ifndef LINK_DAMPING
#define LINK_DAMPING (pass.link_damping > 0.0f)
#endif
#ifndef WIND
#define WIND (pass.wind.w > 0.0f)
#endif

struct Node {
    Real3 position;      // m, from origin()
    Real3 velocity;      // m/s
    Real  inverse_mass;  // 1/kg; 0: no force moves it, and it goes on at its velocity
};

FN Real3 xyz(vec4 v) { return Real3(v.x, v.y, v.z); }

// Squared length, never quite zero: two nodes in one place feel no force, not NaN. The tiny number stands innermost,
// where a fused multiply-add takes it for nothing.
FN Real squared(Real3 a) { return a.x * a.x + (a.y * a.y + (a.z * a.z + Real(1e-20f))); }

FN Real3 unit(Real3 a) { return inversesqrt(squared(a)) * a; }

// ---- forces ----

// In a sheet, which has no neighbours on either side: the normal of the triangles around the node.
FN Real3 fan_normal(Real3 position) {
    Real3 sum = Real3(0.0f, 0.0f, 0.0f);
    Real3 last = neighbour(FAN - 1) * toward(position, FAN - 1);
    for (int l = 0; l < FAN; ++l) {
        Real3 along = neighbour(l) * toward(position, l);
        sum += cross(last, along);
        last = along;
    }
    return unit(sum);
}

// A node's approximate normal: the sum of the unit vectors from its neighbours (2005, eq. 3).
ASIDE Real3 outward(Real3 position) {
    if (FAN > 0) return fan_normal(position);
    Real3 sum = Real3(0.0f, 0.0f, 0.0f);
    UNROLL for (int l = 0; l < LINKS; ++l) sum -= share(l) * unit(toward(position, l));
    return sum;
}

#include "palpate/solver/terms/springs.inl"
#include "palpate/solver/terms/bending.inl"
#include "palpate/solver/terms/cells.inl"

// All terms together, but for what cells of tissue do: that is worked out by cells, damping included, and added where it is
// asked for. A law that joins them is one more file, and one more line in each of these.

FN Real3 elastic_force(Real3 position) {
    Real3 force = spring_force(position);
    if (HINGES > 0) force += bending_force(position);
    return force;
}

FN Real3 elastic_damping(Node node) {
    Real3 force = spring_damping(node);
    if (HINGES > 0) force -= Real(pass.link_damping) * bending_stiffness_times(node);
    return force;
}

ASIDE Real3 elastic_stiffness_times(Node node) {
    Real3 force = spring_stiffness_times(node);
    if (HINGES > 0) force += bending_stiffness_times(node);
    return force;
}

ASIDE Real elastic_energy(Real3 position) {
    Real energy = spring_energy(position);
    if (HINGES > 0) energy += bending_energy(position);
    if (CELLS > 0) energy += own_cell_energy();
    return energy;
}

// Where a node is at a round tip.
struct AtTip {
    Real3 away;     // from the tip's centre, m
    Real  inverse;  // of its length, 1/m
    Real  pushed;   // m^2
    Real  depth;    // m; 0: it does not touch
};

// Inside tissue a tip pushes the nodes that it reaches too, or it would fall through once it is some cells deep: in
// proportion to their volume, so that what is felt does not depend on how fine the cells are.
FN AtTip at_tip(Real3 position, RoundTip t) {
    AtTip here;
    here.away = origin() + position - xyz(t.place);
    Real square = squared(here.away);
    here.inverse = inversesqrt(square);
    Real part = min(Real(pass.cell_size) / Real(t.place.w), Real(1.0f));
    Real inner = part * Real(pass.cell_size * pass.cell_size);
    here.pushed = select(area() > Real(0.0f), area(), inner);
    Real carried = select(area() > Real(0.0f), cover(), Real(0.0f));
    here.depth = max(Real(t.place.w) + carried - square * here.inverse, Real(0.0f));
    return here;
}

// A round tip pushes out of its centre, in proportion to the depth of the surface that the node carries.
FN Real3 tip_force(Real3 position, int i) {
    RoundTip t = tip(i);
    AtTip here = at_tip(position, t);
    return (Real(t.push.x) * here.pushed * here.depth * here.inverse) * here.away;
}

FN Real3 push_force(Real3 position) {
    return push() + push_stiffness() * (push_target() - (origin() + position));
}

// The air presses with half its density x the square of its speed through the surface: on both sides of a sheet, on
// a solid from the windward side. Along the surface it slides past.
ASIDE Real3 wind_force(Node node) {
    Real3 normal = outward(node.position);
    normal = min(inversesqrt(squared(normal)), Real(1.0f)) * normal;  // a short one says little
    Real through = dot(xyz(pass.wind) - node.velocity, normal);
    if (FAN == 0) through = min(through, Real(0.0f));
    return (Real(0.5f * pass.wind.w) * area() * max(through, -through) * through) * normal;
}

FN Real3 tool_force(Real3 position) {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    for (int i = 0; i < TIPS; ++i) force += tip_force(position, i);
    if (PUSHES > 0) force += push_force(position);
    return force;
}

FN Real3 acceleration(Node node) {
    Real3 force = elastic_force(node.position);
    if (LINK_DAMPING) force += elastic_damping(node);
    if (CELLS > 0) force += cells_force();
    if (TIPS + PUSHES > 0) force += tool_force(node.position);
    if (WIND) force += wind_force(node);
    return node.inverse_mass * force + xyz(pass.gravity) - Real(pass.damping) * node.velocity;
}

// ---- motion ----

// How a tip resists what moves past it: a damper along its radius, which never pulls, and dry friction across. Both look at
// the velocity that the node would have after this pass, so that what sticks goes with the tip and does not creep, and so
// that they take no more than all of that velocity, however strong they are. `start`, `change`: as in integrate().
ASIDE Real3 tip_resistance(Node start, Real3 position, Real3 change, int i) {
    RoundTip t = tip(i);
    AtTip here = at_tip(position, t);
    if (!any_node(here.depth > Real(0.0f))) return Real3(0.0f, 0.0f, 0.0f);
    Real3 normal = here.inverse * here.away;
    Real3 speed = start.velocity + Real(pass.kick) * change - xyz(t.velocity);
    Real outward = dot(speed, normal), gain = Real(pass.kick) * start.inverse_mass;  // m/s for each newton
    Real spring = Real(t.push.x) * here.pushed * here.depth;
    Real damper = select(here.depth > Real(0.0f), Real(t.push.y) * here.pushed, Real(0.0f));
    Real damped = max(-outward * damper / (Real(1.0f) + gain * damper), -spring);
    Real3 slip = speed - outward * normal;
    Real square = squared(slip), inverse = inversesqrt(square);
    Real stops = square * inverse / max(gain, Real(1e-30f)), pressed = spring + damped;
    Real held = select(stops <= Real(t.push.z) * pressed, stops, Real(t.push.w) * pressed);
    return damped * normal - (held * inverse) * slip;
}

// `change` with what all tips resist, one after the other.
FN Real3 resisted(Node start, Real3 position, Real3 change) {
    if (!RESISTANCE) return change;
    for (int i = 0; i < TIPS; ++i) {
        Real3 force = tip_resistance(start, position, change, i);
        given(i, force);
        change += start.inverse_mass * force;
    }
    return change;
}

// One pass of a step that began at `start`: from its velocity and position on, with the velocity and the
// acceleration of `now`. What has no inverse mass keeps its velocity.
FN Node integrate(Node start, Node now, Real3 change) {
    Node next = start;
    Real free = select(start.inverse_mass > Real(0.0f), Real(1.0f), Real(0.0f));
    next.velocity += (free * Real(pass.kick)) * change;
    next.position += Real(pass.drift) * (now.velocity + Real(pass.lead) * (next.velocity - now.velocity));
    return next;
}

// What a pass adds to the sum over all passes of a step.
FN Node collect(Node sum, Node now, Real3 change) {
    Real free = select(now.inverse_mass > Real(0.0f), Real(1.0f), Real(0.0f));
    sum.velocity += (free * Real(pass.part)) * change;
    sum.position += Real(pass.part) * now.velocity;
    return sum;
}

// How many things are wrong with a node: its place is not a number, or a spring or a cell is torn.
ASIDE Real torn(Real3 position) {
    Real wrong = select(dot(position, position) <= Real(1e30f), Real(0.0f), Real(1.0f)) + torn_springs(position);
    if (CELLS > 0) wrong += own_cell_torn();
    return wrong;
}
