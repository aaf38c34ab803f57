// dent.inl: how Gaussian dents deform a surface, written once for C++ and GLSL (Luciano, Banerjee and Rizzi 2007,
// section IV).
//
// Functions have GLSL's names, which C++ supplies as well (cross, dot, exp, normalize). In C++ this file is included
// inside a struct, in GLSL at global scope. It uses from there:
//   FN              what stands before a function
//   Real, Real3     a number, a vector
//   select(c, a, b) a where c holds, b elsewhere
//   dent_count      how many dents there are
//   dent(i)         one of them: its centre, depth, width and facing
// Places are always those of the surface without dents, so that all stages of a shader measure in the same
// space.

// The vector from the centre of dent i, in widths.
FN Real3 widths_away(int i, Real3 place) { return (place - dent(i).centre) * (Real(1.0f) / dent(i).width); }

FN Real depth_of(int i, Real3 away) { return dent(i).depth * exp(Real(-0.5f) * dot(away, away)); }

// The direction against which dent i moves a place.
FN Real3 facing_of(int i, Real3 normal) {
    Real3 facing = dent(i).facing;
    return select(dot(facing, facing) > Real(0.0f), facing, normal);
}

// The displacement of a place by all dents.
FN Real3 moved(Real3 place, Real3 normal) {
    Real3 sum = Real3(0.0f, 0.0f, 0.0f);
    for (int i = 0; i < dent_count; ++i) sum -= depth_of(i, widths_away(i, place)) * facing_of(i, normal);
    return sum;
}

FN Real depth_at(Real3 place, Real3 normal) { return -dot(moved(place, normal), normal); }

FN Real3 dented(Real3 place, Real3 normal) { return place + moved(place, normal); }

// The normal transforms by the cofactors of the Jacobian of the displacement, whose columns are x, y and z. That is
// exact for dents with `facing`. For dents along the surface's own normals, these are taken to be parallel; this
// equals the paper's rotation, but needs neither its angle nor its axis, which is undefined at the contact. The
// normal stays as it is if the dents are too far away to matter, or so deep that the Jacobian is degenerate.
FN Real3 dented_normal(Real3 place, Real3 normal) {
    Real3 x = Real3(1.0f, 0.0f, 0.0f), y = Real3(0.0f, 1.0f, 0.0f), z = Real3(0.0f, 0.0f, 1.0f);
    for (int i = 0; i < dent_count; ++i) {
        Real3 away = widths_away(i, place), facing = facing_of(i, normal);
        Real3 slope = depth_of(i, away) * (Real(1.0f) / dent(i).width) * away;
        x += slope.x * facing;
        y += slope.y * facing;
        z += slope.z * facing;
    }
    Real3 turned = normal.x * cross(y, z) + normal.y * cross(z, x) + normal.z * cross(x, y),
          by = turned - normal;
    Real size = dot(turned, turned);
    return select(dot(by, by) > Real(0.0f) && size > Real(1e-12f) && size < Real(1e30f), normalize(turned),
                  normal);
}
