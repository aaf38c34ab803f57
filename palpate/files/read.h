#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// Reads a surface. The format goes by the name's ending; what is a gzip, by its name or not, is unzipped.
/// PLY, OBJ, STL, OFF, glTF, GLB, 3MF, X3D (.x3d, .x3dv) and VRML 2 (.wrl) are read by readers of our own;
/// whatever else assimp knows (FBX, Collada, 3DS, ...) by assimp, in a process of its own.
///
/// Coordinates are in `units`; where those are not given, in what the file states (3MF, X3D, FBX, Collada,
/// AMF and DXF can), or in metres. Where `units` and the file differ, `units` count, and a note says so.
///
/// All parts of the file become one mesh, as it is at rest; polygons are cut into triangles (polygon.h),
/// points and lines are left out. The vertices of a file stay as they are (an STL has three for each
/// triangle: see repair.h to weld them), but an OBJ file's are those that its faces use, in that order, one
/// for each position and normal. Texts are read to the last digit, so what is written comes back exactly.
/// Normals are kept where the file has one for every vertex, or for every corner.
///
/// What lies so far from the origin that floats would lose its shape, a millimetre at a thousand kilometres,
/// is moved to it. `notes` gets a line on that, and on whatever else was left out or changed.
///
/// Throws Error if the file is missing, truncated, damaged, has no faces, has coordinates that are not finite
/// or beyond a float's range, or has faces that name vertices which do not exist. Memory stays within a small
/// multiple of the file's size, whatever the file claims; a file that assimp is not done with after 15 s of
/// the processor, or for which it crashes, is an Error too.
Mesh read_mesh(const std::filesystem::path& path, std::optional<Units> units = {},
               std::vector<std::string>* notes = nullptr);

/// The same for a file's bytes, not zipped, that are in memory already. `name` chooses the format by its
/// ending and stands in messages. A format that wants other files beside it is refused.
Mesh parse_mesh(std::string_view bytes, const std::string& name, std::optional<Units> units = {},
                std::vector<std::string>* notes = nullptr);

/// True if a name ends like a mesh's that can be read, with .gz behind or not.
bool is_mesh(const std::filesystem::path& path);

/// True if a name ends like a volume's (.nii, .hdr, .img, .nrrd, .nhdr, .mha, .mhd, each also with .gz
/// behind; .dcm), if the file is DICOM by what it holds, or if it is a folder.
bool is_volume(const std::filesystem::path& path);

/// Reads a scalar volume of any kind of number: NIfTI-1 and -2 (.nii, or a pair .hdr and .img), Analyze 7.5,
/// NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd), or a DICOM series: the folder it lies in, or one above, or
/// one of its files. A gzip is known by its content.
///
/// Lengths are in `units`. If those are not given they are in what the file states (NIfTI, NRRD and MetaImage
/// may; DICOM is in millimetres), or else in millimetres. Slope and intercept are applied, slice by slice, so
/// that CT is in Hounsfield units, and MONOCHROME1 is not turned over. Of several time points, echoes or
/// other volumes in one file or series the first is taken, or the one that the named slice belongs to.
/// NIfTI's sform counts before its qform, and both before the spacing alone. DICOM's slices lie from the
/// lowest to the highest along the cross product of their rows and columns. What is no slice of the series is
/// skipped, and so are series of a single slice unless named; a series is parted by size, spacing, angle and
/// time, and the largest part, or the named slice's, is taken. A voxel without a finite value gets the lowest
/// value (at most 0). `notes` gets a line on whatever was assumed, left out or changed so.
///
/// Throws Error if a file is missing, truncated, damaged, claims more voxels than it holds or than 2^30, has
/// no finite value, voxels of no width, axes that are not at right angles (within 1e-3), several numbers a
/// voxel, or is not three-dimensional; if a folder holds several series (it lists them) or none; if slices do
/// not lie evenly (within a tenth of their distance, or what the decimals of their positions can say; it
/// names the two between which one is missing); if they shift sideways, as with a tilted gantry.
///
/// GDCM reads DICOM in processes of its own, which a damaged file may crash without harm. Until the volume is
/// there, 8 bytes a voxel are held at most; after that 4.
Volume read_volume(const std::filesystem::path& path, std::optional<Units> units = {},
                   std::vector<std::string>* notes = nullptr);

}  // namespace palpate
