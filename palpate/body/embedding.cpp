#include "palpate/body/embedding.h"

#include "palpate/base/error.h"
#include "palpate/body/grid.h"
#include "palpate/body/hull.h"
#include "palpate/mesh/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

// The unit vector along v, or `otherwise` where v has no direction.
vec3 direction(vec3 v, vec3 otherwise) {
    const float length = glm::length(v);
    return length > 1e-20f && std::isfinite(length) ? v / length : otherwise;
}

// ---- cells ----

// Weight of corner k of a cell at the place `at`, and its gradient with respect to the place.
float weight(int k, vec3 at) {
    return (k & 1 ? at.x : 1 - at.x) * (k & 2 ? at.y : 1 - at.y) * (k & 4 ? at.z : 1 - at.z);
}

vec3 gradient(int k, vec3 at) {
    const vec3 side(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
    const vec3 w(k & 1 ? at.x : 1 - at.x, k & 2 ? at.y : 1 - at.y, k & 4 ? at.z : 1 - at.z);
    return {side.x * w.y * w.z, side.y * w.x * w.z, side.z * w.x * w.y};
}

void place(const InCell& vertex, std::span<const vec3> nodes, vec3& position, vec3& normal) {
    vec3 sum(0), dx(0), dy(0), dz(0);  // the position, and the columns of the deformation's gradient
    for (int k = 0; k < 8; ++k) {
        const vec3 node = nodes[vertex.nodes[k]];
        const vec3 slope = gradient(k, vertex.at);
        sum += weight(k, vertex.at) * node;
        dx += slope.x * node;
        dy += slope.y * node;
        dz += slope.z * node;
    }
    position = sum;
    // A normal moves with the inverse transpose of the gradient: its cofactors, which need no division.
    const vec3 n = vertex.normal;
    normal = direction(n.x * glm::cross(dy, dz) + n.y * glm::cross(dz, dx) + n.z * glm::cross(dx, dy), n);
}

// ---- triangles ----

// Three unit vectors at right angles: along the triangle, out of it, and across.
struct Basis {
    vec3 tangent, normal, across;
};

// An approximate normal made unit; shorter where the neighbours' unit vectors cancel and leave it to chance.
vec3 clear_direction(vec3 normal) { return normal / std::max(glm::length(normal), 0.5f); }

vec3 any_across(vec3 n) { return glm::cross(n, std::abs(n.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0)); }

// 2005, eq. 6 and 8, with every vector normalised (the paper's N, B and Nc are not of unit length unless the
// triangle has a right angle). Eq. 8's order, Bc = Nc × T and Tc = Bc × Nc, is kept. A collapsed triangle
// takes what is still defined, and the world's axes for the rest.
Basis basis(const OnTriangle& vertex, const Nodes& nodes) {
    const auto [a, b, c] = vertex.nodes;
    const vec3 p = nodes.positions[a], q = nodes.positions[b], r = nodes.positions[c];
    vec3 normal = direction(glm::cross(q - p, r - p), vec3(0));
    if (vertex.curvature > 0) {
        vec3 sum(0);
        for (int k = 0; k < 3; ++k)
            sum += vertex.weights[k] * clear_direction(nodes.normals[vertex.nodes[k]]);
        const vec3 approximate = glm::length(sum) > 0.05f ? glm::normalize(sum) : normal;
        normal = glm::mix(normal, approximate, vertex.curvature);
    }
    normal = direction(normal, vec3(0, 0, 1));
    const vec3 along = direction(q - p, any_across(normal));
    const vec3 across = direction(glm::cross(normal, along), direction(any_across(normal), vec3(1, 0, 0)));
    return {glm::cross(across, normal), normal, across};
}

vec3 express(vec3 v, const Basis& b) {
    return {glm::dot(v, b.tangent), glm::dot(v, b.normal), glm::dot(v, b.across)};
}
vec3 expand(vec3 v, const Basis& b) { return v.x * b.tangent + v.y * b.normal + v.z * b.across; }

vec3 reference(const OnTriangle& vertex, std::span<const vec3> nodes) {
    vec3 sum(0);
    for (int k = 0; k < 3; ++k) sum += vertex.weights[k] * nodes[vertex.nodes[k]];
    return sum;
}

void place(const OnTriangle& vertex, const Nodes& nodes, vec3& position, vec3& normal) {
    const Basis b = basis(vertex, nodes);
    position = reference(vertex, nodes.positions) + expand(vertex.offset, b);
    normal = direction(expand(vertex.normal, b), b.normal);
}

// ---- finding the cell or the triangle ----

// The places at exactly this distance from the centre, counting diagonals as one.
template <class Visit>
void shell(ivec3 centre, int reach, Visit visit) {
    for (int z = -reach; z <= reach; ++z)
        for (int y = -reach; y <= reach; ++y) {
            const bool face = reach == 0 || std::abs(z) == reach || std::abs(y) == reach;
            for (int x = -reach; x <= reach; x += face ? 1 : 2 * reach) visit(centre + ivec3(x, y, z));
        }
}

// Finds the cells of a lattice near a point.
class CellFinder {
 public:
    explicit CellFinder(const Body& body)
        : body_(body),
          cells_(cell_places(body)),
          origin_(body.positions[0] - body.spacing * vec3(body.stencil().at[0])) {}

    int at(ivec3 place) const { return cells_.at(place); }

    // Calls visit(cell) for the cells around a point, in wider and wider cubes, until it has said true and no
    // cell further out could be nearer than the one it said it of.
    template <class Visit>
    void around(vec3 point, Visit visit) const {
        const ivec3 centre(glm::floor((point - origin_) / body_.spacing));
        const ivec3 span =
            glm::max(glm::abs(centre - cells_.low), glm::abs(centre - (cells_.low + cells_.dims)));
        int last = std::max({span.x, span.y, span.z});
        bool found = false;
        for (int reach = 0; reach <= last; ++reach) {
            bool here = false;
            shell(centre, reach, [&](ivec3 place) {
                if (const int cell = at(place); cell >= 0) here |= visit(cell);
            });
            if (here && !found) last = std::max(2, 2 * reach);
            found |= here;
        }
    }

 private:
    const Body& body_;
    GridIndex cells_;
    vec3 origin_;
};

float distance_to_cell(vec3 point, vec3 corner, float spacing) {
    return glm::length(glm::max(glm::max(corner - point, point - corner - spacing), vec3(0)));
}

std::vector<InCell> embed_in_cells(const Mesh& surface, const Body& body) {
    const CellFinder cells(body);
    std::vector<InCell> vertices;
    vertices.reserve(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i], n = surface.normals[i];
        // The nearest cell to the vertex; of cells about as near, the one nearest to a point half a cell
        // inside, so that the far wall of a gap is not taken for the near one.
        const vec3 inside = v - 0.5f * body.spacing * n;
        int best = -1;
        float least = std::numeric_limits<float>::max();
        cells.around(v, [&](int c) {
            const vec3 corner = body.positions[body.cells[c][0]];
            const float cost = distance_to_cell(v, corner, body.spacing) +
                               0.25f * distance_to_cell(inside, corner, body.spacing);
            if (cost < least) {
                least = cost;
                best = c;
            }
            return true;
        });
        const auto& nodes = body.cells[best];
        vertices.push_back({nodes, (v - body.positions[nodes[0]]) / body.spacing, n});
    }
    return vertices;
}

std::vector<std::vector<HullTriangle>> hull_by_cell(const Body& body) {
    std::vector<std::vector<HullTriangle>> by_cell(body.cells.size());
    for (const HullTriangle& triangle : hull(body)) by_cell[triangle.cell].push_back(triangle);
    return by_cell;
}

std::vector<OnTriangle> embed_on_hull(const Mesh& surface, const Body& body, float curvature) {
    const CellFinder cells(body);
    const auto hull = hull_by_cell(body);
    const std::vector<vec3> approximate = approximate_normals(body, body.positions);
    const Nodes rest{body.positions, approximate};
    std::vector<OnTriangle> vertices;
    vertices.reserve(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i], n = surface.normals[i];
        OnTriangle vertex{{0, 0, 0}, vec3(1, 0, 0), vec3(0), n, curvature};
        float least = std::numeric_limits<float>::max();
        auto consider = [&](const HullTriangle& t) {
            const auto [a, b, c] = t.nodes;
            const vec3 w = nearest_weights(v, body.positions[a], body.positions[b], body.positions[c]);
            const vec3 point = w.x * body.positions[a] + w.y * body.positions[b] + w.z * body.positions[c];
            // A triangle that faces away from the vertex's own side belongs to the other wall of a gap: it
            // counts as two cells further off.
            const float wrong_side = glm::dot(n, t.normal) > 0 ? 0 : 2 * body.spacing;
            const float cost = glm::distance(point, v) + wrong_side;
            if (cost >= least) return;
            least = cost;
            vertex.nodes = t.nodes;
            vertex.weights = w;
        };
        cells.around(v, [&](int c) {
            for (const HullTriangle& t : hull[c]) consider(t);
            return !hull[c].empty();
        });
        const Basis b = basis(vertex, rest);
        vertex.offset = express(v - reference(vertex, body.positions), b);
        vertex.normal = express(n, b);
        vertices.push_back(vertex);
    }
    return vertices;
}

}  // namespace

Embedding embed(const Mesh& surface, const Body& body, Mapping mapping) {
    if (body.cells.empty() && !surface.positions.empty())
        throw Error("a body without a filled cell", body.name.empty() ? "the lattice" : body.name,
                    "make it at least two nodes thick along each axis to hang a surface on it");
    Mesh copy;
    const Mesh* with_normals = &surface;
    if (surface.normals.size() != surface.positions.size()) {
        copy = surface;
        compute_normals(copy);
        with_normals = &copy;
    }
    switch (mapping) {
        case Mapping::automatic:
        case Mapping::trilinear:
            return {embed_in_cells(*with_normals, body)};
        case Mapping::constant:
            return {embed_on_hull(*with_normals, body, 0)};
        case Mapping::interpolated:
            return {embed_on_hull(*with_normals, body, 1)};
    }
    return {};
}

void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals) {
    if (const auto* vertices = std::get_if<std::vector<InCell>>(&embedding.vertices)) {
        positions.resize(vertices->size());
        normals.resize(vertices->size());
        for (std::size_t i = 0; i < vertices->size(); ++i)
            place((*vertices)[i], nodes.positions, positions[i], normals[i]);
        return;
    }
    const auto& vertices = std::get<std::vector<OnTriangle>>(embedding.vertices);
    positions.resize(vertices.size());
    normals.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) place(vertices[i], nodes, positions[i], normals[i]);
}

std::vector<vec3> approximate_normals(const Body& body, std::span<const vec3> positions) {
    const Table springs = table(body);
    std::vector<vec3> normals(body.count(), vec3(0));
    for (std::size_t i = 0; i < body.count(); ++i) {
        const auto ties = springs.of(i);
        auto toward = [&](int t) { return ties[t].to < 0 ? vec3(0) : positions[ties[t].to] - positions[i]; };
        vec3 round(0);
        for (int t = 0; t < body.fan; ++t) round += glm::cross(toward(t), toward((t + 1) % body.fan));
        normals[i] = direction(round, vec3(0));
        if (body.fan == 0)
            for (int t = 0; t < springs.width; ++t)
                if (ties[t].to >= 0) normals[i] -= ties[t].share * direction(toward(t), vec3(0));
    }
    return normals;
}

}  // namespace palpate
