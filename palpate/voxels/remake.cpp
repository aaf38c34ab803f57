#include "palpate/mesh/remake.h"

#include "palpate/base/error.h"
#include "palpate/base/parallel.h"
#include "palpate/mesh/parts.h"
#include "palpate/mesh/winding_number.h"
#include "palpate/voxels/isosurface.h"

#include <fmt/format.h>

#include <cmath>

namespace palpate {
namespace {

constexpr float default_voxels = 300;    // along the longest side
constexpr double most_voxels = 1 << 28;  // 1 GB
constexpr int margin = 3;                // voxels outside, on each side
constexpr float band = 2;                // voxels; depths are clamped to this
constexpr float hole_slope = 8;          // voxels per winding; see across()

// The depth of each voxel inside a mesh whose unit is the voxel. First its side, block by block: a block far
// from the surface needs a single test. Then the distance to the surface, only where inside meets outside,
// since the isosurface needs no other.
class Depths {
 public:
    Depths(const Mesh& mesh, Volume& volume) : tree_(mesh), winding_(tree_), volume_(volume) {}

    void fill(ivec3 low, int size) { fill(low, size, none, winding_.ball(middle(low, size), reach(size))); }

    // For the layer z, when all sides are known.
    void find_border(int z) {
        std::vector<Index>& border = border_[std::size_t(z)];
        const std::vector<float>& value = volume_.values;
        const int row = volume_.dims.x, layer = row * volume_.dims.y;
        for (int y = 1; y + 1 < volume_.dims.y; ++y)
            for (int x = 1; x + 1 < volume_.dims.x; ++x) {
                const int i = z * layer + y * row + x;
                const bool inside = value[std::size_t(i)] > 0;
                for (int next : {-1, 1, -row, row, -layer, layer})
                    if ((value[std::size_t(i + next)] > 0) != inside) {
                        border.push_back(Index(i));
                        break;
                    }
            }
    }

    // For that layer, when the border is complete.
    void measure_border(int z) {
        Index guess = none;
        for (Index i : border_[std::size_t(z)]) {
            const int x = int(i) % volume_.dims.x, y = int(i) / volume_.dims.x % volume_.dims.y;
            const Tree::Nearest nearest = tree_.nearest(vec3(x, y, z), band, guess);
            guess = nearest.face;
            float& depth = volume_.values[i];
            depth = std::copysign(off_voxel(std::min(nearest.distance, std::abs(depth))), depth);
        }
    }

 private:
    using Ball = WindingNumber::Ball;

    static dvec3 middle(ivec3 low, int size) { return dvec3(low) + 0.5 * (size - 1); }
    static double reach(int size) { return 0.5 * std::sqrt(3.0) * (size - 1); }

    // `guess`: a nearby face, if one is known. `ball`: around the block.
    void fill(ivec3 low, int size, Index guess, const Ball& ball) {
        const ivec3 high = glm::min(low + size, volume_.dims);
        const Tree::Nearest nearest = tree_.nearest(vec3(ball.centre), 2 * float(ball.radius) + band, guess);
        const double clear = double(nearest.distance);
        float side = 0;
        if (clear > ball.radius) side = decided(winding_.at(ball.centre, ball), ball.radius / clear);
        if (side == 0 && clear > ball.radius + double(band) && size > 2) side = agreed(low, high - 1, ball);
        if (side != 0) return fill_with(side * band, low, high);
        const int half = size / 2;
        for (int i = 0; i < 8; ++i) {
            const ivec3 part = low + half * ivec3(i & 1, i >> 1 & 1, i >> 2);
            if (glm::any(glm::greaterThanEqual(part, volume_.dims))) continue;
            if (half == 1)
                at(part) = across(part, ball);
            else
                fill(part, half, nearest.face, winding_.ball(middle(part, half), reach(half), ball));
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

    // 1 or -1 if a whole ball is inside or outside, 0 if unknown. Away from the surface the winding number is
    // a harmonic function. So if it is between 0 and 1, Harnack's inequality bounds how much nearer to a half
    // it can be anywhere in the ball than at the centre. `ratio`: of the ball's radius to that of a
    // concentric ball without surface.
    static float decided(double winding, double ratio) {
        const double off = std::max(0.0, std::min(winding, 1 - winding));
        if (off * (1 + ratio) >= 0.5 * (1 - ratio) * (1 - ratio)) return 0;
        return winding > 0.5 ? 1.0f : -1.0f;
    }

    // The same for a block away from the surface whose corners are all well on one side, by the maximum
    // principle: a harmonic function takes its extremes on the border, and it changes little over the
    // distance to the surface.
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

    static float off_voxel(float depth) { return std::max(depth, 1e-3f); }

    // Across a hole, where there is no surface, the winding number falls smoothly through one half: it is
    // converted to a depth that is smaller than the distance from the surface only there.
    float across(dvec3 p, const Ball& ball) const {
        const float depth = hole_slope * float(winding_.at(p, ball) - 0.5);
        return std::copysign(off_voxel(std::abs(depth)), depth);
    }

    Tree tree_;
    WindingNumber winding_;
    Volume& volume_;
    std::vector<std::vector<Index>> border_{std::size_t(volume_.dims.z)};  // by layer
};

// An offset by half a voxel keeps axis-aligned walls off the voxel centres.
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

// The faces of the parts that face inwards.
std::vector<Index> inward_faces(const Mesh& mesh, const Parts& part) {
    const std::vector<double> volume = volumes(mesh, part);
    std::vector<Index> faces;
    for (Index face = 0; face < part.of.size(); ++face)
        if (volume[part.of[face]] < 0) faces.push_back(face);
    return faces;
}

// Distinguishes the cavities of a mesh from mere gaps between its parts. Its unit is the voxel.
class Walls {
 public:
    explicit Walls(const Mesh& mesh)
        : part_(parts(mesh)), all_(mesh), inward_(mesh, inward_faces(mesh, part_)), winding_(inward_) {}

    // `hollow`: the faces of the voxel remesh that bound it.
    bool bound(const Mesh& solid, const std::vector<Index>& hollow, double volume) const {
        double around = 0, area = 0;
        std::vector<double> area_by(part_.count);
        const std::size_t samples = std::min(most_samples, hollow.size());
        for (std::size_t sample = 0; sample < samples; ++sample) {
            const uvec3 t = solid.triangles[hollow[sample * hollow.size() / samples]];
            const vec3 a = solid.positions[t.x], b = solid.positions[t.y], c = solid.positions[t.z],
                       middle = (a + b + c) / 3.0f, way = glm::cross(b - a, c - a);
            const double own = face_area(solid, t);
            area += own;
            if (own > 0) around += winding_.at(dvec3(middle + 0.5f * glm::normalize(way))) / double(samples);
            const Index nearest = all_.nearest(middle, farthest).face;
            if (nearest != none) area_by[part_.of[nearest]] += own;
        }
        if (around < -0.5) return true;
        const double whole = area * double(hollow.size()) / double(samples);
        const bool wide = 3 * volume > least_radius * whole;  // as for a ball
        return wide && *std::max_element(area_by.begin(), area_by.end()) > 0.75 * area;
    }

 private:
    static constexpr std::size_t most_samples = 200;
    static constexpr float farthest = 4;       // voxels, from a wall to the surface made of it
    static constexpr double least_radius = 2;  // voxels

    Parts part_;
    Tree all_, inward_;
    WindingNumber winding_;
};

// Fills the hollows that no wall of `mesh` bounds.
Dropped fill_hollows(Mesh& solid, const Mesh& mesh) {
    const Parts part = parts(solid);
    const std::vector<double> volume = volumes(solid, part);
    if (std::none_of(volume.begin(), volume.end(), [](double v) { return v < 0; })) return {};
    std::vector<std::vector<Index>> faces(part.count);
    for (Index face = 0; face < part.of.size(); ++face)
        if (volume[part.of[face]] < 0) faces[part.of[face]].push_back(face);
    const Walls walls(mesh);
    std::vector<char> keep(part.count, true);
    for (Index i = 0; i < part.count; ++i)
        keep[i] = !(volume[i] < 0) || walls.bound(solid, faces[i], -volume[i]);
    return keep_parts(solid, part, keep);
}

// Drops small outer parts, but never the largest.
Dropped drop_bits(Mesh& solid) {
    constexpr double least = 64;  // voxels
    const Parts part = parts(solid);
    const std::vector<double> volume = volumes(solid, part);
    const double largest = *std::max_element(volume.begin(), volume.end());
    std::vector<char> keep;
    for (double one : volume) keep.push_back(one < 0 || one >= std::min(least, largest));
    return keep_parts(solid, part, keep);
}

// Whether any voxel around a point is inside.
bool is_kept(const Volume& depths, dvec3 point) {
    const ivec3 low = glm::clamp(ivec3(glm::floor(point)), ivec3(0), depths.dims - 2);
    for (int i = 0; i < 8; ++i)
        if (depths.at(low.x + (i & 1), low.y + (i >> 1 & 1), low.z + (i >> 2)) > 0) return true;
    return false;
}

// Finds the faces of `mesh` with no inner voxel next to them, by samples about a voxel apart.
void find_thin(const Mesh& mesh, const Volume& depths, Remade& made) {
    constexpr int most_samples = 64;  // along a side
    double area = 0, lost = 0;
    for (uvec3 t : mesh.triangles) {
        const dvec3 a(mesh.positions[t.x]), ab = dvec3(mesh.positions[t.y]) - a,
                                            ac = dvec3(mesh.positions[t.z]) - a;
        const double own = face_area(mesh, t);
        if (!(own > 0)) continue;
        const dvec3 inward = -0.5 * glm::normalize(glm::cross(ab, ac));
        const double longest = std::max({glm::length(ab), glm::length(ac), glm::length(ac - ab)});
        const int n = std::clamp(int(longest), 1, most_samples);
        int samples = 0, missed = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j, ++samples) {
                const dvec3 point = a + (i + 1.0 / 3) / n * ab + (j + 1.0 / 3) / n * ac;
                missed += !is_kept(depths, point) && !is_kept(depths, point + inward);
            }
        area += own;
        lost += own * missed / samples;
        made.thin_faces += 2 * missed > samples;
    }
    if (made.thin_faces > 0) made.thin = lost / area;
}

}  // namespace

Remade remake(const Mesh& mesh, float voxel, const std::string& name, const Progress& progress) {
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
        if (progress) progress("remeshing by voxels", double(z) / blocks.z);
        parallel_for(std::size_t(blocks.y) * blocks.x, 1, [&](std::size_t i) {
            filler.fill(block * ivec3(int(i) % blocks.x, int(i) / blocks.x, z), block);
        });
    }
    const std::size_t layers = depths.dims.z - 2;
    parallel_for(layers, 1, [&](std::size_t i) { filler.find_border(int(i) + 1); });
    parallel_for(layers, 1, [&](std::size_t i) { filler.measure_border(int(i) + 1); });

    // A sheet has inner points only by rounding.
    if (!(*std::max_element(depths.values.begin(), depths.values.end()) > 0.25f)) throw nothing;
    Remade made{isosurface(depths, 0)};
    made.hollows = fill_hollows(made.solid, small);
    made.bits = drop_bits(made.solid);
    find_thin(small, depths, made);
    for (Dropped* removed : {&made.hollows, &made.bits}) {
        removed->volume *= unit * unit * unit;
        removed->area *= unit * unit;
    }
    for (vec3& p : made.solid.positions) p = vec3(origin + unit * dvec3(p));
    return made;
}

}  // namespace palpate
