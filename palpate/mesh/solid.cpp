#include "palpate/mesh/solid.h"

#include "palpate/base/error.h"
#include "palpate/mesh/repair.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/MeshToVolume.h>

namespace palpate {
namespace {

using openvdb::FloatGrid;

// How many voxels to either side have a distance of their own: OpenVDB's default.
constexpr float level_set_band = 3;
constexpr double most_bytes = 2e9;

// Throws unless a grid all over the mesh's box would fit; the band alone takes less.
void check_memory(vec3 size, float voxel) {
    const dvec3 voxels = glm::ceil(dvec3(size) / double(voxel)) + 2.0 * (level_set_band + 1);
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
bool is_open_when_welded(Mesh mesh) {
    weld(mesh);
    return mesh.triangles.empty() || soundness(mesh).open_edges > 0;
}

}  // namespace

// In units of a voxel, from near the mesh's lowest corner: so small units and places far off cost no digits.
struct SignedDistance::Grid {
    FloatGrid::Ptr voxels;
    vec3 origin;
    float voxel;
};

SignedDistance::SignedDistance(const Mesh& mesh, float voxel) {
    check(mesh, "the mesh whose distance is wanted");
    if (!(voxel > 0))
        throw Error(fmt::format("a voxel of {} m", voxel), "the signed distance", "use a width above zero");
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
    auto grid = openvdb::tools::meshToLevelSet<FloatGrid>(never, openvdb::math::Transform(), points,
                                                          triangles, level_set_band);
    // A closed sheet thinner than a voxel has no inside to be seen either, but nothing is wrong with it.
    if (!has_inside(*grid) && is_open_when_welded(mesh))
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
