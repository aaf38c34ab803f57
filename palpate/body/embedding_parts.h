#pragma once
// Shared by the parts of embedding.cpp.
#include "palpate/body/embedding.h"
#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace palpate {

/// mapping.inl for one vertex at a time.
template <class Number>
struct MappingIn {
    using Real = Number;
    using Real3 = glm::vec<3, Number>;
    static Real select(bool c, Real a, Real b) { return c ? a : b; }
    static Real3 select(bool c, Real3 a, Real3 b) { return c ? a : b; }
    static Real x_of(Real3 v) { return v.x; }
    static Real abs(Real a) { return std::abs(a); }
    static Real min(Real a, Real b) { return b < a ? b : a; }
    static Real inversesqrt(Real a) { return 1 / std::sqrt(a); }
#define FN static
#include "palpate/body/mapping.inl"
#undef FN
};
using MappingText = MappingIn<float>;

inline vec3 direction(vec3 v, vec3 otherwise) { return MappingText::direction(v, otherwise); }
inline vec3 any_perpendicular(vec3 n) { return MappingText::any_perpendicular(n); }

/// A triangle of a body's boundary surface.
struct Facet {
    std::array<int, 3> nodes;  // counter-clockwise seen from outside
    vec3 normal;               // at rest
};

/// The hull of a body's cells, or its faces if it has no cells.
std::vector<Facet> facets(const Body& body);

/// Bounding boxes in a uniform grid, for a nearest-neighbour search.
class BoxGrid {
 public:
    /// There must be at least one box to search.
    explicit BoxGrid(std::span<const Bounds> boxes);

    /// The box with the least cost(index, least), which must be at least the distance from the point to the
    /// box. `least`: the least cost so far; for a box that cannot beat it, any larger cost will do.
    template <class Cost>
    int best(vec3 point, Cost cost) const {
        const ivec3 centre = bucket_of(point);
        const ivec3 span = glm::max(centre, dims_ - 1 - centre);
        const int last = std::max({span.x, span.y, span.z});
        int best = 0;
        float least = std::numeric_limits<float>::max();
        for (int reach = 0; reach <= last && float(reach - 1) * size_ < least; ++reach)
            shell(centre, reach, [&](ivec3 bucket) {
                const std::size_t at = slot(bucket);
                for (int i = begins_[at]; i < begins_[at + 1]; ++i)
                    if (const float c = cost(items_[i], least); c < least) {
                        least = c;
                        best = items_[i];
                    }
            });
        return best;
    }

 private:
    // The bucket that a point is in, or the nearest one.
    ivec3 bucket_of(vec3 point) const {
        return ivec3(glm::clamp((point - origin_) / size_, vec3(0), vec3(dims_ - 1)));
    }
    std::size_t slot(ivec3 b) const { return (std::size_t(b.z) * dims_.y + b.y) * dims_.x + b.x; }

    // The buckets at exactly this Chebyshev distance from the centre.
    template <class Visit>
    void shell(ivec3 centre, int reach, Visit visit) const {
        const ivec3 low = glm::max(centre - reach, ivec3(0)), high = glm::min(centre + reach, dims_ - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) {
                const bool face = std::abs(z - centre.z) == reach || std::abs(y - centre.y) == reach;
                for (int x = low.x; x <= high.x; ++x)
                    if (face || std::abs(x - centre.x) == reach) visit(ivec3(x, y, z));
            }
    }
    template <class Visit>
    void for_each_bucket(const Bounds& box, Visit visit) const;

    vec3 origin_;
    float size_;  // of a bucket: about the size of the boxes
    ivec3 dims_;
    std::vector<int> begins_, items_;  // where the items of each bucket begin; the items
};

/// The boundary surface of a body at rest, with a search for the facet to which a vertex belongs.
class Outside {
 public:
    explicit Outside(const Body& body);

    /// The best facet for a vertex v with normal n, by distance(facet, least), with `least` as above; it must
    /// be at least the distance from v to the facet.
    template <class Distance>
    const Facet& best(vec3 v, vec3 n, Distance distance) const {
        return facets_[box_grid_.best(v, [&](int i, float least) {
            // A triangle that faces away from the vertex's own side belongs to the opposite wall of a gap: it
            // counts as two cells farther away. A sheet is both walls.
            const bool wrong_side = body_.fan == 0 && !(glm::dot(n, facets_[i].normal) > 0);
            const float further = wrong_side ? 2 * body_.spacing : 0;
            return distance(facets_[i], least - further) + further;
        })];
    }
    const Facet& nearest(vec3 v, vec3 n) const;

    /// Barycentric weights of the nearest place on a facet.
    vec3 weights(const Facet& facet, vec3 v) const {
        const auto [a, b, c] = facet.nodes;
        return nearest_weights(v, body_.positions[a], body_.positions[b], body_.positions[c]);
    }
    vec3 point(const Facet& facet, vec3 weights) const {
        const auto [a, b, c] = facet.nodes;
        return weights.x * body_.positions[a] + weights.y * body_.positions[b] +
               weights.z * body_.positions[c];
    }
    float distance(const Facet& facet, vec3 v) const {
        return glm::distance(point(facet, weights(facet, v)), v);
    }
    const std::vector<Facet>& all() const { return facets_; }

 private:
    const Body& body_;
    std::vector<Facet> facets_;
    BoxGrid box_grid_;
};

/// How many vertices hang on the body.
std::size_t vertex_count(const Embedding& embedding);

/// Throws Error where there are fewer nodes, or approximate normals, than the embedding needs.
void check(const Nodes& nodes, const Embedding& embedding);

// Each mapping's way to embed a surface, which must have normals.

std::vector<InCell> embed_in_cells(const Mesh& surface, const Body& body);
std::vector<OnTriangle> embed_on_triangles(const Mesh& surface, const Body& body, Mapping mapping);
Framed embed_on_frames(const Mesh& surface, const Body& body);

/// The tangents of the surface at rest, in the axes of the vertices' cells, or in their bases.
std::vector<vec4> tangents_in(std::span<const InCell> vertices, const Body& body,
                              const std::vector<vec4>& tangents);
std::vector<vec4> tangents_in(std::span<const OnTriangle> vertices, const Body& body,
                              const std::vector<vec4>& tangents);

}  // namespace palpate
