#pragma once
#include "palpate/mesh/corners.h"
#include "palpate/mesh/mesh.h"

#include <vector>

namespace palpate {

/// Boxes in boxes over the faces of a mesh, halved by their middles: as deep as the logarithm of their
/// number, however they lie. A question to many faces is asked of few.
struct Tree {
    struct Node {
        vec3 low, high;
        Index first, count;  // its faces, in `faces`
        Index second;        // of two halves the second; the first is the node behind this. 0: not halved
    };
    /// A node's faces as seen from afar: a single flat one.
    struct Plate {
        dvec3 area{0};     // normal times area, m²
        dvec3 centre{0};   // m
        double reach = 0;  // m, from the centre to the farthest corner of the node's box, or more
    };
    std::vector<Plate> plates() const;

    std::vector<Node> nodes;   // nodes[0] holds all; none if the mesh has no faces
    std::vector<Index> faces;  // by node

    /// Over all faces, or over these. The mesh must outlive it, unchanged.
    explicit Tree(const Mesh& mesh);
    Tree(const Mesh& mesh, std::vector<Index> faces);

    struct Nearest {
        float distance;
        Index face;  // of the mesh; none if no face is nearer than was asked
    };
    /// The face nearest to a point; at `most`, if none is nearer. `guess`: a face that may be near, so that
    /// less is looked at. Any unit, but neither so large nor so small that squares of lengths do not fit a
    /// float.
    Nearest nearest(vec3 point, float most, Index guess = none) const;
    float distance(vec3 point, float most) const { return nearest(point, most).distance; }

    const Mesh& mesh;

 private:
    double add_faces(const Node& leaf, Plate& plate) const;
};

}  // namespace palpate
