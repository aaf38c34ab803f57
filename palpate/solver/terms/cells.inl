// cells.inl: cells of tissue. It stands in node.inl, in the same words; a backend supplies the cells.
//
// A cell is a cube of a neo-Hookean solid with one integration point. F, the mean of its edges over the edge at rest, gives
// the energy for each volume at rest
//   mu/2 (|F|^2 - 3) + r/2 (lambda d^2 + mu min(d, 0)^2) - mu (min(d, 0) + ln max(J, 1)),   J = det F, d = J - 1.
// It is finite where a cell is flat or inside out, and there pushes it back. r = 1 / (1 + 4 u^2), u = max(|F|^2/3 - 1, 0),
// lowers the bulk modulus of a cell that is drawn out, so that the step which holds at rest holds there too. What F does not
// see are twelve ways to bend and twist the cell, the hourglasses; springs resist them, the first nine with E h/48, so that
// a bar one cell thick bends as beams do, the last three with mu h/16 (Flanagan and Belytschko 1981 name and control them).
//
// stiffness_times is C : dE, of the rate of the Green strain E and the moduli at rest: at rest that is the derivative of the
// forces, elsewhere it leaves out the stress's own part, and so is never negative and does not resist a rotation. It too is
// eased where a cell is drawn out.

// Of corner k: x in the lowest bit, then y, then z.
struct Eight {
    Real3 c[8];
};

// One component of eight vectors. One is worked out after the other, since eight numbers fit into sixteen registers.
struct EightReals {
    Real c[8];
};

FN EightReals x_of(Eight e) {
    EightReals x;
    UNROLL for (int k = 0; k < 8; ++k) x.c[k] = e.c[k].x;
    return x;
}
FN EightReals y_of(Eight e) {
    EightReals y;
    UNROLL for (int k = 0; k < 8; ++k) y.c[k] = e.c[k].y;
    return y;
}
FN EightReals z_of(Eight e) {
    EightReals z;
    UNROLL for (int k = 0; k < 8; ++k) z.c[k] = e.c[k].z;
    return z;
}
FN Eight vectors(EightReals x, EightReals y, EightReals z) {
    Eight e;
    UNROLL for (int k = 0; k < 8; ++k) e.c[k] = Real3(x.c[k], y.c[k], z.c[k]);
    return e;
}

// Sums and differences along the three axes, but for the sum of all, in whose place is 0. Corners are subtracted from each
// other before anything is added, since they may be far from where they count from.
FN EightReals sums_and_differences(EightReals e) {
    Real x0 = e.c[1] - e.c[0], x1 = e.c[3] - e.c[2], x2 = e.c[5] - e.c[4], x3 = e.c[7] - e.c[6];  // edges along x
    Real y = (e.c[2] - e.c[0]) + (e.c[3] - e.c[1]);  // from the first of these to the others, twice
    Real z = (e.c[4] - e.c[0]) + (e.c[5] - e.c[1]);
    Real yz = (e.c[6] - e.c[0]) + (e.c[7] - e.c[1]);
    EightReals mode;
    mode.c[0] = Real(0.0f);
    mode.c[1] = (x0 + x1) + (x2 + x3);
    mode.c[2] = y + (yz - z);
    mode.c[3] = (x1 - x0) + (x3 - x2);
    mode.c[4] = (yz + z) - y;
    mode.c[5] = (x2 + x3) - (x0 + x1);
    mode.c[6] = (yz - z) - y;
    mode.c[7] = (x3 - x2) - (x1 - x0);
    return mode;
}

FN EightReals transposed_sums(EightReals e) {
    UNROLL for (int axis = 0; axis < 3; ++axis)
        UNROLL for (int k = 0; k < 8; ++k)
            if ((k >> axis & 1) == 0) {
                Real a = e.c[k], b = e.c[k + (1 << axis)];
                e.c[k] = a - b;
                e.c[k + (1 << axis)] = a + b;
            }
    return e;
}

// 1, 2 and 4 are four times the mean edges; 3, 5, 6 and 7 the hourglasses.
FN Eight modes(Eight e) {
    return vectors(sums_and_differences(x_of(e)), sums_and_differences(y_of(e)), sums_and_differences(z_of(e)));
}

// The transpose: what is given by modes, of which the first is 0, on all corners; or on one.
FN Eight on_corners(Eight e) {
    return vectors(transposed_sums(x_of(e)), transposed_sums(y_of(e)), transposed_sums(z_of(e)));
}

FN Real3 on_corner(Eight e, int k) {
    Real x = Real(float((k & 1) * 2 - 1)), y = Real(float((k >> 1 & 1) * 2 - 1)), z = Real(float((k >> 2) * 2 - 1));
    return x * e.c[1] + y * e.c[2] + z * e.c[4] + (x * y) * e.c[3] + (x * z) * e.c[5] + (y * z) * e.c[6] +
           (x * y * z) * e.c[7];
}

// F by its columns, and what the energy is made of.
struct Deformation {
    Real3 f0, f1, f2;  // columns of F,
    Real3 k0, k1, k2;  // and of its cofactors
    Real d, drawn;     // J - 1; u
};

FN Deformation deformation(Eight mode) {
    Real to_f = Real(0.25f / pass.cell_size);
    Deformation now;
    now.f0 = to_f * mode.c[1] + cell_axis(0);
    now.f1 = to_f * mode.c[2] + cell_axis(1);
    now.f2 = to_f * mode.c[4] + cell_axis(2);
    now.k0 = cross(now.f1, now.f2);
    now.k1 = cross(now.f2, now.f0);
    now.k2 = cross(now.f0, now.f1);
    now.d = dot(now.f0, now.k0) - Real(1.0f);
    Real square = dot(now.f0, now.f0) + dot(now.f1, now.f1) + dot(now.f2, now.f2);
    now.drawn = max(square * Real(1.0f / 3.0f) - Real(1.0f), Real(0.0f));
    return now;
}

FN Real eased(Real drawn) { return Real(1.0f) / (Real(1.0f) + Real(4.0f) * drawn * drawn); }

// What the mean edges feel, and beside it the hourglasses with a spring each.
FN Eight with_hourglasses(Eight push, Eight mode, Real weight) {
    Real bend = Real(pass.bend) * weight;
    push.c[0] = Real3(0.0f, 0.0f, 0.0f);
    push.c[3] = bend * mode.c[3];
    push.c[5] = bend * mode.c[5];
    push.c[6] = bend * mode.c[6];
    push.c[7] = (Real(pass.twist) * weight) * mode.c[7];
    return push;
}

// N, by modes: what a cell does to its corners.
FN Eight cell_forces(Eight corners, Real weight) {
    Eight mode = modes(corners), push;
    Deformation now = deformation(mode);
    Real squeezed = max(-now.d, Real(0.0f)), ease = eased(now.drawn);  // and d + squeezed = max(d, 0)
    Real area = Real(-0.25f * pass.cell_size * pass.cell_size) * weight;
    Real bulk = ease * (Real(pass.lame) * now.d - Real(pass.shear) * squeezed);
    Real pressure = area * (bulk - Real(pass.shear) / (Real(1.0f) + (now.d + squeezed)));
    Real tension = area * (Real(pass.shear) - (Real(8.0f / 3.0f) * now.drawn * ease) * (bulk * now.d));
    push.c[1] = tension * now.f0 + pressure * now.k0;
    push.c[2] = tension * now.f1 + pressure * now.k1;
    push.c[4] = tension * now.f2 + pressure * now.k2;
    return with_hourglasses(push, mode, Real(-1.0f) * weight);
}

// N, by modes: how a cell resists a displacement of its corners, m.
FN Eight cell_stiffness_times(Eight corners, Eight displacement, Real weight) {
    Eight change = modes(displacement), push;
    Deformation now = deformation(modes(corners));
    Real to_f = Real(0.25f / pass.cell_size);
    Real3 g0 = to_f * change.c[1], g1 = to_f * change.c[2], g2 = to_f * change.c[4];
    Real e00 = dot(now.f0, g0), e11 = dot(now.f1, g1), e22 = dot(now.f2, g2);  // the change of the Green strain
    Real e01 = Real(0.5f) * (dot(now.f0, g1) + dot(now.f1, g0)), e12 = Real(0.5f) * (dot(now.f1, g2) + dot(now.f2, g1));
    Real e20 = Real(0.5f) * (dot(now.f2, g0) + dot(now.f0, g2));
    Real twice = Real(2.0f * pass.shear), mean = Real(pass.lame) * (e00 + e11 + e22);
    Real size = Real(1.0f) + now.drawn;
    Real area = Real(0.25f * pass.cell_size * pass.cell_size) * weight / (size * size);
    push.c[1] = area * ((twice * e00 + mean) * now.f0 + (twice * e01) * now.f1 + (twice * e20) * now.f2);
    push.c[2] = area * ((twice * e01) * now.f0 + (twice * e11 + mean) * now.f1 + (twice * e12) * now.f2);
    push.c[4] = area * ((twice * e20) * now.f0 + (twice * e12) * now.f1 + (twice * e22 + mean) * now.f2);
    return with_hourglasses(push, change, weight);
}

// J.
ASIDE Real cell_energy(Eight corners, Real weight) {
    Eight mode = modes(corners);
    Deformation now = deformation(mode);
    Real square = dot(now.f0, now.f0) + dot(now.f1, now.f1) + dot(now.f2, now.f2);
    Real least = min(now.d, Real(0.0f)), volume = Real(pass.cell_size * pass.cell_size * pass.cell_size);
    Real density = Real(0.5f * pass.shear) * (square - Real(3.0f)) +
                   Real(0.5f) * eased(now.drawn) * (Real(pass.lame) * now.d * now.d + Real(pass.shear) * least * least) -
                   Real(pass.shear) * (least + log(max(now.d, Real(0.0f)) + Real(1.0f)));
    Real bent = dot(mode.c[3], mode.c[3]) + dot(mode.c[5], mode.c[5]) + dot(mode.c[6], mode.c[6]);
    Real hourglass = Real(0.5f * pass.bend) * bent + Real(0.5f * pass.twist) * dot(mode.c[7], mode.c[7]);
    return weight * (volume * density + hourglass);
}

// ---- what a node has of the cells around it ----

FN Eight cell_corners(int k) {
    Eight corners;
    UNROLL for (int c = 0; c < 8; ++c) corners.c[c] = cell_corner(k, c);
    return corners;
}
FN Eight cell_velocities(int k) {
    Eight corners;
    UNROLL for (int c = 0; c < 8; ++c) corners.c[c] = cell_corner_velocity(k, c);
    return corners;
}

// N, by modes: what the cell of which this node is corner k does, with the damping that is proportional to stiffness.
FN Eight damped_cell_forces(int k) {
    Eight corners = cell_corners(k);
    Eight force = cell_forces(corners, cell_weight(k));
    if (LINK_DAMPING) {
        Eight resistance = cell_stiffness_times(corners, cell_velocities(k), cell_weight(k));
        UNROLL for (int c = 0; c < 8; ++c) force.c[c] -= Real(pass.link_damping) * resistance.c[c];
    }
    return force;
}

#ifndef OWN_CELLS
FN Real3 cells_force() {
    Real3 force = Real3(0.0f, 0.0f, 0.0f);
    for (int k = 0; k < CELLS; ++k) force += on_corner(damped_cell_forces(k), k);
    return force;
}
#endif

// J, of the one of its cells of which this node is the lowest corner.
ASIDE Real own_cell_energy() { return cell_energy(cell_corners(0), cell_weight(0)); }

// 1 where that is stretched to ten times its size.
ASIDE Real own_cell_torn() {
    Deformation now = deformation(modes(cell_corners(0)));
    Real longest = max(max(dot(now.f0, now.f0), dot(now.f1, now.f1)), dot(now.f2, now.f2));
    return select(cell_weight(0) * (longest - Real(100.0f)) <= Real(0.0f), Real(0.0f), Real(1.0f));
}
