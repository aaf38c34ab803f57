#pragma once
#include "palpate/base/progress.h"
#include "palpate/body/body.h"
#include "palpate/body/material.h"
#include "palpate/mesh/mesh.h"

namespace palpate {

/// How fine a lattice is, and what it is made of.
struct LatticeSettings {
    int nodes = 20'000;  // how many nodes to aim for; what comes out is the nearest that a spacing can give
    float spacing = 0;   // m; if given, it decides and `nodes` does not
    Material material;
};

/// A mass-spring lattice that fills a closed mesh: cubic cells, and at their corners nodes with 18 springs
/// each, to the neighbours along the axes and the face diagonals (2005, section 3.1). Of springs with a
/// Young's modulus E each gets 0.4 · E · spacing; of tissue (MaterialModel) the cells are the solid, and
/// the springs have no stiffness and say who is whose neighbour. Parts thinner than a cell become one cell
/// thick, so that nothing vanishes and nothing comes apart; the mass is density × the mesh's volume whatever
/// the cells' own volume is. Throws Error if the mesh is not sound (check()) or encloses no volume, if the
/// material does not say one stiffness and one mass, if neither nodes nor a spacing are asked for, or if the
/// lattice would have more than 30 million cells in its box.
Body lattice(const Mesh& mesh, const LatticeSettings& settings, const Progress& progress = {});

/// Makes the lattice of a mesh one of another material, as if it had been made of that: no node is held and
/// no part is harder any more. `volume`: the mesh's, m³. False, and nothing changes, where that would have
/// other links at the rim (Material::links) or another model.
bool restuff(Body& body, const Material& from, const Material& to, double volume);

/// A plain box of `dims` nodes along each axis, 1 or more, at most 30 million, node (0, 0, 0) at the origin.
/// Of a Material{} of which nothing is said it is a cage: no force moves it, but others may. A dimension of
/// one node is a sheet, two are a thread: there no cell is filled, so they are of springs, which are as
/// strong as along the edge of a solid.
Body lattice(ivec3 dims, float spacing, const Material& material);

/// The volume of 2012, section 3: such a box with 32 springs a node, structural ones along the axes, shear
/// ones across the diagonals of faces and of cells, flexion ones to the next but one; all whole, at the rim
/// too. Of the material its mass and damping are taken.
Body lattice(ivec3 dims, float spacing, const SpringKinds& stiffness, const Material& material);

}  // namespace palpate
