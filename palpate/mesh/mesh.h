#pragma once
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"

#include <cstdint>
#include <string_view>
#include <vector>

namespace palpate {

/// A triangle mesh. Plain data; the winding order is counter-clockwise as seen from outside.
struct Mesh {
    std::vector<vec3> positions;   // m
    std::vector<vec3> normals;     // vertex normals: unit, one for each vertex; or empty
    std::vector<uvec3> triangles;  // indices into positions
    /// Texture coordinates, one for each vertex; or empty. u runs to the right and v up, from (0, 0) at an
    /// image's lower left corner to (1, 1), as in OBJ and OpenGL; outside of that the image repeats.
    std::vector<vec2> uvs = {};
    std::vector<vec4> tangents =
        {};  // along the texture's u, unit; w, the handedness: 1, or -1 where it is mirrored; or empty
};

/// The unit of length of a file. Inside Palpate everything is in metres.
enum class Units { metres, centimetres, millimetres, micrometres };

/// Their names: m, cm, mm, um.
std::span<const Named<Units>> names(Units);

/// Metres per unit: 0.001 for millimetres.
float metres(Units units);

/// Throws Error if a triangle refers to a missing vertex, if lists differ in length, or if a position is not
/// finite. `where`: the name of the mesh for the message.
void check(const Mesh& mesh, std::string_view where);

inline Bounds bounds(const Mesh& mesh) { return bounds(mesh.positions); }

/// Enclosed volume in m³ (divergence theorem, summed in double); negative if the mesh is inside out.
double volume(const Mesh& mesh);

/// Computes the vertex normals: at each vertex the mean of its face normals, weighted by the face's angle
/// there; slivers count for less. A vertex without a face of positive area gets (0, 0, 1).
void compute_normals(Mesh& mesh);

/// The same for moved positions of the same triangles, into `normals` (resized).
void compute_normals(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles,
                     std::vector<vec3>& normals);

/// The same across texture seams, where several vertices share a place: they get the normal that a single
/// vertex would have there.
void compute_normals_by_place(Mesh& mesh);

/// Computes mesh.tangents from its texture coordinates: at each vertex the mean of its faces' directions of
/// u, weighted by the face's angle there, made perpendicular to the normal; w is 1 if v runs along normal ×
/// tangent in most of its faces, else -1. A vertex whose faces have no area in the texture gets an arbitrary
/// tangent. Where a texture is mirrored at a seam, there should be two vertices. Throws Error if it has no
/// texture coordinates.
void compute_tangents(Mesh& mesh);

/// Rotates by degrees about x, then y, then z, about the world's origin. (-90, 0, 0) turns z-up into y-up.
void rotate(Mesh& mesh, vec3 degrees);

/// For each position, the index of the first one that equals it.
std::vector<std::uint32_t> first_in_place(const std::vector<vec3>& positions);

}  // namespace palpate
