#include "palpate/body/embedding_parts.h"

namespace palpate {
namespace {

// The sum of the face normals around a node, weighted by area.
vec3 normal_round(std::span<const std::array<int, 3>> faces, std::span<const vec3> positions) {
    vec3 sum(0);
    for (const auto& [a, b, c] : faces)
        sum += glm::cross(positions[b] - positions[a], positions[c] - positions[a]);
    return direction(sum, vec3(0));
}

// How isotropic a set of vectors is: the geometric mean of the eigenvalues of their moment matrix over the
// arithmetic mean. 1 if isotropic, 0 in a plane; 0.5 if one eigenvalue is a thirtieth of the others.
double roundness(const dmat3& moments) {
    const double mean = (moments[0][0] + moments[1][1] + moments[2][2]) / 3;
    return mean > 0 ? std::cbrt(std::max(glm::determinant(moments), 0.0)) / mean : 0;
}

class FrameMaker {
 public:
    FrameMaker(const Body& body, std::span<const Facet> facets)
        : body_(body), springs_(table(body)), facets_at_(body.count()), frame_of_(body.count(), -1) {
        for (const Facet& f : facets)
            for (int node : f.nodes) facets_at_[node].push_back(f.nodes);
    }

    // The frame of a node; made on first use.
    int frame(int node, Framed& framed) {
        int& number = frame_of_[node];
        if (number < 0) {
            number = int(framed.frames.size());
            make(node, framed);
        }
        return number;
    }

 private:
    // The neighbours of a node, each with its rest vector weighted by its share over the fourth power of the
    // distance. So near ones dominate: what a neighbour tells holds half way to it, and at a rim all are on
    // one side.
    std::vector<Spoke> neighbours(int node) const {
        std::vector<Spoke> list;
        auto add = [&](int to, float share) {
            for (const Spoke& s : list)
                if (s.to == to) return;
            const vec3 toward = body_.positions[to] - body_.positions[node];
            const float square = glm::dot(toward, toward);
            if (to != node && square > 0) list.push_back({to, share / (square * square) * toward});
        };
        for (const Tie& tie : springs_.of(node))
            if (tie.to >= 0 && tie.share > 0) add(tie.to, tie.share);
        // The edges of a net's faces need not be springs.
        if (body_.cells.empty())
            for (const auto& corners : facets_at_[node])
                for (int to : corners) add(to, 1);
        return list;
    }

    void make(int node, Framed& framed) const {
        std::vector<Spoke> spokes = neighbours(node);
        dmat3 moments(0);
        for (const Spoke& s : spokes) {
            const dvec3 toward(body_.positions[s.to] - body_.positions[node]);
            moments += glm::outerProduct(dvec3(s.pull), toward);
        }
        const double size = (moments[0][0] + moments[1][1] + moments[2][2]) / 3;
        // The springs of a sheet lie nearly in a plane: there the normal of the faces serves as one more
        // spring.
        dvec3 normal(0);
        if (body_.fan > 0 || roundness(moments) < 0.5) {
            framed.faces.insert(framed.faces.end(), facets_at_[node].begin(), facets_at_[node].end());
            normal = normal_round(facets_at_[node], body_.positions);
        }
        const dmat3 whole = moments + size * glm::outerProduct(normal, normal);
        // A regularisation so small that it only matters in directions where nothing else is known.
        const dmat3 inverse = glm::inverse(whole + (1e-9 * size + 1e-30) * dmat3(1));
        for (Spoke& s : spokes) s.pull = vec3(inverse * dvec3(s.pull));
        framed.spokes.insert(framed.spokes.end(), spokes.begin(), spokes.end());
        framed.frames.push_back({node, int(framed.spokes.size()), int(framed.faces.size()),
                                 vec3(size * (inverse * normal)), mat3(dmat3(1) - whole * inverse)});
    }

    const Body& body_;
    Table springs_;
    std::vector<std::vector<std::array<int, 3>>> facets_at_;
    std::vector<int> frame_of_;
};

}  // namespace

Framed embed_on_frames(const Mesh& surface, const Body& body) {
    const Outside outside(body);
    FrameMaker maker(body, outside.all());
    Framed framed;
    framed.vertices.reserve(surface.positions.size());
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i];
        const Facet& facet = outside.nearest(v, surface.normals[i]);
        OnFrames vertex{outside.weights(facet, v), {}, surface.normals[i], {}};
        // The arms begin half way from a node to the place under the vertex, not at the node: then the blend
        // follows a curved sheet to second order. (Full arms would bulge by as much as the flat triangle
        // sags.) For affine motions both are the same.
        const vec3 foot = outside.point(facet, vertex.weights);
        for (int k = 0; k < 3; ++k) {
            vertex.frames[k] = maker.frame(facet.nodes[k], framed);
            vertex.arms[k] = v - 0.5f * (body.positions[facet.nodes[k]] + foot);
        }
        framed.vertices.push_back(vertex);
    }
    return framed;
}

}  // namespace palpate
