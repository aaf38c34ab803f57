#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/mesh/ending.h"
#include "palpate/mesh/formats/formats.h"
#include "palpate/mesh/read.h"

#include <zlib.h>

#include <memory>
#include <new>

namespace palpate {
namespace {

struct Format {
    std::string_view ending;
    Draft (*read)(Source);
};

constexpr Format own_formats[] = {
    {".ply", read_ply}, {".obj", read_obj}, {".stl", read_stl}, {".off", read_off}, {".wrl", read_vrml}};

Draft read_draft(const Source& source, const std::string& format, const std::filesystem::path& folder) {
    for (const Format& own : own_formats)
        if (own.ending == format) return own.read(source);
    return read_with_assimp(source, folder);
}

void check_format(const std::string& format, const std::string& name) {
    for (const Format& own : own_formats)
        if (own.ending == format) return;
    if (!assimp_knows(format))
        throw Error("cannot read the mesh format " + in_quotes(format), name,
                    "use .ply, .obj, .stl, .off, .wrl, .gltf, .glb or .x3d, or one of them with .gz behind");
}

Mesh mesh_of(std::string_view bytes, const std::string& format, const std::string& name,
             const std::filesystem::path& folder, Units units, std::vector<std::string>* notes) {
    return finish(read_draft(Source(bytes, name), format, folder), units, name, notes);
}

[[noreturn]] void out_of_memory(const std::string& name) {
    throw Error("more than the memory can hold", name, "free some, or use a smaller mesh");
}

// The whole of a gzip. It grows as it comes, and not beyond what a mesh that is packed well may need.
std::string read_unzipped(const std::filesystem::path& path) {
    struct Close {
        void operator()(gzFile file) const { gzclose(file); }
    };
    std::error_code none;
    const std::size_t most = (std::size_t(256) << 20) + 64 * std::filesystem::file_size(path, none);
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

Mesh read_mesh(const std::filesystem::path& path, Units units, std::vector<std::string>* notes) {
    const bool zipped = ending(path) == ".gz";
    const std::string format = ending(zipped ? path.stem() : path);
    check_format(format, path.string());
    try {
        const std::string bytes = zipped ? read_unzipped(path) : read_text(path);
        const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
        return mesh_of(bytes, format, path.string(), folder, units, notes);
    } catch (const std::bad_alloc&) {
        out_of_memory(path.string());
    }
}

Mesh parse_mesh(std::string_view bytes, const std::string& name, Units units,
                std::vector<std::string>* notes) {
    const std::string format = ending(name);
    check_format(format, name);
    try {
        return mesh_of(bytes, format, name, {}, units, notes);
    } catch (const std::bad_alloc&) {
        out_of_memory(name);
    }
}

}  // namespace palpate
