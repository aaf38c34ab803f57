#pragma once
#include "palpate/mesh/mesh.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace palpate {

/// A surface that moves, written picture by picture. Each goes to disk at once, so memory does not grow with
/// their number. A file of many pictures gets its name in finish(), and without that nothing of it is left;
/// numbered files get theirs one by one.
class Sequence {
 public:
    virtual ~Sequence() = default;

    /// The next picture: where the mesh's vertices are at `time` (s, later than the last one's), and their
    /// normals, if the mesh has any; a cache of positions alone (.pc2, .mdd) needs none. Throws Error if they
    /// are another number or not later, if the disk is full, or if more than `pictures` are too many.
    virtual void add(double time, std::span<const vec3> positions, std::span<const vec3> normals) = 0;

    /// After the last picture; there must be one. Throws Error.
    virtual void finish() = 0;
};

/// Throws Error if make_sequence knows no format for a file of this name.
void check_sequence_name(const std::filesystem::path& path);

/// Begins a sequence of the mesh, which is given as it is at rest, in metres and seconds, in the format of
/// the name's ending. For OUT with up to `pictures` pictures (which only numbers and limits depend on):
/// - `.ply`, `.obj`, `.stl`: OUT-0001.ply and so on; older files with higher numbers stay;
/// - `.vtp`: OUT-0001.vtp and so on, and OUT.pvd, which lists them with their times;
/// - `.pc2`, `.mdd`: a cache of positions alone, evenly timed, and OUT.obj, the mesh at rest with its
/// vertices
///   in the same order;
/// - `.glb`: glTF with a morph target a picture, which an animation blends; 24 bytes a vertex and picture (12
///   without normals), and 4 for each pair of pictures.
///
/// Throws Error if it is no such name, or if all pictures would not fit into a .glb of 2 GB.
std::unique_ptr<Sequence> make_sequence(const Mesh& mesh, const std::filesystem::path& path,
                                        std::size_t pictures);

}  // namespace palpate
