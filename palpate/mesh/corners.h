#pragma once
#include "palpate/mesh/mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace palpate {

using Index = std::uint32_t;

/// Which faces meet at each vertex; what every question about neighbours starts from. Corner 3f + k is corner
/// k of face f.
class Corners {
 public:
    explicit Corners(const Mesh& mesh) : triangles_(mesh.triangles), first_(mesh.positions.size() + 1) {
        for (uvec3 t : triangles_)
            for (int k = 0; k < 3; ++k) ++first_[t[k] + 1];
        for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
        corners_.resize(3 * triangles_.size());
        std::vector<Index> place(first_.begin(), first_.end() - 1);
        for (Index corner = 0; corner < corners_.size(); ++corner) corners_[place[vertex(corner)]++] = corner;
    }

    std::span<const Index> at(std::size_t vertex) const {
        return std::span(corners_).subspan(first_[vertex], first_[vertex + 1] - first_[vertex]);
    }
    Index vertex(Index corner) const { return triangles_[corner / 3][corner % 3]; }

    /// The corners that follow and precede within the same face.
    static Index next(Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
    static Index previous(Index corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }

 private:
    const std::vector<uvec3>& triangles_;
    std::vector<Index> first_;    // where each vertex's corners begin
    std::vector<Index> corners_;  // by vertex
};

}  // namespace palpate
