#include "palpate/files/formats/draft.h"

#include "palpate/base/error.h"
#include "palpate/mesh/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace palpate {
namespace {

// As floats.
template <int L>
bool finite(glm::vec<L, double> v) {
    for (int k = 0; k < L; ++k)
        if (!std::isfinite(float(v[k]))) return false;
    return true;
}

// An attribute of vertices; dropped with a note if some of it is not finite.
template <int L>
std::vector<glm::vec<L, float>> attribute(const std::vector<glm::vec<L, double>>& values,
                                          std::string_view what, std::vector<std::string>& notes) {
    if (std::all_of(values.begin(), values.end(), finite<L>)) return {values.begin(), values.end()};
    notes.push_back(fmt::format("left the {} out, because some are not finite", what));
    return {};
}

Error only_points_or_lines(const std::string& name) {
    return {"no faces, only points or lines", name,
            "make a surface of them first, as MeshLab can, or export it with faces"};
}

void check(const Draft& draft, const std::string& name) {
    auto broken = [&](const std::string& what) { throw Error(what, name, "export it again"); };
    if (draft.corners.empty() && draft.loose > 0) throw only_points_or_lines(name);
    if (draft.corners.empty()) broken("no faces");
    for (std::size_t i = 0; i < draft.positions.size(); ++i)
        if (!finite(draft.positions[i]))
            broken(fmt::format("vertex {} of {} not finite", i + 1, draft.positions.size()));
    std::size_t corner = 0;
    for (std::size_t face = 0; face < draft.sizes.size(); ++face)
        for (const std::size_t end = corner + draft.sizes[face]; corner < end; ++corner)
            if (draft.corners[corner] >= draft.positions.size())
                broken(fmt::format("face {} of {} naming vertex {} of {}, counted from 0", face + 1,
                                   draft.sizes.size(), draft.corners[corner], draft.positions.size()));
}

// The bounding box of points, of which there is at least one.
struct BoxOfPoints {
    dvec3 low, high;
};

BoxOfPoints box_of_points(std::span<const dvec3> points) {
    BoxOfPoints box{points[0], points[0]};
    for (dvec3 p : points) box.low = glm::min(box.low, p), box.high = glm::max(box.high, p);
    return box;
}

// The distance may use up 11 of the 24 bits of a float's mantissa.
bool too_far_for_floats(const BoxOfPoints& box) {
    const dvec3 size = box.high - box.low, far = glm::max(glm::abs(box.low), glm::abs(box.high));
    const double longest = std::max({size.x, size.y, size.z});
    return longest != 0 && longest * 0x1p11 < std::max({far.x, far.y, far.z});
}

// The new origin with which floats keep the shape. `scale`: m per unit of the file.
dvec3 origin_for(const Draft& draft, double scale, const std::string& name, std::vector<std::string>& notes) {
    const BoxOfPoints box = box_of_points(draft.positions);
    if (!too_far_for_floats(box)) return dvec3(0);
    if (draft.single)
        throw Error("a mesh so far from the origin that its shape is already lost", name,
                    "move it to the origin first");
    const dvec3 origin = box.low + 0.5 * (box.high - box.low), by = 0.0 - origin * scale;
    notes.push_back(fmt::format(
        "moved to the origin by ({:.15g}, {:.15g}, {:.15g}) m: so far from it, floats would lose the shape",
        by.x, by.y, by.z));
    return origin;
}

// Metres per unit of the file.
double scale_for(const Draft& draft, std::optional<Units> units, std::vector<std::string>& notes) {
    if (!units) return draft.unit > 0 ? draft.unit : 1;
    const double asked = metres(*units);
    if (draft.unit > 0 && std::abs(asked / draft.unit - 1) > 1e-6)
        notes.push_back(fmt::format("read in {} as asked, though the file says that its unit is {:.6g} m",
                                    name_of(*units), draft.unit));
    return asked;
}

// All faces as triangles.
std::vector<uvec3> triangles_of(const Draft& draft, const std::vector<vec3>& positions) {
    std::vector<uvec3> triangles;
    triangles.reserve(draft.sizes.size());
    std::vector<vec3> outline;
    const Index* corner = draft.corners.data();
    for (Index size : draft.sizes) {
        const std::size_t first = triangles.size();
        outline.clear();
        for (Index k = 0; k < size; ++k) outline.push_back(positions[corner[k]]);
        triangulate(outline, triangles);
        for (uvec3& t : std::span(triangles).subspan(first)) t = {corner[t.x], corner[t.y], corner[t.z]};
        corner += size;
    }
    return triangles;
}

}  // namespace

bool too_far_for_floats(std::span<const dvec3> positions) {
    return !positions.empty() && too_far_for_floats(box_of_points(positions));
}

Mesh finish(const Draft& draft, std::optional<Units> units, const std::string& name,
            std::vector<std::string>* notes) {
    check(draft, name);
    std::vector<std::string> all_notes = draft.notes;
    const double scale = scale_for(draft, units, all_notes);
    const dvec3 origin = origin_for(draft, scale, name, all_notes);
    Mesh mesh;
    mesh.positions.reserve(draft.positions.size());
    for (dvec3 p : draft.positions) mesh.positions.emplace_back(p - origin);
    mesh.triangles = triangles_of(draft, mesh.positions);
    if (mesh.triangles.empty()) throw only_points_or_lines(name);
    const auto small = [](Index corners) { return corners < 3; };
    if (const std::size_t count = draft.loose + std::size_t(std::ranges::count_if(draft.sizes, small)))
        all_notes.push_back(count == 1 ? "left out a point or a line"
                                       : fmt::format("left out {} points and lines", count));
    for (vec3& p : mesh.positions) p *= float(scale);
    mesh.normals = attribute(draft.normals, "normals", all_notes);
    mesh.uvs = attribute(draft.uvs, "texture coordinates", all_notes);
    if (notes) notes->insert(notes->end(), all_notes.begin(), all_notes.end());
    return mesh;
}

}  // namespace palpate
