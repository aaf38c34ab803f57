#pragma once
#include "palpate/base/names.h"
#include "palpate/base/vectors.h"

#include <vector>

namespace palpate {

/// A surface of triangles. Plain data; triangles turn counter-clockwise seen from outside.
struct Mesh {
    std::vector<vec3> positions;   // m
    std::vector<vec3> normals;     // unit, one a vertex; or empty
    std::vector<uvec3> triangles;  // indices into positions
};

/// What a file's numbers mean. Inside Palpate everything is in metres.
enum class Units { metres, centimetres, millimetres, micrometres };

/// Their names: m, cm, mm, um.
std::span<const Named<Units>> names(Units);

/// Metres per unit: 0.001 for millimetres.
float metres(Units units);

Bounds bounds(const Mesh& mesh);

/// Enclosed volume in m³ (divergence theorem, summed in double); negative if the mesh is inside out.
double volume(const Mesh& mesh);

/// Fills mesh.normals: at each vertex the mean of its faces' normals, each weighted by the face's angle
/// there; slivers count for less. A vertex without a face that has an area gets (0, 0, 1).
void compute_normals(Mesh& mesh);

/// The same for moved vertices of the same triangles, into `normals` (resized).
void compute_normals(const std::vector<vec3>& positions, const std::vector<uvec3>& triangles,
                     std::vector<vec3>& normals);

/// Turns by degrees about x, then y, then z, about the world's origin. (-90, 0, 0) takes z up to y up.
void rotate(Mesh& mesh, vec3 degrees);

}  // namespace palpate
