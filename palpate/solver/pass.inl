// pass.inl: what all nodes of a body share during one pass. C++, GLSL (std140) and CUDA read the same bytes, so an
// array holds nothing smaller than a vec4. The host fills it; node.inl reads it.

struct Spring {
    int   offset;      // to the neighbour, in nodes, where a backend lays its nodes out as a grid
    float stiffness;   // N/m
    float tension;     // stiffness x rest length, N
    float spare;
};

struct Pass {
    vec4  gravity;     // m/s^2
    float kick;        // s: how far this pass carries the velocities ...
    float drift;       // s: ... and the positions
    float damping;     // 1/s
    int   links;
    int   tips;
    int   planes;
    int   spheres;
    int   spare;
    vec4  tip[8];      // centre, radius
    vec4  tip_push[8]; // x: pressure for each metre of depth, Pa/m
    vec4  plane[8];    // unit normal, offset
    vec4  sphere[8];   // centre, radius
    Spring spring[32];
};
