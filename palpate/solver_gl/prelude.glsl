// prelude.glsl: the words of node.inl in GLSL, and how fields are looked up. Before it stands a line for each of these that
// holds for the body:
//   LINKS n       how many links a node has
//   HINGES n      and how many hinges; only where springs are written out
//   CELLS n       8 in tissue, else 0
//   FIELDS n      how many obstacles are distance fields
//   TABLE         springs are written out; else a grid implies them:
//   QUARTERS      with shares of three bits, ten in a word; else one bit each
//   STRENGTH      with a factor on stiffness for each node
//   SLOTS n       places for nodes, those without one included
//   SPACING a     of the body, m
//   SUMS          the integrator adds up its passes
//   GUIDES        there are nodes of infinite mass
//   TILE          a work group keeps its nodes' positions at hand; what goes with it is in tiles.h
//   FLAT n        the state lies in textures of rows of n; else in buffers

#define FN
#define ASIDE
#define UNROLL
#define Real float
#define Real3 vec3
#define select(c, a, b) ((c) ? (a) : (b))
#define any_node(c) (c)

#ifdef FLAT
#define Floats sampler2D
#define at(field, slot) texelFetch(field, ivec2((slot) & (FLAT - 1), (slot) / FLAT), 0)
#else
#define Floats samplerBuffer
#define at(field, slot) texelFetch(field, slot)
#endif
