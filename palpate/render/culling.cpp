#include "palpate/render/culling.h"

#include "palpate/render/gpu_embedding.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <span>
#include <string>

namespace palpate {
namespace {

const char* cell_parts_glsl =
#include "embedded/cell_parts.glsl.h"
    ;
const char* cluster_glsl =
#include "embedded/cluster.glsl.h"
    ;
const char* cull_comp =
#include "embedded/cull.comp.h"
    ;
const char* frame_parts_glsl =
#include "embedded/frame_parts.glsl.h"
    ;
const char* triangle_parts_glsl =
#include "embedded/triangle_parts.glsl.h"
    ;

constexpr GLuint cull_group = 64;  // as in cull.comp
constexpr float widest = 0.1f;     // the cosine of half the opening angle of the widest cone of normals that
                                   // is used

// In the layout that the shaders read; the GLSL says what they mean.
struct Cluster {
    int parts_end = 0, corners_end = 0;
    vec3 axis = vec3(0);
    float cosine = 0, sine = 0;
    float sharpness = 0, smallness = 0;
};
struct CellPart {
    std::array<int, 8> nodes;
    vec3 low, high, origin;
};
struct TrianglePart {
    std::array<int, 3> nodes;
    vec2 low, high;
    float reach;
};
struct FramePart {
    std::array<int, 3> frames;
    vec2 low, high;
    std::array<vec3, 3> arm, spread;
};
struct Command {
    GLuint count, instances, first_index;
    GLint base_vertex;
    GLuint base_instance;
};
static_assert(sizeof(Cluster) == 9 * 4 && sizeof(CellPart) == 17 * 4 && sizeof(TrianglePart) == 8 * 4 &&
              sizeof(FramePart) == 25 * 4);

using Members = std::vector<unsigned>;  // numbers of vertices

Members members(std::span<const uvec3> triangles) {
    std::set<unsigned> all;
    for (uvec3 t : triangles) all.insert({t.x, t.y, t.z});
    return {all.begin(), all.end()};
}

std::span<const uvec3> triangles_of(const Clusters& clusters, std::size_t c) {
    const std::size_t begin = c > 0 ? clusters.ends[c - 1] : 0;
    return std::span(clusters.triangles).subspan(begin, clusters.ends[c] - begin);
}

// The members of a cluster, grouped by the nodes that they follow.
template <class Hangs>
auto by_nodes(const Members& members, Hangs hangs) {
    std::map<decltype(hangs(0u)), Members> groups;
    for (unsigned v : members) groups[hangs(v)].push_back(v);
    return groups;
}

// The cone that holds the normals of the triangles, for vertices at these places. It is left empty if the
// normals spread too far.
void make_cone(std::span<const uvec3> triangles, const std::map<unsigned, vec3>& places, Cluster& cluster) {
    std::vector<vec3> normals;
    vec3 sum(0);
    float sharpness = 0, smallness = 0;
    for (uvec3 t : triangles) {
        const vec3 a = places.at(t.x), b = places.at(t.y), c = places.at(t.z), area = cross(b - a, c - a);
        std::array<float, 3> sides = {distance(a, b), distance(b, c), distance(c, a)};
        std::sort(sides.begin(), sides.end());
        const float twice = length(area);
        if (!(twice > 0)) return;
        sharpness = std::max(sharpness, (sides[0] + sides[1]) / twice);
        smallness = std::max(smallness, 1 / twice);
        normals.push_back(area / twice);
        sum += normals.back();
    }
    const vec3 axis = unit(sum, vec3(0));
    float cosine = 1;
    for (vec3 n : normals) cosine = std::min(cosine, dot(n, axis) - 1e-4f);
    if (!(cosine > widest)) return;
    cluster.axis = axis;
    cluster.cosine = cosine;
    cluster.sine = std::sqrt(1 - cosine * cosine);
    cluster.sharpness = sharpness;
    cluster.smallness = smallness;
}

// Clusters and their parts, as they are built.
template <class Part>
struct Made {
    std::vector<Cluster> clusters;
    std::vector<Part> parts;
};

Made<CellPart> make(const Clusters& clusters, const Mesh& mesh, const Embedding& embedding,
                    const std::vector<InCell>& vertices) {
    Made<CellPart> made;
    const mat3 to_cells(glm::inverse(dmat3(embedding.edges)));
    const vec3 middle = bounds(mesh).centre();
    for (std::size_t c = 0; c < clusters.ends.size(); ++c) {
        const auto triangles = triangles_of(clusters, c);
        std::map<unsigned, vec3> places;  // of vertices, in cells
        for (const auto& [nodes, group] :
             by_nodes(members(triangles), [&](unsigned v) { return vertices[v].nodes; })) {
            Bounds box;
            for (unsigned v : group) box.include(vertices[v].at);
            const unsigned first = group.front();
            const vec3 origin = to_cells * (mesh.positions[first] - middle) - vertices[first].at;
            for (unsigned v : group) places[v] = origin + vertices[v].at;
            made.parts.push_back({nodes, box.low, box.high, origin});
        }
        Cluster& cluster =
            made.clusters.emplace_back(Cluster{int(made.parts.size()), int(3 * clusters.ends[c])});
        make_cone(triangles, places, cluster);
    }
    return made;
}

// The range of the second and third barycentric weight; the first is 1 minus both.
void include(const vec3& weights, vec2& low, vec2& high) {
    low = min(low, vec2(weights.y, weights.z));
    high = max(high, vec2(weights.y, weights.z));
}

Made<TrianglePart> make(const Clusters& clusters, const Mesh&, const Embedding&,
                        const std::vector<OnTriangle>& vertices) {
    Made<TrianglePart> made;
    for (std::size_t c = 0; c < clusters.ends.size(); ++c) {
        for (const auto& [nodes, group] :
             by_nodes(members(triangles_of(clusters, c)), [&](unsigned v) { return vertices[v].nodes; })) {
            TrianglePart part{nodes, vec2(1e30f), vec2(-1e30f), 0};
            for (unsigned v : group) {
                include(vertices[v].weights, part.low, part.high);
                part.reach = std::max(part.reach, length(vertices[v].offset));
            }
            made.parts.push_back(part);
        }
        made.clusters.push_back({int(made.parts.size()), int(3 * clusters.ends[c])});
    }
    return made;
}

Made<FramePart> make(const Clusters& clusters, const Mesh&, const Embedding&, const Framed& framed) {
    Made<FramePart> made;
    for (std::size_t c = 0; c < clusters.ends.size(); ++c) {
        for (const auto& [frames, group] : by_nodes(members(triangles_of(clusters, c)),
                                                    [&](unsigned v) { return framed.vertices[v].frames; })) {
            FramePart part{frames, vec2(1e30f), vec2(-1e30f), {}, {}};
            std::array<Bounds, 3> arms;
            for (unsigned v : group) {
                include(framed.vertices[v].weights, part.low, part.high);
                for (std::size_t k = 0; k < 3; ++k) arms[k].include(framed.vertices[v].arms[k]);
            }
            for (std::size_t k = 0; k < 3; ++k) {
                part.arm[k] = arms[k].centre();
                part.spread[k] = 0.5f * arms[k].size();
            }
            made.parts.push_back(part);
        }
        made.clusters.push_back({int(made.parts.size()), int(3 * clusters.ends[c])});
    }
    return made;
}

gl::Program finder(const Embedding& embedding, bool in_textures) {
    const char* kinds[] = {cell_parts_glsl, triangle_parts_glsl, frame_parts_glsl};
    static_assert(std::size(kinds) == std::variant_size_v<decltype(embedding.vertices)>);
    const std::string text = "#version 450 core\n" + nodes_shader(in_textures) + cluster_glsl +
                             kinds[embedding.vertices.index()] + cull_comp;
    return gl::Program({{GL_COMPUTE_SHADER, "cull.comp", text}});
}

}  // namespace

Culling::Culling(const Clusters& clusters, const Mesh& mesh, const Embedding& embedding)
    : from_buffers_(finder(embedding, false)), from_textures_(finder(embedding, true)) {
    std::visit(
        [&](const auto& vertices) {
            const auto made = make(clusters, mesh, embedding, vertices);
            parts_ = gl::Buffer(made.parts);
            clusters_ = gl::Buffer(made.clusters);
        },
        embedding.vertices);
    for (std::size_t c = 0; c < clusters.ends.size(); ++c)
        sizes_.push_back({members(triangles_of(clusters, c)).size(), 3 * clusters.ends[c]});
    commands_ = gl::Buffer::room(sizes_.size() * sizeof(Command));
}

void Culling::find(const View& view, bool culls_back_faces, bool in_textures, float moved) const {
    const gl::Program& program = in_textures ? from_textures_ : from_buffers_;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 3, parts_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 4, clusters_.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, commands_.name());
    program.set("to_clip", view.to_clip);
    program.set("eye", view.eye);
    program.set("culls_back_faces", culls_back_faces);
    program.set("moved", moved);
    program.use();
    glDispatchCompute(GLuint(sizes_.size() + cull_group - 1) / cull_group, 1, 1);
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

void Culling::draw() const {
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT, nullptr, GLsizei(sizes_.size()), 0);
}

Culled Culling::count(const gl::Context& context) const {
    std::vector<Command> commands(sizes_.size());
    context.read(commands_.name(), std::as_writable_bytes(std::span(commands)));
    Culled culled{.clusters = sizes_.size()};
    std::size_t drawn_until = 0;  // so many corners
    for (std::size_t c = 0; c < sizes_.size(); ++c) {
        if (commands[c].instances > 0) drawn_until = commands[c].first_index + commands[c].count;
        const bool drawn = sizes_[c].corners_end <= drawn_until;
        culled.vertices += sizes_[c].vertices;
        culled.clusters_drawn += drawn;
        culled.vertices_drawn += drawn ? sizes_[c].vertices : 0;
    }
    return culled;
}

}  // namespace palpate
