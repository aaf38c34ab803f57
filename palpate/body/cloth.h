#pragma once
#include "palpate/body/body.h"
#include "palpate/body/material.h"
#include "palpate/mesh/mesh.h"

#include <span>

namespace palpate {

/// What a cloth is made of. Give a density or a mass.
struct ClothSettings {
    SpringKinds stiffness = {.structural = 100, .shear = 50, .flexion = 5};  // N/m
    /// N m: how stiff a sheet of any triangles is in bending by the angles between them (bending() below).
    /// Besides it flexion springs, which resist stretching too, are best 0.
    float bending = 0;
    float density = 0;       // kg/m²; a shirt is 0.15, or
    float mass = 0;          // kg, of the whole
    float damping = 0;       // 1/s, of velocities
    float link_damping = 0;  // s: a spring resists its stretching with this × its stiffness, N s/m
};

/// A rectangle of `dims` nodes in the plane z = 0, node (0, 0) at the origin, its normal along +z. 12 springs
/// a node: 4 structural, 4 shear, 4 flexion (2012, section 3). Each node weighs by the squares around it.
/// Throws Error if `bending` is given: flexion springs are what it bends by.
Body cloth(ivec2 dims, float spacing, const ClothSettings& settings);

/// A sheet of any triangles, open or closed: a node a vertex, a structural spring an edge, a flexion spring
/// between the two vertices opposite an edge. Triangles are rigid in shear by themselves, so `shear` is not
/// used. Each node weighs by a third of its triangles. The mesh is welded (mesh/repair.h) and manifold:
/// throws Error if a vertex belongs to no triangle or to several fans of them, naming the first.
Body cloth(const Mesh& mesh, const ClothSettings& settings);

/// Hinges between a body's faces, which are at rest as it is, whatever its shape: a plate of `rigidity` N m,
/// which is E t³ / 12 (1 - ν²). Each is as stiff as rigidity × length² of its edge / area of its two
/// triangles. Of equilateral triangles that is exact for every bend, with a Poisson's ratio of -1/3 (Seung
/// and Nelson 1988); of squares, each cut in two, for bends along their sides. Elsewhere the mesh shows:
/// equilateral triangles whose corners were moved by up to a fifth of a side are 8 % too stiff, and squares
/// that are all cut alike 0.8 to 3 times as stiff as they should be, depending on how they are bent. An edge
/// beside a triangle without area gets no hinge. Throws Error where faces do not lie on one sheet.
Bending bending(const Body& sheet, float rigidity);

/// Any net of springs; one whose rest length is 0 is as long as its nodes are apart. `masses`: kg, one a
/// node; 0 pins it. `faces`: triangles of its nodes, counter-clockwise from outside, for a surface to hang
/// on; may be empty. Throws Error if a spring or a face names no node.
Body net(std::span<const vec3> positions, std::span<const float> masses, std::span<const Spring> springs,
         std::span<const uvec3> faces = {});

/// The faces of a sheet or a net as a surface to draw.
Mesh face_mesh(const Body& body);

}  // namespace palpate
