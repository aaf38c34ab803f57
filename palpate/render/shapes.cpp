#include "palpate/render/shapes.h"

#include "palpate/voxels/isosurface.h"

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr int parts_of_a_rounding = 10;

// The positions of the grid lines of a rounded box's faces along one axis: at even angles round its edges.
std::vector<float> grid_lines(float half, float rounding) {
    std::vector<float> lines;
    for (int i = parts_of_a_rounding; rounding > 0 && i > 0; --i)
        lines.push_back(half +
                        rounding * std::tan(std::numbers::pi_v<float> / 4 * float(i) / parts_of_a_rounding));
    lines.push_back(half);
    for (std::size_t i = lines.size(); i-- > 0;)
        if (lines[i] > 0) lines.push_back(-lines[i]);  // no duplicate line where the box has no width
    for (float& line : lines) line = -line;
    return lines;
}

// A rounded box around the origin: the grids on the faces of a sharp box, projected onto its rounded edges.
Mesh round_box(vec3 half, float rounding) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const auto first = unsigned(mesh.positions.size());
            const std::vector<float> across = grid_lines(half[u], rounding),
                                     up = grid_lines(half[v], rounding);
            for (float y : up)
                for (float x : across) {
                    vec3 outer(0), out(0);
                    outer[axis] = side * (half[axis] + rounding);
                    outer[u] = x;
                    outer[v] = y;
                    out[axis] = side;
                    const vec3 core = glm::clamp(outer, -half, half);
                    if (rounding > 0) out = glm::normalize(outer - core);
                    mesh.positions.push_back(core + rounding * out);
                    mesh.normals.push_back(out);
                }
            const auto wide = unsigned(across.size());
            for (unsigned j = 0; j + 1 < up.size(); ++j)
                for (unsigned i = 0; i + 1 < wide; ++i) {
                    const unsigned a = first + j * wide + i, b = a + 1, c = a + wide, d = c + 1;
                    if (side > 0)
                        mesh.triangles.insert(mesh.triangles.end(), {{a, b, d}, {a, d, c}});
                    else
                        mesh.triangles.insert(mesh.triangles.end(), {{a, d, b}, {a, c, d}});
                }
        }
    return mesh;
}

Mesh placed(Mesh mesh, const mat3& axes, vec3 centre) {
    for (vec3& p : mesh.positions) p = centre + axes * p;
    for (vec3& n : mesh.normals) n = axes * n;
    return mesh;
}

Mesh mesh_of(const Plane&) { return {}; }
Mesh mesh_of(const Sphere&) { return {}; }

Mesh mesh_of(const Capsule& capsule) {
    const vec3 along = capsule.to - capsule.from;
    const float length = glm::length(along);
    const vec3 y = length > 0 ? along / length : vec3(0, 1, 0);
    const vec3 x = glm::normalize(glm::cross(y, std::abs(y.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 0, 1)));
    return placed(round_box({0, length / 2, 0}, capsule.radius), {x, y, glm::cross(x, y)},
                  0.5f * (capsule.from + capsule.to));
}

Mesh mesh_of(const Box& box) {
    return placed(round_box(box.half, box.rounding), {box.axes[0], box.axes[1], box.axes[2]}, box.centre);
}

Mesh mesh_of(const Polygon& polygon) {
    Mesh mesh;
    for (const auto& [a, b, c] : polygon.triangles) {
        const auto first = unsigned(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {a, b, c});
        mesh.normals.insert(mesh.normals.end(), 3, glm::normalize(glm::cross(b - a, c - a)));
        mesh.triangles.push_back({first, first + 1, first + 2});
    }
    return mesh;
}

Mesh mesh_of(const DistanceField& field) {
    Volume depth{.name = "a distance field",
                 .dims = field.dims,
                 .spacing = vec3(field.spacing),
                 .origin = field.origin,
                 .values = field.distance};
    for (float& value : depth.values) value = -value;
    Mesh mesh = isosurface(depth, 0);
    compute_normals(mesh);
    return mesh;
}

}  // namespace

Mesh shape_mesh(const Collider& collider) {
    return std::visit([](const auto& shape) { return mesh_of(shape); }, collider.shape);
}

}  // namespace palpate
