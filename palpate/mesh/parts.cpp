#include "palpate/mesh/parts.h"

#include "palpate/mesh/repair.h"

#include <cmath>
#include <numeric>

namespace palpate {

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

std::vector<std::vector<Index>> faces_by(const std::vector<Index>& group_of_face, Index groups) {
    std::vector<std::vector<Index>> faces(groups);
    for (Index face = 0; face < group_of_face.size(); ++face) faces[group_of_face[face]].push_back(face);
    return faces;
}

std::vector<Bounds> boxes(const Mesh& mesh, const Parts& parts) {
    std::vector<Bounds> box(parts.count);
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
        for (int k = 0; k < 3; ++k) box[parts.of[face]].include(mesh.positions[mesh.triangles[face][k]]);
    return box;
}

std::vector<double> areas(const Mesh& mesh, const Parts& parts) {
    std::vector<double> area(parts.count);
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
        area[parts.of[face]] += face_area(mesh, mesh.triangles[face]);
    return area;
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

Dropped keep_parts(Mesh& mesh, const Parts& parts, const std::vector<char>& keep) {
    Dropped dropped;
    dropped.parts = std::size_t(std::count(keep.begin(), keep.end(), false));
    if (dropped.parts == 0) return dropped;
    const std::vector<double> volume = volumes(mesh, parts), area = areas(mesh, parts);
    for (Index part = 0; part < parts.count; ++part) {
        if (keep[part]) continue;
        dropped.volume += std::abs(volume[part]);
        dropped.area += area[part];
    }
    std::size_t face = 0;
    std::erase_if(mesh.triangles, [&](uvec3) { return !keep[parts.of[face++]]; });
    drop_unused(mesh);
    return dropped;
}

Dropped drop_crumbs(Mesh& mesh, std::size_t most) {
    const Parts part = parts(mesh);
    if (part.count <= most) return {};
    const std::vector<double> volume = volumes(mesh, part);
    std::vector<Index> order(part.count);
    std::iota(order.begin(), order.end(), Index(0));
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return std::abs(volume[a]) > std::abs(volume[b]); });
    std::vector<char> keep(part.count);
    for (std::size_t i = 0; i < most; ++i) keep[order[i]] = true;
    return keep_parts(mesh, part, keep);
}

Dropped fill_cavities(Mesh& mesh, double fraction) {
    const Parts part = parts(mesh);
    const std::vector<double> volume = volumes(mesh, part);
    double all = 0;
    for (double one : volume) all += one;
    std::vector<char> keep;
    for (double one : volume) keep.push_back(one >= 0 || -one >= fraction * all);
    return keep_parts(mesh, part, keep);
}

Dropped drop_specks(Mesh& mesh, float fraction) {
    const Parts part = parts(mesh);
    if (part.count < 2) return {};
    const std::vector<float> side = sides(mesh, part);
    const float least = fraction * *std::max_element(side.begin(), side.end());
    std::vector<char> keep;
    for (float length : side) keep.push_back(!(length < least));
    return keep_parts(mesh, part, keep);
}

}  // namespace palpate
