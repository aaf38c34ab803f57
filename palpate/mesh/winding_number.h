#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/tree.h"

#include <span>
#include <vector>

namespace palpate {

/// The generalized winding number of a surface around a point: 1 inside and 0 outside a closed surface; 2
/// inside two at once; in between near holes, with 0.5 where a patch would best close them. It is the sum of
/// the solid angles of the faces over 4 pi (Jacobson et al. 2013). Far groups of faces are approximated by a
/// dipole with their total area and centre (Barill et al. 2018, the fast winding number): so a query takes
/// logarithmic time. The error is at most 0.05, and 0.01 on average.
class WindingNumber {
 public:
    /// The tree must outlive this.
    explicit WindingNumber(const Tree& tree);

    double at(dvec3 point) const;

    /// A ball in which there will be many queries. The far field is summed once, as a value and a gradient;
    /// what is near is summed for each query.
    struct Ball {
        dvec3 centre{0};
        double radius = 0;
        double value = 0;           // of the far field, at the centre
        dvec3 slope{0};             // the gradient of that value, 1/m
        std::vector<Index> near{};  // nodes of the tree
    };
    Ball ball(dvec3 centre, double radius) const;
    Ball ball(dvec3 centre, double radius, const Ball& around) const;  // from a larger ball that contains it

    /// The same as at(point), to the same accuracy, for a point in the ball.
    double at(dvec3 point, const Ball& ball) const;

 private:
    struct Sum;
    struct Face {
        dvec3 area, centre;  // like those of a plate
        double squared;      // of the distance from which it counts as far
    };
    void add(std::size_t node, dvec3 point, Sum& sum) const;
    void gather(Index node, Ball& ball) const;

    const Tree& tree_;
    std::vector<Tree::Plate> plates_;  // one for each node of the tree
    std::vector<Face> faces_;          // in the tree's order
};

/// The signed solid angle of a triangle as seen from `point`, over 4 pi: positive if its back is seen. Exact;
/// 0 if the point is one of its corners.
double solid_angle(dvec3 point, dvec3 a, dvec3 b, dvec3 c);

/// The exact sum over these faces of a mesh, computed in parallel; the result does not depend on the number
/// of threads.
double exact_winding(const Mesh& mesh, std::span<const Index> faces, dvec3 point);

}  // namespace palpate
