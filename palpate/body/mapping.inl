// mapping.inl: how a vertex of the fine surface follows the nodes that it hangs on, written once for every backend.
//
// The words are GLSL's; C++ brings the same ones (dot, cross, max, mix, inversesqrt). In C++ this file is included inside
// a struct, in GLSL at global scope, and finds there:
//   FN              what stands before a function
//   Real, Real3     a number, a vector
//   select(c, a, b) a where c holds, b elsewhere
//   x_of(v)         the first component of a vector; abs(a)

// Where a vertex is, and three vectors that carry what is fixed to it: in a cell and on frames the columns of the
// deformation's gradient, on a triangle the basis.
struct Followed {
    Real3 position;
    Real3 x, y, z;
};

// The unit vector along v, or `otherwise` where v has no direction.
FN Real3 direction(Real3 v, Real3 otherwise) {
    Real square = dot(v, v);
    return select(square > Real(1e-37f), select(square < Real(3e38f), inversesqrt(square) * v, otherwise), otherwise);
}

FN Real3 any_across(Real3 n) {
    return cross(n, select(abs(x_of(n)) < Real(0.6f), Real3(1.0f, 0.0f, 0.0f), Real3(0.0f, 1.0f, 0.0f)));
}

// Components in the three vectors, put together.
FN Real3 expand(Followed f, Real x, Real y, Real z) { return x * f.x + (y * f.y + z * f.z); }

// A normal moves with the inverse transpose of the gradient: its cofactors, which need no division.
FN Real3 normal_by_cofactors(Followed f, Real x, Real y, Real z, Real3 at_rest) {
    return direction(x * cross(f.y, f.z) + (y * cross(f.z, f.x) + z * cross(f.x, f.y)), at_rest);
}

// A tangent brought to right angles with the normal that it has now.
FN Real3 upright(Real3 tangent, Real3 normal) {
    return direction(tangent - dot(tangent, normal) * normal,
                     direction(any_across(normal), Real3(1.0f, 0.0f, 0.0f)));
}

// In a cell, by its eight corners: x runs fastest. x, y, z: where in it, 0 to 1 along each axis.
FN Followed in_cell(Real3 corner[8], Real x, Real y, Real z) {
    Real3 along_00 = corner[1] - corner[0], along_10 = corner[3] - corner[2];
    Real3 along_01 = corner[5] - corner[4], along_11 = corner[7] - corner[6];
    Real3 at_00 = corner[0] + x * along_00, at_10 = corner[2] + x * along_10;
    Real3 at_01 = corner[4] + x * along_01, at_11 = corner[6] + x * along_11;
    Real3 up_0 = at_10 - at_00, up_1 = at_11 - at_01;
    Real3 at_0 = at_00 + y * up_0, at_1 = at_01 + y * up_1;
    Real3 along_0 = along_00 + y * (along_10 - along_00), along_1 = along_01 + y * (along_11 - along_01);
    Followed f;
    f.x = along_0 + z * (along_1 - along_0);
    f.y = up_0 + z * (up_1 - up_0);
    f.z = at_1 - at_0;
    f.position = at_0 + z * f.z;
    return f;
}

// An approximate normal made unit; shorter where the neighbours' unit vectors cancel and leave it to chance.
FN Real3 clear_direction(Real3 normal) {
    return min(inversesqrt(dot(normal, normal) + Real(1e-30f)), Real(2.0f)) * normal;
}

// The basis on a triangle of nodes (2005, eq. 6 and 8) with every vector normalised: the paper's N, B and Nc are not of
// unit length unless the triangle has a right angle. Eq. 8's order, Bc = Nc x T and Tc = Bc x Nc, is kept. `approximate`:
// the mean of the corners' clear normals; `curvature`: how far the basis turns to it. A collapsed triangle takes what is
// still defined, and the world's axes for the rest. x runs along the triangle, y out of it, z across.
FN Followed on_triangle(Real3 a, Real3 b, Real3 c, Real3 approximate, Real curvature) {
    Real3 nothing = Real3(0.0f, 0.0f, 0.0f);
    Real3 along_b = b - a, along_c = c - a, area = cross(along_b, along_c);
    // Of a collapsed triangle, rounding leaves a little area, whose direction is chance.
    Real3 flat_normal =
        select(dot(area, area) > Real(1e-12f) * dot(along_b, along_b) * dot(along_c, along_c), direction(area, nothing), nothing);
    Real3 turned = select(dot(approximate, approximate) > Real(0.0025f), direction(approximate, flat_normal), flat_normal);
    Followed f;
    f.position = nothing;
    f.y = direction(flat_normal + curvature * (turned - flat_normal), Real3(0.0f, 0.0f, 1.0f));
    Real3 along = direction(along_b, any_across(f.y));
    f.z = direction(cross(f.y, along), direction(any_across(f.y), Real3(1.0f, 0.0f, 0.0f)));
    f.x = cross(f.z, f.y);
    return f;
}
