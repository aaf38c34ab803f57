#pragma once
#include "palpate/mesh/mesh.h"
#include "palpate/mesh/volume.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// Reads a surface. The format is chosen by the file name's extension; a gzip, whatever its name, is
/// decompressed. PLY, OBJ, STL, OFF, glTF, GLB, 3MF, X3D (.x3d, .x3dv) and VRML 2 (.wrl) have readers of our
/// own; other formats that assimp knows (FBX, Collada, 3DS, ...) are read by assimp, in a process of its own.
///
/// Coordinates are in `units`; if those are not given, in what the file states (3MF, X3D, FBX, Collada, AMF
/// and DXF can), or in metres. If `units` and the file differ, `units` win, and a note says so.
///
/// All parts of the file become one mesh, at rest; polygons are triangulated (polygon.h), points and lines
/// are skipped. The vertices of a file are kept as they are (an STL has three for each triangle: see repair.h
/// to weld them), but for OBJ: there they are those that faces use, in that order, one for each combination
/// of position and normal. Numbers are read exactly, so a written file reads back the same. Normals are kept
/// if the file has one for every vertex, or for every corner.
///
/// A mesh so far from the origin that floats would lose its shape, such as a millimetre at a thousand
/// kilometres, is moved to the origin. `notes` gets a line on that, and on everything else that was skipped
/// or changed.
///
/// Throws Error if the file is missing, truncated or damaged, has no faces, has coordinates that are not
/// finite or beyond a float's range, or has faces with indices of missing vertices. Memory stays within a
/// small multiple of the file's size, whatever the file claims. A file that makes assimp crash, or takes it
/// more than 15 s of processor time, is an Error, too.
Mesh read_mesh(const std::filesystem::path& path, std::optional<Units> units = {},
               std::vector<std::string>* notes = nullptr);

/// The same for the uncompressed bytes of a file in memory. `name` selects the format by its extension, and
/// is for messages. A file that needs other files is refused.
Mesh parse_mesh(std::string_view bytes, const std::string& name, std::optional<Units> units = {},
                std::vector<std::string>* notes = nullptr);

/// True if a file name has an extension of a readable mesh format, also followed by .gz.
bool is_mesh(const std::filesystem::path& path);

/// True if a file name has an extension of a volume format (.nii, .hdr, .img, .nrrd, .nhdr, .mha, .mhd, each
/// also followed by .gz; .dcm), if the file's content is DICOM, or if it is a folder.
bool is_volume(const std::filesystem::path& path);

/// Reads a scalar volume of any number type: NIfTI-1 and -2 (.nii, or a pair .hdr and .img), Analyze 7.5,
/// NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd), or a DICOM series, given by its folder, a folder above, or
/// one of its files. A gzip is recognised by its content.
///
/// Lengths are in `units`. If those are not given, they are in what the file states (NIfTI, NRRD and
/// MetaImage may; DICOM is in millimetres), or else in millimetres. Rescale slope and intercept are applied,
/// slice by slice, so CT is in Hounsfield units; MONOCHROME1 is not inverted. Of several time points, echoes
/// or other volumes in one file or series, the first is taken, or the one of the named slice. NIfTI's sform
/// takes precedence over its qform, and both over the spacing alone. DICOM's slices are sorted along the
/// cross product of their rows and columns. Other files in the folder are skipped, and so are series of a
/// single slice unless named; a series is split by size, spacing, angle and time, and the largest group, or
/// that of the named slice, is taken. A voxel without a finite value gets the lowest value (at most 0).
/// `notes` gets a line on everything that was assumed, skipped or changed.
///
/// Throws Error if a file is missing, truncated or damaged, claims more voxels than it holds or than 2^30,
/// has no finite value, has voxels of zero width, axes that are not orthogonal (within 1e-3) or several
/// numbers per voxel, or is not three-dimensional; if a folder holds several series (it lists them) or none;
/// if slices are not evenly spaced (within a tenth of their distance, or the precision of their positions; it
/// names the two between which one is missing); if they shift sideways, as with a tilted gantry.
///
/// GDCM reads DICOM in processes of its own, which a damaged file may crash without harm. Reading needs at
/// most 8 bytes a voxel, the volume 4.
Volume read_volume(const std::filesystem::path& path, std::optional<Units> units = {},
                   std::vector<std::string>* notes = nullptr);

}  // namespace palpate
