#include "palpate/mesh/repair.h"

#include "palpate/mesh/corners.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace palpate {
namespace {

constexpr Index none = ~Index(0);

// For each vertex, one vertex of its part that all of the part share.
std::vector<Index> roots(const Mesh& mesh) {
    std::vector<Index> parent(mesh.positions.size());
    std::iota(parent.begin(), parent.end(), Index(0));
    auto root = [&](Index v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];  // halves the way for those who come later
        return v;
    };
    for (uvec3 t : mesh.triangles) {
        parent[root(t.y)] = root(t.x);
        parent[root(t.z)] = root(t.x);
    }
    for (Index v = 0; v < parent.size(); ++v) parent[v] = root(v);
    return parent;
}

// How many faces each part has, at its root; zero elsewhere.
std::vector<std::size_t> faces_by_root(const Mesh& mesh, const std::vector<Index>& root) {
    std::vector<std::size_t> faces(mesh.positions.size());
    for (uvec3 t : mesh.triangles) ++faces[root[t.x]];
    return faces;
}

// Removes second copies of a face: the same three corners, turning the same way.
void drop_copies(Mesh& mesh) {
    for (uvec3& t : mesh.triangles)  // begin each at its lowest corner: then copies are equal
        while (t.x > t.y || t.x > t.z) t = {t.y, t.z, t.x};
    struct Hash {
        std::size_t operator()(uvec3 t) const {
            return ((std::uint64_t(t.x) << 32 | t.y) * 0x9e3779b97f4a7c15u ^ t.z) * 0xbf58476d1ce4e5b9u >> 16;
        }
    };
    std::unordered_set<uvec3, Hash> seen(mesh.triangles.size());
    std::erase_if(mesh.triangles, [&](uvec3 t) { return !seen.insert(t).second; });
}

struct HashPlace {
    std::size_t operator()(dvec3 p) const {
        std::size_t hash = 0;
        for (int k = 0; k < 3; ++k)  // + 0.0 makes -0 and 0, which are equal, hash alike
            hash = (hash ^ std::hash<double>()(p[k] + 0.0)) * 0x9e3779b97f4a7c15u;
        return hash ^ (hash >> 32);
    }
};

// The kept vertices, findable by place: in cells twice as wide as the tolerance, so that all that can be near
// a point lies in at most eight of them, and mostly in a few. With no tolerance each place is its own cell.
class Kept {
 public:
    Kept(const std::vector<vec3>& positions, float tolerance)
        : positions_(positions), tolerance_(tolerance), below_(positions.size(), none) {
        top_.reserve(positions.size());
    }

    Index find(vec3 p) const {
        const dvec3 low = cell(dvec3(p) - double(tolerance_)), high = cell(dvec3(p) + double(tolerance_));
        const ivec3 last(glm::notEqual(low, high));
        for (int z = 0; z <= last.z; ++z)
            for (int y = 0; y <= last.y; ++y)
                for (int x = 0; x <= last.x; ++x) {
                    auto found = top_.find(glm::mix(low, high, glm::bvec3(x, y, z)));
                    for (Index v = found == top_.end() ? none : found->second; v != none; v = below_[v])
                        if (glm::distance(positions_[v], p) <= tolerance_) return v;
                }
        return none;
    }

    void add(Index v) {
        Index& top = top_.try_emplace(cell(dvec3(positions_[v])), none).first->second;
        below_[v] = top;
        top = v;
    }

 private:
    dvec3 cell(dvec3 p) const { return tolerance_ > 0 ? glm::floor(p / (2.0 * tolerance_)) : p; }

    const std::vector<vec3>& positions_;
    float tolerance_;
    std::unordered_map<dvec3, Index, HashPlace> top_;  // the last vertex added to each cell
    std::vector<Index> below_;                         // the one added to the same cell before
};

// The vertices that each vertex moves towards: all its neighbours, or at an open border only those along the
// border, so that the border is smoothed as a line and does not creep inwards.
struct Neighbours {
    std::vector<Index> first, vertices;
};

Neighbours neighbours(const Mesh& mesh) {
    const Corners corners(mesh);
    Neighbours result;
    result.first.reserve(mesh.positions.size() + 1);
    result.vertices.reserve(3 * mesh.triangles.size());
    std::vector<Index> around, inner, border;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        around.clear(), inner.clear(), border.clear();
        for (Index c : corners.at(v)) {
            around.push_back(corners.vertex(Corners::next(c)));
            around.push_back(corners.vertex(Corners::previous(c)));
        }
        std::sort(around.begin(), around.end());
        for (auto at = around.begin(); at != around.end();) {
            auto end = std::upper_bound(at, around.end(), *at);
            (end - at == 1 ? border : inner).push_back(*at);  // a border's edge has one face
            at = end;
        }
        const std::vector<Index>& chosen = border.empty() ? inner : border;
        result.first.push_back(Index(result.vertices.size()));
        result.vertices.insert(result.vertices.end(), chosen.begin(), chosen.end());
    }
    result.first.push_back(Index(result.vertices.size()));
    return result;
}

// Moves every vertex by `step` of the way to the mean of its neighbours.
void move_to_mean(const Neighbours& near, float step, const std::vector<vec3>& from, std::vector<vec3>& to) {
    for (std::size_t v = 0; v < from.size(); ++v) {
        vec3 sum(0);
        const Index first = near.first[v], last = near.first[v + 1];
        for (Index i = first; i < last; ++i) sum += from[near.vertices[i]];
        to[v] = first == last ? from[v] : from[v] + step * (sum / float(last - first) - from[v]);
    }
}

}  // namespace

std::size_t weld(Mesh& mesh, float tolerance) {
    assert(tolerance >= 0);
    Kept kept(mesh.positions, tolerance);
    std::vector<Index> place(mesh.positions.size());
    Index count = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        place[v] = kept.find(mesh.positions[v]);
        if (place[v] != none) continue;
        mesh.positions[count] = mesh.positions[v];
        kept.add(count);
        place[v] = count++;
    }
    const std::size_t went = place.size() - count;
    if (went == 0) return 0;
    mesh.positions.resize(count);
    mesh.normals.clear();
    for (uvec3& t : mesh.triangles) t = {place[t.x], place[t.y], place[t.z]};
    return went;
}

std::size_t drop_unused(Mesh& mesh) {
    std::vector<Index> place(mesh.positions.size(), none);
    for (uvec3 t : mesh.triangles) place[t.x] = place[t.y] = place[t.z] = 0;
    Index used = 0;
    for (std::size_t v = 0; v < place.size(); ++v) {
        if (place[v] == none) continue;
        mesh.positions[used] = mesh.positions[v];
        place[v] = used++;
    }
    const std::size_t went = place.size() - used;
    if (went == 0) return 0;
    mesh.positions.resize(used);
    mesh.normals.clear();
    for (uvec3& t : mesh.triangles) t = {place[t.x], place[t.y], place[t.z]};
    return went;
}

std::size_t drop_collapsed(Mesh& mesh) {
    const std::size_t before = mesh.triangles.size();
    std::erase_if(mesh.triangles, [](uvec3 t) { return t.x == t.y || t.y == t.z || t.z == t.x; });
    drop_copies(mesh);
    drop_unused(mesh);
    return before - mesh.triangles.size();
}

std::size_t keep_largest(Mesh& mesh) {
    if (mesh.triangles.empty()) return 0;
    const std::vector<Index> root = roots(mesh);
    const std::vector<std::size_t> faces = faces_by_root(mesh, root);
    const auto largest = Index(std::max_element(faces.begin(), faces.end()) - faces.begin());
    std::erase_if(mesh.triangles, [&](uvec3 t) { return root[t.x] != largest; });
    drop_unused(mesh);
    return std::count_if(faces.begin(), faces.end(), [](std::size_t n) { return n > 0; }) - 1;
}

void smooth(Mesh& mesh, int passes) {
    // Taubin's pair: what the first step shrinks, the second grows back, all but the ripples of a few edges'
    // length. They cross at a spatial frequency of 1/0.5 - 1/0.53 = 0.11, near the 0.1 that he advises.
    constexpr float shrink = 0.5f, grow = -0.53f;
    if (passes <= 0) return;
    const Neighbours near = neighbours(mesh);
    std::vector<vec3> moved(mesh.positions.size());
    for (int pass = 0; pass < passes; ++pass) {
        move_to_mean(near, shrink, mesh.positions, moved);
        move_to_mean(near, grow, moved, mesh.positions);
    }
    mesh.normals.clear();
}

Soundness soundness(const Mesh& mesh) {
    Soundness found;
    for (std::size_t faces : faces_by_root(mesh, roots(mesh))) found.parts += faces > 0;

    // Each edge is looked at from its lower end, where its faces run out along it or come in.
    struct Side {
        Index other;
        int out, in;
    };
    const Corners corners(mesh);
    std::vector<Side> sides;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        sides.clear();
        for (Index c : corners.at(v)) {
            sides.push_back({corners.vertex(Corners::next(c)), 1, 0});
            sides.push_back({corners.vertex(Corners::previous(c)), 0, 1});
        }
        std::erase_if(sides, [&](Side side) { return side.other < v; });
        std::sort(sides.begin(), sides.end(), [](Side a, Side b) { return a.other < b.other; });
        for (std::size_t i = 0; i < sides.size();) {
            Side edge = sides[i];
            for (++i; i < sides.size() && sides[i].other == edge.other; ++i)
                edge.out += sides[i].out, edge.in += sides[i].in;
            if (edge.out + edge.in == 1)
                ++found.open_edges;
            else if (edge.out != 1 || edge.in != 1 || edge.other == v)
                ++found.bad_edges;
        }
    }
    return found;
}

}  // namespace palpate
