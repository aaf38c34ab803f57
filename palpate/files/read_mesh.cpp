#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/extension.h"
#include "palpate/files/formats/budget.h"
#include "palpate/files/formats/foreign.h"
#include "palpate/files/formats/formats.h"
#include "palpate/files/read.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>
#include <utility>

namespace palpate {
namespace {

struct Format {
    std::string_view extension;
    Draft (*read)(Source);
};

constexpr Format own_formats[] = {{".ply", read_ply},  {".obj", read_obj},   {".stl", read_stl},
                                  {".off", read_off},  {".gltf", read_gltf}, {".glb", read_gltf},
                                  {".vrm", read_gltf}, {".3mf", read_3mf},   {".x3d", read_x3d},
                                  {".x3dz", read_x3d}, {".x3db", read_x3d},  {".x3dv", read_vrml},
                                  {".wrl", read_vrml}, {".wrz", read_vrml},  {".vrml", read_vrml}};

// The first bytes of volumes (magic numbers), whatever their names.
struct VolumeSign {
    std::string_view start, what, remedy;
    std::size_t at = 0;  // its offset
};

constexpr VolumeSign volume_signs[] = {{"NRRD000", "an NRRD volume", "name it .nrrd"},
                                       {"ObjectType = Image", "a MetaImage volume", "name it .mha or .mhd"},
                                       {std::string_view("n+1\0", 4), "a NIfTI volume", "name it .nii", 344},
                                       {std::string_view("n+2\0", 4), "a NIfTI volume", "name it .nii", 4},
                                       {"DICM", "a DICOM file", "name it .dcm", 128}};

constexpr std::string_view zip = "PK\3\4", gzip = "\x1f\x8b";
constexpr std::string_view zipped_formats[] = {".3mf", ".3d", ".zae", ".q3o", ".pk3"};

const Format* own_format(std::string_view extension) {
    const auto found = std::ranges::find(own_formats, extension, &Format::extension);
    return found == std::end(own_formats) ? nullptr : found;
}

// First bytes (magic numbers) that identify a format, whatever the extension.
constexpr std::pair<std::string_view, std::string_view> signs[] = {
    {"glTF", ".glb"},    {"ply\n", ".ply"}, {"ply\r", ".ply"}, {"#VRML V", ".wrl"},
    {"#X3D V", ".x3dv"}, {"OFF\n", ".off"}, {"OFF\r", ".off"}};

// The same for ambiguous first bytes, with a word that follows soon after them.
struct Sign {
    std::string_view start, soon, extension;
};
constexpr Sign longer_signs[] = {{"solid", "facet normal", ".stl"},
                                 {"<?xml", "<X3D", ".x3d"},
                                 {"PK\3\4", "[Content_Types].xml", ".3mf"},
                                 {"{", "\"asset\"", ".gltf"}};

// The extension that fits a file's first bytes; empty if they may be of any format.
std::string_view extension_by(std::string_view bytes) {
    for (const auto& [start, extension] : signs)
        if (bytes.starts_with(start)) return extension;
    for (const auto& [start, soon, extension] : longer_signs)
        if (bytes.starts_with(start) && bytes.substr(0, 1000).find(soon) != std::string_view::npos)
            return extension;
    return {};
}

void refuse_other_kinds(std::string_view bytes, const std::string& format, const std::string& name) {
    if (bytes.empty()) throw Error("an empty file", name, "get the file again");
    refuse_foreign(bytes, name);
    for (const auto& [start, what, remedy, at] : volume_signs)
        if (bytes.substr(std::min(at, bytes.size())).starts_with(start))
            throw Error(fmt::format("{}, not a mesh,", what), name, remedy);
    if (bytes.starts_with(zip) && extension_by(bytes) != ".3mf" &&
        std::ranges::count(zipped_formats, format) == 0)
        throw Error("a ZIP archive", name, "unpack it first");
}

Draft read_draft(const Source& source, const std::string& format) {
    refuse_other_kinds(source.whole(), format, source.name());
    const Format* const named = own_format(format);
    const std::string_view extension = extension_by(source.whole());
    const Format* const meant = own_format(extension);
    if (!meant || (named && named->read == meant->read))
        return named ? named->read(source) : read_with_assimp(source);
    Draft draft = meant->read(source);
    draft.notes.push_back(fmt::format("read as {}, because its first bytes say so", extension));
    return draft;
}

bool is_known(const std::string& format) { return own_format(format) || assimp_knows(format); }

// A file's extension, ignoring a final .gz.
std::string format_of(const std::filesystem::path& path) {
    return extension(extension(path) == ".gz" ? path.stem() : path);
}

void check_format(const std::string& format, const std::string& name) {
    if (is_known(format)) return;
    throw Error(format.empty() ? "no extension that identifies the format"
                               : "cannot read the mesh format " + in_quotes(format),
                name,
                "use .ply, .obj, .stl, .off, .gltf, .glb, .3mf, .x3d or .wrl for a mesh, and .nii, .nrrd, "
                ".mha, .mhd or DICOM for a volume");
}

[[noreturn]] void out_of_memory(const std::string& name) {
    throw Error("more than the memory can hold", name, "free some, or use a smaller mesh");
}

// Decompresses a whole gzip, up to the size of a very well compressed mesh.
std::string read_unzipped(const std::filesystem::path& path) {
    struct Close {
        void operator()(gzFile file) const { gzclose(file); }
    };
    std::error_code none;
    const std::size_t most = warranted(std::filesystem::file_size(path, none));
    const std::unique_ptr<gzFile_s, Close> file(none ? nullptr : gzopen(path.c_str(), "rb"));
    std::string text;
    for (std::vector<char> block(1 << 20);;) {
        const int count = file ? gzread(file.get(), block.data(), unsigned(block.size())) : -1;
        int error = Z_OK;
        if (file) gzerror(file.get(), &error);
        if (count < 0 || error != Z_OK)
            throw Error("a missing, truncated or damaged gzip", path.string(), "get the file again");
        if (count == 0) return text;
        text.append(block.data(), std::size_t(count));
        if (text.size() > most)
            throw Error("more than 64 times the gzip's size", path.string(), "unzip it first");
    }
}

}  // namespace

bool is_mesh(const std::filesystem::path& path) { return is_known(format_of(path)); }

Mesh read_mesh(const std::filesystem::path& path, std::optional<Units> units,
               std::vector<std::string>* notes) {
    const std::string format = format_of(path);
    if (std::error_code unreadable; !std::filesystem::exists(path, unreadable))
        throw Error("cannot find the file", path.string(), "check the name and that it may be read");
    check_format(format, path.string());
    try {
        std::string bytes = read_text(path);
        if (bytes.starts_with(gzip)) bytes = read_unzipped(path);
        const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
        return finish(read_draft(Source(bytes, path.string(), folder), format), units, path.string(), notes);
    } catch (const std::bad_alloc&) {
        out_of_memory(path.string());
    }
}

Mesh parse_mesh(std::string_view bytes, const std::string& name, std::optional<Units> units,
                std::vector<std::string>* notes) {
    const std::string format = extension(name);
    check_format(format, name);
    try {
        return finish(read_draft(Source(bytes, name), format), units, name, notes);
    } catch (const std::bad_alloc&) {
        out_of_memory(name);
    }
}

}  // namespace palpate
