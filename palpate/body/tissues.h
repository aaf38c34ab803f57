#pragma once
#include "palpate/body/material.h"

#include <span>
#include <string_view>

namespace palpate {

/// What a tissue, or something that stands in for one, is made of, as it was published (docs/tissues.md says
/// how to choose among them).
///
/// The moduli are those of small and slow deformations. Where a shear modulus µ was published, or the speed
/// of a shear wave, Young's modulus is 3 µ, as of what keeps its volume. Densities of the body's own tissues
/// are those of ICRU Reports 44 (1989) and 46 (1992).
///
/// Two numbers are our choice and were not published. Poisson's ratio: tissue full of water keeps its
/// volume, but the nearer the ratio is to 1/2, the shorter the steps; where it was measured, `source` says
/// so. Damping: the one value at which a tissue stops swinging within some tenths of a second.
struct Tissue {
    std::string_view name, about;
    float youngs_modulus;  // Pa
    float low, high;       // Pa; its published range
    float poisson;
    float density;  // kg/m³
    float damping;  // 1/s
    std::string_view source;

    Material material() const;
};

/// The tissues that come with Palpate.
std::span<const Tissue> tissues();

/// The tissue of that name. If there is none, throws an Error that lists the names. `where`: who asks for it.
const Tissue& tissue_named(std::string_view name, std::string_view where = "the list of tissues");

}  // namespace palpate
