#include "palpate/mesh/intersections.h"

#include "palpate/base/parallel.h"
#include "palpate/mesh/face_pairs.h"
#include "palpate/mesh/repair.h"

#include <array>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

struct Triangle {
    std::array<dvec3, 3> corners;
    dvec3 normal;  // unit; zero if the face is degenerate
};

Triangle triangle(const Mesh& mesh, Index face) {
    const uvec3 t = mesh.triangles[face];
    Triangle result{{dvec3(mesh.positions[t.x]), dvec3(mesh.positions[t.y]), dvec3(mesh.positions[t.z])},
                    dvec3(0)};
    if (!is_flat(mesh, t))
        result.normal = glm::normalize(
            glm::cross(result.corners[1] - result.corners[0], result.corners[2] - result.corners[0]));
    return result;
}

// On which side of a face's plane each corner of another lies: 1, -1, or 0 if it touches within rounding.
std::array<int, 3> sides_of(const Triangle& plane, const Triangle& other, double touch) {
    std::array<int, 3> side{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double height = glm::dot(plane.normal, other.corners[k] - plane.corners[0]);
        side[k] = height > touch ? 1 : height < -touch ? -1 : 0;
    }
    return side;
}

// Whether the line from p to q passes through the inside of the triangle.
bool passes(dvec3 p, dvec3 q, const Triangle& through, double touch) {
    const dvec3 way = q - p;
    bool left = true, right = true;
    for (std::size_t k = 0; k < 3; ++k) {
        const dvec3 from = through.corners[k], to = through.corners[(k + 1) % 3];
        const double turn = glm::dot(way, glm::cross(from - p, to - p));
        const double least = touch * glm::length(glm::cross(way, to - from));  // for lines that are just that
                                                                               // far apart
        left &= turn > least;
        right &= turn < -least;
    }
    return left || right;
}

bool any_side_passes(const Triangle& from, const std::array<int, 3>& side, const Triangle& through,
                     double touch) {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (side[k] * side[next] < 0 && passes(from.corners[k], from.corners[next], through, touch))
            return true;
    }
    return false;
}

bool one_side_only(const std::array<int, 3>& side) {
    return std::min({side[0], side[1], side[2]}) >= 0 || std::max({side[0], side[1], side[2]}) <= 0;
}

bool boxes_are_apart(const Triangle& a, const Triangle& b) {
    const auto low = [](const Triangle& t) {
        return glm::min(glm::min(t.corners[0], t.corners[1]), t.corners[2]);
    };
    const auto high = [](const Triangle& t) {
        return glm::max(glm::max(t.corners[0], t.corners[1]), t.corners[2]);
    };
    return glm::any(glm::greaterThan(low(a), high(b))) || glm::any(glm::greaterThan(low(b), high(a)));
}

bool cut(const Triangle& a, const Triangle& b, double touch) {
    if (boxes_are_apart(a, b)) return false;
    const std::array<int, 3> of_a = sides_of(b, a, touch), of_b = sides_of(a, b, touch);
    return (!one_side_only(of_a) && any_side_passes(a, of_a, b, touch)) ||
           (!one_side_only(of_b) && any_side_passes(b, of_b, a, touch));
}

// The plates of a tree's nodes, and the greatest distance of a vertex from each one's plane.
class Planes {
 public:
    Planes(const Tree& tree, double touch)
        : plates_(tree.plates()), thickness_(tree.nodes.size()), touch_(touch) {
        parallel_for(thickness_.size(), 1024,
                     [&](std::size_t i) { thickness_[i] = thickness(tree, tree.nodes[i], plates_[i]); });
    }

    // Whether all faces of two nodes are coplanar, so that none can cut another.
    bool in_one_plane(Index node, Index other) const {
        if (!(thickness_[node] + thickness_[other] <= touch_)) return false;
        const Tree::Plate &a = plates_[node], &b = plates_[other];
        const double tilt = glm::length(glm::cross(glm::normalize(a.area), glm::normalize(b.area))) * b.reach;
        return tilt + std::abs(glm::dot(glm::normalize(a.area), b.centre - a.centre)) <= touch_;
    }

 private:
    // Infinite if it is more than counts as one plane, which mostly shows after a few faces.
    double thickness(const Tree& tree, const Tree::Node& node, const Tree::Plate& plate) const {
        constexpr double infinite = std::numeric_limits<double>::infinity();
        const double length = glm::length(plate.area);
        if (length == 0) return infinite;
        double thickness = 0;
        for (Index i = node.first; i < node.first + node.count; ++i)
            for (int k = 0; k < 3; ++k) {
                const dvec3 corner(tree.mesh.positions[tree.mesh.triangles[tree.faces[i]][k]]);
                thickness =
                    std::max(thickness, std::abs(glm::dot(plate.area, corner - plate.centre)) / length);
                if (thickness > touch_) return infinite;
            }
        return thickness;
    }

    std::vector<Tree::Plate> plates_;
    std::vector<double> thickness_;  // m
    double touch_;
};

// What one thread searches in one round.
struct Share {
    std::vector<uvec2> waiting{};  // pairs of nodes
    std::vector<uvec2> cuts{};     // pairs of faces
    std::size_t tests = 0;
};
constexpr std::size_t shares_at_once = 64, tests_in_a_share = 20'000;

// These faces and `rings` rings of faces around them.
void drop_around(Mesh& mesh, const Intersections& found, int rings) {
    std::vector<char> face(mesh.triangles.size()), vertex(mesh.positions.size());
    for (uvec2 pair : found.faces) face[pair.x] = face[pair.y] = true;
    for (int ring = 0; ring < rings; ++ring) {
        for (std::size_t f = 0; f < face.size(); ++f)
            for (int k = 0; face[f] && k < 3; ++k) vertex[mesh.triangles[f][k]] = true;
        for (std::size_t f = 0; f < face.size(); ++f)
            for (int k = 0; k < 3; ++k) face[f] |= vertex[mesh.triangles[f][k]];
    }
    std::size_t f = 0;
    std::erase_if(mesh.triangles, [&](uvec3) { return face[f++]; });
}

std::size_t count_faces(const Intersections& found) {
    std::vector<Index> faces;
    for (uvec2 pair : found.faces) faces.insert(faces.end(), {pair.x, pair.y});
    std::sort(faces.begin(), faces.end());
    return std::size_t(std::unique(faces.begin(), faces.end()) - faces.begin());
}

}  // namespace

std::size_t most_tests_of(const Mesh& mesh) { return 10'000'000 + 100 * mesh.triangles.size(); }

Intersections intersections(const Mesh& mesh, std::size_t most) { return intersections(Tree(mesh), most); }

Intersections intersections(const Tree& tree, std::size_t most) {
    const Mesh& mesh = tree.mesh;
    Intersections found;
    if (tree.nodes.empty()) return found;
    const dvec3 size = dvec3(tree.nodes[0].high) - dvec3(tree.nodes[0].low);
    const double touch = 1e-6 * std::max({size.x, size.y, size.z});
    std::vector<Triangle> triangles(tree.faces.size());
    parallel_for(triangles.size(), 4096,
                 [&](std::size_t i) { triangles[i] = triangle(mesh, tree.faces[i]); });

    const Planes planes(tree, touch);
    const std::size_t most_tests = most_tests_of(mesh);
    std::size_t tests = 0;
    std::vector<uvec2> waiting = {{0, 0}};
    // All threads search, in rounds of fixed size, so that the point at which a search gives up does not
    // depend on their number.
    while (!waiting.empty() && tests <= most_tests && found.faces.size() < most) {
        std::vector<Share> shares(std::min(shares_at_once, waiting.size()));
        for (Share& share : shares) {
            share.waiting.push_back(waiting.back());
            waiting.pop_back();
        }
        parallel_for(shares.size(), 1, [&](std::size_t i) {
            Share& share = shares[i];
            for_each_pair_of_leaves(
                tree, share.waiting, 0, [&](Index a, Index b) { return planes.in_one_plane(a, b); },
                [&](Index leaf, Index other) {
                    for_each_pair_of_faces(tree, leaf, other, [&](Index a, Index b) {
                        ++share.tests;
                        if (cut(triangles[a], triangles[b], touch))
                            share.cuts.push_back({tree.faces[a], tree.faces[b]});
                    });
                    return share.tests < tests_in_a_share;
                });
        });
        for (const Share& share : shares) {
            tests += share.tests;
            found.faces.insert(found.faces.end(), share.cuts.begin(), share.cuts.end());
            waiting.insert(waiting.end(), share.waiting.begin(), share.waiting.end());
        }
    }
    found.all = waiting.empty() && found.faces.size() < most;
    return found;
}

std::size_t mend_intersections(Mesh& mesh, const Intersections& found) {
    constexpr double few = 0.05, most_lost = 0.02;  // as parts of the faces, and of the volume
    constexpr int rounds = 4;
    const std::size_t faces = count_faces(found);
    if (faces == 0 || double(faces) > few * double(mesh.triangles.size())) return 0;
    const double before = volume(mesh);
    Mesh mended{mesh.positions, {}, mesh.triangles};
    Intersections left = found;
    for (int round = 1; round <= rounds && !left.faces.empty(); ++round) {
        drop_around(mended, left, round);
        close_holes(mended);
        drop_flaps(mended);
        separate_sheets(mended);
        left = intersections(mended);
    }
    if (!left.faces.empty() || !(std::abs(volume(mended) - before) <= most_lost * std::abs(before))) return 0;
    drop_unused(mended);
    mesh = std::move(mended);
    return faces;
}

}  // namespace palpate
