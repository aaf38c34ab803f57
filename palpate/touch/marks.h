#pragma once
#include "palpate/body/dent.h"
#include "palpate/body/feel.h"
#include "palpate/body/patch.h"
#include "palpate/touch/proxy.h"

#include <span>
#include <vector>

namespace palpate {

/// The dent that a contact presses into a surface now, beside those that are there: as deep as it is behind
/// them, as far as a single press goes. Its depth is 0 where it presses none.
Dent dent_under(const Contact& contact, const Feel& feel, std::span<const Dent> lasting);

/// The dents that stay where a surface was pressed in deeper than it springs back from. Surfaces carry them
/// along. There is room for as many as are drawn; it allocates only when it is made.
class Marks {
 public:
    explicit Marks(std::size_t surfaces);

    std::span<const Dent> on(std::size_t surface) const { return dents_[surface]; }
    std::size_t surfaces() const { return dents_.size(); }

    /// The latest of the strokes that left any; 0 if there are none.
    int last_stroke() const;

    /// To where their surfaces are at a time.
    void carry(const Patch& patch, double time);

    /// What this contact leaves behind: one more, or a deeper one of the same stroke.
    void leave(const Contact& contact, const Feel& feel, int stroke);

    /// Those of this stroke and of all later ones are gone.
    void forget(int from_stroke);

 private:
    // Where in its surface a dent is, and of which stroke.
    struct Mark {
        int triangle;
        dvec3 weights;
        int stroke;
    };

    std::vector<std::vector<Mark>> marks_;  // by surface, like
    std::vector<std::vector<Dent>> dents_;  // theirs
};

}  // namespace palpate
