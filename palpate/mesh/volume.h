#pragma once
#include "palpate/base/vectors.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

/// A volume image: a scalar grid, as from CT or MRI. Plain data. Voxel (i, j, k) lies at origin + direction ·
/// (spacing · (i, j, k)).
struct Volume {
    std::string name = "the volume";  // for messages: its file
    ivec3 dims = ivec3(0);
    vec3 spacing = vec3(1);     // m
    vec3 origin = vec3(0);      // m, the centre of voxel (0, 0, 0); DICOM's axes: x left, y back, z up
    mat3 direction = mat3(1);   // the grid's axes in the world, as orthonormal columns
    std::vector<float> values;  // x runs fastest

    std::size_t count() const { return std::size_t(dims.x) * dims.y * dims.z; }
    float at(int x, int y, int z) const { return values[(std::size_t(z) * dims.y + y) * dims.x + x]; }
};

}  // namespace palpate
