#include "palpate/mesh/corners.h"
#include "palpate/mesh/polygon.h"
#include "palpate/mesh/repair.h"

#include <cmath>
#include <limits>
#include <utility>

namespace palpate {
namespace {

// The boundary loops of holes, in the winding order of the missing faces. A walk along border edges leaves
// every vertex as often as it enters it, so it always returns to a vertex where it has been; what it has
// walked since then is cut off as a loop of its own. So no loop passes through a vertex twice.
std::vector<std::vector<Index>> loops(const Mesh& mesh) {
    const std::vector<Index> twin = twins(mesh);
    auto vertex = [&](Index corner) { return mesh.triangles[corner / 3][corner % 3]; };
    std::vector<Index> last(mesh.positions.size(), none);  // the last border edge from each vertex, as a
                                                           // corner
    std::vector<Index> before(twin.size(), none);          // the border edge before it from the same vertex
    for (Index corner = 0; corner < twin.size(); ++corner)
        if (twin[corner] == none) before[corner] = std::exchange(last[vertex(Corners::next(corner))], corner);

    std::vector<std::vector<Index>> found;
    std::vector<Index> path, place(mesh.positions.size(), none);
    for (Index start = 0; start < last.size(); ++start) {
        for (Index at = start; last[at] != none;) {
            place[at] = Index(path.size());
            path.push_back(at);
            const Index corner = last[at];
            last[at] = before[corner];
            at = vertex(corner);
            if (place[at] == none) continue;
            found.emplace_back(path.begin() + place[at], path.end());
            for (Index v : found.back()) place[v] = none;
            path.resize(path.size() - found.back().size());
        }
    }
    return found;
}

// The triangulation of a loop with the least area and, among those of about the same area, with the shortest
// edges; by dynamic programming in cubic time.
class LeastArea {
 public:
    explicit LeastArea(std::span<const vec3> corners)
        : corners_(corners), n_(Index(corners.size())), best_(n_ * n_), tip_(n_ * n_) {
        for (Index width = 2; width < n_; ++width)
            for (Index from = 0; from + width < n_; ++from) choose_tip(from, from + width);
    }

    void cut(std::vector<uvec3>& out) const { cut(0, n_ - 1, out); }

 private:
    void choose_tip(Index from, Index to) {
        double& best = best_[from * n_ + to];
        best = std::numeric_limits<double>::max();
        for (Index tip = from + 1; tip < to; ++tip) {
            const double sum = best_[from * n_ + tip] + best_[tip * n_ + to] + cost(from, tip, to);
            if (sum >= best) continue;
            best = sum;
            tip_[from * n_ + to] = tip;
        }
    }

    double cost(Index i, Index j, Index k) const {
        const dvec3 a(corners_[i]), ab = dvec3(corners_[j]) - a, ac = dvec3(corners_[k]) - a, bc = ac - ab;
        return glm::length(glm::cross(ab, ac)) +
               1e-3 * (glm::dot(ab, ab) + glm::dot(ac, ac) + glm::dot(bc, bc));
    }

    void cut(Index from, Index to, std::vector<uvec3>& out) const {
        if (to - from < 2) return;
        const Index tip = tip_[from * n_ + to];
        out.push_back({from, tip, to});
        cut(from, tip, out);
        cut(tip, to, out);
    }

    std::span<const vec3> corners_;
    Index n_;
    std::vector<double> best_;  // the cost of the triangles beyond the chord from one corner to a later one
    std::vector<Index> tip_;    // the tip of the triangle on that chord
};

constexpr double most_work = 1e9;  // steps of the dynamic programming, about a second or two

}  // namespace

std::size_t close_holes(Mesh& mesh) {
    const std::vector<std::vector<Index>> found = loops(mesh);
    std::vector<vec3> corners;
    std::vector<uvec3> faces;
    double work = 0;
    for (const std::vector<Index>& loop : found) {
        corners.clear(), faces.clear();
        for (Index v : loop) corners.push_back(mesh.positions[v]);
        const double steps = std::pow(double(loop.size()), 3) / 6;
        if (work + steps <= most_work && loop.size() <= 400) {
            work += steps;
            LeastArea(corners).cut(faces);
        } else {
            triangulate(corners, faces);
        }
        for (uvec3 t : faces) mesh.triangles.push_back({loop[t.x], loop[t.y], loop[t.z]});
    }
    if (!found.empty()) drop_attributes(mesh);
    return found.size();
}

}  // namespace palpate
