// Carries surfaces along: mapping.inl with a vector in one register.
#include "palpate/base/team.h"
#include "palpate/body/embedding.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace palpate {
namespace {

#define FN [[gnu::always_inline]] inline

// Four floats in a register, which every machine has; what is in the fourth place means nothing.
struct Vector {
    using Four [[gnu::vector_size(16)]] = float;
    Four v;

    Vector() = default;
    FN Vector(Four four) : v(four) {}
    FN Vector(float x, float y, float z) : v{x, y, z, 0} {}
    FN explicit Vector(vec3 a) : Vector(a.x, a.y, a.z) {}

    FN friend Vector operator+(Vector a, Vector b) { return a.v + b.v; }
    FN friend Vector operator-(Vector a, Vector b) { return a.v - b.v; }
    FN friend Vector operator*(float s, Vector a) { return s * a.v; }
    FN friend float x_of(Vector a) { return a.v[0]; }
    FN friend float dot(Vector a, Vector b) {
        const Four products = a.v * b.v;
        return products[0] + (products[1] + products[2]);
    }
    FN friend Vector cross(Vector a, Vector b) { return next(a.v * next(b.v) - next(a.v) * b.v); }

 private:
    FN static Four next(Four a) { return __builtin_shufflevector(a, a, 1, 2, 0, 3); }  // y, z, x
};

struct Text {
    using Real = float;
    using Real3 = Vector;
    FN static Vector select(bool c, Vector a, Vector b) { return c ? a : b; }
    FN static float abs(float a) { return std::abs(a); }
    FN static float min(float a, float b) { return b < a ? b : a; }
    FN static float inversesqrt(float a) { return 1 / std::sqrt(a); }
#undef FN
#define FN [[gnu::always_inline]] static inline
#include "palpate/body/mapping.inl"
#undef FN
#define FN [[gnu::always_inline]] inline
};

FN Vector load(const vec4& from) {
    Vector::Four four;
    std::memcpy(&four, &from, sizeof four);
    return four;
}

FN void store(Vector a, vec4& to) { std::memcpy(&to, &a.v, sizeof to); }

// Writes three floats; where more of the same follows, which will overwrite it, a fourth.
FN void store(Vector a, vec3& to, bool more) {
    std::memcpy(&to, &a.v, more ? sizeof a.v : sizeof to);
}

// What there is to do.
struct Work {
    const Embedding& embedding;
    const vec4 *positions, *normals;  // of nodes
    mat3x4* gradients;                // of frames
    vec3 *to_positions, *to_normals;
    vec4* to_tangents;  // null: not asked for
};

class Carrier : Text {
 public:
    explicit Carrier(const Work& work) : work_(work) {}

    // Each from one vertex, or frame, to before another.

    void carry(const std::vector<InCell>& vertices, std::size_t first, std::size_t end) const {
        for (std::size_t i = first; i < end; ++i) {
            const InCell& vertex = vertices[i];
            Vector corner[8];
            for (int k = 0; k < 8; ++k) corner[k] = node(vertex.nodes[std::size_t(k)]);
            const Followed f = in_cell(corner, vertex.at.x, vertex.at.y, vertex.at.z);
            put(i, end, f, by_cofactors(f, vertex.normal));
        }
    }

    void carry(const std::vector<OnTriangle>& vertices, std::size_t first, std::size_t end) const {
        for (std::size_t i = first; i < end; ++i) {
            const OnTriangle& vertex = vertices[i];
            const auto [a, b, c] = vertex.nodes;
            const float wa = vertex.weights.x, wb = vertex.weights.y, wc = vertex.weights.z;
            Vector approximate(0, 0, 0);
            if (vertex.curvature > 0)
                approximate = wa * clear_direction(load(work_.normals[a])) +
                              (wb * clear_direction(load(work_.normals[b])) + wc * clear_direction(load(work_.normals[c])));
            Followed f = on_triangle(node(a), node(b), node(c), approximate, vertex.curvature);
            const Vector foot = wa * node(a) + (wb * node(b) + wc * node(c));
            f.position = foot + expand(f, vertex.offset.x, vertex.offset.y, vertex.offset.z);
            put(i, end, f, direction(expand(f, vertex.normal.x, vertex.normal.y, vertex.normal.z), f.y));
        }
    }

    void carry(const Framed& framed, std::size_t first, std::size_t end) const {
        for (std::size_t i = first; i < end; ++i) {
            const OnFrames& vertex = framed.vertices[i];
            Followed f;
            f.position = f.x = f.y = f.z = Vector(0, 0, 0);
            for (int k = 0; k < 3; ++k) {
                const int frame = vertex.frames[std::size_t(k)];
                const float w = vertex.weights[k];
                const vec3 arm = vertex.arms[std::size_t(k)];
                const mat3x4& gradient = work_.gradients[frame];
                const Vector x = load(gradient[0]), y = load(gradient[1]), z = load(gradient[2]);
                const Vector at = node(framed.frames[std::size_t(frame)].node);
                f.position = f.position + w * (at + (arm.x * x + (arm.y * y + arm.z * z)));
                f.x = f.x + w * x, f.y = f.y + w * y, f.z = f.z + w * z;
            }
            put(i, end, f, by_cofactors(f, vertex.normal));
        }
    }

    // The gradient of the deformation at each frame.
    void find_gradients(const Framed& framed, std::size_t first, std::size_t end) const {
        for (std::size_t i = first; i < end; ++i) {
            const Frame& frame = framed.frames[i];
            const int spokes = i > 0 ? framed.frames[i - 1].spokes_end : 0, faces = i > 0 ? framed.frames[i - 1].faces_end : 0;
            Vector x(frame.rest[0]), y(frame.rest[1]), z(frame.rest[2]);
            auto add = [&](Vector along, vec3 pull) {
                x = x + pull.x * along, y = y + pull.y * along, z = z + pull.z * along;
            };
            for (int s = spokes; s < frame.spokes_end; ++s)
                add(node(framed.spokes[std::size_t(s)].to) - node(frame.node), framed.spokes[std::size_t(s)].pull);
            if (faces < frame.faces_end) {
                Vector sum(0, 0, 0);  // of the faces' normals, each by its area
                for (int f = faces; f < frame.faces_end; ++f) {
                    const auto [a, b, c] = framed.faces[std::size_t(f)];
                    sum = sum + cross(node(b) - node(a), node(c) - node(a));
                }
                add(direction(sum, Vector(0, 0, 0)), frame.normal_pull);
            }
            mat3x4& to = work_.gradients[i];
            store(x, to[0]), store(y, to[1]), store(z, to[2]);
        }
    }

 private:
    FN Vector node(int i) const { return load(work_.positions[i]); }
    FN static Vector by_cofactors(const Followed& f, vec3 n) {
        return normal_by_cofactors(f, n.x, n.y, n.z, Vector(n));
    }
    FN void put(std::size_t i, std::size_t end, const Followed& f, Vector normal) const {
        const bool more = i + 1 < end;
        store(f.position, work_.to_positions[i], more);
        store(normal, work_.to_normals[i], more);
        if (!work_.to_tangents) return;
        const vec4 t = work_.embedding.tangents[i];
        store(upright(expand(f, t.x, t.y, t.z), normal), work_.to_tangents[i]);
        work_.to_tangents[i].w = t.w;
    }

    const Work& work_;
};

std::size_t count(const Embedding& embedding) {
    if (const auto* framed = std::get_if<Framed>(&embedding.vertices)) return framed->vertices.size();
    if (const auto* in_cells = std::get_if<std::vector<InCell>>(&embedding.vertices)) return in_cells->size();
    return std::get<std::vector<OnTriangle>>(embedding.vertices).size();
}

std::vector<vec4> padded(std::span<const vec3> vectors) {
    std::vector<vec4> with_room;
    with_room.reserve(vectors.size());
    for (vec3 v : vectors) with_room.emplace_back(v, 0.0f);
    return with_room;
}

}  // namespace

void deform(const Embedding& embedding, const Nodes& nodes, std::vector<vec3>& positions,
            std::vector<vec3>& normals, std::vector<vec4>* tangents, Team* team) {
    const std::size_t vertices = count(embedding);
    positions.resize(vertices);
    normals.resize(vertices);
    if (tangents) tangents->resize(embedding.tangents.size());
    const auto* framed = std::get_if<Framed>(&embedding.vertices);
    const std::vector<vec4> at = padded(nodes.positions), facing = padded(nodes.normals);
    std::vector<mat3x4> gradients(framed ? framed->frames.size() : 0);
    const bool with_tangents = tangents && !tangents->empty();
    const Work work{embedding,      at.data(),      facing.data(), gradients.data(),
                    positions.data(), normals.data(), with_tangents ? tangents->data() : nullptr};
    const Carrier carrier(work);
    auto part = [&](std::size_t all, int member) { return all * std::size_t(member) / std::size_t(team ? team->members() : 1); };
    auto share = [&](int member) {
        if (framed) {
            const std::size_t frames = framed->frames.size();
            carrier.find_gradients(*framed, part(frames, member), part(frames, member + 1));
            if (team) team->meet();
        }
        std::visit([&](const auto& v) { carrier.carry(v, part(vertices, member), part(vertices, member + 1)); },
                   embedding.vertices);
    };
    if (team)
        team->run(share);
    else
        share(0);
}

}  // namespace palpate
