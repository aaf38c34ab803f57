#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/base/nearest.h"
#include "palpate/files/extension.h"
#include "palpate/files/read.h"
#include "palpate/scene/scene.h"

#include <fmt/format.h>

namespace palpate {
namespace {

// The remedy if neither a scene nor a file has the name.
std::string remedy_for_unknown(const std::string& name) {
    std::string list;
    std::vector<std::string> names;
    for (const ShippedScene& shipped : shipped_scenes()) {
        list += (list.empty() ? "" : ", ") + shipped.name;
        names.push_back(shipped.name);
    }
    const std::string meant = nearest(name, names);
    return (meant.empty() ? "" : "did you mean " + meant + "? Or ") +
           "give a scene (.toml), a mesh, a volume, or one of: " + list;
}

// A file name as a TOML string.
std::string quoted(const std::filesystem::path& file) {
    std::string text = "\"";
    for (char c : file.string()) {
        if (c == '"' || c == '\\') text += '\\';
        if (static_cast<unsigned char>(c) < 0x20)
            text += fmt::format("\\u{:04x}", int(c));
        else
            text += c;
    }
    return text + '"';
}

// It is scaled to 0.2 m, which suits the hand, and damped as tissues are (body/tissues.h).
SceneText scene_around(const char* kind, const std::filesystem::path& file) {
    return {fmt::format(R"([[body]]
name = "it"
{} = {}
size = 0.2
centre = true
nodes = 5000
density = 1000
damping = 10
pin = {{ below = 0.2 }}
)",
                        kind, quoted(file)),
            file.stem().string(), file.parent_path()};
}

}  // namespace

SceneText find_scene(const std::string& file_or_name) {
    for (const ShippedScene& shipped : shipped_scenes())
        if (shipped.name == file_or_name)
            return {shipped.text, shipped.name, std::filesystem::current_path()};
    std::error_code error;
    if (!std::filesystem::exists(file_or_name, error))
        throw Error("no such scene or file", file_or_name, remedy_for_unknown(file_or_name));
    const std::filesystem::path file = file_or_name;
    const bool is_toml = extension(file) == ".toml";
    if (!is_toml && is_volume(file)) return scene_around("volume", std::filesystem::absolute(file));
    if (!is_toml && is_mesh(file)) return scene_around("surface", std::filesystem::absolute(file));
    if (std::filesystem::is_directory(file, error))
        throw Error("no DICOM series in the folder", file_or_name, "name a file, or another folder");
    if (!is_toml && file.has_extension())
        throw Error("an extension of neither a scene nor a mesh nor a volume", file_or_name,
                    "a scene ends in .toml; meshes and volumes are listed in docs/import.md");
    return {read_text(file_or_name), file_or_name, file.parent_path()};
}

}  // namespace palpate
