#include "palpate/mesh/solid.h"

#include "palpate/base/error.h"
#include "palpate/base/parallel.h"
#include "palpate/mesh/repair.h"
#include "palpate/mesh/tree.h"
#include "palpate/mesh/triangle.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {
namespace {

constexpr float level_set_band = 3;  // voxels; no distance is larger
// Half a voxel's diagonal: a surface that passes through a voxel is no farther from its centre.
constexpr float wall = 0.8660254f;
// Up to this distance from the surface, distances are exact: as far as the voxel behind any wall, which says
// on which side the wall is.
constexpr float exact = 1 + wall + 1e-3f;
constexpr double most_bytes = 2e9;

constexpr int wide = 8;  // voxels, of a block
constexpr std::size_t in_block = wide * wide * wide;

// Throws unless a dense grid over the mesh's bounding box would fit; the narrow band takes less.
void check_memory(vec3 size, float voxel) {
    const dvec3 voxels = glm::ceil(dvec3(size) / double(voxel)) + 2.0 * (level_set_band + 1);
    const double bytes = voxels.x * voxels.y * voxels.z * sizeof(float);
    if (!(bytes <= most_bytes))
        throw Error(fmt::format("a distance grid of {:.0f} x {:.0f} x {:.0f} voxels, over 2 GB", voxels.x,
                                voxels.y, voxels.z),
                    "the mesh", "use larger voxels");
}

bool is_open_when_welded(Mesh mesh) {
    weld(mesh);
    return soundness(mesh).open_edges > 0;
}

// The neighbours of a voxel, which share a face (the first six), an edge or a corner with it.
const std::array<ivec3, 26> around = [] {
    std::array<ivec3, 26> ways{};
    std::size_t sides = 0, others = 6;
    for (int i = 0; i < 27; ++i)
        if (const ivec3 way = ivec3(i % 3, i / 3 % 3, i / 9) - 1; way != ivec3(0))
            ways[glm::dot(vec3(way), vec3(way)) == 1 ? sides++ : others++] = way;
    return ways;
}();

}  // namespace

// A sparse grid of voxel blocks; those far from the surface store only on which side they lie. Its unit is
// the voxel, counted from below the mesh's lowest corner: so small units and distant places lose no
// precision.
struct SignedDistance::Grid {
    vec3 origin;  // of the voxel (0, 0, 0), m
    float voxel;  // m
    ivec3 blocks;
    std::vector<Index> first;   // by block: the start of its voxels in `values`, or none
    std::vector<float> far;     // by block: the distance where it has no voxels of its own
    std::vector<float> values;  // x fastest

    bool holds(ivec3 p) const {
        return glm::all(glm::greaterThanEqual(p, ivec3(0))) && glm::all(glm::lessThan(p, wide * blocks));
    }
    std::size_t block_of(ivec3 p) const {
        const ivec3 b = p / wide;
        return (std::size_t(b.z) * blocks.y + b.y) * blocks.x + b.x;
    }
    ivec3 low_of(std::size_t block) const {
        const int b = int(block);
        return wide * ivec3(b % blocks.x, b / blocks.x % blocks.y, b / blocks.x / blocks.y);
    }
    // The index of a voxel with a stored value; none for others.
    Index number_of(ivec3 p) const {
        const Index start = first[block_of(p)];
        const ivec3 in = p % wide;
        return start == none ? none : start + Index((in.z * wide + in.y) * wide + in.x);
    }
    float at(ivec3 p) const {
        if (!holds(p)) return level_set_band;
        const Index number = number_of(p);
        return number == none ? far[block_of(p)] : values[number];
    }
    // Trilinear.
    float at(vec3 p) const {
        const ivec3 low(glm::floor(p));
        const vec3 up = p - vec3(low), down = 1.0f - up;
        float all[8];
        corners(low, all);
        auto mixed = [&](int i) { return down.x * all[i] + up.x * all[i + 1]; };
        return down.z * (down.y * mixed(0) + up.y * mixed(2)) + up.z * (down.y * mixed(4) + up.y * mixed(6));
    }

 private:
    // The eight values of a voxel and its upper neighbours, x in the lowest bit; mostly all are in one block.
    void corners(ivec3 low, float (&all)[8]) const {
        const ivec3 in = low & (wide - 1);
        if (!holds(low) || std::max({in.x, in.y, in.z}) == wide - 1) {
            for (int i = 0; i < 8; ++i) all[i] = at(low + ivec3(i & 1, i >> 1 & 1, i >> 2));
            return;
        }
        const Index number = number_of(low);
        for (int i = 0; i < 8; ++i)
            all[i] = number == none
                         ? far[block_of(low)]
                         : values[number + Index((i & 1) + wide * ((i >> 1 & 1) + wide * (i >> 2)))];
    }
};

namespace {

// Fills the grid of a mesh, whose unit is the voxel. Walls are the voxels that the surface passes through. A
// flood fill from outside that does not pass through walls finds the outside; walls on that side of the
// surface belong to it, too. Everything else is inside.
class Filling {
 public:
    Filling(const Mesh& mesh, SignedDistance::Grid& grid) : mesh_(mesh), tree_(mesh), grid_(grid) {}

    void fill() {
        find_near_blocks();
        parallel_for(near_.size(), 1, [&](std::size_t i) { measure(grid_.low_of(near_[i]), wide, none); });
        flood();
        turn_walls();
        forget_inner_walls();
        spread();
        for_each_voxel([&](ivec3, Index i) {
            if (!outside_[i]) grid_.values[i] = -grid_.values[i];
        });
    }

 private:
    // Whether a voxel is known to be outside.
    bool outside(ivec3 p) const {
        if (!grid_.holds(p)) return true;
        const Index i = grid_.number_of(p);
        return i == none ? grid_.far[grid_.block_of(p)] > 0 : bool(outside_[i]);
    }
    bool is_wall(Index i) const { return grid_.values[i] <= wall; }

    // The index of a voxel whose nearest face is known; none for others.
    Index measured(ivec3 p) const {
        const Index i = grid_.holds(p) ? grid_.number_of(p) : none;
        return i == none || face_[i] == none ? none : i;
    }

    // Calls visit(voxel, its index) for each voxel with a stored value, in parallel.
    template <class Visit>
    void for_each_voxel(const Visit& visit) const {
        parallel_for(near_.size(), 8, [&](std::size_t i) {
            const ivec3 low = grid_.low_of(near_[i]);
            Index number = grid_.first[near_[i]];
            for (int z = 0; z < wide; ++z)
                for (int y = 0; y < wide; ++y)
                    for (int x = 0; x < wide; ++x) visit(low + ivec3(x, y, z), number++);
        });
    }

    vec3 nearest_point(vec3 p, Index face) const {
        const uvec3 t = mesh_.triangles[face];
        const vec3 a = mesh_.positions[t.x], b = mesh_.positions[t.y], c = mesh_.positions[t.z];
        const vec3 weights = nearest_weights(p, a, b, c);
        return weights.x * a + weights.y * b + weights.z * c;
    }

    // The distance from the centre of a cube of voxels to the farthest voxel.
    static float reach_of(int size) { return 0.5f * std::sqrt(3.0f) * float(size - 1); }

    // The face nearest to the centre of a cube of voxels, if any of its voxels may be within the band.
    Tree::Nearest nearest(ivec3 low, int size, Index guess) const {
        return tree_.nearest(vec3(low) + 0.5f * float(size - 1), reach_of(size) + level_set_band, guess);
    }

    void find_near_blocks() {
        std::vector<char> is_near(grid_.first.size());
        parallel_for(is_near.size(), 64, [&](std::size_t block) {
            is_near[block] = nearest(grid_.low_of(block), wide, none).face != none;
        });
        for (std::size_t block = 0; block < is_near.size(); ++block) {
            if (!is_near[block]) continue;
            grid_.first[block] = Index(in_block * near_.size());
            near_.push_back(block);
        }
        grid_.values.assign(in_block * near_.size(), level_set_band);
        face_.assign(grid_.values.size(), none);
        in_band_.assign(grid_.values.size(), false);
        outside_.assign(grid_.values.size(), false);
    }

    // Works on a cube of voxels, by recursive subdivision. `guess`: a nearby face, if one is known. The
    // nearest face is found only for voxels at the surface; others that may be within the band are marked.
    void measure(ivec3 low, int size, Index guess) {
        const Tree::Nearest found = nearest(low, size, guess);
        if (found.face == none) return;
        const bool all_are_far = found.distance > exact + reach_of(size);
        for (int i = 0; i < 8; ++i) {
            const ivec3 part = low + size / 2 * ivec3(i & 1, i >> 1 & 1, i >> 2);
            if (size > 2)
                measure(part, size / 2, found.face);
            else
                measure_voxel(part, all_are_far, found.face);
        }
    }
    void measure_voxel(ivec3 p, bool is_far, Index guess) {
        const Index i = grid_.number_of(p);
        in_band_[i] = true;
        if (is_far) return;
        const Tree::Nearest found = tree_.nearest(vec3(p), exact, guess);
        if (found.face != none) grid_.values[i] = found.distance, face_[i] = found.face;
    }

    // The flood fill starts at the grid's corner, since the mesh is nowhere near its rim.
    void flood() {
        std::vector<ivec3> waiting;
        auto reach = [&](ivec3 p) {
            if (outside(p)) return;
            const Index i = grid_.number_of(p);
            if (i == none)
                grid_.far[grid_.block_of(p)] = level_set_band;
            else if (is_wall(i))
                return;
            else
                outside_[i] = true;
            waiting.push_back(p);
        };
        reach(ivec3(0));
        while (!waiting.empty()) {
            const ivec3 p = waiting.back();
            waiting.pop_back();
            if (grid_.number_of(p) != none)
                for (int side = 0; side < 6; ++side) reach(p + around[std::size_t(side)]);
            else
                reach_around(p / wide * wide, reach);
        }
    }

    // Reaches all voxels next to a block.
    template <class Reach>
    static void reach_around(ivec3 low, const Reach& reach) {
        for (int axis = 0; axis < 3; ++axis)
            for (int u = 0; u < wide; ++u)
                for (int v = 0; v < wide; ++v)
                    for (int side : {-1, wide}) {
                        ivec3 p = low;
                        p[axis] += side;
                        p[(axis + 1) % 3] += u;
                        p[(axis + 2) % 3] += v;
                        reach(p);
                    }
    }

    // A wall is outside if it is on the same side of the surface as a neighbouring voxel that was reached.
    void turn_walls() {
        for_each_voxel([&](ivec3 p, Index i) {
            if (!is_wall(i)) return;
            for (ivec3 way : around) {
                const Index beside = measured(p + way);
                if (beside == none || is_wall(beside) || !outside_[beside]) continue;
                const vec3 foot = nearest_point(vec3(p + way), face_[beside]);
                if (glm::dot(vec3(p + way) - foot, vec3(p) - foot) <= 0) continue;
                outside_[i] = true;
                return;
            }
        });
    }

    // Faces that do not separate inside from outside, as where a mesh intersects itself or has a cavity, are
    // not part of the solid's surface.
    void forget_inner_walls() {
        std::vector<char> inner(face_.size(), false);
        for_each_voxel([&](ivec3 p, Index i) {
            if (outside_[i] || face_[i] == none) return;
            const ivec3 foot(glm::round(nearest_point(vec3(p), face_[i])));
            inner[i] = !outside(foot) &&
                       std::ranges::none_of(around, [&](ivec3 way) { return outside(foot + way); });
        });
        for (std::size_t i = 0; i < inner.size(); ++i)
            if (inner[i]) face_[i] = none, grid_.values[i] = level_set_band;
    }

    // Ring by ring, the voxels of the band without a nearest face get the nearest of their neighbours' faces
    // (a distance transform by propagation).
    void spread() {
        std::vector<Found> rest;
        for (std::size_t block : near_)
            for (int k = 0; k < int(in_block); ++k)
                if (const Index i = grid_.first[block] + Index(k); in_band_[i] && face_[i] == none)
                    rest.push_back(
                        {grid_.low_of(block) + ivec3(k % wide, k / wide % wide, k / wide / wide), none});
        for (float reach = 0; reach < level_set_band && !rest.empty(); ++reach) {
            parallel_for(rest.size(), 1024,
                         [&](std::size_t i) { rest[i].face = nearest_beside(rest[i].voxel); });
            for (const Found& found : rest) set(found);
            std::erase_if(rest, [](const Found& found) { return found.face != none; });
        }
    }

    struct Found {
        ivec3 voxel;
        Index face;
    };
    void set(const Found& found) {
        if (found.face == none) return;
        const Index i = grid_.number_of(found.voxel);
        face_[i] = found.face;
        grid_.values[i] = glm::distance(vec3(found.voxel), nearest_point(vec3(found.voxel), found.face));
    }

    Index nearest_beside(ivec3 p) const {
        float best = level_set_band;
        Index face = none;
        for (ivec3 way : around) {
            const Index beside = measured(p + way);
            if (beside == none) continue;
            const float distance = glm::distance(vec3(p), nearest_point(vec3(p), face_[beside]));
            if (distance < best) best = distance, face = face_[beside];
        }
        return face;
    }

    const Mesh& mesh_;
    Tree tree_;
    SignedDistance::Grid& grid_;
    std::vector<std::size_t> near_;        // blocks whose voxels have stored values
    std::vector<Index> face_;              // by voxel: the nearest face, as far as known
    std::vector<char> in_band_, outside_;  // by voxel
};

}  // namespace

SignedDistance::SignedDistance(const Mesh& mesh, float voxel) {
    check(mesh, "the mesh of a signed distance");
    if (!(voxel > 0))
        throw Error(fmt::format("a voxel of {} m", voxel), "the signed distance", "use a width above zero");
    const Error nothing("nothing inside at this voxel size", "the mesh",
                        "close its holes or use smaller voxels");
    if (mesh.triangles.empty()) throw nothing;
    const Bounds box = bounds(mesh);
    check_memory(box.size(), voxel);
    // An offset by half a voxel keeps axis-aligned walls off the voxel centres.
    const float margin = level_set_band + 1.5f;
    grid_ = std::make_unique<Grid>();
    grid_->origin = box.low - margin * voxel;
    grid_->voxel = voxel;
    grid_->blocks = ivec3(glm::ceil(box.size() / voxel) + 2 * margin) / wide + 1;
    const std::size_t blocks = std::size_t(grid_->blocks.x) * grid_->blocks.y * grid_->blocks.z;
    grid_->first.assign(blocks, none);
    grid_->far.assign(blocks, -level_set_band);
    Mesh small{mesh.positions, {}, mesh.triangles};
    for (vec3& p : small.positions) p = (p - grid_->origin) / voxel;
    Filling(small, *grid_).fill();
    // A closed sheet thinner than a voxel shows no inside, too, but is valid.
    const bool has_inside = std::ranges::any_of(grid_->values, [](float value) { return value < -0.1f; });
    if (!has_inside && is_open_when_welded(mesh)) throw nothing;
}

SignedDistance::~SignedDistance() = default;
SignedDistance::SignedDistance(SignedDistance&&) noexcept = default;
SignedDistance& SignedDistance::operator=(SignedDistance&&) noexcept = default;

std::vector<float> SignedDistance::sample(vec3 origin, float spacing, ivec3 dims) const {
    const vec3 beyond(wide * grid_->blocks);
    std::vector<float> distances;
    distances.reserve(std::size_t(dims.x) * dims.y * dims.z);
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                const vec3 p = (origin + spacing * vec3(x, y, z) - grid_->origin) / grid_->voxel;
                distances.push_back(grid_->voxel * grid_->at(glm::clamp(p, vec3(-2), beyond)));
            }
    return distances;
}

}  // namespace palpate
