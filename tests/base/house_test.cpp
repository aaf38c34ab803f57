// The house keeps its floors: a folder includes only what stands below it (docs/architecture.md has the
// table).
#include "palpate/base/files.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace palpate {
namespace {

const std::filesystem::path house = PALPATE_SOURCE_DIR "/palpate";

// What each folder may include besides itself.
const std::map<std::string, std::set<std::string>> may_include = {
    {"base", {}},
    {"mesh", {"base"}},
    {"gl", {"base"}},
    {"body", {"base", "mesh"}},
    {"scene", {"base", "mesh", "body"}},
    {"solver", {"base", "mesh", "body"}},
    {"solver/gpu", {"base", "mesh", "body", "gl"}},
    {"solver/feedback", {"base", "mesh", "body", "gl"}},
    {"solver/fragment", {"base", "mesh", "body", "gl"}},
    {"solver/compute", {"base", "mesh", "body", "gl"}},
    {"touch", {"base", "mesh", "body", "scene"}},
    {"render", {"base", "mesh", "gl", "body", "scene"}},
    {"run", {"base", "mesh", "gl", "body", "scene", "solver", "render"}},
};

// Folders of palpate/ that a file includes.
std::set<std::string> included_by(const std::filesystem::path& file) {
    static const std::regex include(R"(^\s*#\s*include\s*["<]palpate/(\w+)/)");
    std::set<std::string> folders;
    std::istringstream lines(read_text(file));
    std::smatch found;
    for (std::string line; std::getline(lines, line);)
        if (std::regex_search(line, found, include)) folders.insert(found[1]);
    return folders;
}

TEST(House, EachFloorIncludesOnlyWhatStandsBelow) {
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(house)) {
        const std::filesystem::path below = std::filesystem::relative(entry.path(), house);
        if (!entry.is_regular_file() || std::distance(below.begin(), below.end()) < 2) continue;
        const std::string floor = *below.begin();
        // A folder within a floor may have a line of its own.
        const std::string inner = below.parent_path().string();
        const std::string line = may_include.contains(inner) ? inner : floor;
        ASSERT_TRUE(may_include.contains(line)) << line << " is not in the table";
        for (const std::string& folder : included_by(entry.path()))
            EXPECT_TRUE(folder == floor || may_include.at(line).contains(folder))
                << below << " includes " << folder;
        ++files;
    }
    EXPECT_GT(files, 40);
}

TEST(House, TheWholeLibraryIsInItsOneHeader) {
    const std::string all = read_text(house / "palpate.h");
    // Parts inside the house that a user does not reach for.
    const std::set<std::string> inner = {
        "base/pipe.h",         "base/pack-inl.h",        "solver/schedule.h",      "solver/cpu/kernel.h",
        "solver/cpu/layout.h", "solver/cpu/laid_body.h", "body/embedding_parts.h", "body/cells.h",
        "body/grid.h",         "mesh/corners.h",         "mesh/ending.h",          "mesh/bytes.h",
        "mesh/gltf.h",         "mesh/parts.h",           "scene/check.h",          "scene/toml_reader.h",
        "solver/pass.h"};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(house)) {
        const std::string below = std::filesystem::relative(entry.path(), house).string();
        const bool part_of_drawing =
            below.starts_with("gl/") || below.starts_with("render/") || below.starts_with("run/");
        if (entry.path().extension() != ".h" || inner.contains(below) || part_of_drawing ||
            below.starts_with("mesh/formats/") || below.starts_with("solver/gpu/") || below == "palpate.h")
            continue;
        EXPECT_NE(all.find("palpate/" + below), std::string::npos) << below;
    }
}

}  // namespace
}  // namespace palpate
