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

// The winding number of the other parts around each part, tested at the centres of a few of its faces. Where
// another part touches, it is undefined and does not count.
Arrangement::Around windings_around(const Mesh& mesh, const Parts& part, const Tree& tree) {
    constexpr std::size_t most_samples = 8;
    const WindingNumber all(tree);
    const std::vector<std::vector<Index>> faces = faces_by(part.of, part.count);
    const auto around = [&](const std::vector<Index>& own) -> std::optional<int> {
        const std::size_t samples = std::min(most_samples, own.size());
        int least = std::numeric_limits<int>::max(), most = std::numeric_limits<int>::min();
        for (std::size_t sample = 0; sample < samples; ++sample) {
            const uvec3 t = mesh.triangles[own[sample * own.size() / samples]];
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

// Whether each part separates inside from outside; `crossing` counts those that do so only in some places.
std::vector<char> separating_parts(const Mesh& mesh, const Parts& part, const Tree& tree,
                                   std::size_t& crossing) {
    const std::vector<char> is_inward = inward(mesh, part);
    const Arrangement::Around around = windings_around(mesh, part, tree);
    std::vector<char> separates;
    crossing = 0;
    for (Index i = 0; i < part.count; ++i) {
        crossing += !around[i];
        separates.push_back(!around[i] || (is_inward[i] ? *around[i] == 1 : *around[i] <= 0));
    }
    return separates;
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
        arrangement.around_outward = windings_around(mesh, part, arrangement.tree());
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
    const std::vector<char> keep = separating_parts(mesh, part, arrangement.tree(), found.crossing);
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
    const std::vector<char> keep = separating_parts(turned, part, arrangement.tree(), found.crossing),
                            is_inward = inward(turned, part);
    for (Index i = 0; i < part.count; ++i) {
        found.redundant += !keep[i];
        found.cavities += keep[i] && is_inward[i];
    }
    return found;
}

}  // namespace palpate
