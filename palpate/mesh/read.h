#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// Reads a surface whose coordinates are in `units`. The format goes by the name's ending, with .gz behind if
/// the file is a gzip: PLY, OBJ, STL, OFF and VRML 2 (.wrl) by readers of our own; glTF, GLB, X3D and
/// whatever else assimp knows (FBX, Collada, 3DS, ...) by assimp, in a process of its own.
///
/// All parts of the file become one mesh; polygons are cut into triangles (polygon.h), points and lines are
/// left out. The vertices of a file stay as they are (an STL has three for each triangle: see repair.h to
/// weld them), but an OBJ file's are those that its faces use, in that order, one for each position and
/// normal. Texts are read to the last digit, so what is written comes back exactly. Normals are kept where
/// the file has one for every vertex, or for every corner.
///
/// What lies so far from the origin that floats would lose its shape, a millimetre at a thousand kilometres,
/// is moved to it. `notes` gets a line on that, and on whatever else was left out or changed.
///
/// Throws Error if the file is missing, truncated, damaged, has no faces, has coordinates that are not finite
/// or beyond a float's range, or has faces that name vertices which do not exist. Memory stays within a small
/// multiple of the file's size, whatever the file claims; a file that assimp is not done with after 15 s, or
/// for which it crashes, is an Error too.
Mesh read_mesh(const std::filesystem::path& path, Units units, std::vector<std::string>* notes = nullptr);

/// The same for a file's bytes, not zipped, that are in memory already. `name` chooses the format by its
/// ending and stands in messages. A format that wants other files beside it is refused.
Mesh parse_mesh(std::string_view bytes, const std::string& name, Units units,
                std::vector<std::string>* notes = nullptr);

/// True if a name ends like a volume's (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd, .dcm), if the file bears
/// DICOM's mark, or if it is a folder with such a file in it.
bool is_volume(const std::filesystem::path& path);

/// Reads a scalar volume of any kind of number: NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd, .nhdr), MetaImage
/// (.mha, .mhd), or a DICOM series: the folder it lies in, or one of its files if the folder holds several
/// series. Files that are no pictures are skipped, and so are series of a single slice unless named. DICOM's
/// slope and intercept are applied (so that CT is in Hounsfield units), and slices lie from the lowest to the
/// highest along the cross product of their rows and columns. Where the grid lies is kept as ITK gives it.
/// Spacing and origin are in `units`; NIfTI and DICOM mean millimetres, and a NIfTI file that says that it is
/// in metres or micrometres is brought to millimetres first.
///
/// Throws Error if a file is missing, truncated, damaged, claims more voxels than it holds or than 2^30, has
/// values that are not finite, voxels of no width, axes that are not at right angles (within 1e-3), several
/// numbers a voxel, or is not three-dimensional; if a folder holds several series (it lists them) or none; if
/// slices of a series differ in size, spacing or direction, lie in the same place, or are not evenly spaced
/// (within 1 %; it names the two between which one is missing); if they shift sideways, as with a tilted
/// gantry.
///
/// Only files of which enough is really there are read. ITK reads them in a process of its own, which a
/// damaged file may crash without harm. Until the volume is there, 8 bytes a voxel are held at most, or twice
/// as many as the file's own numbers take if that is more; after that 4.
Volume read_volume(const std::filesystem::path& path, Units units = Units::millimetres);

}  // namespace palpate
