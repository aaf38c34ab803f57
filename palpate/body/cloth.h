#pragma once
#include "palpate/body/body.h"
#include "palpate/body/material.h"
#include "palpate/mesh/mesh.h"

#include <span>

namespace palpate {

/// What a cloth is made of. Give a density or a mass.
struct ClothSettings {
    SpringKinds stiffness = {.structural = 100, .shear = 50, .flexion = 5};  // N/m
    float density = 0;                                                       // kg/m²; a shirt is 0.15, or
    float mass = 0;                                                          // kg, of the whole
    float damping = 0;                                                       // 1/s, of velocities
    float link_damping = 0;  // s: a spring resists its stretching with this × its stiffness, N s/m
};

/// A rectangle of `dims` nodes in the plane z = 0, node (0, 0) at the origin, its normal along +z. 12 springs
/// a node: 4 structural, 4 shear, 4 flexion (2012, section 3). Each node weighs by the squares around it.
Body cloth(ivec2 dims, float spacing, const ClothSettings& settings);

/// A sheet of any triangles, open or closed: a node a vertex, a structural spring an edge, a flexion spring
/// between the two vertices opposite an edge. Triangles are rigid in shear by themselves, so `shear` is not
/// used. Each node weighs by a third of its triangles. The mesh is welded (mesh/repair.h) and manifold:
/// throws Error if a vertex belongs to no triangle or to several fans of them, naming the first.
Body cloth(const Mesh& mesh, const ClothSettings& settings);

/// Any net of springs; one whose rest length is 0 is as long as its nodes are apart. `masses`: kg, one a
/// node; 0 pins it. `faces`: triangles of its nodes, counter-clockwise from outside, for a surface to hang
/// on; may be empty. Throws Error if a spring or a face names no node.
Body net(std::span<const vec3> positions, std::span<const float> masses, std::span<const Spring> springs,
         std::span<const uvec3> faces = {});

/// The faces of a sheet or a net as a surface to draw.
Mesh face_mesh(const Body& body);

}  // namespace palpate
