#include "palpate/mesh/solid.h"

#include "palpate/base/error.h"
#include "palpate/mesh/repair.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <cassert>
#include <utility>

namespace palpate {
namespace {

using openvdb::FloatGrid;

// The volume as OpenVDB wants it: inside is what lies below zero, and all beyond the volume is as far outside
// as its lowest voxel. Scaled to within -1 and 1, so that no difference of two is too large for a float.
FloatGrid::Ptr inside_below_zero(const Volume& volume, float iso, float lowest, float highest) {
    const double scale = 1 / std::max(double(iso) - lowest, double(highest) - iso);
    auto scaled = [&](float value) { return float((double(iso) - value) * scale); };
    std::vector<float> values(volume.values.size());
    std::transform(volume.values.begin(), volume.values.end(), values.begin(), scaled);

    using openvdb::Coord;
    const ivec3 last = volume.dims - 1;
    const openvdb::tools::Dense<float, openvdb::tools::LayoutXYZ> dense(
        openvdb::CoordBBox(Coord(0), Coord(last.x, last.y, last.z)), values.data());
    auto grid = FloatGrid::create(scaled(lowest));
    openvdb::tools::copyFromDense(dense, grid->tree(), 0.0f);
    return grid;
}

// Cuts a quad along its shorter diagonal. Each diagonal joins two cells that no other quad joins, so the
// surface stays as sound as the quads were.
void add_quad(Mesh& mesh, openvdb::Vec4I q, bool turn_over) {
    if (turn_over) std::swap(q[1], q[3]);
    auto length = [&](int i, int j) { return glm::distance(mesh.positions[q[i]], mesh.positions[q[j]]); };
    const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
    auto corner = [&](int i) { return q[(first + i) % 4]; };
    mesh.triangles.push_back({corner(0), corner(1), corner(2)});
    mesh.triangles.push_back({corner(0), corner(2), corner(3)});
}

// How many voxels to either side have a distance of their own: OpenVDB's default.
constexpr float band = 3;
constexpr double most_bytes = 2e9;

// Throws unless a grid all over the mesh's box would fit; the band alone takes less.
void check_memory(vec3 size, float voxel) {
    const dvec3 voxels = glm::ceil(dvec3(size) / double(voxel)) + 2.0 * (band + 1);
    const double bytes = voxels.x * voxels.y * voxels.z * sizeof(float);
    if (!(bytes <= most_bytes))
        throw Error(fmt::format("a distance grid of {:.0f} x {:.0f} x {:.0f} voxels, over 2 GB", voxels.x,
                                voxels.y, voxels.z),
                    "the mesh", "use larger voxels");
}

// Where a mesh is open, OpenVDB floods it from outside and leaves at most specks of rounding below zero.
bool has_inside(const FloatGrid& grid) {
    for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel)
        if (*voxel < -0.1f) return true;
    return false;
}

// Also true of no mesh at all.
bool is_open(Mesh mesh) {
    weld(mesh);
    return mesh.triangles.empty() || soundness(mesh).open_edges > 0;
}

}  // namespace

Mesh isosurface(const Volume& volume, float iso) {
    assert(volume.count() > 0 && volume.values.size() == volume.count());
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    if (!(*low < iso && iso < *high))
        throw Error(fmt::format("no surface at the value {} (its voxels hold {} to {})", iso, *low, *high),
                    volume.name, "choose an iso value between these");

    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*inside_below_zero(volume, iso, *low, *high), points, quads, 0.0);

    Mesh mesh;
    mesh.positions.reserve(points.size());
    for (const auto& p : points)
        mesh.positions.push_back(volume.origin +
                                 volume.direction * (volume.spacing * vec3(p.x(), p.y(), p.z())));
    mesh.triangles.reserve(2 * quads.size());
    const bool mirrored = glm::determinant(volume.direction) < 0;
    for (const auto& quad : quads) add_quad(mesh, quad, mirrored);
    return mesh;
}

// In units of a voxel, from near the mesh's lowest corner: so small units and places far off cost no digits.
struct SignedDistance::Grid {
    FloatGrid::Ptr voxels;
    vec3 origin;
    float voxel;
};

SignedDistance::SignedDistance(const Mesh& mesh, float voxel) {
    assert(voxel > 0);
    const Bounds box = bounds(mesh);
    check_memory(box.size(), voxel);
    const vec3 low = box.low - 0.5f * voxel;  // half a voxel keeps a box's walls off the voxels themselves
    std::vector<openvdb::Vec3s> points;
    points.reserve(mesh.positions.size());
    for (vec3 p : mesh.positions) {
        const vec3 q = (p - low) / voxel;
        points.emplace_back(q.x, q.y, q.z);
    }
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(mesh.triangles.size());
    for (uvec3 t : mesh.triangles) triangles.emplace_back(t.x, t.y, t.z);

    openvdb::initialize();
    openvdb::util::NullInterrupter never;
    auto grid =
        openvdb::tools::meshToLevelSet<FloatGrid>(never, openvdb::math::Transform(), points, triangles, band);
    // A closed sheet thinner than a voxel has no inside to be seen either, but nothing is wrong with it.
    if (!has_inside(*grid) && is_open(mesh))
        throw Error("nothing inside at this voxel size", "the mesh", "close its holes or use smaller voxels");
    grid_ = std::make_unique<Grid>(Grid{grid, low, voxel});
}

SignedDistance::~SignedDistance() = default;
SignedDistance::SignedDistance(SignedDistance&&) noexcept = default;
SignedDistance& SignedDistance::operator=(SignedDistance&&) noexcept = default;

std::vector<float> SignedDistance::sample(vec3 origin, float spacing, ivec3 dims) const {
    const auto voxels = grid_->voxels->getConstAccessor();
    std::vector<float> distances;
    distances.reserve(std::size_t(dims.x) * dims.y * dims.z);
    for (int z = 0; z < dims.z; ++z)
        for (int y = 0; y < dims.y; ++y)
            for (int x = 0; x < dims.x; ++x) {
                const vec3 p = (origin + spacing * vec3(x, y, z) - grid_->origin) / grid_->voxel;
                const openvdb::Vec3R at(p.x, p.y, p.z);
                distances.push_back(grid_->voxel * openvdb::tools::BoxSampler::sample(voxels, at));
            }
    return distances;
}

}  // namespace palpate
