// The house keeps its floors: a folder includes only what stands below it (docs/architecture.md has the
// table).
#include "palpate/base/files.h"

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace palpate {
namespace {

const std::filesystem::path house = PALPATE_SOURCE_DIR "/palpate";

// What each folder may include besides itself.
const std::map<std::string, std::set<std::string>> may_include = {
    {"base", {}},
    {"mesh", {"base"}},
    {"gl", {"base"}},
    {"voxels", {"base", "mesh"}},
    {"files", {"base", "mesh"}},
    {"body", {"base", "mesh"}},
    {"scene", {"base", "mesh", "voxels", "files", "body"}},
    {"solver", {"base", "mesh", "body"}},
    {"solver_gl", {"base", "mesh", "body", "gl", "solver"}},
    {"touch", {"base", "mesh", "body", "scene"}},
    {"render", {"base", "mesh", "voxels", "gl", "body", "scene"}},
    {"run", {"base", "mesh", "voxels", "files", "gl", "body", "scene", "solver", "touch", "render"}},
    {"viewer",
     {"base", "mesh", "voxels", "files", "gl", "body", "scene", "solver", "touch", "render", "run"}},
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

// The command stands on the library and on what it measures with, and nothing stands on the command.
TEST(House, NothingIncludesTheCommand) {
    for (const char* part : {"palpate", "bench", "examples", "fuzz"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(house.parent_path() / part)) {
            const std::string extension = entry.path().extension().string();
            if (extension == ".h" || extension == ".cpp")
                EXPECT_EQ(read_text(entry.path()).find("#include \"app/"), std::string::npos) << entry.path();
        }
}

TEST(House, TheWholeLibraryIsInItsOneHeader) {
    const std::string all = read_text(house / "palpate.h");
    // Parts inside the house that a user does not reach for.
    const std::set<std::string> inner = {"solver/origin.h",
                                         "solver/cpu/hinges.h",
                                         "solver/cpu/node_access-inl.h",
                                         "base/pipe.h",
                                         "base/pack-inl.h",
                                         "solver/schedule.h",
                                         "solver/cpu/kernel.h",
                                         "solver/cpu/layout.h",
                                         "solver/cpu/body_memory.h",
                                         "solver/cpu/ties.h",
                                         "body/embedding_parts.h",
                                         "body/cells.h",
                                         "body/grid.h",
                                         "mesh/corners.h",
                                         "files/extension.h",
                                         "files/bytes.h",
                                         "files/gltf.h",
                                         "mesh/parts.h",
                                         "scene/check.h",
                                         "scene/toml_reader.h",
                                         "solver/pass.h",
                                         "solver/check.h",
                                         "solver/machine.h",
                                         "solver/pushes.h",
                                         "solver/reference/node.h",
                                         "scene/hold.h",
                                         "scene/reading.h",
                                         "scene/thin_walls.h",
                                         "solver/short_steps.h",
                                         "mesh/pieces.h",
                                         "mesh/face_pairs.h"};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(house)) {
        const std::string below = std::filesystem::relative(entry.path(), house).string();
        const bool part_of_drawing = below.starts_with("gl/") || below.starts_with("render/") ||
                                     below.starts_with("run/") || below.starts_with("viewer/");
        if (entry.path().extension() != ".h" || inner.contains(below) || part_of_drawing ||
            below.starts_with("files/formats/") || below.starts_with("solver_gl/") || below == "palpate.h")
            continue;
        EXPECT_NE(all.find("palpate/" + below), std::string::npos) << below;
    }
}

// What the library does depends on its arguments, and on these two: where data lie, and programs.
TEST(House, TheLibraryReadsNoOtherEnvironmentVariables) {
    static const std::regex variable(R"re(getenv\(("\w+")?)re");
    const std::set<std::string> known = {"\"PALPATE_DATA\"", "\"PATH\""};
    int found = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(house)) {
        if (!entry.is_regular_file()) continue;
        const std::string text = read_text(entry.path());
        for (std::sregex_iterator i(text.begin(), text.end(), variable), end; i != end; ++i, ++found)
            EXPECT_TRUE(known.contains((*i)[1])) << entry.path() << " asks for " << (*i)[1];
    }
    EXPECT_GT(found, 0);
}

// ---- names that stand twice ----

// A type, or a function with its parameters, that a file defines outside of any class or function.
struct Definition {
    std::string scope;    // the namespaces around it, "::" after each
    bool hidden = false;  // one of them has no name
    bool is_type = false;
    std::string name;
};

// The code without comments, preprocessor's lines, and what stands in quotes.
std::string code_of(const std::string& text) {
    std::string code;
    auto goes_on = [&](std::size_t at, std::string_view with) {
        return std::string_view(text).substr(at).starts_with(with);
    };
    auto after = [&](const std::string& end, std::size_t from) {
        const std::size_t found = text.find(end, from);
        return found == std::string::npos ? text.size() : found + end.size();
    };
    bool line_begins = true;
    for (std::size_t i = 0; i < text.size();) {
        const char c = text[i];
        const bool after_word = i > 0 && (std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0);
        if (goes_on(i, "//")) {
            i = text.find('\n', i);
        } else if (goes_on(i, "/*")) {
            i = after("*/", i);
        } else if (goes_on(i, "R\"")) {
            const std::size_t open = text.find('(', i);
            i = after(')' + text.substr(i + 2, open - i - 2) + '"', open);
            code += "\"\"";
        } else if (c == '#' && line_begins) {
            do i = after("\n", i);
            while (i >= 2 && i < text.size() && text[i - 2] == '\\');
        } else if (c == '"' || (c == '\'' && !after_word)) {
            for (++i; i < text.size() && text[i] != c; ++i) i += text[i] == '\\';
            ++i;
            code += "\"\"";
        } else {
            line_begins = c == '\n' || (line_begins && c == ' ');
            code += c;
            ++i;
        }
    }
    return code;
}

// What a head (all between the last statement and an opening brace) begins to define, if it has a name.
std::optional<Definition> defined_by(std::string head) {
    static const std::regex space(R"(\s+)"), attribute(R"(\[\[[^\]]*\]\])"),
        type(
            R"((?:.*> ?)?(?:struct|class|union|enum(?: class)?) (?:alignas\([^)]*\) )?(\w+)(?: final)?(?: ?:[^:].*)?)"),
        function(R"((?:^|.*[ *&>])((?:\w+::)*(?:operator ?[^( ]+|~?\w+)) ?(\(.*))");
    head = std::regex_replace(std::regex_replace(head, attribute, ""), space, " ");
    while (head.starts_with(' ')) head.erase(0, 1);
    while (head.ends_with(' ')) head.pop_back();
    std::smatch found;
    if (std::regex_match(head, found, type)) return Definition{"", false, true, found[1]};
    const bool has_parameters = head.find('(') != std::string::npos, is_value = head.ends_with('=');
    if (!has_parameters || is_value || head.starts_with("static ") || head.starts_with("TEST") ||
        head.starts_with("INSTANTIATE") || head.starts_with("catch"))
        return std::nullopt;
    if (!std::regex_match(head, found, function)) return std::nullopt;
    return Definition{"", false, false, found[1].str() + found[2].str()};
}

std::vector<Definition> definitions_in(const std::string& text) {
    static const std::regex space(R"(\s+)"), name_space(R"( ?(?:inline )?namespace ?([\w:]*) ?)");
    const std::string code = code_of(text);
    std::vector<Definition> all;
    std::vector<std::string> scopes;
    std::size_t head = 0, brackets = 0;
    for (std::size_t i = 0; i < code.size(); ++i) {
        if (code[i] == '(') ++brackets;
        if (code[i] == ')' && brackets > 0) --brackets;
        if (brackets > 0) continue;
        if (code[i] == ';') head = i + 1;
        if (code[i] == '}') {
            if (!scopes.empty()) scopes.pop_back();
            head = i + 1;
        }
        if (code[i] != '{') continue;
        const std::string before = std::regex_replace(code.substr(head, i - head), space, " ");
        if (std::smatch found; std::regex_match(before, found, name_space)) {
            scopes.push_back(found[1]);
            head = i + 1;
            continue;
        }
        if (auto definition = defined_by(before)) {
            for (const std::string& scope : scopes) {
                definition->hidden |= scope.empty();
                if (!scope.empty()) definition->scope += scope + "::";
            }
            all.push_back(*definition);
        }
        for (int depth = 0; i < code.size(); ++i) {  // over its body
            depth += code[i] == '{' ? 1 : code[i] == '}' ? -1 : 0;
            if (depth == 0) break;
        }
        head = i + 1;
    }
    return all;
}

TEST(House, ADefinitionIsFound) {
    auto names = [](const std::string& text) {
        std::string all;
        for (const Definition& d : definitions_in(text))
            all += d.scope + (d.hidden ? "(hidden)" : "") + (d.is_type ? "type " : "") + d.name + "\n";
        return all;
    };
    EXPECT_EQ(names("namespace a::b {\nclass C final : public D {\n struct Inner {};\n};\n}"),
              "a::b::type C\n");
    EXPECT_EQ(names("namespace a {\nnamespace {\nstruct C { int i = 2; };\n}\nenum class E : int { x };\n}"),
              "a::(hidden)type C\na::type E\n");
    EXPECT_EQ(
        names("struct A;  // struct B {\nconst char* s = \"struct C {\";\n#define D struct E {\nint x{3};"),
        "");
    EXPECT_EQ(names("inline int f(int a) {\n return a;\n}\ntemplate <class T>\nvoid g(T t = {}) { t(); }"),
              "f(int a)\ng(T t = {})\n");
    EXPECT_EQ(
        names(
            "const char* s = R\"(struct A {)\";\nclass A::B {};\nvoid A::run() const {}\nstatic void f() {}"),
        "A::run() const\n");
}

// Two definitions of one name are one to the linker, which takes either: what an optimised build happens to
// inline, another calls in the wrong place. Nor does a file give a hidden type the name that a header gives
// to another in the same namespace: whoever includes that header next can tell them apart no longer.
TEST(House, NoNameStandsTwice) {
    const std::filesystem::path root = PALPATE_SOURCE_DIR;
    std::map<std::string, std::set<std::string>> files_of, headers_of, hidden_in;
    std::set<std::string> in_programs;  // of one file each, which only the library is linked to
    for (const char* part : {"palpate", "app", "bench", "tests", "examples/programs", "fuzz"})
        for (const auto& entry : std::filesystem::recursive_directory_iterator(root / part)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            const std::string file = std::filesystem::relative(entry.path(), root).string();
            for (const Definition& d : definitions_in(read_text(entry.path()))) {
                const std::string name = d.scope + d.name;
                // Every program has its own main; and of what a build may leave out there are two, of which
                // it takes one.
                if (d.name.starts_with("main(") || file == "palpate/viewer/no_window.cpp" ||
                    file == "palpate/mesh/no_voxels.cpp")
                    continue;
                if (file.starts_with("examples") || file.starts_with("fuzz")) {
                    if (!d.hidden) in_programs.insert(name);
                } else if (d.hidden) {
                    if (d.is_type && file.starts_with("palpate/")) hidden_in[name].insert(file);
                } else {
                    files_of[name].insert(file);
                    if (d.is_type && extension == ".h" && file.starts_with("palpate/"))
                        headers_of[name].insert(file);
                }
            }
        }
    EXPECT_GT(files_of.size(), 1000u);
    for (const auto& [name, files] : files_of)
        EXPECT_EQ(files.size(), 1u) << name << " is defined in " << *files.begin() << " and in "
                                    << *files.rbegin();
    for (const std::string& name : in_programs)
        EXPECT_FALSE(files_of.contains(name))
            << name << " is in a program, and in " << *files_of[name].begin();
    for (const auto& [name, files] : hidden_in)
        EXPECT_FALSE(headers_of.contains(name))
            << name << " is in " << *headers_of[name].begin() << ", and hidden in " << *files.begin();
}

}  // namespace
}  // namespace palpate
