#include "palpate/base/parallel.h"
#include "palpate/mesh/parts.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/winding_number.h"

#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace palpate {
namespace {

std::vector<char> inward(const Mesh& mesh, const Parts& part) {
    std::vector<char> inward;
    for (double volume : volumes(mesh, part)) inward.push_back(volume < 0);
    return inward;
}

// Tested at the centres of a few faces of each part. Where another part touches, the result is undefined and
// does not count.
Arrangement::Around surroundings(const Mesh& mesh, const Parts& part, const Tree& tree) {
    constexpr std::size_t most_looks = 8;
    const WindingNumber all(tree);
    std::vector<std::vector<Index>> faces(part.count);
    for (Index face = 0; face < part.of.size(); ++face) faces[part.of[face]].push_back(face);
    const auto around = [&](const std::vector<Index>& own) -> std::optional<int> {
        const std::size_t looks = std::min(most_looks, own.size());
        int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
        for (std::size_t look = 0; look < looks; ++look) {
            const uvec3 t = mesh.triangles[own[look * own.size() / looks]];
            const dvec3 a(mesh.positions[t.x]), b(mesh.positions[t.y]), c(mesh.positions[t.z]),
                middle = (a + b + c) / 3.0;
            const double seen = all.at(middle) - exact_winding(mesh, own, middle);
            const int whole = int(std::lround(seen));
            if (std::abs(seen - whole) > 0.25) continue;
            least = std::min(least, whole);
            most = std::max(most, whole);
        }
        if (most < least) return 0;
        return most == least ? std::optional(most) : std::nullopt;
    };
    Arrangement::Around result(part.count);
    parallel_for(part.count, 1, [&](std::size_t i) { result[i] = around(faces[i]); });
    return result;
}

// Whether each part has inside on one side and outside on the other; `crossing` counts those of which that is
// true only in some places.
std::vector<char> part_inside_from_outside(const Mesh& mesh, const Parts& part, const Tree& tree,
                                           std::size_t& crossing) {
    const std::vector<char> is_inward = inward(mesh, part);
    const Arrangement::Around around = surroundings(mesh, part, tree);
    std::vector<char> does;
    crossing = 0;
    for (Index i = 0; i < part.count; ++i) {
        crossing += !around[i];
        does.push_back(!around[i] || (is_inward[i] ? *around[i] == 1 : *around[i] <= 0));
    }
    return does;
}

}  // namespace

void turn_over(Mesh& mesh, const Parts& part, const std::vector<char>& turn) {
    for (std::size_t face = 0; face < mesh.triangles.size(); ++face)
        if (turn[part.of[face]]) std::swap(mesh.triangles[face].y, mesh.triangles[face].z);
}

std::vector<char> wrong_way_out(Mesh& mesh, const Parts& part, Arrangement& arrangement) {
    const std::vector<char> is_inward = inward(mesh, part);
    if (part.count < 2 || std::count(is_inward.begin(), is_inward.end(), true) == 0) return is_inward;
    if (!arrangement.around_outward) {
        turn_over(mesh, part, is_inward);
        arrangement.around_outward = surroundings(mesh, part, arrangement.tree());
        turn_over(mesh, part, is_inward);
    }
    std::vector<char> turn(part.count);
    bool all = true;
    for (Index i = 0; i < part.count; ++i) {
        if ((*arrangement.around_outward)[i].value_or(0) > 0) continue;
        turn[i] = is_inward[i];
        all &= bool(turn[i]);
    }
    if (all) turn.assign(part.count, true);
    return turn;
}

std::size_t turn_parts(Mesh& mesh, Arrangement& arrangement) {
    const Parts part = parts(mesh);
    const std::vector<char> turn = wrong_way_out(mesh, part, arrangement);
    const auto turned = std::size_t(std::count(turn.begin(), turn.end(), true));
    turn_over(mesh, part, turn);
    if (turned > 0) drop_attributes(mesh);
    return turned;
}

std::size_t turn_parts(Mesh& mesh) {
    Arrangement arrangement(mesh);
    return turn_parts(mesh, arrangement);
}

Nested drop_nested(Mesh& mesh, Arrangement& arrangement) {
    Nested found;
    const Parts part = parts(mesh);
    if (part.count < 2) return found;
    const std::vector<char> keep = part_inside_from_outside(mesh, part, arrangement.tree(), found.crossing);
    found.dropped = keep_parts(mesh, part, keep).parts;
    if (found.dropped > 0) arrangement.forget();
    return found;
}

Nested drop_nested(Mesh& mesh) {
    Arrangement arrangement(mesh);
    return drop_nested(mesh, arrangement);
}

Nesting nesting(const Mesh& mesh) {
    Nesting found;
    const Parts part = parts(mesh);
    Mesh turned{mesh.positions, {}, mesh.triangles};
    Arrangement arrangement(turned);
    const std::vector<char> turn = wrong_way_out(turned, part, arrangement);
    found.inside_out = std::size_t(std::count(turn.begin(), turn.end(), true));
    if (part.count < 2) return found;
    turn_over(turned, part, turn);
    const std::vector<char> keep = part_inside_from_outside(turned, part, arrangement.tree(), found.crossing),
                            is_inward = inward(turned, part);
    for (Index i = 0; i < part.count; ++i) {
        found.redundant += !keep[i];
        found.cavities += keep[i] && is_inward[i];
    }
    return found;
}

}  // namespace palpate
