#pragma once
#include "palpate/base/names.h"

#include <span>

namespace palpate {

/// What resists the deformation of a solid (docs/why-physics.md, "Two models of a solid").
enum class MaterialModel {
    automatic,  // tissue where a Young's modulus is given and no links are; springs otherwise
    tissue,     // cells of a neo-Hookean solid, of any Poisson's ratio, which return from any shape
    springs,    // the lattice of 2005: 18 springs a node, whose Poisson's ratio is 1/4
};

inline std::span<const Named<MaterialModel>> names(MaterialModel) {
    static constexpr Named<MaterialModel> all[] = {{MaterialModel::automatic, "automatic"},
                                                   {MaterialModel::tissue, "tissue"},
                                                   {MaterialModel::springs, "springs"}};
    return all;
}

/// How strong the springs are at the rim of a body, where some of the cells around them are empty
/// (docs/why-physics.md, "The lattice is a solid").
enum class Links {
    automatic,  // cells where a Young's modulus is given, equal where a stiffness is
    cells,      // each spring weighs by how many of the cells around it are filled: the bulk's modulus at any
                // thickness
    equal,      // every spring alike, as in the 2005 paper: thin parts are too soft
};

inline std::span<const Named<Links>> names(Links) {
    static constexpr Named<Links> all[] = {
        {Links::automatic, "automatic"}, {Links::cells, "cells"}, {Links::equal, "equal"}};
    return all;
}

/// How strong the three kinds of springs of 2012, section 3, are, N/m. A zero: they resist nothing.
struct SpringKinds {
    float structural = 0;  // to the next node along an axis: resists stretching
    float shear = 0;       // to the next node across a diagonal: resists shearing
    float flexion = 0;     // to the next but one along an axis: resists bending

    bool operator==(const SpringKinds&) const = default;
};

/// What a body is made of. Give a modulus or a stiffness, and a density or a mass; a zero says
/// "not given".
struct Material {
    float youngs_modulus = 0;  // Pa; brain about 1e3 to 1e4, skin 1e5
    float poisson = 0.45f;     // Poisson's ratio of tissue; springs have 1/4 whatever stands here
    float stiffness = 0;       // N/m of each spring
    float density = 0;         // kg/m³; water is 1000
    float mass = 0;            // kg, of the whole body
    float damping = 0;         // 1/s; free motion decays as exp(-damping · t / 2)
    float link_damping = 0;    // s; each spring resists its stretching with this × its stiffness, N s/m
    MaterialModel model = MaterialModel::automatic;
    Links links = Links::automatic;

    bool operator==(const Material&) const = default;
};

/// Whether a solid of it is made of cells of tissue.
inline bool is_tissue(const Material& material) {
    if (material.model != MaterialModel::automatic) return material.model == MaterialModel::tissue;
    return material.youngs_modulus > 0 && material.links == Links::automatic;
}

}  // namespace palpate
