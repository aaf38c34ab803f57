#include "palpate/mesh/corners.h"
#include "palpate/mesh/repair.h"

#include <array>
#include <span>
#include <utility>

namespace palpate {
namespace {

bool is_collapsed(uvec3 t) { return t.x == t.y || t.y == t.z || t.z == t.x; }

// The same face, rotated to begin at its lowest vertex.
uvec3 lowest_first(uvec3 t) {
    while (t.x > t.y || t.x > t.z) t = {t.y, t.z, t.x};
    return t;
}

uvec3 ascending(uvec3 t) {
    t = lowest_first(t);
    return t.y < t.z ? t : uvec3(t.x, t.z, t.y);
}

// Calls f(faces) for each group of faces with the same key, in increasing order. A key's first vertex is its
// lowest.
template <class F>
void for_each_alike(const Mesh& mesh, uvec3 (*key)(uvec3), F f) {
    std::vector<Index> first(mesh.positions.size() + 1), order(mesh.triangles.size());
    for (uvec3 t : mesh.triangles) ++first[std::size_t(std::min({t.x, t.y, t.z})) + 1];
    for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
    std::vector<Index> place(first.begin(), first.end() - 1);
    for (Index face = 0; face < order.size(); ++face) {
        const uvec3 t = mesh.triangles[face];
        order[place[std::min({t.x, t.y, t.z})]++] = face;
    }
    auto less = [&](Index a, Index b) {
        const uvec3 s = key(mesh.triangles[a]), t = key(mesh.triangles[b]);
        return s.y != t.y ? s.y < t.y : s.z != t.z ? s.z < t.z : a < b;
    };
    for (std::size_t v = 0; v + 1 < first.size(); ++v) {
        const auto begin = order.begin() + first[v], end = order.begin() + first[v + 1];
        std::sort(begin, end, less);
        for (auto from = begin; from != end;) {
            const auto to = std::find_if(from, end, [&](Index face) {
                return key(mesh.triangles[face]) != key(mesh.triangles[*from]);
            });
            f(std::span<const Index>(from, to));
            from = to;
        }
    }
}

// Removes the faces for which `drop` is true.
void drop_faces(Mesh& mesh, const std::vector<char>& drop) {
    std::size_t face = 0;
    std::erase_if(mesh.triangles, [&](uvec3) { return drop[face++]; });
}

std::size_t count(const std::vector<char>& drop) {
    return std::size_t(std::count(drop.begin(), drop.end(), true));
}

// Mends degenerate faces. Each change concerns only a face and its neighbours, which are then left alone
// until the next pass.
class FlatFaces {
 public:
    explicit FlatFaces(Mesh& mesh) : mesh_(mesh), twins_(twins(mesh)), corners_(mesh) {}

    // Returns whether anything changed.
    bool mend() {
        changed_.assign(mesh_.positions.size(), false);
        bool any = false;
        for (Index face = 0; face < mesh_.triangles.size(); ++face)
            if (!is_collapsed(mesh_.triangles[face]) && is_flat(mesh_, mesh_.triangles[face]))
                any |= mend(face);
        return any;
    }

 private:
    Index vertex(Index corner) const { return mesh_.triangles[corner / 3][corner % 3]; }
    double length(Index corner) const {
        return glm::distance(dvec3(mesh_.positions[vertex(corner)]),
                             dvec3(mesh_.positions[vertex(Corners::next(corner))]));
    }

    // A needle has two long sides; the long side of a cap is as long as the two others together.
    bool mend(Index face) {
        std::array<Index, 3> side = {3 * face, 3 * face + 1, 3 * face + 2};
        std::sort(side.begin(), side.end(), [&](Index a, Index b) { return length(a) < length(b); });
        return length(side[0]) < 1e-3 * length(side[2]) ? collapse(side[0]) || flip(side[2])
                                                        : flip(side[2]) || collapse(side[0]);
    }

    bool unchanged(Index v) const { return !changed_[v]; }

    // Avoids quadratic time at a vertex of very many faces.
    bool may_change(Index v) const { return unchanged(v) && corners_.at(v).size() <= 500; }

    // Edge collapse: moves the far end of the side that begins at `corner` to its near end, which removes two
    // faces. It is safe only if the ends share no neighbours but the tips of these faces (the link
    // condition).
    bool collapse(Index corner) {
        const Index to = vertex(corner), from = vertex(Corners::next(corner));
        if (twins_[corner] == none || !may_change(to) || !may_change(from)) return false;
        std::vector<Index> near_to = neighbours(to), near_from = neighbours(from), common;
        std::set_intersection(near_to.begin(), near_to.end(), near_from.begin(), near_from.end(),
                              std::back_inserter(common));
        auto all_unchanged = [&](const std::vector<Index>& near) {
            return std::all_of(near.begin(), near.end(), [&](Index v) { return unchanged(v); });
        };
        if (common.size() != 2 || near_to.size() < 4 || near_from.size() < 4 || !all_unchanged(near_to) ||
            !all_unchanged(near_from))
            return false;
        for (Index v : near_to) changed_[v] = true;
        for (Index v : near_from) changed_[v] = true;
        for (Index c : corners_.at(from)) mesh_.triangles[c / 3][c % 3] = to;
        return true;
    }

    // Edge flip: joins the corners across the side that begins at `corner`, instead of its ends.
    bool flip(Index corner) {
        const Index back = twins_[corner];
        if (back == none) return false;
        const Index a = vertex(corner), b = vertex(back), c = vertex(Corners::previous(corner)),
                    d = vertex(Corners::previous(back));
        if (c == d || !unchanged(a) || !unchanged(b) || !may_change(c) || !unchanged(d)) return false;
        const std::vector<Index> near = neighbours(c);
        if (std::binary_search(near.begin(), near.end(), d)) return false;
        mesh_.triangles[corner / 3] = {a, d, c};
        mesh_.triangles[back / 3] = {d, b, c};
        changed_[a] = changed_[b] = changed_[c] = changed_[d] = true;
        return true;
    }

    std::vector<Index> neighbours(Index v) const {
        std::vector<Index> near;
        for (Index c : corners_.at(v)) {
            near.push_back(vertex(Corners::next(c)));
            near.push_back(vertex(Corners::previous(c)));
        }
        std::sort(near.begin(), near.end());
        near.erase(std::unique(near.begin(), near.end()), near.end());
        return near;
    }

    Mesh& mesh_;
    std::vector<Index> twins_;
    Corners corners_;
    std::vector<char> changed_;  // by vertex, in this pass
};

std::size_t count_flat(const Mesh& mesh) {
    return std::size_t(std::count_if(mesh.triangles.begin(), mesh.triangles.end(),
                                     [&](uvec3 t) { return is_flat(mesh, t); }));
}

}  // namespace

std::size_t drop_unused(Mesh& mesh) {
    std::vector<Index> place(mesh.positions.size(), none);
    for (uvec3 t : mesh.triangles) place[t.x] = place[t.y] = place[t.z] = 0;
    Index used = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == none) continue;
        mesh.positions[used] = mesh.positions[v];
        place[v] = used++;
    }
    return renumber(mesh, place, used);
}

std::size_t drop_collapsed(Mesh& mesh) {
    std::vector<char> drop(mesh.triangles.size());
    for_each_alike(mesh, lowest_first, [&](std::span<const Index> same) {
        for (Index face : same) drop[face] = face != same[0] || is_collapsed(mesh.triangles[face]);
    });
    drop_faces(mesh, drop);
    drop_unused(mesh);
    return count(drop);
}

std::size_t drop_copies(Mesh& mesh) {
    std::vector<char> drop(mesh.triangles.size());
    for_each_alike(mesh, ascending, [&](std::span<const Index> same) {
        for (Index face : same) drop[face] = face != same[0];
    });
    drop_faces(mesh, drop);
    return count(drop);
}

std::size_t drop_flaps(Mesh& mesh) {
    std::vector<char> drop(mesh.triangles.size());
    std::vector<Index> open;  // faces with these corners that have no opposite face yet
    for_each_alike(mesh, ascending, [&](std::span<const Index> same) {
        open.clear();
        for (Index face : same) {
            if (open.empty() ||
                lowest_first(mesh.triangles[open.back()]) == lowest_first(mesh.triangles[face])) {
                open.push_back(face);
                continue;
            }
            drop[face] = drop[open.back()] = true;
            open.pop_back();
        }
    });
    drop_faces(mesh, drop);
    return count(drop);
}

std::size_t drop_flat_faces(Mesh& mesh) {
    constexpr int most_passes = 8;  // each mends at least every other one in a row of them
    std::size_t removed = 0, flat = count_flat(mesh);
    for (int pass = 0; pass < most_passes && flat > 0; ++pass) {
        Mesh mended{mesh.positions, {}, mesh.triangles};
        FlatFaces(mended).mend();
        drop_collapsed(mended);
        const std::size_t left = count_flat(mended);
        if (left >= flat) break;
        removed += flat - left;
        flat = left;
        mesh = std::move(mended);
    }
    return removed;
}

}  // namespace palpate
