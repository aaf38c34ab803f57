#include "palpate/mesh/parts.h"
#include "palpate/mesh/repair.h"

#include <utility>

namespace palpate {
namespace {

// For each corner, the corner from which the other face at this edge begins it, in either direction; none at
// a border and at edges with more than two faces.
std::vector<Index> corners_beyond(const Mesh& mesh) {
    std::vector<Index> beyond(3 * mesh.triangles.size(), none);
    for_each_edge(Corners(mesh), [&](Index low, std::span<const Side> sides) {
        if (sides.size() != 2 || sides[0].other == low) return;
        beyond[sides[0].corner] = sides[1].corner;
        beyond[sides[1].corner] = sides[0].corner;
    });
    return beyond;
}

// Which faces to flip, sheet by sheet. A sheet is a set of faces connected by edges with two faces.
struct Turning {
    std::vector<char> turn;
    std::vector<Index> one_sided;  // a face of each non-orientable sheet
};

Turning find_turning(const Mesh& mesh) {
    const std::vector<Index> beyond = corners_beyond(mesh);
    auto begins = [&](Index corner) { return mesh.triangles[corner / 3][corner % 3]; };
    Turning result{std::vector<char>(mesh.triangles.size()), {}};
    std::vector<char> seen(mesh.triangles.size());
    std::vector<Index> sheet;
    for (Index first = 0; first < seen.size(); ++first) {
        if (seen[first]) continue;
        sheet.assign(1, first);
        seen[first] = true;
        bool one_sided = false;
        std::size_t turned = 0;
        for (std::size_t i = 0; i < sheet.size(); ++i) {
            const Index face = sheet[i];
            for (Index corner = 3 * face; corner < 3 * face + 3; ++corner) {
                if (beyond[corner] == none) continue;
                const Index other = beyond[corner] / 3;
                const bool clash = begins(corner) == begins(beyond[corner]);
                const bool turn = bool(result.turn[face]) != clash;
                if (seen[other]) {
                    one_sided |= bool(result.turn[other]) != turn;
                    continue;
                }
                seen[other] = true;
                result.turn[other] = turn;
                turned += turn;
                sheet.push_back(other);
            }
        }
        if (one_sided) result.one_sided.push_back(first);
        if (2 * turned > sheet.size())  // the majority decides
            for (Index face : sheet) result.turn[face] ^= 1;
    }
    return result;
}

}  // namespace

std::size_t turn_faces(Mesh& mesh) {
    const Turning turning = find_turning(mesh);
    std::size_t turned = 0;
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
        if (!turning.turn[face]) continue;
        std::swap(mesh.triangles[face].y, mesh.triangles[face].z);
        ++turned;
    }
    if (turned > 0) drop_attributes(mesh);
    return turned;
}

std::size_t one_sided_parts(const Mesh& mesh) { return find_turning(mesh).one_sided.size(); }

}  // namespace palpate
