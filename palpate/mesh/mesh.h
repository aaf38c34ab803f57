#pragma once
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace palpate {

/// A surface of triangles. Plain data; triangles turn counter-clockwise seen from outside.
struct Mesh {
    std::vector<vec3> positions;   // m
    std::vector<vec3> normals;     // unit, one a vertex; or empty
    std::vector<uvec3> triangles;  // indices into positions
    /// Texture coordinates, one a vertex; or empty. u runs to the right and v up, from (0, 0) at a picture's
    /// lower left corner to (1, 1), as OBJ and OpenGL have it; beyond that the picture repeats.
    std::vector<vec2> uvs = {};
    std::vector<vec4> tangents =
        {};  // along the texture's u, unit; w: 1, or -1 where it is mirrored; or empty
};

/// What a file's numbers mean. Inside Palpate everything is in metres.
enum class Units { metres, centimetres, millimetres, micrometres };

/// Their names: m, cm, mm, um.
std::span<const Named<Units>> names(Units);

/// Metres per unit: 0.001 for millimetres.
float metres(Units units);

/// Throws Error where a mesh's triangles name vertices that it does not have, its lists are not as long as
/// one another, or a vertex is at a place that is not finite. `where`: what the message calls it.
void check(const Mesh& mesh, std::string_view where);

inline Bounds bounds(const Mesh& mesh) { return bounds(mesh.positions); }

/// Enclosed volume in m³ (divergence theorem, summed in double); negative if the mesh is inside out.
double volume(const Mesh& mesh);

/// Fills mesh.normals: at each vertex the mean of its faces' normals, each weighted by the face's angle
/// there; slivers count for less. A vertex without a face that has an area gets (0, 0, 1).
void compute_normals(Mesh& mesh);

/// The same for moved vertices of the same triangles, into `normals` (resized).
void compute_normals(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles,
                     std::vector<vec3>& normals);

/// The same across the seams of a texture, where a file has several vertices in one place: they get the
/// normal that one vertex would have there.
void compute_normals_by_place(Mesh& mesh);

/// Fills mesh.tangents from its texture coordinates: at each vertex the mean of its faces' ways along u, each
/// by the face's angle there, brought to right angles with the normal; w says whether v runs along the normal
/// × the tangent (1) or against it (-1), as most of its faces say. A vertex whose faces have no area in the
/// texture gets any tangent. Where a texture meets its own mirror image, vertices should be two. Throws Error
/// if it has no texture coordinates.
void compute_tangents(Mesh& mesh);

/// Turns by degrees about x, then y, then z, about the world's origin. (-90, 0, 0) takes z up to y up.
void rotate(Mesh& mesh, vec3 degrees);

/// For each position the number of the first that equals it.
std::vector<std::uint32_t> first_in_place(const std::vector<vec3>& positions);

}  // namespace palpate
