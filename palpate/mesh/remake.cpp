#include "palpate/mesh/remake.h"

#include "palpate/base/error.h"
#include "palpate/mesh/isosurface.h"
#include "palpate/mesh/winding_number.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>

namespace palpate {
namespace {

constexpr float default_voxels = 300;    // along the longest side
constexpr double most_voxels = 1 << 28;  // 1 GB
constexpr int margin = 3;                // voxels of outside all around
constexpr float band = 2;                // voxels; distances beyond this are cut off
constexpr float hole_slope = 8;          // voxels per winding; see depth()

// How deep each voxel lies inside a mesh whose unit is the voxel, found block by block: one that is far from
// the surface needs a single look.
class Depths {
 public:
    Depths(const Mesh& mesh, Volume& volume) : tree_(mesh), winding_(tree_), volume_(volume) {}

    void fill(ivec3 low, int size) { fill(low, size, 0, winding_.ball(middle(low, size), reach(size))); }

 private:
    using Ball = WindingNumber::Ball;

    static dvec3 middle(ivec3 low, int size) { return dvec3(low) + 0.5 * (size - 1); }
    static double reach(int size) { return 0.5 * std::sqrt(3.0) * (size - 1); }

    // `sign`: of all the block's depths, if it is known, else 0. `ball`: around the block.
    void fill(ivec3 low, int size, float sign, const Ball& ball) {
        const ivec3 high = glm::min(low + size, volume_.dims);
        const double clear = double(distance(vec3(ball.centre), 2 * float(ball.radius)));
        if (sign == 0 && clear > ball.radius)
            sign = decided(winding_.at(ball.centre, ball), ball.radius / clear);
        if (clear > ball.radius + double(band)) {
            if (sign == 0 && size > 2) sign = agreed(low, high - 1, ball);
            if (sign != 0) return fill_with(sign * band, low, high);
        }
        const int half = size / 2;
        for (int i = 0; i < 8; ++i) {
            const ivec3 part = low + half * ivec3(i & 1, i >> 1 & 1, i >> 2);
            if (glm::any(glm::greaterThanEqual(part, volume_.dims))) continue;
            if (half == 1)
                at(part) = sign != 0 ? sign * depth_of(distance(part, 0)) : depth(part, ball);
            else
                fill(part, half, sign,
                     sign != 0 ? Ball{middle(part, half), reach(half)}
                               : winding_.ball(middle(part, half), reach(half), ball));
        }
    }

    float& at(ivec3 p) {
        return volume_.values[(std::size_t(p.z) * volume_.dims.y + p.y) * volume_.dims.x + p.x];
    }

    void fill_with(float value, ivec3 low, ivec3 high) {
        for (int z = low.z; z < high.z; ++z)
            for (int y = low.y; y < high.y; ++y)
                for (int x = low.x; x < high.x; ++x) at({x, y, z}) = value;
    }

    // 1 or -1 if a whole ball is inside or outside, 0 if that cannot be told. Away from the surface the
    // winding number is harmonic. So if it lies between 0 and 1, Harnack's inequality bounds how much nearer
    // to a half it may be anywhere in the ball than in the middle. `ratio`: of the ball's radius to that of
    // one free of surface.
    static float decided(double winding, double ratio) {
        const double off = std::max(0.0, std::min(winding, 1 - winding));
        if (off * (1 + ratio) >= 0.5 * (1 - ratio) * (1 - ratio)) return 0;
        return winding > 0.5 ? 1.0f : -1.0f;
    }

    // The same for a block clear of the surface whose corners are all well on one side: within it a harmonic
    // function is nowhere more extreme than on its border, and changes little over the distance to the
    // surface.
    float agreed(ivec3 low, ivec3 high, const Ball& ball) const {
        constexpr double well = 0.02;
        int inside = 0, outside = 0;
        for (int i = 0; i < 8; ++i) {
            const ivec3 corner = glm::mix(low, high, glm::bvec3(i & 1, i & 2, i & 4));
            const double winding = winding_.at(dvec3(corner), ball);
            inside += winding > 0.5 + well;
            outside += winding < 0.5 - well;
        }
        return inside == 8 ? 1.0f : outside == 8 ? -1.0f : 0.0f;
    }

    float distance(vec3 p, float beyond) const { return tree_.distance(p, beyond + band); }

    // Off the voxel itself.
    static float depth_of(float distance) { return std::max(distance, 1e-3f); }

    // The distance to the surface, negative outside. Across a hole, where there is no surface, the winding
    // number falls smoothly past one half: a distance is made of it that is the smaller only there.
    float depth(vec3 p, const Ball& ball) const {
        const float across = hole_slope * float(winding_.at(dvec3(p), ball) - 0.5);
        return std::copysign(depth_of(std::min(distance(p, 0), std::abs(across))), across);
    }

    Tree tree_;
    WindingNumber winding_;
    Volume& volume_;
};

// Half a voxel keeps a box's walls off the voxels themselves.
Volume empty_grid(dvec3 size, const std::string& name) {
    const dvec3 voxels = glm::ceil(size) + double(2 * margin + 1);
    if (!(voxels.x * voxels.y * voxels.z <= most_voxels))
        throw Error(
            fmt::format("a grid of {:.0f} x {:.0f} x {:.0f} voxels, over 2^28", voxels.x, voxels.y, voxels.z),
            name, "use larger voxels");
    Volume volume;
    volume.dims = ivec3(voxels);
    volume.values.resize(volume.count());
    volume.name = name;
    return volume;
}

}  // namespace

Mesh remake(const Mesh& mesh, float voxel, const std::string& name, const Progress& progress) {
    const Error nothing("no inside", name, "give it a thickness, or use it as a cloth (sheet = true)");
    if (mesh.triangles.empty()) throw nothing;
    dvec3 low(std::numeric_limits<double>::max()), high = -low;
    for (vec3 p : mesh.positions) low = glm::min(low, dvec3(p)), high = glm::max(high, dvec3(p));
    const dvec3 size = high - low;
    const double unit = voxel > 0 ? double(voxel) : std::max({size.x, size.y, size.z}) / default_voxels;
    if (!(unit > 0)) throw nothing;

    Volume depths = empty_grid(size / unit, name);
    const dvec3 origin = low - unit * (margin + 0.5);
    Mesh small{mesh.positions, {}, mesh.triangles};
    for (vec3& p : small.positions) p = vec3((dvec3(p) - origin) / unit);
    Depths filler(small, depths);
    constexpr int block = 32;
    const ivec3 blocks = (depths.dims + block - 1) / block;
    for (int z = 0; z < blocks.z; ++z) {
        if (progress) progress("making a solid by voxels", double(z) / blocks.z);
        tbb::parallel_for(0, blocks.y * blocks.x,
                          [&](int i) { filler.fill(block * ivec3(i % blocks.x, i / blocks.x, z), block); });
    }

    // A sheet has points inside by rounding at most.
    if (!(*std::max_element(depths.values.begin(), depths.values.end()) > 0.25f)) throw nothing;
    Mesh solid = isosurface(depths, 0);
    for (vec3& p : solid.positions) p = vec3(origin + unit * dvec3(p));
    return solid;
}

}  // namespace palpate
