#include "palpate/body/embedding.h"

#include "palpate/base/error.h"
#include "palpate/body/embedding_parts.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

void check(const Body& body, Mapping mapping) {
    if (!body.cells.empty()) return;
    if (mapping == Mapping::trilinear)
        throw Error("no cells for the trilinear mapping", name_in_errors(body),
                    "use the mapping frames, or a lattice at least two nodes thick along each axis");
    if (body.faces.empty())
        throw Error("a body with neither filled cells nor faces", name_in_errors(body),
                    "make it at least two nodes thick along each axis to hang a surface on it, or give a net "
                    "faces");
}

// Two trial deformations of a box: twisted by 90° along its longest side, or bent by as much towards its
// shortest.
class Trial {
 public:
    explicit Trial(const Bounds& box) : middle_(box.centre()) {
        const vec3 size = box.size();
        for (int k = 0; k < 3; ++k) {
            if (size[k] > size[along_]) along_ = k;
            if (size[k] <= size[across_]) across_ = k;
        }
        if (across_ == along_) across_ = (along_ + 1) % 3;
        rate_ = glm::radians(90.0f) / std::max(size[along_], 1e-20f);
    }
    vec3 twisted(vec3 p) const {
        p -= middle_;
        const int y = (along_ + 1) % 3, z = (along_ + 2) % 3;
        const float c = std::cos(rate_ * p[along_]), s = std::sin(rate_ * p[along_]);
        const float turned = c * p[y] - s * p[z];
        p[z] = s * p[y] + c * p[z];
        p[y] = turned;
        return middle_ + p;
    }
    vec3 bent(vec3 p) const {
        p -= middle_;
        const float angle = rate_ * p[along_], radius = 1 / rate_ - p[across_];
        p[along_] = radius * std::sin(angle);
        p[across_] = 1 / rate_ - radius * std::cos(angle);
        return middle_ + p;
    }

 private:
    vec3 middle_;
    int along_ = 0, across_ = 2;
    float rate_;  // 1/m
};

// The ideal positions of a surface over a sheet when all space is deformed: each vertex keeps its height over
// the same place of the deformed sheet, along its normal. The sheet cannot determine more than that.
template <class Motion>
std::vector<vec3> carried_by(Motion motion, const Mesh& surface, const Body& body) {
    std::vector<vec3> moved;
    const Outside outside(body);
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const vec3 v = surface.positions[i];
        const Facet& facet = outside.nearest(v, surface.normals[i]);
        const vec3 n = facet.normal;
        const float height = glm::dot(v - body.positions[facet.nodes[0]], n), step = 0.05f * body.spacing;
        const vec3 foot = v - height * n;
        const vec3 x = glm::normalize(any_perpendicular(n)), y = glm::cross(n, x);
        auto slope = [&](vec3 along) { return motion(foot + step * along) - motion(foot - step * along); };
        moved.push_back(motion(foot) + height * direction(glm::cross(slope(x), slope(y)), n));
    }
    return moved;
}

// The squared error, summed over vertices, of a surface whose nodes are moved by the motion.
template <class Motion>
double misfit(const Mesh& surface, const Body& body, const Embedding& skin, Motion motion) {
    std::vector<vec3> nodes, positions, normals;
    for (vec3 p : body.positions) nodes.push_back(motion(p));
    const std::vector<vec3> approximate = approximate_normals(body, nodes);
    deform(skin, {nodes, approximate}, positions, normals);
    const std::vector<vec3> exact = carried_by(motion, surface, body);
    double sum = 0;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        const dvec3 way = dvec3(positions[i]) - dvec3(exact[i]);
        sum += glm::dot(way, way);
    }
    return sum;
}

// On sheets no mapping is always the best: frames do best on fine ones, the interpolated basis where there
// are few nodes. So each is tried on a twist and a bend of this surface. Frames must beat both mappings of
// the paper in both trials; otherwise the one of those two with the smaller total error is taken.
Embedding embed_by_trial(const Mesh& surface, const Body& body) {
    const Trial trial(bounds(surface));
    struct Tried {
        Embedding skin;
        double twist, bend;
    };
    auto attempt = [&](Mapping mapping) {
        Tried tried{embed(surface, body, mapping), 0, 0};
        tried.twist = misfit(surface, body, tried.skin, [&](vec3 p) { return trial.twisted(p); });
        tried.bend = misfit(surface, body, tried.skin, [&](vec3 p) { return trial.bent(p); });
        return tried;
    };
    Tried frames = attempt(Mapping::frames), turned = attempt(Mapping::interpolated),
          flat = attempt(Mapping::constant);
    if (frames.twist <= std::min(turned.twist, flat.twist) && frames.bend <= std::min(turned.bend, flat.bend))
        return std::move(frames.skin);
    return turned.twist + turned.bend <= flat.twist + flat.bend ? std::move(turned.skin)
                                                                : std::move(flat.skin);
}

}  // namespace

Embedding embed(const Mesh& surface, const Body& body, Mapping mapping) {
    check(surface, "the surface that is hung on " + name_in_errors(body));
    check(body);
    if (surface.positions.empty()) return {};
    check(body, mapping);
    if (surface.normals.size() != surface.positions.size()) {
        Mesh with_normals = surface;
        compute_normals(with_normals);
        return embed(with_normals, body, mapping);
    }
    if (mapping == Mapping::automatic && body.fan > 0) return embed_by_trial(surface, body);
    // Around a solid, bases of triangles open seams where neighbouring vertices are attached to different
    // sides; frames do not.
    if (mapping == Mapping::automatic) mapping = body.cells.empty() ? Mapping::frames : Mapping::trilinear;
    const bool has_tangents = surface.tangents.size() == surface.positions.size();
    const std::vector<vec4> tangents = has_tangents ? surface.tangents : std::vector<vec4>();
    if (mapping == Mapping::trilinear) {
        auto vertices = embed_in_cells(surface, body);
        auto in_cells = tangents_in(vertices, body, tangents);
        return {std::move(vertices), std::move(in_cells), cell_edges(body), body.count()};
    }
    if (mapping == Mapping::frames) return {embed_on_frames(surface, body), tangents, {}, body.count()};
    auto vertices = embed_on_triangles(surface, body, mapping);
    auto in_bases = tangents_in(vertices, body, tangents);
    return {std::move(vertices), std::move(in_bases), {}, body.count()};
}

namespace {

template <class Vertex>
std::vector<Vertex> these(const std::vector<Vertex>& all, std::span<const unsigned> vertices) {
    std::vector<Vertex> some;
    for (unsigned v : vertices) some.push_back(all[v]);
    return some;
}

Framed these(const Framed& all, std::span<const unsigned> vertices) {
    Framed some;
    some.vertices = these(all.vertices, vertices);
    std::vector<int> number(all.frames.size(), -1);
    auto add = [&](int frame) {
        const auto f = std::size_t(frame);
        if (number[f] >= 0) return;
        number[f] = int(some.frames.size());
        const int spokes = f > 0 ? all.frames[f - 1].spokes_end : 0,
                  faces = f > 0 ? all.frames[f - 1].faces_end : 0;
        Frame copy = all.frames[f];
        some.spokes.insert(some.spokes.end(), all.spokes.begin() + spokes,
                           all.spokes.begin() + copy.spokes_end);
        some.faces.insert(some.faces.end(), all.faces.begin() + faces, all.faces.begin() + copy.faces_end);
        copy.spokes_end = int(some.spokes.size());
        copy.faces_end = int(some.faces.size());
        some.frames.push_back(copy);
    };
    for (OnFrames& vertex : some.vertices)
        for (int& frame : vertex.frames) {
            add(frame);
            frame = number[std::size_t(frame)];
        }
    return some;
}

}  // namespace

Embedding part_of(const Embedding& whole, std::span<const unsigned> vertices) {
    return std::visit(
        [&](const auto& all) {
            return Embedding{these(all, vertices), {}, whole.edges, whole.nodes};
        },
        whole.vertices);
}

std::vector<vec3> approximate_normals(const Body& body, std::span<const vec3> positions) {
    if (positions.size() < body.count())
        throw Error(fmt::format("{} positions of {} nodes", positions.size(), body.count()),
                    name_in_errors(body), "hand in one for each");
    const Table springs = table(body);
    std::vector<vec3> normals(body.count(), vec3(0));
    for (std::size_t i = 0; i < body.count(); ++i) {
        const auto ties = springs.of(i);
        auto toward = [&](int t) { return ties[t].to < 0 ? vec3(0) : positions[ties[t].to] - positions[i]; };
        vec3 round(0);
        for (int t = 0; t < body.fan; ++t) round += glm::cross(toward(t), toward((t + 1) % body.fan));
        normals[i] = direction(round, vec3(0));
        if (body.fan == 0)
            for (int t = 0; t < springs.width; ++t)
                if (ties[t].to >= 0) normals[i] -= ties[t].share * direction(toward(t), vec3(0));
    }
    return normals;
}

std::size_t vertex_count(const Embedding& embedding) {
    if (const auto* framed = std::get_if<Framed>(&embedding.vertices)) return framed->vertices.size();
    if (const auto* in_cells = std::get_if<std::vector<InCell>>(&embedding.vertices)) return in_cells->size();
    return std::get<std::vector<OnTriangle>>(embedding.vertices).size();
}

void check(const Nodes& nodes, const Embedding& embedding) {
    const auto* on_triangles = std::get_if<std::vector<OnTriangle>>(&embedding.vertices);
    const bool needs_normals = on_triangles && std::ranges::any_of(*on_triangles, [](const OnTriangle& v) {
                                   return v.curvature > 0;
                               });
    if (nodes.positions.size() < embedding.nodes)
        throw Error(
            fmt::format("{} nodes instead of the {} of the body", nodes.positions.size(), embedding.nodes),
            "the surface that follows them", "hand in all of them");
    if (nodes.normals.size() < embedding.nodes && needs_normals)
        throw Error("the approximate normals are missing that the mapping needs",
                    "the surface that is deformed", "hand in Solver::nodes(), or approximate_normals()");
}

}  // namespace palpate
