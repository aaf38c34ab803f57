#pragma once
#include "palpate/base/vectors.h"
#include "palpate/mesh/corners.h"

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace palpate {

/// A surface that a hand can touch, as it is at one moment.
struct Touchable {
    std::span<const vec3> positions;        // m
    std::span<const uvec3> triangles;       // counter-clockwise as seen from outside
    std::span<const vec3> velocities = {};  // m/s, one for each vertex; empty: it stands still
    bool is_sheet = false;                  // it stops a hand from both sides; otherwise only from outside
    std::span<const int> numbers = {};      // of the triangles, where they are part of a larger surface
};

/// The triangles near a place that a hand can touch, with their motion, in a bounding volume hierarchy: the
/// broad phase of contact. Queries allocate nothing, so a haptic loop may make them.
class Patch {
 public:
    struct Face {
        std::array<dvec3, 3> corners;     // m, at the time of the query
        std::array<dvec3, 3> velocities;  // m/s
        int surface;                      // the number of its Touchable
        int triangle;                     // and which of its triangles it is
        bool is_sheet;
    };

    Patch() = default;  // nothing to touch, anywhere

    /// All triangles of the surfaces that come within `radius` of `centre`. It holds at `time` (s, on the
    /// haptic loop's clock). After that, positions are extrapolated with each vertex's velocity, for
    /// `longest_guess` at most. Throws Error if a triangle refers to missing vertices.
    explicit Patch(std::span<const Touchable> surfaces, vec3 centre = vec3(0),
                   float radius = std::numeric_limits<float>::infinity(), double time = 0);

    /// Which triangles of a surface have finite corners and come within `radius` of `centre`, and some that
    /// are slightly farther away. Throws Error likewise.
    static std::vector<int> near(const Touchable& surface, vec3 centre, float radius);

    static constexpr double longest_guess = 0.05;  // s: three frames. After that the simulation must have
                                                   // stalled

    double time() const { return time_; }  // s, at which it holds

    /// The ball outside of which nothing is known.
    dvec3 centre() const { return centre_; }
    double radius() const { return radius_; }

    /// A bound on the speed of all vertices, m/s; velocities beyond `fastest_guess` are reduced to it, since
    /// only a diverging simulation is so fast.
    double fastest() const { return double(fastest_); }
    static constexpr float fastest_guess = 3;

    /// The number of Touchables.
    std::size_t surfaces() const { return surfaces_; }

    std::size_t size() const { return faces_ ? faces_->from.size() : 0; }

    /// A triangle of a surface at a time, if it is in the patch.
    std::optional<Face> find(int surface, int triangle, double time) const;

    /// Broad phase: calls act(Face) for every triangle that comes within `reach` of a point at a time, and
    /// for some that are slightly farther away.
    template <class Act>
    void for_each_near(dvec3 point, double reach, double time, const Act& act) const {
        const float far = float(reach) + 1e-6f + 3e-7f * float(glm::length(point));  // for rounding to floats
        for_each_within(vec3(point), far * far, float(age_at(time)),
                        [&](Index face) { act(face_at(face, time)); });
    }

 private:
    friend class PatchMaker;

    struct From {
        int surface, triangle;
        bool is_sheet;
    };
    struct Vertex {
        int surface;
        unsigned vertex;
    };
    struct Node {
        Index first, count;  // the range of its triangles
        Index second;        // the second child; the first is the next node. 0: a leaf
    };
    // The triangles of a patch, wherever they are now: what patches share that are made one after another.
    struct Faces {
        std::vector<Node> nodes;       // a bounding volume hierarchy over them
        std::vector<uvec3> triangles;  // indices into `vertices`; ordered by node
        std::vector<From> from;        // of each triangle
        std::vector<Index> sorted;     // all triangles, so that `from` increases
        std::vector<Vertex> vertices;
    };

    using Vector [[gnu::vector_size(16)]] = float;  // x, y, z and 0: a SIMD register
    static Vector in_register(vec3 v) { return Vector{v.x, v.y, v.z, 0}; }
    // The bounds of a node's vertices, which move.
    struct MovingBox {
        Vector low, high;              // m, at first
        Vector low_speed, high_speed;  // m/s, along each axis
    };

    // The blocks of vertices between which the corners of a block of triangles lie.
    struct Span {
        Index first, last;
    };
    using Spans = std::vector<Span>;  // of the blocks of a surface

    static std::vector<Spans> spans(std::span<const Touchable> surfaces);
    // Of those with finite positions.
    static std::shared_ptr<const Faces> faces_near(std::span<const Touchable> surfaces,
                                                   const std::vector<Spans>& spans, vec3 centre,
                                                   float radius);
    Patch(std::shared_ptr<const Faces> faces, std::span<const Touchable> surfaces, vec3 centre, float radius,
          double time);
    void gather(std::span<const Touchable> surfaces);
    void enclose();

    double age_at(double time) const;
    Face face_at(Index face, double time) const;

    template <class Act>
    void for_each_within(vec3 point, float squared, float age, const Act& act) const {
        if (boxes_.empty()) return;
        std::array<Index, 128> waiting;  // a tree along a Z curve is never so deep
        std::size_t count = 0;
        waiting[count++] = 0;
        const Vector centre = in_register(point);
        while (count > 0) {
            const Index here = waiting[--count];
            const MovingBox& box = boxes_[here];
            const Vector below = box.low + age * box.low_speed - centre,
                         above = centre - (box.high + age * box.high_speed);
            const Vector off = below > above ? below : above, outside = off > 0 ? off * off : Vector{};
            if (outside[0] + outside[1] + outside[2] > squared) continue;
            const Node& node = faces_->nodes[here];
            if (node.second == 0) {
                for (Index face = node.first; face < node.first + node.count; ++face) act(face);
                continue;
            }
            waiting[count++] = node.second;
            waiting[count++] = here + 1;
        }
    }

    dvec3 centre_ = dvec3(0);
    double radius_ = std::numeric_limits<double>::infinity();
    double time_ = 0;
    float fastest_ = 0;  // m/s
    std::size_t surfaces_ = 0;
    std::shared_ptr<const Faces> faces_;
    std::vector<MovingBox> boxes_;                // of the faces' nodes
    std::vector<Vector> positions_, velocities_;  // of the faces' vertices
};

/// Makes the patches of a hand, one after another, on surfaces that move little from one to the next. It
/// looks at all triangles only now and then, and remembers those that come within somewhat more than the
/// radius: until another one can have come within the radius, it takes their new positions alone.
class PatchMaker {
 public:
    /// Patch(surfaces, centre, radius, time), with some triangles that are farther away. If triangles were
    /// changed in place, forget() them first.
    Patch next(std::span<const Touchable> surfaces, vec3 centre = vec3(0),
               float radius = std::numeric_limits<float>::infinity(), double time = 0);

    void forget() { faces_.reset(); }

 private:
    // A surface as it was when all of its triangles were looked at.
    struct Seen {
        std::span<const uvec3> triangles;
        bool is_sheet;
        std::vector<vec3> watched;  // positions of the vertices that may bring other triangles near; those
                                    // of others are not a number
    };

    bool is_same(std::span<const Touchable> surfaces) const;
    bool knows(std::span<const Touchable> surfaces, vec3 centre, float radius) const;
    bool is_sound(const Patch& patch) const;
    void look(std::span<const Touchable> surfaces, vec3 centre, float radius);
    void watch(std::span<const vec3> positions, std::vector<vec3>& watched) const;

    std::shared_ptr<const Patch::Faces> faces_;  // all that come within reach_ of centre_
    double size_ = 0;                            // m, of all their boxes
    vec3 centre_ = vec3(0);
    float reach_ = 0;  // m
    std::vector<Seen> seen_;
    std::vector<Patch::Spans> spans_;  // of the surfaces seen
};

}  // namespace palpate
