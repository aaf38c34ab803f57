// Maps surfaces: mapping.inl for as many vertices at once as a SIMD register holds floats, compiled once for
// each instruction set.
#include "palpate/base/error.h"
#include "palpate/base/team.h"
#include "palpate/body/embedding_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#define HWY_DISABLED_TARGETS \
    (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "palpate/body/deform.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef PALPATE_BODY_DEFORM
#define PALPATE_BODY_DEFORM
namespace palpate {

// The inputs and outputs of one mapping.
struct MappingWork {
    const Embedding& embedding;
    const vec4 *positions, *normals;  // of nodes, padded to four floats
    const mat4* frames;               // the deformation gradient at each, and the position of its node
    vec3 *to_positions, *to_normals;  // normals: null where they are not asked for
    vec4* to_tangents;                // null: not wanted
};

}  // namespace palpate
#endif

#undef FN
#define FN HWY_INLINE

HWY_BEFORE_NAMESPACE();
namespace palpate::HWY_NAMESPACE {

#include "palpate/base/pack-inl.h"

struct Text {
    using Real = Pack;
    using Real3 = Pack3;
#include "palpate/body/mapping.inl"
};

// As many vertices as there are lanes, from `first` on; past `end` the last one is repeated.
template <class Vertex>
class Lanewise : Text {
 public:
    FN Lanewise(const MappingWork& work, const std::vector<Vertex>& vertices, std::size_t first,
                std::size_t end)
        : work_(work), vertices_(vertices.data()), first_(first), end_(end) {}

    FN void map_vertices() {
        if constexpr (std::is_same_v<Vertex, InCell>) map_in_cells();
        if constexpr (std::is_same_v<Vertex, OnTriangle>) map_on_triangles();
        if constexpr (std::is_same_v<Vertex, OnFrames>) map_on_frames();
    }

 private:
    FN std::size_t number(std::size_t lane) const { return std::min(first_ + lane, end_ - 1); }
    FN const Vertex& vertex(std::size_t lane) const { return vertices_[number(lane)]; }

    FN Pack3 each(vec3 Vertex::*member) const {
        return load_each([&](std::size_t lane) HWY_ATTR { return &(vertex(lane).*member).x; });
    }
    template <class Index>
    FN Pack3 each(const vec4* from, Index index) const {
        return load_each([&](std::size_t lane) HWY_ATTR { return &from[index(vertex(lane))].x; });
    }

    FN void map_in_cells() {
        Pack3 corner[8];
        for (std::size_t k = 0; k < 8; ++k)
            corner[k] = each(work_.positions, [k](const InCell& v) HWY_ATTR { return v.nodes[k]; });
        const Pack3 at = each(&InCell::at), n = each(&InCell::normal);
        const MappedVertex f = in_cell(corner, at.x, at.y, at.z);
        put(f, [&]() HWY_ATTR { return normal_by_cofactors(f, n.x, n.y, n.z, n); });
    }

    FN void map_on_triangles() {
        Pack3 node[3], approximate(0.0f, 0.0f, 0.0f);
        const Pack3 weights = each(&OnTriangle::weights);
        const Pack w[3] = {weights.x, weights.y, weights.z};
        HWY_ALIGN float curvatures[HWY_LANES(float)];
        bool flat = true;
        for (std::size_t lane = 0; lane < lanes(); ++lane) {
            curvatures[lane] = vertex(lane).curvature;
            flat = flat && !(curvatures[lane] > 0);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            auto index = [k](const OnTriangle& v) HWY_ATTR { return v.nodes[k]; };
            node[k] = each(work_.positions, index);
            if (!flat) approximate += w[k] * clear_direction(each(work_.normals, index));
        }
        MappedVertex f =
            on_triangle(node[0], node[1], node[2], approximate, ::palpate::HWY_NAMESPACE::load(curvatures));
        const Pack3 offset = each(&OnTriangle::offset), n = each(&OnTriangle::normal);
        f.position =
            w[0] * node[0] + (w[1] * node[1] + w[2] * node[2]) + expand(f, offset.x, offset.y, offset.z);
        put(f, [&]() HWY_ATTR { return direction(expand(f, n.x, n.y, n.z), f.y); });
    }

    FN void map_on_frames() {
        const Pack3 weights = each(&OnFrames::weights), n = each(&OnFrames::normal);
        const Pack w[3] = {weights.x, weights.y, weights.z};
        MappedVertex f;
        f.position = f.x = f.y = f.z = Pack3(0.0f, 0.0f, 0.0f);
        for (std::size_t k = 0; k < 3; ++k) {
            const Pack3 arm = load_each([&](std::size_t lane) HWY_ATTR { return &vertex(lane).arms[k].x; });
            auto column = [&](int c) HWY_ATTR {
                return load_each([&](std::size_t lane)
                                     HWY_ATTR { return &work_.frames[vertex(lane).frames[k]][c].x; });
            };
            const Pack3 x = column(0), y = column(1), z = column(2);
            f.position += w[k] * (column(3) + (arm.x * x + (arm.y * y + arm.z * z)));
            f.x += w[k] * x;
            f.y += w[k] * y;
            f.z += w[k] * z;
        }
        put(f, [&]() HWY_ATTR { return normal_by_cofactors(f, n.x, n.y, n.z, n); });
    }

    template <class Normal>
    FN void put(const MappedVertex& f, Normal find_normal) {
        write(f.position, work_.to_positions);
        if (!work_.to_normals) return;
        const Pack3 normal = find_normal();
        write(normal, work_.to_normals);
        if (!work_.to_tangents) return;
        const vec4* rest = work_.embedding.tangents.data();
        const Pack3 t = load_each([&](std::size_t lane) HWY_ATTR { return &rest[number(lane)].x; });
        const Pack3 tangent = upright(expand(f, t.x, t.y, t.z), normal);
        HWY_ALIGN float x[HWY_LANES(float)], y[HWY_LANES(float)], z[HWY_LANES(float)];
        ::palpate::HWY_NAMESPACE::store(tangent, x, y, z, 0);
        for (std::size_t lane = 0; first_ + lane < end_ && lane < lanes(); ++lane)
            work_.to_tangents[first_ + lane] = vec4(x[lane], y[lane], z[lane], rest[first_ + lane].w);
    }
    FN void write(Pack3 a, vec3* to) {
        if (first_ + lanes() <= end_) return store_interleaved(a, &to[first_].x);
        HWY_ALIGN float some[3 * HWY_LANES(float)];
        store_interleaved(a, some);
        std::memcpy(&to[first_], some, (end_ - first_) * sizeof(vec3));
    }

    const MappingWork& work_;
    const Vertex* vertices_;
    std::size_t first_, end_;
};

template <class Vertex>
void map_all(const MappingWork& work, const std::vector<Vertex>& vertices, std::size_t first,
             std::size_t end) {
    for (std::size_t i = first; i < end; i += lanes())
        Lanewise<Vertex>(work, vertices, i, end).map_vertices();
}

// Maps the vertices `first` <= i < `end`.
void map_vertices(const MappingWork& work, std::size_t first, std::size_t end) {
    if (const auto* framed = std::get_if<Framed>(&work.embedding.vertices))
        map_all(work, framed->vertices, first, end);
    if (const auto* in_cells = std::get_if<std::vector<InCell>>(&work.embedding.vertices))
        map_all(work, *in_cells, first, end);
    if (const auto* on = std::get_if<std::vector<OnTriangle>>(&work.embedding.vertices))
        map_all(work, *on, first, end);
}

}  // namespace palpate::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace palpate {
namespace {

HWY_EXPORT(map_vertices);

std::vector<vec4> with_room(std::span<const vec3> vectors) {
    std::vector<vec4> list;
    list.reserve(vectors.size());
    for (vec3 v : vectors) list.emplace_back(v, 0.0f);
    return list;
}

// A vector in one SIMD register: the compiler does not vectorise three floats.
using Four [[gnu::vector_size(16)]] = float;
Four four(const vec4& v) { return Four{v.x, v.y, v.z, v.w}; }
Four four(vec3 v) { return Four{v.x, v.y, v.z, 0}; }
vec4 back(Four v) { return {v[0], v[1], v[2], v[3]}; }

// Finds the deformation gradients at frames `first` <= i < `end`, and the positions of their nodes.
void find_frames(const Framed& framed, const std::vector<vec4>& nodes, std::size_t first, std::size_t end,
                 std::vector<mat4>& to) {
    for (std::size_t i = first; i < end; ++i) {
        const Frame& frame = framed.frames[i];
        const int spokes = i > 0 ? framed.frames[i - 1].spokes_end : 0,
                  faces = i > 0 ? framed.frames[i - 1].faces_end : 0;
        const vec4 here = nodes[std::size_t(frame.node)];
        Four x = four(frame.rest[0]), y = four(frame.rest[1]), z = four(frame.rest[2]);
        auto add = [&](Four along, vec3 pull) {
            x += pull.x * along, y += pull.y * along, z += pull.z * along;
        };
        for (int s = spokes; s < frame.spokes_end; ++s) {
            const Spoke& spoke = framed.spokes[std::size_t(s)];
            add(four(nodes[std::size_t(spoke.to)]) - four(here), spoke.pull);
        }
        if (faces < frame.faces_end) {
            vec3 sum(0);  // of the face normals, weighted by area
            for (int f = faces; f < frame.faces_end; ++f) {
                const auto [a, b, c] = framed.faces[std::size_t(f)];
                const vec3 corner(nodes[std::size_t(a)]);
                sum += glm::cross(vec3(nodes[std::size_t(b)]) - corner, vec3(nodes[std::size_t(c)]) - corner);
            }
            add(four(direction(sum, vec3(0))), frame.normal_pull);
        }
        to[i] = mat4(back(x), back(y), back(z), here);
    }
}

// Into what is not null.
void map_all(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
             std::vector<vec3>* normals, std::vector<vec4>* tangents, Team* team) {
    check(nodes, embedding);
    const std::size_t vertices = vertex_count(embedding);
    positions.resize(vertices);
    if (normals) normals->resize(vertices);
    if (tangents) tangents->resize(embedding.tangents.size());
    const auto* framed = std::get_if<Framed>(&embedding.vertices);
    const bool on_triangles = std::holds_alternative<std::vector<OnTriangle>>(embedding.vertices);
    const std::vector<vec4> at = with_room(nodes.positions),
                            facing = with_room(on_triangles ? nodes.normals : std::span<const vec3>());
    std::vector<mat4> frames(framed ? framed->frames.size() : 0);
    const bool with_tangents = tangents && !tangents->empty();
    const MappingWork work{embedding,
                           at.data(),
                           facing.data(),
                           frames.data(),
                           positions.data(),
                           normals ? normals->data() : nullptr,
                           with_tangents ? tangents->data() : nullptr};
    const std::size_t members = std::size_t(team ? team->members() : 1);
    auto share = [&](int member) {
        auto part = [&](std::size_t all) { return all * std::size_t(member) / members; };
        auto next = [&](std::size_t all) { return all * (std::size_t(member) + 1) / members; };
        if (framed) {
            find_frames(*framed, at, part(frames.size()), next(frames.size()), frames);
            if (team) team->meet();
        }
        HWY_DYNAMIC_DISPATCH(map_vertices)(work, part(vertices), next(vertices));
    };
    if (team)
        team->run(share);
    else
        share(0);
}

}  // namespace

void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals, std::vector<vec4>* tangents, Team* team) {
    map_all(embedding, nodes, positions, &normals, tangents, team);
}

void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions, Team* team) {
    map_all(embedding, nodes, positions, nullptr, nullptr, team);
}

}  // namespace palpate
#endif
