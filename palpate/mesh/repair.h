#pragma once
#include "palpate/base/progress.h"
#include "palpate/mesh/arrangement.h"
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/soundness.h"

#include <cstddef>
#include <string>
#include <vector>

namespace palpate {

// ---- all of it ----

/// How a surface becomes a solid: its own faces are repaired, and only if that fails it is remeshed by voxels
/// (walls); or it is remeshed by voxels at once (voxels).
enum class SolidBy { walls, voxels };

/// Their names: walls, voxels.
std::span<const Named<SolidBy>> names(SolidBy);

struct RepairSettings {
    float weld = 0;        // m; vertices no farther apart are merged. 0: those in the same place and, if the
                           // mesh is open, those of the border within 1e-5 of its longest side
    float specks = 0.01f;  // parts shorter than this fraction of the longest part are dropped; 0 keeps all
    bool largest = false;  // keep only the largest piece: see keep_largest()
    double cavities = 0;   // cavities below this fraction of the volume are filled: in scans they are noise
    bool sheet = false;    // a cloth: may stay open, and is neither closed nor remeshed by voxels
    SolidBy solid = SolidBy::walls;  // ignored for a sheet
    float voxel = 0;                 // m; for voxel remeshing. 0: 1/300 of the longest side
    std::string name = "the mesh";   // of the mesh, for errors

    bool operator==(const RepairSettings&) const = default;
};

/// One step that changed the mesh: {"vertices welded", 214}.
struct Repair {
    std::string what;
    std::size_t count = 0;
    double volume = 0;  // m³ that it removed or added; 0 if none, or if the surface encloses none
    double share = 0;   // the same as a share of the final volume plus all that was dropped; if `volume` is
                        // 0, a share of the surface's area
};

/// The step in words: "specks dropped: 3 (0.2 % of the volume, 0.41 ml)".
std::string in_words(const Repair& step);

/// Makes a sound solid of any triangles: finite, closed and consistently oriented (every edge has two faces
/// that run along it in opposite directions), with a volume above zero. Returns what changed, in order; a
/// sound mesh stays the same, to the bit. If the walls could not be repaired, the step "faces made by voxels,
/// because …" says why. Two steps change nothing: "faces too crowded to be searched for cuts" and "… for
/// parts that touch" mean that so many long thin faces lie together that not all pairs could be tested. If
/// the mesh is already closed, vertices that share a place are not welded, since they separate what would
/// otherwise touch. Drops normals, texture coordinates and tangents of a mesh that it changes. Throws Error
/// if a position is not finite or nothing encloses a volume: a sheet, a line, a point, a Möbius band. Lengths
/// may have any magnitude, 1e-20 m as well as 1e30 m.
std::vector<Repair> repair(Mesh& mesh, const RepairSettings& settings = {}, const Progress& progress = {});

// ---- its steps ----

// Each step changes the mesh in place, drops its normals, texture coordinates and tangents if positions or
// vertices change, and returns a count for the report. An arrangement must belong to the mesh. All positions
// stay finite.

/// What a step dropped.
struct Dropped {
    std::size_t parts = 0;
    double volume = 0;        // m³, the sum over parts; for an open part, relative to the centre of its
                              // bounding box
    double area = 0;          // m²
    std::size_t crowded = 0;  // faces, if they were too crowded to be searched for parts that touch
};

/// The result of drop_nested().
struct Nested {
    std::size_t dropped = 0;
    std::size_t crossing = 0;  // parts that lie only partly inside others, and are kept
};

/// Merges vertices in the same place; returns how many were removed. `tolerance` (m): a vertex no farther
/// than this from an earlier one is merged into it; 0 merges only equal positions.
std::size_t weld(Mesh& mesh, float tolerance = 0);

/// The same for the vertices of open edges only: closes seams and changes nothing else.
std::size_t weld_border(Mesh& mesh, float tolerance);

/// Drops faces with two equal corners, duplicate faces, and unused vertices; returns how many faces were
/// removed. Weld first, so that vertices in one place are the same. A face whose three corners are collinear
/// but different is kept, because it connects its neighbours: so a closed mesh stays closed.
std::size_t drop_collapsed(Mesh& mesh);

/// Drops all but the first of the faces with the same three corners, in either orientation; returns how many
/// were removed.
std::size_t drop_copies(Mesh& mesh);

/// Drops pairs of faces that lie back to back: the same corners in opposite orientation. A closed mesh stays
/// closed. Returns how many were removed.
std::size_t drop_flaps(Mesh& mesh);

/// Removes degenerate faces (without an area): collapses the short edge of a needle and flips the long edge
/// of a cap, so a closed mesh stays closed. Returns how many were removed. A face is kept if neither can be
/// done without harm; so may be the middle of a long row of them.
std::size_t drop_flat_faces(Mesh& mesh);

/// Drops unused vertices; returns how many.
std::size_t drop_unused(Mesh& mesh);

/// Keeps the piece with the largest volume: parts that touch, overlap or lie inside each other, with their
/// cavities (mesh/pieces.h). Parts may be open or inside out. Keeps everything if faces are too crowded to be
/// searched for parts that touch.
Dropped keep_largest(Mesh& mesh);
Dropped keep_largest(Mesh& mesh, Arrangement& arrangement);

/// The same for open surfaces: keeps the connected part with the largest area.
Dropped keep_largest_sheet(Mesh& mesh);

/// Keeps at most that many parts, those with the largest volume: drops what simplification broke off.
Dropped drop_crumbs(Mesh& mesh, std::size_t most);

/// Fills the cavities that are smaller than `fraction` of the volume, by dropping their walls.
Dropped fill_cavities(Mesh& mesh, double fraction);

/// Drops the parts whose bounding box's longest side is less than `fraction` of that of the longest part.
Dropped drop_specks(Mesh& mesh, float fraction);

/// Flips faces until the orientation within each part is consistent, as that of the majority. Returns how
/// many were flipped. A non-orientable part, such as a Möbius band, keeps a seam of bad edges.
std::size_t turn_faces(Mesh& mesh);

/// Flips each part whose volume is negative, except cavities: parts inside another that face the other way.
/// Returns how many parts were flipped.
std::size_t turn_parts(Mesh& mesh);
std::size_t turn_parts(Mesh& mesh, Arrangement& arrangement);

/// Drops redundant parts inside another that are not cavities of it, so that all remaining walls separate
/// inside from outside. The volume is unchanged. Call turn_parts() first.
Nested drop_nested(Mesh& mesh);
Nested drop_nested(Mesh& mesh, Arrangement& arrangement);

/// Closes each loop of open edges with new faces between its vertices; returns how many loops. If the
/// orientation was consistent, all edges then have as many faces in one direction as in the other.
std::size_t close_holes(Mesh& mesh);

/// Separates sheets that only touch, which makes the mesh manifold. At an edge with more than two faces,
/// those that bound the same matter stay together; where several sheets share only a vertex, each gets its
/// own. Returns how many vertices were added: at the places of the old ones, or at midpoints of edges where
/// that is not enough.
std::size_t separate_sheets(Mesh& mesh);

/// Taubin smoothing (λ|μ): `passes` pairs of a shrinking and an inflating Laplacian step, so that the volume
/// stays within a percent or two. Removes the staircase that a voxel grid leaves on an isosurface.
void smooth(Mesh& mesh, int passes);

/// Decimation: simplifies to about `faces` faces by edge collapses of least quadric error; returns how many
/// faces were removed. A mesh that already has fewer stays unchanged. A closed mesh stays closed. A part that
/// was attached by a single vertex comes loose: call drop_crumbs() afterwards.
std::size_t decimate(Mesh& mesh, std::size_t faces);

}  // namespace palpate
