#include "palpate/mesh/formats/draft.h"

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

// What belongs to vertices: all of it, or with a note nothing where some is not finite.
template <int L>
std::vector<glm::vec<L, float>> attribute(const std::vector<glm::vec<L, double>>& values,
                                          std::string_view what, std::vector<std::string>& notes) {
    if (std::all_of(values.begin(), values.end(), finite<L>)) return {values.begin(), values.end()};
    notes.push_back(fmt::format("left the {} out, of which some are not finite", what));
    return {};
}

void check(const Draft& draft, const std::string& name) {
    auto broken = [&](const std::string& what) { throw Error(what, name, "export it again"); };
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

// Where to begin to count from, so that floats keep the shape: of their 24 bits, 11 may go for the distance.
dvec3 origin_for(const Draft& draft, Units units, const std::string& name, std::vector<std::string>& notes) {
    dvec3 low = draft.positions[0], high = low;
    for (dvec3 p : draft.positions) low = glm::min(low, p), high = glm::max(high, p);
    const dvec3 size = high - low, far = glm::max(glm::abs(low), glm::abs(high));
    const double longest = std::max({size.x, size.y, size.z});
    if (longest == 0 || longest * 0x1p11 >= std::max({far.x, far.y, far.z})) return dvec3(0);
    if (draft.single)
        throw Error("a mesh too far from the origin for the digits", name, "move it to the origin first");
    const dvec3 origin = low + 0.5 * size, by = 0.0 - origin * double(metres(units));
    notes.push_back(fmt::format(
        "moved to the origin by ({:.15g}, {:.15g}, {:.15g}) m: so far from it the shape would be lost", by.x,
        by.y, by.z));
    return origin;
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

Mesh finish(const Draft& draft, Units units, const std::string& name, std::vector<std::string>* notes) {
    check(draft, name);
    std::vector<std::string> said = draft.notes;
    const dvec3 origin = origin_for(draft, units, name, said);
    Mesh mesh;
    mesh.positions.reserve(draft.positions.size());
    for (dvec3 p : draft.positions) mesh.positions.emplace_back(p - origin);
    mesh.triangles = triangles_of(draft, mesh.positions);
    if (mesh.triangles.empty()) throw Error("no faces, only points or lines", name, "export it again");
    if (const auto count =
            std::count_if(draft.sizes.begin(), draft.sizes.end(), [](Index n) { return n < 3; }))
        said.push_back(fmt::format("left out {} points and lines", count));
    for (vec3& p : mesh.positions) p *= metres(units);
    mesh.normals = attribute(draft.normals, "normals", said);
    mesh.uvs = attribute(draft.uvs, "texture coordinates", said);
    if (notes) notes->insert(notes->end(), said.begin(), said.end());
    return mesh;
}

}  // namespace palpate
