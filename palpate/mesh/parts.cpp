#include "palpate/mesh/parts.h"

#include "palpate/mesh/repair.h"

namespace palpate {
namespace {

std::vector<Bounds> boxes(const Mesh& mesh, const Parts& parts) {
    std::vector<Bounds> box(parts.count);
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
        for (int k = 0; k < 3; ++k) box[parts.of[face]].include(mesh.positions[mesh.triangles[face][k]]);
    return box;
}

}  // namespace

Parts parts(const Mesh& mesh) {
    Groups groups(mesh.positions.size());
    for (uvec3 t : mesh.triangles) {
        groups.unite(t.x, t.y);
        groups.unite(t.x, t.z);
    }
    Parts result;
    std::vector<Index> number(mesh.positions.size(), none);
    result.of.reserve(mesh.triangles.size());
    for (uvec3 t : mesh.triangles) {
        Index& part = number[groups.of(t.x)];
        if (part == none) part = result.count++;
        result.of.push_back(part);
    }
    return result;
}

std::vector<double> volumes(const Mesh& mesh, const Parts& parts) {
    const std::vector<Bounds> box = boxes(mesh, parts);
    std::vector<double> six_volumes(parts.count);
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
        const Index part = parts.of[face];
        const uvec3 t = mesh.triangles[face];
        const dvec3 tip = 0.5 * (dvec3(box[part].low) + dvec3(box[part].high));
        const dvec3 a = dvec3(mesh.positions[t.x]) - tip, b = dvec3(mesh.positions[t.y]) - tip,
                    c = dvec3(mesh.positions[t.z]) - tip;
        six_volumes[part] += glm::dot(a, glm::cross(b, c));
    }
    for (double& volume : six_volumes) volume /= 6;
    return six_volumes;
}

std::vector<float> sides(const Mesh& mesh, const Parts& parts) {
    std::vector<float> longest;
    for (const Bounds& box : boxes(mesh, parts)) {
        const vec3 size = box.size();
        longest.push_back(std::max({size.x, size.y, size.z}));
    }
    return longest;
}

std::size_t keep_parts(Mesh& mesh, const Parts& parts, const std::vector<char>& keep) {
    const auto go = std::size_t(std::count(keep.begin(), keep.end(), false));
    if (go == 0) return 0;
    std::size_t face = 0;
    std::erase_if(mesh.triangles, [&](uvec3) { return !keep[parts.of[face++]]; });
    drop_unused(mesh);
    return go;
}

std::size_t keep_largest(Mesh& mesh) {
    const Parts part = parts(mesh);
    if (part.count < 2) return drop_unused(mesh), 0;
    std::vector<std::size_t> faces(part.count);
    for (Index i : part.of) ++faces[i];
    std::vector<char> keep(part.count);
    keep[std::size_t(std::max_element(faces.begin(), faces.end()) - faces.begin())] = true;
    return keep_parts(mesh, part, keep);
}

std::size_t drop_specks(Mesh& mesh, float fraction) {
    const Parts part = parts(mesh);
    if (part.count < 2) return 0;
    const std::vector<float> side = sides(mesh, part);
    const float least = fraction * *std::max_element(side.begin(), side.end());
    std::vector<char> keep;
    for (float length : side) keep.push_back(!(length < least));
    return keep_parts(mesh, part, keep);
}

}  // namespace palpate
