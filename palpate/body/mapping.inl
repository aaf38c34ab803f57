// mapping.inl: how a vertex of the fine surface follows its nodes (skinning), written once for every backend.
//
// Functions have GLSL's names, which C++ supplies as well (dot, cross, max, mix, inversesqrt). In C++ this file is
// included inside a struct, in GLSL at global scope. It uses from there:
//   FN              what stands before a function
//   Real, Real3     a number, a vector
//   select(c, a, b) a where c holds, b elsewhere
//   x_of(v)         the first component of a vector; abs(a)

// A mapped vertex: its position, and three vectors that transform directions at it. In a cell and on frames these are
// the columns of the deformation gradient (the Jacobian of the mapping); on a triangle, its basis.
struct MappedVertex {
    Real3 position;
    Real3 x, y, z;
};

// The unit vector along v, or `otherwise` if v is zero or not finite.
FN Real3 direction(Real3 v, Real3 otherwise) {
    Real square = dot(v, v);
    return select(square > Real(1e-37f), select(square < Real(3e38f), inversesqrt(square) * v, otherwise), otherwise);
}

FN Real3 any_perpendicular(Real3 n) {
    return cross(n, select(abs(x_of(n)) < Real(0.6f), Real3(1.0f, 0.0f, 0.0f), Real3(0.0f, 1.0f, 0.0f)));
}

// The vector with components x, y and z in the three vectors.
FN Real3 expand(MappedVertex f, Real x, Real y, Real z) { return x * f.x + (y * f.y + z * f.z); }

// A normal transforms by the inverse transpose of the gradient, up to scale by its cofactors, which need no division.
FN Real3 normal_by_cofactors(MappedVertex f, Real x, Real y, Real z, Real3 at_rest) {
    return direction(x * cross(f.y, f.z) + (y * cross(f.z, f.x) + z * cross(f.x, f.y)), at_rest);
}

// A tangent made perpendicular to the normal (Gram-Schmidt).
FN Real3 upright(Real3 tangent, Real3 normal) {
    return direction(tangent - dot(tangent, normal) * normal,
                     direction(any_perpendicular(normal), Real3(1.0f, 0.0f, 0.0f)));
}

// Trilinear interpolation in a cell, of its eight corners: x runs fastest. x, y, z: the place in the cell, 0 to 1
// along each axis.
FN MappedVertex in_cell(Real3 corner[8], Real x, Real y, Real z) {
    Real3 along_00 = corner[1] - corner[0], along_10 = corner[3] - corner[2];
    Real3 along_01 = corner[5] - corner[4], along_11 = corner[7] - corner[6];
    Real3 at_00 = corner[0] + x * along_00, at_10 = corner[2] + x * along_10;
    Real3 at_01 = corner[4] + x * along_01, at_11 = corner[6] + x * along_11;
    Real3 up_0 = at_10 - at_00, up_1 = at_11 - at_01;
    Real3 at_0 = at_00 + y * up_0, at_1 = at_01 + y * up_1;
    Real3 along_0 = along_00 + y * (along_10 - along_00), along_1 = along_01 + y * (along_11 - along_01);
    MappedVertex f;
    f.x = along_0 + z * (along_1 - along_0);
    f.y = up_0 + z * (up_1 - up_0);
    f.z = at_1 - at_0;
    f.position = at_0 + z * f.z;
    return f;
}

// An approximate normal made unit, or shorter where the neighbours' unit vectors nearly cancel, so that its direction
// is unreliable.
FN Real3 clear_direction(Real3 normal) {
    return min(inversesqrt(dot(normal, normal) + Real(1e-30f)), Real(2.0f)) * normal;
}

// The basis on a triangle of nodes (2005, eq. 6 and 8), with every vector normalised: the paper's N, B and Nc are of
// unit length only if the triangle has a right angle. Eq. 8's order, Bc = Nc x T and Tc = Bc x Nc, is kept.
// `approximate`: the mean of the corners' approximate normals; `curvature`: how far the basis turns to it, 0 to 1. A
// degenerate triangle uses what is still defined, and the world's axes for the rest. x runs along the triangle, y out
// of it, z across.
FN MappedVertex on_triangle(Real3 a, Real3 b, Real3 c, Real3 approximate, Real curvature) {
    Real3 nothing = Real3(0.0f, 0.0f, 0.0f);
    Real3 along_b = b - a, along_c = c - a, area = cross(along_b, along_c);
    // In a degenerate triangle, rounding leaves a little area whose direction is arbitrary.
    Real3 flat_normal =
        select(dot(area, area) > Real(1e-12f) * dot(along_b, along_b) * dot(along_c, along_c), direction(area, nothing), nothing);
    Real3 turned = select(dot(approximate, approximate) > Real(0.0025f), direction(approximate, flat_normal), flat_normal);
    MappedVertex f;
    f.position = nothing;
    f.y = direction(flat_normal + curvature * (turned - flat_normal), Real3(0.0f, 0.0f, 1.0f));
    Real3 along = direction(along_b, any_perpendicular(f.y));
    f.z = direction(cross(f.y, along), direction(any_perpendicular(f.y), Real3(1.0f, 0.0f, 0.0f)));
    f.x = cross(f.z, f.y);
    return f;
}
