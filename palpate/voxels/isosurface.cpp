#include "palpate/voxels/isosurface.h"

#include "palpate/base/error.h"

#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/VolumeToMesh.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate {
namespace {

using openvdb::FloatGrid;

// A leaf node of OpenVDB: 8 voxels wide.
using Block = FloatGrid::TreeType::LeafNodeType;
constexpr int wide = Block::DIM;

// The volume as a level set for OpenVDB: negative inside, and everything beyond the volume is as far outside
// as its lowest voxel. Scaled to between -1 and 1, so that no difference overflows a float.
class ScaledVolume {
 public:
    ScaledVolume(const Volume& volume, float iso, float lowest, float highest)
        : volume_(volume),
          iso_(iso),
          scale_(1 / std::max(double(iso) - lowest, double(highest) - iso)),
          outside_(scaled(lowest)) {}

    float outside() const { return outside_; }
    float at(int x, int y, int z) const { return within(x, y, z) ? scaled(volume_.at(x, y, z)) : outside_; }
    bool inside(int x, int y, int z) const { return within(x, y, z) && scaled(volume_.at(x, y, z)) < 0; }

 private:
    float scaled(float value) const { return float((double(iso_) - value) * scale_); }
    bool within(int x, int y, int z) const {
        return x >= 0 && y >= 0 && z >= 0 && x < volume_.dims.x && y < volume_.dims.y && z < volume_.dims.z;
    }

    const Volume& volume_;
    double iso_, scale_;
    float outside_;
};

// Whether a block and the voxels right around it are all on the same side.
bool on_one_side(const ScaledVolume& values, ivec3 low) {
    const bool side = values.inside(low.x, low.y, low.z);
    for (int z = low.z - 1; z <= low.z + wide; ++z)
        for (int y = low.y - 1; y <= low.y + wide; ++y)
            for (int x = low.x - 1; x <= low.x + wide; ++x)
                if (values.inside(x, y, z) != side) return false;
    return true;
}

// Only blocks at the surface hold values; for the others OpenVDB stores only the side (a narrow band). So
// memory is proportional to the surface.
FloatGrid::Ptr inside_below_zero(const ScaledVolume& values, ivec3 dims) {
    auto grid = FloatGrid::create(values.outside());
    auto& tree = grid->tree();
    for (int z = 0; z < dims.z; z += wide)
        for (int y = 0; y < dims.y; y += wide)
            for (int x = 0; x < dims.x; x += wide) {
                const openvdb::Coord low(x, y, z);
                if (on_one_side(values, {x, y, z})) {
                    if (values.inside(x, y, z)) tree.addTile(1, low, -1.0f, true);
                    continue;
                }
                Block& block = *tree.touchLeaf(low);
                for (openvdb::Index i = 0; i < Block::SIZE; ++i) {
                    const openvdb::Coord p = block.offsetToGlobalCoord(i);
                    block.setValueOn(i, values.at(p.x(), p.y(), p.z()));
                }
            }
    return grid;
}

// Splits a quad along its shorter diagonal. Each diagonal joins two cells that no other quad joins, so the
// surface stays as sound as the quads were.
void add_quad(Mesh& mesh, openvdb::Vec4I q, bool turn_over) {
    if (turn_over) std::swap(q[1], q[3]);
    auto length = [&](int i, int j) { return glm::distance(mesh.positions[q[i]], mesh.positions[q[j]]); };
    const int first = length(0, 2) <= length(1, 3) ? 0 : 1;
    auto corner = [&](int i) { return q[(first + i) % 4]; };
    mesh.triangles.push_back({corner(0), corner(1), corner(2)});
    mesh.triangles.push_back({corner(0), corner(2), corner(3)});
}

}  // namespace

Mesh isosurface(const Volume& volume, float iso) {
    if (volume.count() == 0 || volume.values.size() != volume.count())
        throw Error("a volume whose number of values differs from the product of its dims", volume.name,
                    "give one value for each voxel");
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    if (!(*low < iso && iso < *high))
        throw Error(fmt::format("no surface at the value {} (its voxels hold {} to {})", iso, *low, *high),
                    volume.name, "choose an iso value between these");

    openvdb::initialize();
    std::vector<openvdb::Vec3s> points;
    std::vector<openvdb::Vec4I> quads;
    openvdb::tools::volumeToMesh(*inside_below_zero({volume, iso, *low, *high}, volume.dims), points, quads,
                                 0.0);

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

}  // namespace palpate
