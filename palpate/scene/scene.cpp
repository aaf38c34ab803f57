#include "palpate/scene/scene.h"

#include "palpate/base/error.h"
#include "palpate/base/nearest.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

namespace palpate {

namespace {

std::optional<std::filesystem::path> find(const std::string& name, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> places{folder};
    if (const char* data = std::getenv("PALPATE_DATA")) places.push_back(data);
    places.push_back("/usr/share/mricron/templates");
    for (const auto& place : places) {
        std::error_code error;  // devices and pipes are skipped
        const auto kind = std::filesystem::status(place / name, error).type();
        using enum std::filesystem::file_type;
        if (!name.empty() && (kind == regular || kind == directory)) return place / name;
    }
    return std::nullopt;
}

}  // namespace

std::string Lines::where(const std::string& key, const std::string& file) const {
    if (const int line = of(key); line > 0) return fmt::format("{}, line {}", file, line);
    return keys.empty() ? file : "--set";  // a recipe without keys is not from a file
}

vec3 sky(const Scene& scene) {
    const vec3 up = scene.camera.up.value_or(-scene.simulation.gravity);
    const float length = glm::length(up);
    return length > 0 && std::isfinite(length) ? up / length : vec3(0, 1, 0);
}

bool is_found(const std::string& name, const std::filesystem::path& folder) {
    return find(name, folder).has_value();
}

std::string remedy_for_missing(const std::string& name, const std::filesystem::path& folder) {
    const std::string wanted = std::filesystem::path(name).filename().string();
    const std::filesystem::path beside = (folder / name).parent_path();
    std::vector<std::string> there;
    std::error_code error;
    for (const auto& file : std::filesystem::directory_iterator(beside.empty() ? "." : beside, error))
        if (file.exists(error)) there.push_back(file.path().filename().string());  // no broken link
    if (const std::string meant = nearest(wanted, there); !meant.empty())
        return "did you mean " + meant + "?";
    return "name it from the scene's folder, or set PALPATE_DATA to its folder; the brain and the head come "
           "with Debian's mricron-data, other meshes with scripts/get-data or as their scene says";
}

std::filesystem::path find_data(const std::string& name, const std::filesystem::path& folder) {
    if (const auto path = find(name, folder)) return *path;
    std::error_code unreadable;
    if (std::filesystem::exists(folder / name, unreadable))
        throw Error("a folder, a pipe or a device where a file was expected", name, "name a file");
    throw Error("cannot find the file", name, remedy_for_missing(name, folder));
}

}  // namespace palpate
