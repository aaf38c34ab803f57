// assimp reads the files, but it believes them: it allocates what a list claims, goes on in an older line
// where a line is short, and takes a word that is no number for 0. So a file is looked through first, and
// assimp gets what a mesh needs of it, text with one row a line and in the spelling of numbers that it reads
// exactly.
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/mesh/ending.h"
#include "palpate/mesh/read.h"

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace palpate {
namespace {

using Index = std::uint32_t;

constexpr std::size_t most_unzipped = std::size_t(4) << 30;  // bytes

// What is left to read of a file, and under which name to complain about it.
struct Source {
    std::string_view rest;
    const std::filesystem::path& path;

    [[noreturn]] void broken(std::string_view what) const {
        throw Error(what, path.string(), "export it again");
    }
};

// Takes the next word off the text; empty at its end.
std::string_view word(std::string_view& text) {
    constexpr std::string_view space = " \t\r\n\v\f";
    text.remove_prefix(std::min(text.find_first_not_of(space), text.size()));
    std::string_view taken = text.substr(0, text.find_first_of(space));
    text.remove_prefix(taken.size());
    return taken;
}

// Takes off what comes before the next `end`, and the end itself.
std::string_view until(char end, std::string_view& text) {
    std::string_view taken = text.substr(0, text.find(end));
    text.remove_prefix(std::min(taken.size() + 1, text.size()));
    return taken;
}

// The number that a whole word spells. As double, in which each of a PLY file's kinds of number is exact.
std::optional<double> spelled(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = std::numeric_limits<double>::infinity();  // stays so where the number is out of range
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::invalid_argument || end != text.data() + text.size()) return {};
    return value;
}

bool finite(double number) { return std::isfinite(float(number)); }
bool whole(double number, double least, double most) {
    return number >= least && number <= most && number == std::floor(number);
}

// assimp reads fifteen decimals exactly, but rounds where there is an exponent.
std::string exact(double number) {
    const float x = float(number), size = std::abs(x);
    const bool plain = size == 0 || (size > 1.5e-8f && size < 1e18f);
    return plain ? fmt::format(" {:.15f}", x) : fmt::format(" {:.9g}", x);
}

// --- PLY ---------------------------------------------------------------------------------------------------

struct Kind {
    std::string_view name, other_name;
    std::size_t bytes;
    double (*load)(const char* from, bool swapped);
};

template <class T>
double load(const char* from, bool swapped) {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), from, sizeof raw);
    if (swapped) std::reverse(raw.begin(), raw.end());
    return double(std::bit_cast<T>(raw));
}

constexpr Kind kinds[] = {
    {"char", "int8", 1, load<std::int8_t>},    {"uchar", "uint8", 1, load<std::uint8_t>},
    {"short", "int16", 2, load<std::int16_t>}, {"ushort", "uint16", 2, load<std::uint16_t>},
    {"int", "int32", 4, load<std::int32_t>},   {"uint", "uint32", 4, load<std::uint32_t>},
    {"float", "float32", 4, load<float>},      {"double", "float64", 8, load<double>}};

struct Property {
    std::string_view name;  // "other" if a mesh has no place for it
    const Kind* kind;
    const Kind* length;  // what a list's length is stored as; a plain property has none
};

struct Element {
    std::string_view name;
    double count;
    std::vector<Property> properties;

    bool wanted() const { return name == "vertex" || name == "face"; }
};

class Ply : Source {
 public:
    explicit Ply(const Source& source) : Source(source) {}

    std::string checked() {
        read_header();
        // After this assimp skips one \n, which could else be the first number's.
        text_ = fmt::format("ply\nformat {} 1.0\n{}end_header\r\n", format_, text_);
        for (const Element& element : elements_) check_rows(element);
        return std::move(text_);
    }

 private:
    bool ascii() const { return format_ == "ascii"; }

    void read_header() {
        if (word(rest) != "ply") broken("no PLY header");
        for (std::string_view key; key != "end_header";) {
            if (rest.empty()) broken("a PLY header without end");
            std::string_view text = until('\n', rest);
            key = word(text);
            if (key == "format" && elements_.empty()) format_ = word(text);
            if (key == "element") add_element(text);
            if (key == "property") add_property(text);
        }
        std::multiset<std::string_view> needed = {"vertex", "x", "y", "z", "face", "vertex_indices"};
        if (found_.contains("nx")) needed.insert({"nx", "ny", "nz"});
        if (found_ != needed) broken("not just one vertex with x, y, z and one face with vertex_indices");
        if (text_.size() > 65536) broken("an endless header");  // over which assimp takes its time
    }

    void add_element(std::string_view text) {
        if (!ascii() && format_ != "binary_little_endian" && format_ != "binary_big_endian")
            broken(fmt::format("the unknown PLY format \"{}\"", format_));
        const std::string_view name = word(text);
        const auto count = spelled(word(text));
        if (!count || !whole(*count, 0, std::min(double(rest.size()), 0x7fffffffp0)))
            broken(fmt::format("an impossible count of the element \"{}\" promised", name));
        elements_.push_back({name, *count, {}});
        if (!elements_.back().wanted()) return;
        if (name == "vertex") vertices_ = *count;
        found_.insert(name);
        text_ += fmt::format("element {} {}\n", name, Index(*count));
    }

    void add_property(std::string_view text) {
        if (elements_.empty()) broken("a property before any element");
        Element& element = elements_.back();
        std::string_view type = word(text);
        const Kind* length = type == "list" ? &kind(word(text)) : nullptr;
        const Kind& of = kind(length ? word(text) : type);
        std::string_view name = word(text);
        constexpr std::string_view columns[] = {"x", "y", "z", "nx", "ny", "nz"};
        if (element.name == "face" && length && (name == "vertex_index" || name == "vertex_indices"))
            found_.insert(name = "vertex_indices");
        else if (element.name == "vertex" && !length && std::ranges::count(columns, name) > 0)
            found_.insert(name);
        else
            name = "other";
        element.properties.push_back({name, &of, length});
        if (!element.wanted()) return;
        text_ += length ? fmt::format("property list {} ", ascii() ? "uint" : length->name) : "property ";
        const std::string_view in_text = name == "vertex_indices" ? "uint" : "float";
        text_ += fmt::format("{} {}\n", ascii() ? in_text : of.name, name);
    }

    const Kind& kind(std::string_view name) const {
        for (const Kind& k : kinds)
            if (name == k.name || name == k.other_name) return k;
        broken(fmt::format("the unknown number type \"{}\"", name));
    }

    void check_rows(const Element& element) {
        const std::string_view body = rest;
        const std::size_t before = text_.size();
        for (element_ = &element, row_ = 1; row_ <= element.count; ++row_) {
            for (const Property& p : element.properties) check(p);
            if (ascii()) text_ += '\n';
        }
        if (!element.wanted())
            text_.resize(before);
        else if (!ascii())
            text_ += body.substr(0, body.size() - rest.size());
    }

    void check(const Property& p) {
        const bool corners = p.name == "vertex_indices";
        const double length = p.length ? number(*p.length) : 1;
        if (!whole(length, corners ? 3 : 0, 0xffffffffp0)) bad(fmt::format("with {} corners", length));
        if (ascii() && p.length) text_ += fmt::format(" {}", Index(length));
        for (double i = 0; i < length; ++i) {
            const double value = number(*p.kind);
            if (corners && !whole(value, 0, vertices_ - 1))
                bad(fmt::format("naming vertex {} of {}, counted from 0", value, vertices_));
            if (p.name != "other" && !finite(value)) bad("not finite");
            if (ascii()) text_ += corners ? fmt::format(" {}", Index(value)) : exact(value);
        }
    }

    double number(const Kind& kind) {
        const std::string_view text = ascii() ? word(rest) : rest.substr(0, kind.bytes);
        if (text.size() < (ascii() ? 1 : kind.bytes)) bad("promised, but the file is truncated");
        if (ascii()) {
            if (const auto value = spelled(text)) return *value;
            bad(fmt::format("with \"{}\" for a number", text.substr(0, 40)));
        }
        rest.remove_prefix(kind.bytes);
        return kind.load(text.data(), format_ == "binary_big_endian");
    }

    [[noreturn]] void bad(std::string_view what) const {
        broken(fmt::format("{} {} of {} {}", element_->name, row_, element_->count, what));
    }

    std::string_view format_;
    std::vector<Element> elements_;
    std::multiset<std::string_view> found_;  // the elements and properties that a mesh has a place for
    double vertices_ = 0;
    std::string text_;
    const Element* element_ = nullptr;  // where we are
    double row_ = 0;
};

// --- OBJ ---------------------------------------------------------------------------------------------------

// OBJ counts from 1, or backwards from the last one so far. 0: none.
std::int64_t index(std::string_view text, std::size_t so_far) {
    const auto number = spelled(text);
    if (!number || !whole(*number, -double(so_far), 0x7fffffffp0)) return 0;
    return std::int64_t(*number) + (*number < 0 ? std::int64_t(so_far) + 1 : 0);
}

// Positions, normals and faces, without the groups and materials that make several meshes of one.
std::string checked_obj(Source source) {
    std::string text, normals;
    std::size_t position_count = 0, normal_count = 0, infinite = 0;
    bool all_normals = true;  // each corner has one
    for (std::size_t number = 1; !source.rest.empty(); ++number) {
        std::string_view words = until('\n', source.rest);
        const std::string_view key = word(words);
        auto bad = [&](std::string_view what) { source.broken(fmt::format("{} in line {}", what, number)); };
        if (key == "v" || key == "vn") {
            ++(key == "v" ? position_count : normal_count);
            std::string row(key);
            for (int k = 0; k < 3; ++k) {
                const auto value = spelled(word(words));
                if (!value || (key == "vn" && !finite(*value))) bad("not three numbers");
                if (!finite(*value) && infinite == 0) infinite = position_count;
                row += exact(*value);
            }
            (key == "v" ? text : normals) += row + '\n';
        } else if (key == "f") {
            int corners = 0;
            text += key;
            for (auto corner = word(words); !corner.empty(); corner = word(words), ++corners) {
                const auto position = index(until('/', corner), position_count);
                until('/', corner);  // its place in a texture
                const auto normal = index(corner, normal_count);
                if (position == 0) bad("a corner of no vertex");
                all_normals = all_normals && normal != 0;
                text += fmt::format(" {}//{}", position, std::max<std::int64_t>(normal, 1));
            }
            if (corners < 3) bad(fmt::format("a face of {} corners", corners));
            text += '\n';
        }
    }
    if (infinite > 0) source.broken(fmt::format("vertex {} of {} not finite", infinite, position_count));
    return all_normals ? normals + text : text;
}

// --- both --------------------------------------------------------------------------------------------------

// An OBJ file's vertices come once for every corner: those that are equal bit for bit are joined again.
Mesh mesh_of(const aiMesh& from, bool join) {
    auto vector = [](aiVector3D v) { return vec3(v.x, v.y, v.z); };
    Mesh mesh;
    std::vector<std::array<vec3, 2>> rows(from.mNumVertices);
    std::vector<Index> place(from.mNumVertices);
    std::unordered_map<std::string_view, Index> known;
    for (Index i = 0; i < from.mNumVertices; ++i) {
        rows[i] = {vector(from.mVertices[i]), from.HasNormals() ? vector(from.mNormals[i]) : vec3(0)};
        const std::string_view bytes(reinterpret_cast<const char*>(&rows[i]), sizeof rows[i]);
        const Index next = Index(mesh.positions.size());
        place[i] = join ? known.try_emplace(bytes, next).first->second : next;
        if (place[i] != next) continue;
        mesh.positions.push_back(rows[i][0]);
        if (from.HasNormals()) mesh.normals.push_back(rows[i][1]);
    }
    for (const aiFace& face : std::span(from.mFaces, from.mNumFaces))
        for (Index k = 2; k < face.mNumIndices; ++k)
            mesh.triangles.push_back(
                {place[face.mIndices[0]], place[face.mIndices[k - 1]], place[face.mIndices[k]]});
    return mesh;
}

// The whole of a file, unzipped where it is a gzip. It grows as it comes, and not beyond what a mesh may
// need.
std::string read_unzipped(const std::filesystem::path& path) {
    struct Close {
        void operator()(gzFile file) const { gzclose(file); }
    };
    const std::unique_ptr<gzFile_s, Close> file(gzopen(path.c_str(), "rb"));
    std::string text;
    for (std::vector<char> block(1 << 20);;) {
        const int count = file ? gzread(file.get(), block.data(), unsigned(block.size())) : -1;
        int error = Z_OK;
        if (file) gzerror(file.get(), &error);
        if (count < 0 || error != Z_OK)
            throw Error("a truncated or damaged gzip", path.string(), "get the file again");
        if (count == 0) return text;
        text.append(block.data(), std::size_t(count));
        if (text.size() > most_unzipped)
            throw Error("a gzip of more than 4 GB", path.string(), "unzip and simplify the mesh first");
    }
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, Units units) {
    const bool zipped = ending(path) == ".gz";
    const std::string format = ending(zipped ? path.stem() : path);
    if (format != ".ply" && format != ".obj")
        throw Error("cannot read the mesh format \"" + format + "\"", path.string(),
                    "use .ply or .obj, or either with .gz behind");
    try {
        const std::string file = zipped ? read_unzipped(path) : read_text(path);
        const Source source{file, path};
        const std::string text = format == ".ply" ? Ply(source).checked() : checked_obj(source);
        if (text.empty()) source.broken("no faces");
        Assimp::Importer importer;
        const aiScene* scene = importer.ReadFileFromMemory(text.data(), text.size(), 0, format.c_str() + 1);
        const std::string_view error = importer.GetErrorString();
        if (error == "std::bad_alloc") throw std::bad_alloc();
        if (!scene) source.broken(error);
        Mesh mesh = scene->HasMeshes() ? mesh_of(*scene->mMeshes[0], format == ".obj") : Mesh();
        if (mesh.triangles.empty()) source.broken("no faces");
        for (vec3& p : mesh.positions) p *= metres(units);
        return mesh;
    } catch (const std::bad_alloc&) {
        throw Error("more than the memory can hold", path.string(), "free some, or use a smaller mesh");
    }
}

}  // namespace palpate
