// dent.inl: what dents make of a surface, written once for C++ and GLSL (Luciano, Banerjee and Rizzi 2007, section IV).
//
// The words are GLSL's; C++ brings the same ones (dot, exp, normalize). In C++ this file is included inside a struct, in
// GLSL at global scope, and finds there:
//   FN              what stands before a function
//   Real, Real3     a number, a vector
//   select(c, a, b) a where c holds, b elsewhere
//   dent_count      how many dents there are
//   dent(i)         one of them: its centre, depth, width and facing
//   min, max        of two numbers
// Places are always those of the surface without dents, so that all stages of a shader measure in the same space.

// How many widths from the middle of dent i.
FN Real3 widths_away(int i, Real3 place) { return (place - dent(i).centre) * (Real(1.0f) / dent(i).width); }

// How much of dent i a surface takes that looks this way.
FN Real share_of(int i, Real3 normal) {
    Real3 facing = dent(i).facing;
    Real part = min(max(Real(2.0f) * dot(facing, normal), Real(0.0f)), Real(1.0f));
    return select(dot(facing, facing) > Real(0.0f), part * part * (Real(3.0f) - Real(2.0f) * part), Real(1.0f));
}

FN Real depth_of(int i, Real3 away) { return dent(i).depth * exp(Real(-0.5f) * dot(away, away)); }

// How deep all of them are.
FN Real depth_at(Real3 place, Real3 normal) {
    Real depth = Real(0.0f);
    for (int i = 0; i < dent_count; ++i) depth += share_of(i, normal) * depth_of(i, widths_away(i, place));
    return depth;
}

// Which way that grows along the surface, and how fast.
FN Real3 slope_at(Real3 place, Real3 normal) {
    Real3 slope = Real3(0.0f, 0.0f, 0.0f);
    for (int i = 0; i < dent_count; ++i) {
        Real3 away = widths_away(i, place);
        slope -= share_of(i, normal) * depth_of(i, away) * (Real(1.0f) / dent(i).width) * away;
    }
    return slope;
}

FN Real3 dented(Real3 place, Real3 normal) { return place - depth_at(place, normal) * normal; }

// Turned towards where it gets deeper, by the arctangent of the slope along the surface: the paper's rotation, without an
// angle, and without its axis, which has no direction at the contact. Dents too far off to matter leave the normal as it is.
FN Real3 dented_normal(Real3 place, Real3 normal) {
    Real3 slope = slope_at(place, normal);
    return select(dot(slope, slope) > Real(0.0f), normalize(normal + (slope - dot(slope, normal) * normal)), normal);
}
