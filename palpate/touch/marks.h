#pragma once
#include "palpate/body/dent.h"
#include "palpate/body/feel.h"
#include "palpate/body/patch.h"
#include "palpate/touch/proxy.h"

#include <span>
#include <vector>

namespace palpate {

/// The dent that a contact presses into a surface now, beside the lasting ones: as deep as the contact is
/// below those, up to the limit of a single press. Its depth is 0 if it presses none.
Dent dent_under(const Contact& contact, const Feel& feel, std::span<const Dent> lasting);

/// The lasting dents (plastic deformation): where a surface was pressed in deeper than Feel::yield. They move
/// with their surfaces. There is room for as many as can be drawn; memory is allocated only in the
/// constructor.
class Marks {
 public:
    explicit Marks(std::size_t surfaces);

    std::span<const Dent> on(std::size_t surface) const { return dents_[surface]; }
    std::size_t surfaces() const { return dents_.size(); }

    /// The latest stroke that left any; 0 if there are none.
    int last_stroke() const;

    /// Moves them to where their surfaces are at a time.
    void carry(const Patch& patch, double time);

    /// Adds what this contact leaves: a new dent, or more depth for one of the same stroke.
    void leave(const Contact& contact, const Feel& feel, int stroke);

    /// Removes those of this stroke and of all later ones.
    void forget(int from_stroke);

 private:
    // Where in its surface a dent is, in barycentric coordinates, and its stroke.
    struct Mark {
        int triangle;
        dvec3 weights;
        int stroke;
    };

    std::vector<std::vector<Mark>> marks_;  // by surface, as are
    std::vector<std::vector<Dent>> dents_;  // their dents
};

}  // namespace palpate
