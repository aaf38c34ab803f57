// Macros that let GLSL compile mapping.inl and dent.inl, which it shares with C++.
#define FN
#define Real float
#define Real3 vec3
#define select(c, a, b) ((c) ? (a) : (b))
#define x_of(v) (v).x
