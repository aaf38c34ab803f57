#pragma once
#include "palpate/body/body.h"
#include "palpate/solver/forces.h"

#include <span>
#include <vector>

// Tissue against theory and against finite elements: tests hold what is quick to bounds, `palpate bench
// tissue` prints all of it for docs/results.md.

namespace palpate::studies {

inline constexpr double density = 1000;  // kg/m³, of all tissue here

// ---- small deformations: equilibrium of the linear system ----

/// The sag under its own weight of a square cantilever of tissue, `cells` thick and twelve times as long,
/// over that of Timoshenko's beam theory.
double tissue_sag(int cells, float poisson);
/// The same of the solid itself, whose width the wall holds too, as CalculiX computes it. It needs the
/// program ccx. Throws Error if that fails.
double solid_sag(double poisson);

/// The torque that twists a square bar of tissue, `cells` thick and eight times as long, with ends that are
/// free to warp, over Saint-Venant's.
double tissue_torque(int cells, float poisson);

// ---- a tip that presses, brought to rest by damped motion ----

/// A rigid sphere on a square block that is held at its bottom; lengths in spacings.
struct Indenter {
    int width, height;  // of the block
    double radius;
    float poisson;
};
struct Indentation {
    double depth, contact;  // of the surface, and Hertz's radius of contact, in spacings
    double over_hertz;      // the force over that on a half-space (Hertz 1882),
    double over_layer;      // and over that on a layer bonded to its ground (Dimitriadis et al. 2002)
};
/// At each depth of the tip in turn, in spacings.
std::vector<Indentation> indent(const Indenter& indenter, std::span<const double> depths);

/// A block of Poisson's ratio 0.49, from whose height a ball presses away a third.
struct UnderABall {
    double depth;            // of the height, where the block is lowest
    double volume;           // over that at rest
    std::size_t inside_out;  // how many cells
};
UnderABall press_with_a_ball();

// ---- large deformations, which CalculiX computes too ----

/// A box of a neo-Hookean solid.
struct Block {
    dvec3 size = dvec3(0.04);      // m
    double youngs_modulus = 5000;  // Pa
    double poisson = 0.45;
    double gravity = 0;  // m/s², along -y
};

/// What is bonded to the top of a block, which stands on its bottom and is bonded there, and presses it down:
/// a flat plate, at whose rim the exact solution has infinite stresses; or one whose depth goes as sin² along
/// both sides of the top, which leaves the rim in peace.
enum class Plate { flat, dished };
/// Where a point of the top goes; `depth`: in the middle, of the height.
dvec3 pressed_to(const Block& block, Plate plate, double depth, dvec3 place);

struct PressedBlock {
    double depth;           // of the height
    double force;           // N
    double volume;          // over that at rest
    double energy;          // J
    double energy_by_ours;  // J, that the tissue's law gives these displacements
};
/// At each depth in turn; `cells`: along the height.
std::vector<PressedBlock> press(const Block& block, Plate plate, std::span<const double> depths, int cells);

/// A box that is bonded to a wall at x = 0 and bends far under its own weight.
inline const Block beam{.size = {0.08, 0.04, 0.04}, .youngs_modulus = 20'000, .gravity = 9.81};
struct BentBeam {
    double sag;     // m, of the middle of its free end
    double volume;  // over that at rest
};
BentBeam bend(const Block& beam, int cells);

/// The same by CalculiX, with hexahedra of 20 nodes; `elements`: along the height, an even number. It needs
/// the program ccx. Throws Error if that fails.
std::vector<PressedBlock> press_by_elements(const Block& block, Plate plate, std::span<const double> depths,
                                            int elements);
BentBeam bend_by_elements(const Block& beam, int elements);

/// CalculiX's neo-Hookean law is another one than ours, with the same moduli where deformations are small.
/// Both give the energy of a deformation gradient, over the volume at rest, Pa.
class Laws {
 public:
    Laws(double youngs_modulus, double poisson);
    double tissue(const dmat3& gradient) const;
    double calculix(const dmat3& gradient) const;

    double shear, bulk;  // moduli, Pa

 private:
    Body cell_;  // one cell of 1 m
    Forces terms_{cell_};
};

/// The stress in a bar of tissue that is pressed together by a part of its length, with free sides, over that
/// by CalculiX's law.
double bar_over_calculix(double poisson, double shortening);

/// The highest frequency of tissue that is pressed together like that bar, over that at rest, by which steps
/// are chosen.
double frequency_when_pressed(double poisson, double shortening);

}  // namespace palpate::studies
