#pragma once
#include "palpate/mesh/corners.h"
#include "palpate/mesh/mesh.h"

#include <vector>

namespace palpate {

/// A bounding volume hierarchy (BVH) over the faces of a mesh: a binary tree of axis-aligned bounding boxes,
/// split at the median, so its depth is the logarithm of the number of faces.
struct Tree {
    struct Node {
        vec3 low, high;
        Index first, count;  // the range of its faces in `faces`
        Index second;        // the second child; the first is the next node. 0: a leaf
    };
    /// A node's faces in the far field: a single flat plate (the dipole of Barill et al. 2018).
    struct Plate {
        dvec3 area{0};     // the sum of normal times area, m²
        dvec3 centre{0};   // m
        double reach = 0;  // m, from the centre to the farthest corner of the node's box, or more
    };
    std::vector<Plate> plates() const;

    std::vector<Node> nodes;   // nodes[0] holds all; none if the mesh has no faces
    std::vector<Index> faces;  // ordered by node

    /// Over all faces, or over these. The mesh must outlive the tree and stay unchanged.
    explicit Tree(const Mesh& mesh);
    Tree(const Mesh& mesh, std::vector<Index> faces);

    struct Nearest {
        float distance;
        Index face;  // of the mesh; none if no face is nearer than `most`
    };
    /// The face nearest to a point; none, with distance `most`, if none is nearer than that. `guess`: a face
    /// that may be near, to speed up the search. In any unit in which squares of lengths fit a float.
    Nearest nearest(vec3 point, float most, Index guess = none) const;
    float distance(vec3 point, float most) const { return nearest(point, most).distance; }

    const Mesh& mesh;

 private:
    double add_faces(const Node& leaf, Plate& plate) const;
};

}  // namespace palpate
