#include "palpate/mesh/soundness.h"

#include "palpate/base/parallel.h"
#include "palpate/mesh/parts.h"
#include "palpate/mesh/repair.h"

#include <unordered_map>

namespace palpate {
namespace {

// Counts edges by their defects. Corners connected by shared edges are united into fans: at a vertex with
// more than one fan, sheets only touch. Open edges are united into the borders of holes.
void look_at_edges(const Mesh& mesh, Soundness& found) {
    const Corners corners(mesh);
    Groups fans(3 * mesh.triangles.size()), holes(mesh.positions.size());
    std::vector<uvec2> open;
    long edges = 0;
    for_each_edge(corners, [&](Index low, std::span<const Side> sides) {
        ++edges;
        for (Side side : sides.subspan(1)) {
            fans.unite(sides[0].low(), side.low());
            fans.unite(sides[0].high(), side.high());
        }
        const Index high = sides[0].other;
        if (sides.size() == 1) {
            open.push_back({low, high});
            holes.unite(low, high);
        } else if (sides.size() > 2 || high == low) {
            ++found.crowded_edges;
        } else if (sides[0].up == sides[1].up) {
            ++found.clashing_edges;
        }
    });
    found.open_edges = open.size();
    found.bad_edges = found.crowded_edges + found.clashing_edges;

    std::unordered_map<Index, double> length;  // by hole
    for (uvec2 edge : open)
        length[holes.of(edge.x)] +=
            glm::distance(dvec3(mesh.positions[edge.x]), dvec3(mesh.positions[edge.y]));
    found.holes = length.size();
    for (auto [hole, around] : length) found.longest_hole = std::max(found.longest_hole, around);

    long used = 0;
    for (std::size_t v = 0; v < corners.vertices(); ++v) {
        const auto at = corners.at(v);
        found.unused_vertices += at.empty();
        used += !at.empty();
        found.shared_vertices +=
            std::any_of(at.begin(), at.end(), [&](Index c) { return fans.of(c) != fans.of(at[0]); });
    }
    found.euler = used - edges + long(mesh.triangles.size());
}

void look_at_faces(const Mesh& mesh, Soundness& found) {
    for (uvec3 t : mesh.triangles) {
        if (t.x == t.y || t.y == t.z || t.z == t.x)
            ++found.collapsed_faces;
        else if (is_flat(mesh, t))
            ++found.flat_faces;
    }
    Mesh copy{mesh.positions, {}, mesh.triangles};
    std::erase_if(copy.triangles, [](uvec3 t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
    found.copied_faces = drop_copies(copy);
}

void look_at_parts(const Mesh& mesh, Soundness& found) {
    const Parts part = parts(mesh);
    found.parts = part.count;
    std::vector<char> open(part.count);
    const std::vector<Index> twin = twins(mesh);
    for (Index corner = 0; corner < twin.size(); ++corner)
        if (twin[corner] == none) open[part.of[corner / 3]] = true;
    const std::vector<double> volume = volumes(mesh, part);
    const std::vector<float> side = sides(mesh, part);
    const float longest = side.empty() ? 0 : *std::max_element(side.begin(), side.end());
    for (Index i = 0; i < part.count; ++i) {
        found.inward_parts += !open[i] && volume[i] < 0;
        found.specks += side[i] < RepairSettings{}.specks * longest;
    }
}

}  // namespace

Soundness soundness(const Mesh& mesh) {
    Soundness found;  // each task fills different members
    parallel_invoke([&] { look_at_edges(mesh, found); }, [&] { look_at_faces(mesh, found); },
                    [&] { look_at_parts(mesh, found); },
                    [&] { found.one_sided_parts = one_sided_parts(mesh); });
    return found;
}

}  // namespace palpate
