#pragma once
#include "palpate/mesh/tree.h"

#include <optional>
#include <vector>

namespace palpate {

/// A cache of what several steps need to know about how a mesh's parts lie: its tree and winding numbers,
/// computed on first use. Faces may be flipped and vertices renumbered in between; call forget() after
/// dropping faces.
class Arrangement {
 public:
    /// The winding number of the other parts around each part; empty where its faces disagree.
    using Around = std::vector<std::optional<int>>;

    explicit Arrangement(const Mesh& mesh) : mesh_(mesh) {}

    const Tree& tree() { return tree_ ? *tree_ : tree_.emplace(mesh_); }
    void forget() {
        tree_.reset();
        around_outward.reset();
    }

    std::optional<Around> around_outward;  // with all parts turned outward

 private:
    const Mesh& mesh_;
    std::optional<Tree> tree_;
};

}  // namespace palpate
