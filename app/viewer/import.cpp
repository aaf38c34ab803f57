#include "app/viewer/import.h"

#include "palpate/base/error.h"
#include "palpate/mesh/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace palpate {
namespace {

// A file's name as TOML writes it.
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

bool ends_in(const std::filesystem::path& file, std::initializer_list<const char*> endings) {
    std::string name = file.filename().string();
    for (char& c : name) c = char(std::tolower(static_cast<unsigned char>(c)));
    return std::ranges::any_of(endings, [&](const char* ending) { return name.ends_with(ending); });
}

// Whatever size it had, it is two decimetres long then: so that step, hand and camera suit it.
std::string body_from(const char* kind, const std::filesystem::path& file) {
    return fmt::format(R"([camera]
eye = [0.3, 0.15, 0.4]

[[body]]
name = "it"
{} = {}
size = 0.2
centre = true
nodes = 5000
youngs_modulus = 5000
density = 1000
damping = 2
pin = {{ below = 0.1 }}
)",
                       kind, quoted(file));
}

}  // namespace

SceneText scene_for(const std::filesystem::path& named) {
    std::error_code error;
    const std::filesystem::path file = std::filesystem::absolute(named, error);
    if (error || !std::filesystem::exists(file, error))
        throw Error("no such file", named.string(), "drop one that is there");
    if (ends_in(file, {".toml"})) return find_scene(file.string());
    return {body_from(is_volume(file) ? "volume" : "surface", file), file.stem().string(),
            file.parent_path()};
}

Import::Import(SceneText source, std::vector<Change> changes)
    : name_(source.name),
      work_(std::async(std::launch::async, [this, source = std::move(source), changes = std::move(changes)] {
          return prepare(source, changes, [this](std::string_view doing, double fraction) {
              if (cancelled_) throw Error("cancelled", name_, "open it again");
              const std::scoped_lock lock(mutex_);
              state_ = {std::string(doing), fraction};
          });
      })) {}

Import::~Import() {
    cancelled_ = true;
    if (work_.valid()) work_.wait();
}

Import::State Import::state() const {
    const std::scoped_lock lock(mutex_);
    return state_;
}

bool Import::done() const {
    return work_.valid() && work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace palpate
