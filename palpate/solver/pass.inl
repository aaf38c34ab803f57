// pass.inl: what all nodes of a body share during one pass. C++, GLSL (std140) and CUDA read the same bytes, so an
// array holds nothing smaller than a vec4. The host fills it; node.inl reads it.

// A link of a grid's stencil; what a node's own table says is not here.
struct LinkNumbers {
    float stiffness;   // N/m
    float tension;     // stiffness x rest length, N
    float longest;     // ten times its rest length, squared, m^2: beyond, the motion has blown up
    float padding;
};

const int half_space = 0, round_box = 1, polygon = 2, field = 3;  // kinds of obstacles

// A collider where it is in this pass, in a frame of its own: a half-space below y = 0; a box around the origin, whose
// rounding makes it a ball or a capsule too; triangles; a distance field.
struct Obstacle {
    vec4  x, y, z;     // rows: what takes a point of the world into its frame
    vec4  size;        // of the box: half its sides, and its rounding; m
    vec4  place;       // its origin in the world; w: how far nodes stay off its surface, m
    vec4  velocity;    // of its origin, m/s; w: friction
    vec4  spin;        // rad/s, about its origin; w: how far nodes may go before their way is looked at, m
    ivec4 kind;        // one of the above; first corner and number of corners of a polygon; number of a field
};

// A round tip that presses, where it is in this pass. There may be any number, so they lie beside the Pass.
struct RoundTip {
    vec4  place;       // centre; radius
    vec4  push;        // pressure for each metre of depth, Pa/m; for each m/s, Pa s/m; friction: still, sliding
    vec4  velocity;    // m/s
};

struct Pass {
    vec4  gravity;     // m/s^2
    vec4  wind;        // m/s; w: density of the air, kg/m^3
    float kick;        // s: how far this pass carries the velocities ...
    float drift;       // s: ... and the positions,
    float lead;        // with the velocities from before the pass (0), with the new ones (1), or between
    float part;        // s: the weight of this pass in the sum over a step
    float duration;    // s, from where the step began to where this pass ends
    float damping;     // 1/s, of velocities
    float link_damping;  // s: a spring resists its stretching with this x stiffness
    int   links;       // of a node
    int   fan;         // the first so many of them go round it in a sheet
    int   tips;
    int   pushes;      // 0: no node is pushed
    int   obstacles;
    int   last;        // 1 in the last pass of a step, 2 in that of a call, else 0
    float time;        // s, from the start of the call to where forces are taken
    int   resistance;  // 1: tips resist what moves past them
    float shear;       // of tissue, Pa: Lamé's parameters
    float lame;
    float cell_size;   // m
    float bend;        // N/m: how its cells resist being bent
    float twist;       // and twisted
    vec4  origin_speed;  // m/s, at which the origin of places goes on, and from which velocities are counted
    vec4  place_shift;   // w: 1 where nothing moves, but places and velocities are counted from another origin: they lose
    vec4  speed_shift;   // these, m and m/s
    Obstacle obstacle[16];
    LinkNumbers spring[32];
};
