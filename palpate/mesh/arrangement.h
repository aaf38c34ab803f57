#pragma once
#include "palpate/mesh/tree.h"

#include <optional>
#include <vector>

namespace palpate {

/// What several questions in turn need to know of how a mesh's parts lie: made when it is first asked for,
/// and kept. Faces may be turned over and vertices numbered anew in between; whoever drops faces calls
/// forget().
class Arrangement {
 public:
    /// How many times others wind around each part; nothing where its faces do not agree.
    using Around = std::vector<std::optional<int>>;

    explicit Arrangement(const Mesh& mesh) : mesh_(mesh) {}

    const Tree& tree() { return tree_ ? *tree_ : tree_.emplace(mesh_); }
    void forget() {
        tree_.reset();
        around_outward.reset();
    }

    std::optional<Around> around_outward;  // if all parts were turned outward

 private:
    const Mesh& mesh_;
    std::optional<Tree> tree_;
};

}  // namespace palpate
