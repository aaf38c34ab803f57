#pragma once
#include "palpate/files/write.h"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

namespace palpate {

/// An animated surface, written picture by picture. Each picture goes to disk at once, so memory does not
/// grow with their number. A single file gets its final name in finish(), and is removed without that;
/// numbered files get theirs one by one.
class Sequence {
 public:
    virtual ~Sequence() = default;

    /// Adds a picture: the positions of the mesh's vertices at `time` (s, later than the last one's), and
    /// their normals if the mesh has any; a cache of positions (.pc2, .mdd) needs none. Throws Error if their
    /// number is wrong, if the time is not later, if the disk is full, or if there are more than `pictures`
    /// where that matters.
    /// `values`: written where write_mesh() writes them, to numbered .ply and .vtp.
    virtual void add(double time, std::span<const vec3> positions, std::span<const vec3> normals,
                     const VertexValues& values = {}) = 0;

    /// Must be called after the last picture, of which there must be at least one. Throws Error.
    virtual void finish() = 0;
};

/// Throws Error if make_sequence has no format for this file name.
void check_sequence_name(const std::filesystem::path& path);

/// Begins a sequence of the mesh, which is given at rest, in metres and seconds, in the format of the file
/// name's extension. For OUT with up to `pictures` pictures (which affects only numbering and limits):
/// - `.ply`, `.obj`, `.stl`: OUT-0001.ply and so on; older files with higher numbers stay;
/// - `.vtp`: OUT-0001.vtp and so on, and OUT.pvd, which lists them with their times;
/// - `.pc2`, `.mdd`: a cache of positions alone, evenly timed, and OUT.obj, the mesh at rest with its
/// vertices
///   in the same order;
/// - `.glb`: glTF with a morph target a picture, which an animation blends; 24 bytes a vertex and picture (12
///   without normals), and 4 for each pair of pictures.
///
/// Throws Error for any other extension, or if the pictures would not fit into a .glb of 2 GB.
std::unique_ptr<Sequence> make_sequence(const Mesh& mesh, const std::filesystem::path& path,
                                        std::size_t pictures);

}  // namespace palpate
