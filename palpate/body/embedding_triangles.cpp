#include "palpate/body/embedding_parts.h"

namespace palpate {
namespace {

using Basis = MappingText::MappedVertex;

Basis basis(const OnTriangle& vertex, const Nodes& nodes) {
    const auto [a, b, c] = vertex.nodes;
    vec3 approximate(0);
    if (vertex.curvature > 0)
        for (int k = 0; k < 3; ++k)
            approximate += vertex.weights[k] * MappingText::clear_direction(nodes.normals[vertex.nodes[k]]);
    return MappingText::on_triangle(nodes.positions[a], nodes.positions[b], nodes.positions[c], approximate,
                                    vertex.curvature);
}

vec3 express(vec3 v, const Basis& b) { return {glm::dot(v, b.x), glm::dot(v, b.y), glm::dot(v, b.z)}; }

vec3 reference(const OnTriangle& vertex, std::span<const vec3> nodes) {
    vec3 sum(0);
    for (int k = 0; k < 3; ++k) sum += vertex.weights[k] * nodes[vertex.nodes[k]];
    return sum;
}

// Attaches vertices to the boundary surface of a body at rest.
class Hanger {
 public:
    explicit Hanger(const Body& body)
        : body_(body), outside_(body), approximate_(approximate_normals(body, body.positions)) {}

    // At the nearest node: the triangle at it is needed for tangents only.
    OnTriangle on_node(vec3 v, vec3 n) const {
        const Facet& facet = outside_.best(v, n, [&](const Facet& f, float) {
            return glm::distance(v, outside_.point(f, nearest_corner(f, v)));
        });
        return {nearest_corner(facet, v), vec3(0), vec3(0, 1, 0), 1, facet.nodes};
    }

    OnTriangle on_triangle(vec3 v, vec3 n, float curvature) const {
        const Facet& facet = outside_.nearest(v, n);
        OnTriangle vertex{outside_.weights(facet, v), vec3(0), vec3(0), curvature, facet.nodes};
        const Basis b = basis(vertex, rest());
        vertex.offset = express(v - reference(vertex, body_.positions), b);
        vertex.normal = express(n, b);
        return vertex;
    }

    // At the place whose interpolated normal meets the vertex. If there is no such place on the boundary
    // surface, the sideways remainder is lost.
    OnTriangle straight_under(vec3 v, vec3 n) const {
        const Facet& facet = outside_.best(v, n, [&](const Facet& f, float least) {
            if (const float near = outside_.distance(f, v); near >= least) return near;
            const Foot at = foot(f, v);
            return glm::distance(v, outside_.point(f, at.weights)) + 4 * at.aside;
        });
        const Foot at = foot(facet, v);
        OnTriangle vertex{at.weights, vec3(0, at.height, 0), vec3(0), 1, facet.nodes};
        vertex.normal = express(n, basis(vertex, rest()));
        return vertex;
    }

 private:
    Nodes rest() const { return {body_.positions, approximate_}; }

    // The barycentric weights of the facet's corner that is nearest to v.
    vec3 nearest_corner(const Facet& facet, vec3 v) const {
        vec3 far;
        for (int k = 0; k < 3; ++k) far[k] = glm::distance(v, body_.positions[facet.nodes[k]]);
        if (far.x <= far.y && far.x <= far.z) return {1, 0, 0};
        return far.y <= far.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    }

    // A foot point: a place on a facet, the height of the vertex along the interpolated normal there, and its
    // distance from that line.
    struct Foot {
        vec3 weights;
        float height, aside;
    };
    // Lifts the facet's corners along their normals until the vertex lies in the lifted triangle: its
    // barycentric weights there are those of the foot point. The height is the root of a cubic, found by
    // Newton's method.
    Foot foot(const Facet& facet, vec3 v) const {
        dvec3 at[3], up[3];
        for (int k = 0; k < 3; ++k) {
            at[k] = dvec3(body_.positions[facet.nodes[k]]);
            up[k] = dvec3(MappingText::clear_direction(approximate_[facet.nodes[k]]));
        }
        // The volume of the tetrahedron of the vertex and the triangle lifted by t, and its derivative by t.
        const dvec3 ab = at[1] - at[0], ac = at[2] - at[0], ab_up = up[1] - up[0], ac_up = up[2] - up[0];
        auto volume = [&](double t) {
            return glm::dot(glm::cross(ab + t * ab_up, ac + t * ac_up), dvec3(v) - at[0] - t * up[0]);
        };
        auto growth = [&](double t) {
            const dvec3 b = ab + t * ab_up, c = ac + t * ac_up;
            return glm::dot(glm::cross(ab_up, c) + glm::cross(b, ac_up), dvec3(v) - at[0] - t * up[0]) -
                   glm::dot(glm::cross(b, c), up[0]);
        };
        Foot best{outside_.weights(facet, v), 0, std::numeric_limits<float>::max()};
        double t = glm::dot(v - outside_.point(facet, best.weights), facet.normal);
        for (int round = 0; round < 12 && best.aside > 1e-7f * body_.spacing; ++round) {
            const vec3 lifted[] = {at[0] + t * up[0], at[1] + t * up[1], at[2] + t * up[2]};
            const vec3 weights = nearest_weights(v, lifted[0], lifted[1], lifted[2]);
            const OnTriangle stand{weights, vec3(0), vec3(0), 1, facet.nodes};
            const vec3 normal = basis(stand, rest()).y, over = v - reference(stand, body_.positions);
            const float height = glm::dot(over, normal), aside = glm::length(over - height * normal);
            if (aside < best.aside) best = {weights, height, aside};
            const double slope = growth(t);
            if (slope == 0) break;
            t -= volume(t) / slope;
        }
        return best;
    }

    const Body& body_;
    Outside outside_;
    std::vector<vec3> approximate_;
};

}  // namespace

std::vector<OnTriangle> embed_on_triangles(const Mesh& surface, const Body& body, Mapping mapping) {
    const Hanger hanger(body);
    std::vector<OnTriangle> vertices;
    vertices.reserve(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i], n = surface.normals[i];
        vertices.push_back(mapping == Mapping::one_to_one      ? hanger.on_node(v, n)
                           : mapping == Mapping::normal_offset ? hanger.straight_under(v, n)
                           : mapping == Mapping::constant      ? hanger.on_triangle(v, n, 0)
                                                               : hanger.on_triangle(v, n, 1));
    }
    return vertices;
}

std::vector<vec4> tangents_in(std::span<const OnTriangle> vertices, const Body& body,
                              const std::vector<vec4>& tangents) {
    if (tangents.empty()) return {};
    const std::vector<vec3> approximate = approximate_normals(body, body.positions);
    const Nodes rest{body.positions, approximate};
    std::vector<vec4> in_bases;
    for (std::size_t i = 0; i < vertices.size(); ++i)
        in_bases.emplace_back(express(vec3(tangents[i]), basis(vertices[i], rest)), tangents[i].w);
    return in_bases;
}

}  // namespace palpate
