#include "palpate/body/tissues.h"

#include "palpate/base/error.h"
#include "palpate/base/nearest.h"

#include <fmt/format.h>

#include <string>
#include <vector>

namespace palpate {
namespace {

constexpr float tissue_poisson = 0.45f, gel_poisson = 0.48f;
constexpr float tissue_damping = 10, gel_damping = 3;  // 1/s

// Young's modulus, Pa, by a shear modulus or the speed of a shear wave in what keeps its volume.
constexpr float by_shear(float modulus) { return 3 * modulus; }
constexpr float by_speed(float speed, float density) { return by_shear(density * speed * speed); }
// By the shear modulus of what does not keep its volume.
constexpr float by_shear(float modulus, float poisson) { return 2 * (1 + poisson) * modulus; }
// By the stress at which a neo-Hookean solid is twice as long.
constexpr float by_doubling(float stress) { return by_shear(stress / 1.75f); }
// By the stress at which something is a quarter shorter.
constexpr float by_quarter(float stress) { return 4 * stress; }

constexpr float psi = 6895;  // Pa

// Sources of several tissues.
constexpr std::string_view arda = "Arda et al. 2011, AJR 197:532: shear-wave ultrasound, 127 volunteers";
constexpr std::string_view samani =
    "Samani et al. 2007, Phys Med Biol 52:1565: indentation of 169 fresh samples";

constexpr Tissue all_tissues[] = {
    {"liver", "healthy, in vivo; cirrhosis makes it several times as stiff", by_shear(2090), by_shear(1680),
     by_shear(2480), tissue_poisson, 1060, tissue_damping,
     "Venkatesh et al. 2014, J Magn Reson Imaging 39:1: MR elastography, 41 volunteers"},
    {"kidney", "the cortex, in vivo", 5000, 2100, 7900, tissue_poisson, 1050, tissue_damping, arda},
    {"spleen", "in vivo; ultrasound found a third of it (Arda 2011)", by_shear(3565), by_shear(2353),
     by_shear(5581), tissue_poisson, 1060, tissue_damping,
     "Mannelli et al. 2010, AJR 195:387: MR elastography at 60 Hz, 16 volunteers"},
    {"pancreas", "in vivo", 4800, 1800, 7800, tissue_poisson, 1040, tissue_damping, arda},
    {"thyroid", "in vivo", 10'970, 7870, 14'070, tissue_poisson, 1050, tissue_damping, arda},
    {"brain", "the mean of grey matter (1.39 kPa) and white (1.90 kPa), of cattle", 1640, 1100, 2490,
     tissue_poisson, 1040, tissue_damping,
     "Budday et al. 2015, J Mech Behav Biomed Mater 46:318: indentation of slices, 192 tests"},
    {"heart", "muscle of the septum between beats, across its fibres; less along them", by_speed(1.82f, 1060),
     by_speed(1.29f, 1060), by_speed(1.96f, 1060), tissue_poisson, 1060, tissue_damping,
     "Song et al. 2016, J Ultrasound Med 35:1419: speed of shear waves, 10 volunteers"},
    {"muscle", "of the thigh, at rest; a few times as stiff when it pulls", by_shear(4230), by_shear(3910),
     by_shear(6150), tissue_poisson, 1050, tissue_damping,
     "Chakouch et al. 2015, PLoS One 10:e0138873: MR elastography, nine muscles of 29 volunteers"},
    {"fat", "of the breast", 3250, 2340, 4160, tissue_poisson, 950, tissue_damping, samani},
    {"breast", "its gland", 3240, 2630, 3850, tissue_poisson, 1020, tissue_damping, samani},
    {"fibroadenoma", "a benign lump of the breast, taken to be as dense as the gland", 6410, 3550, 9270,
     tissue_poisson, 1020, tissue_damping, samani},
    {"carcinoma", "invasive ductal, of high grade, taken to be as dense as the gland", 42'520, 30'050, 54'990,
     tissue_poisson, 1020, tissue_damping, samani},
    {"skin", "of the forearm, sucked outward; pushed in, it is softer", 129'000, 41'000, 217'000,
     tissue_poisson, 1090, tissue_damping,
     "Diridollou et al. 2000, Skin Res Technol 6:214: suction, 10 volunteers"},
    {"prostate", "without cancer, ex vivo; with cancer 24 kPa", 17'000, 8000, 26'000, tissue_poisson, 1040,
     tissue_damping, "Ahn et al. 2010, Urology 76:1007: indentation, 46 glands"},
    {"lung", "with air in it, between breathed out and full", by_shear(1485, 0.43f), by_shear(1140, 0.43f),
     by_shear(1830, 0.43f), 0.43f, 260, tissue_damping,
     "Mariappan et al. 2011, J Magn Reson Imaging 33:1351: MR elastography, 10 "
     "volunteers; Poisson's ratio: Lai-Fook et al. 1976, J Appl Physiol 40:508, dogs"},
    {"gelatine", "5 % in water; the range is of 3 to 7 %; density by mixing", by_shear(4180), by_shear(2010),
     by_shear(10'240), gel_poisson, 1010, gel_damping,
     "Nguyen et al. 2014, Ultrasound Med Biol 40:168: speed of shear waves"},
    {"agar", "a gel that loses water when it is pressed; density of water", 52'000, 52'000, 79'000, 0.32f,
     1000, gel_damping,
     "Ross and Scanlon 1999, J Texture Stud 30:17: compression, and Poisson's ratio; the high end by "
     "indentation"},
    {"cryogel", "10 % polyvinyl alcohol in water, frozen and thawed twice; density by mixing", 79'000, 68'000,
     90'000, gel_poisson, 1020, gel_damping,
     "King et al. 2011, Ultrasound Med Biol 37:827: tension, for phantoms of vessels"},
    {"silicone", "Ecoflex 00-30; the range is from 00-10 to 00-50", by_doubling(10 * psi),
     by_doubling(8 * psi), by_doubling(12 * psi), gel_poisson, 1070, gel_damping,
     "Smooth-On, Ecoflex Series, technical bulletin: stress at 100 % strain, of a neo-Hookean solid"},
    {"sponge", "rubber with open cells, soft; Poisson's ratio and density are those of common ones",
     by_quarter(25'000), by_quarter(15'000), by_quarter(35'000), 0.3f, 330, tissue_damping,
     "ASTM D1056, grade 1: the stress at 25 % compression that it asks for"},
};

}  // namespace

Material Tissue::material() const {
    return {.youngs_modulus = youngs_modulus,
            .poisson = poisson,
            .density = density,
            .damping = damping,
            .model = MaterialModel::tissue};
}

std::span<const Tissue> tissues() { return all_tissues; }

const Tissue& tissue_named(std::string_view name, std::string_view where) {
    std::vector<std::string> names;
    for (const Tissue& one : all_tissues) {
        if (one.name == name) return one;
        names.emplace_back(one.name);
    }
    const std::string meant = nearest(name, names);
    throw Error(
        fmt::format("no tissue \"{}\"", name), where,
        fmt::format("{}choose from {}", meant.empty() ? "" : fmt::format("did you mean \"{}\"? Or ", meant),
                    fmt::join(names, ", ")));
}

}  // namespace palpate
