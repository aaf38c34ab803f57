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

/// How a surface becomes a solid: its own faces are mended, and where that fails voxels make a new surface
/// (walls); or voxels do so at once.
enum class SolidBy { walls, voxels };

/// Their names: walls, voxels.
std::span<const Named<SolidBy>> names(SolidBy);

struct RepairSettings {
    float weld = 0;        // m; vertices no farther apart become one. 0: those in one place and, where
                           // the mesh is open, those of the border within 1e-5 of its longest side
    float specks = 0.01f;  // parts shorter than this fraction of the longest part go; 0 keeps all
    bool largest = false;  // keep only the largest piece: see keep_largest()
    double cavities =
        0;               // those smaller than this fraction of the volume are filled: in scans they are noise
    bool sheet = false;  // a cloth: may stay open, is neither closed nor made by voxels
    SolidBy solid = SolidBy::walls;  // ignored for a sheet
    float voxel = 0;                 // m; for what voxels make. 0: 1/300 of the longest side
    std::string name = "the mesh";   // what errors call it

    bool operator==(const RepairSettings&) const = default;
};

/// One step that changed the mesh: {"vertices welded", 214}.
struct Repair {
    std::string what;
    std::size_t count = 0;
    double volume = 0;  // m³ that went or came with it; 0 where none did, or a surface has none
    double share = 0;   // that, of the volume at the end and all that was dropped; or where `volume` is 0, of
                        // the surface's area
};

/// It in words: "specks dropped: 3 (0.2 % of the volume, 0.41 ml)".
std::string in_words(const Repair& step);

/// Makes a sound solid of any triangles: finite, every edge with two faces that run along it in opposite
/// ways, and a volume above zero. Returns what changed, in order; a sound mesh stays as it is, to the bit.
/// Where the walls could not be mended, the step "faces made by voxels, because …" says why. Two steps change
/// nothing: "faces too crowded to be searched for cuts" and "… for parts that touch", where thousands of long
/// thin ones lie together, so that not all pairs that may cut through or touch each other were looked at.
/// Where the mesh is already closed,
/// vertices that share a place are not welded: they hold apart what would else touch. Drops normals, texture
/// coordinates and tangents of a mesh it changes. Throws Error if a position is not finite or nothing
/// encloses a volume: a sheet, a line, a point, a Möbius band. Positions may be of any size, 1e-20 m as well
/// as 1e30 m.
std::vector<Repair> repair(Mesh& mesh, const RepairSettings& settings = {}, const Progress& progress = {});

// ---- its steps ----

// Each step changes the mesh in place, drops its normals, texture coordinates and tangents if positions or
// vertices change, and returns a count for the report. An arrangement is the mesh's own. None of
// them ever makes a position that is not finite.

/// What went with the parts that a step dropped.
struct Dropped {
    std::size_t parts = 0;
    double volume = 0;        // m³; each part's own, which of an open one is about that of its box's middle
    double area = 0;          // m²
    std::size_t crowded = 0;  // faces, if too many lay together to search them for parts that touch
};

/// What was found of parts that lie inside others.
struct Nested {
    std::size_t dropped = 0;
    std::size_t crossing = 0;  // lie only partly inside others, and stay
};

/// Makes one vertex of all that lie at the same place; returns how many vertices went.
/// `tolerance` (m): a vertex no farther than this from one before it becomes that one; 0 welds only equal
/// positions.
std::size_t weld(Mesh& mesh, float tolerance = 0);

/// The same for the vertices of open edges only: closes seams and leaves all else alone.
std::size_t weld_border(Mesh& mesh, float tolerance);

/// Drops faces with two equal corners, second copies of the same face, and vertices no face uses; returns how
/// many faces went. Weld first: then what lies in one place is equal. A face whose three corners merely lie
/// in a line stays, because it holds its neighbours together: so a closed mesh stays closed.
std::size_t drop_collapsed(Mesh& mesh);

/// Drops all but the first of the faces that have the same three corners, whichever way they turn; returns
/// how many went.
std::size_t drop_copies(Mesh& mesh);

/// Drops each face together with one that lies on its back: the same corners, turning the other way. A closed
/// mesh stays closed. Returns how many went.
std::size_t drop_flaps(Mesh& mesh);

/// Removes faces without an area: of a needle the short edge is collapsed, of a cap the long edge flipped, so
/// a closed mesh stays closed. Returns how many went; where neither can be done without harm the face stays,
/// as may the middle of a long row of them.
std::size_t drop_flat_faces(Mesh& mesh);

/// Drops vertices no face uses; returns how many went.
std::size_t drop_unused(Mesh& mesh);

/// Keeps the piece with the largest volume, a piece being parts that touch, overlap or lie in each other,
/// with the cavities in them (mesh/pieces.h). Parts may be open, and the wrong way out. Keeps everything
/// where faces are too crowded to be searched for parts that touch.
Dropped keep_largest(Mesh& mesh);
Dropped keep_largest(Mesh& mesh, Arrangement& lie);

/// The same for what need not enclose anything: keeps the connected part with the largest area.
Dropped keep_largest_sheet(Mesh& mesh);

/// Keeps that many parts, those with the largest volume: what simplifying broke off goes.
Dropped drop_crumbs(Mesh& mesh, std::size_t most);

/// Fills the cavities that are smaller than `fraction` of the volume: drops the parts that turn inward.
Dropped fill_cavities(Mesh& mesh, double fraction);

/// Drops the parts whose box's longest side is less than `fraction` of that of the longest part.
Dropped drop_specks(Mesh& mesh, float fraction);

/// Turns faces over until, within each part, neighbours turn the same way: as most of the part did. Returns
/// how many were turned. A part with one side only, such as a Möbius band, keeps a seam of bad edges.
std::size_t turn_faces(Mesh& mesh);

/// Turns over each part whose volume is negative, but for cavities: parts inside another that turn the other
/// way. Returns how many parts were turned.
std::size_t turn_parts(Mesh& mesh);
std::size_t turn_parts(Mesh& mesh, Arrangement& lie);

/// Drops the parts that lie inside another and are no cavity of it, so that what is left parts inside from
/// outside. The volume stays as it is. Turn parts first.
Nested drop_nested(Mesh& mesh);
Nested drop_nested(Mesh& mesh, Arrangement& lie);

/// Closes each loop of open edges with new faces between its vertices; returns how many loops. All edges then
/// have as many faces one way as the other, if neighbours turned the same way before.
std::size_t close_holes(Mesh& mesh);

/// Parts what only touches. Where an edge has more than two faces, those that bound the same matter stay
/// together; where several sheets share but a vertex, each gets its own. Returns how many vertices were
/// added: at the places of the old, or where that does not part them in the middles of edges.
std::size_t part_sheets(Mesh& mesh);

/// Taubin's smoothing: `passes` pairs of a shrinking and a growing step, so that the volume stays within a
/// percent or two. Removes the staircase that a voxel grid leaves on an isosurface.
void smooth(Mesh& mesh, int passes);

/// Simplifies to about `faces` faces by collapsing edges where it shows least (quadric error); returns how
/// many faces went. Leaves a mesh that has fewer already as it is. A closed mesh stays closed. A part that
/// hung on by a single vertex comes loose: drop_crumbs afterwards drops it.
std::size_t decimate(Mesh& mesh, std::size_t faces);

}  // namespace palpate
