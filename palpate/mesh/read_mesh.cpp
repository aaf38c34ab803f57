// PLY and OBJ are read by our own hand: what write_mesh wrote comes back float for float and index for index,
// every number is checked before it is believed, and no claim of a file makes us allocate more than its size
// allows.
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/mesh/ending.h"
#include "palpate/mesh/read.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {
namespace {

using Index = std::uint32_t;
constexpr Index none = ~Index(0);

// Where we are in a file, and under which name to complain about it.
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

std::string_view line(std::string_view& text) {
    std::string_view taken = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(taken.size() + 1, text.size()));
    return taken;
}

// The number that a whole word spells. As double, in which each of a PLY file's kinds of number is exact.
template <class T>
std::optional<T> spelled(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    T value;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size() || text.empty()) return {};
    if constexpr (std::is_floating_point_v<T>)
        if (error == std::errc::result_out_of_range) return std::numeric_limits<T>::infinity();
    if (error != std::errc()) return {};
    return value;
}

// Adds a face of any number of corners as a fan of triangles, which is right for every convex one.
void add_face(Mesh& mesh, const std::vector<Index>& corners) {
    for (std::size_t i = 2; i < corners.size(); ++i)
        mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

// --- PLY ---------------------------------------------------------------------------------------------------

enum class Kind { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
    std::string_view name;
    Kind kind;
    std::optional<Kind> count;  // what a list's length is stored as; a plain property has none
};

struct Element {
    std::string_view name;
    std::uint64_t count;
    std::vector<Property> properties;
};

struct Header {
    bool ascii = false;
    bool swapped = false;  // bytes the other way round than in memory
    std::vector<Element> elements;
};

std::size_t bytes(Kind kind) {
    switch (kind) {
        case Kind::int8:
        case Kind::uint8:
            return 1;
        case Kind::int16:
        case Kind::uint16:
            return 2;
        case Kind::float64:
            return 8;
        default:
            return 4;
    }
}

Kind kind(std::string_view name, const Source& source) {
    constexpr std::string_view names[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                             {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                             {"float", "float32"}, {"double", "float64"}};
    for (std::size_t i = 0; i < std::size(names); ++i)
        if (name == names[i][0] || name == names[i][1]) return Kind(i);
    source.broken(fmt::format("the unknown number type \"{}\"", name));
}

Property property(std::string_view text, const Source& source) {
    std::string_view type = word(text);
    std::optional<Kind> count;
    if (type == "list") {
        count = kind(word(text), source);
        type = word(text);
    }
    const Kind of = kind(type, source);
    return {word(text), of, count};
}

Header header(Source& source) {
    Header result;
    if (word(source.rest) != "ply") source.broken("no PLY header");
    for (bool format = false;;) {
        if (source.rest.empty()) source.broken("a PLY header without end");
        std::string_view text = line(source.rest);
        const std::string_view key = word(text);
        if (key == "format") {
            const std::string_view name = word(text);
            if (name != "ascii" && name != "binary_little_endian" && name != "binary_big_endian")
                source.broken(fmt::format("the unknown PLY format \"{}\"", name));
            result.ascii = name == "ascii";
            result.swapped = (name == "binary_big_endian") == (std::endian::native == std::endian::little);
            format = true;
        } else if (key == "element") {
            const std::string_view name = word(text);
            const auto count = spelled<std::uint64_t>(word(text));
            if (!count) source.broken(fmt::format("an unreadable count of the element \"{}\"", name));
            result.elements.push_back({name, *count, {}});
        } else if (key == "property") {
            if (result.elements.empty()) source.broken("a property before any element");
            result.elements.back().properties.push_back(property(text, source));
        } else if (key == "end_header") {
            if (!format) source.broken("a PLY header without a format");
            return result;
        }
    }
}

template <class T>
double load(const char* from, bool swapped) {
    char raw[sizeof(T)];
    std::memcpy(raw, from, sizeof raw);
    if (swapped) std::reverse(raw, raw + sizeof raw);
    return double(std::bit_cast<T>(raw));
}

double number(const Header& header, Kind kind, Source& source) {
    if (header.ascii) {
        const std::string_view text = word(source.rest);
        if (text.empty()) source.broken("fewer numbers than its header promises: the file is truncated");
        const auto value = spelled<double>(text);
        if (!value) source.broken(fmt::format("\"{}\" where a number was expected", text.substr(0, 40)));
        return *value;
    }
    if (source.rest.size() < bytes(kind))
        source.broken("fewer bytes than its header promises: the file is truncated");
    const char* from = source.rest.data();
    source.rest.remove_prefix(bytes(kind));
    switch (kind) {
        case Kind::int8:
            return load<std::int8_t>(from, header.swapped);
        case Kind::uint8:
            return load<std::uint8_t>(from, header.swapped);
        case Kind::int16:
            return load<std::int16_t>(from, header.swapped);
        case Kind::uint16:
            return load<std::uint16_t>(from, header.swapped);
        case Kind::int32:
            return load<std::int32_t>(from, header.swapped);
        case Kind::uint32:
            return load<std::uint32_t>(from, header.swapped);
        case Kind::float32:
            return load<float>(from, header.swapped);
        case Kind::float64:
            return load<double>(from, header.swapped);
    }
    return 0;
}

// The length of a list, which the rest of the file must be able to hold.
std::size_t list_length(const Header& header, const Property& list, Source& source) {
    const double length = number(header, *list.count, source);
    const std::size_t room = source.rest.size() / (header.ascii ? 1 : bytes(list.kind));
    if (!(length >= 0 && length <= double(room)))
        source.broken("a list longer than the file: it is truncated");
    return std::size_t(length);
}

void skip(const Header& header, const Property& property, Source& source) {
    const std::size_t count = property.count ? list_length(header, property, source) : 1;
    for (std::size_t i = 0; i < count; ++i) number(header, property.kind, source);
}

// One look at the size of the file before anything is reserved for what the header claims.
void check_room(const Header& header, const Element& element, const Source& source) {
    std::size_t least = 0;
    for (const Property& p : element.properties) least += header.ascii ? 1 : bytes(p.count.value_or(p.kind));
    if (element.properties.empty() ? element.count > 0 : element.count > source.rest.size() / least)
        source.broken(
            fmt::format("{} of the element \"{}\" promised, more than the file can hold: it is truncated",
                        element.count, element.name));
}

void read_vertices(const Header& header, const Element& element, Source& source, Mesh& mesh) {
    constexpr std::string_view names[] = {"x", "y", "z", "nx", "ny", "nz"};
    std::vector<int> place;  // of each property in the row below; -1: not wanted
    for (const Property& p : element.properties) {
        const auto found = std::find(std::begin(names), std::end(names), p.name);
        place.push_back(p.count || found == std::end(names) ? -1 : int(found - std::begin(names)));
    }
    auto has = [&](int i) { return std::count(place.begin(), place.end(), i) == 1; };
    if (!has(0) || !has(1) || !has(2)) source.broken("vertices without x, y and z");
    const bool normals = has(3) && has(4) && has(5);

    mesh.positions.reserve(element.count);
    if (normals) mesh.normals.reserve(element.count);
    for (std::uint64_t v = 0; v < element.count; ++v) {
        float row[6] = {};
        for (std::size_t i = 0; i < place.size(); ++i)
            if (place[i] < 0)
                skip(header, element.properties[i], source);
            else
                row[place[i]] = float(number(header, element.properties[i].kind, source));
        mesh.positions.push_back({row[0], row[1], row[2]});
        if (normals) mesh.normals.push_back({row[3], row[4], row[5]});
    }
}

void read_faces(const Header& header, const Element& element, std::uint64_t vertices, Source& source,
                Mesh& mesh) {
    auto wanted = [](const Property& p) {
        return p.count && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    if (std::count_if(element.properties.begin(), element.properties.end(), wanted) != 1)
        source.broken("faces without a list of vertex_indices");
    std::vector<Index> corners;
    mesh.triangles.reserve(element.count);
    for (std::uint64_t f = 0; f < element.count; ++f)
        for (const Property& p : element.properties) {
            if (!wanted(p)) {
                skip(header, p, source);
                continue;
            }
            corners.resize(list_length(header, p, source));
            if (corners.size() < 3)
                source.broken(fmt::format("face {} with only {} corners", f + 1, corners.size()));
            for (Index& corner : corners) {
                const double index = number(header, p.kind, source);
                if (!(index >= 0 && index < double(vertices)))
                    source.broken(fmt::format("face {} that names vertex {} of {} (counted from 0)", f + 1,
                                              index, vertices));
                corner = Index(index);
            }
            add_face(mesh, corners);
        }
}

Mesh read_ply(Source source) {
    Mesh mesh;
    const Header head = header(source);
    std::uint64_t vertices = 0;
    for (const Element& element : head.elements)
        if (element.name == "vertex") vertices = element.count;
    if (vertices >= none)
        source.broken(fmt::format("{} vertices promised, more than can be counted", vertices));
    for (const Element& element : head.elements) {
        check_room(head, element, source);
        if (element.name == "vertex")
            read_vertices(head, element, source, mesh);
        else if (element.name == "face")
            read_faces(head, element, vertices, source, mesh);
        else
            for (std::uint64_t i = 0; i < element.count; ++i)
                for (const Property& p : element.properties) skip(head, p, source);
    }
    return mesh;
}

// --- OBJ ---------------------------------------------------------------------------------------------------

// OBJ counts from 1, or backwards from the last one so far. Whether a positive one exists shows at the end.
std::optional<Index> index(std::string_view text, std::size_t so_far) {
    const auto number = spelled<std::int64_t>(text);
    if (!number || *number == 0) return {};
    const std::int64_t from_zero = *number > 0 ? *number - 1 : std::int64_t(so_far) + *number;
    if (from_zero < 0 || from_zero >= std::int64_t(none)) return {};
    return Index(from_zero);
}

vec3 coordinates(std::string_view text, std::size_t number, const Source& source) {
    vec3 result;
    for (int k = 0; k < 3; ++k) {
        const auto value = spelled<double>(word(text));
        if (!value) source.broken(fmt::format("three numbers expected in line {}", number));
        result[k] = float(*value);
    }
    return result;
}

// The normals as OBJ has them: a list of their own, of which each corner of a face names one.
struct ObjNormals {
    std::vector<vec3> values;
    std::vector<Index> of_vertex;  // which one each vertex uses
    bool one_each = true;          // no corner without a normal, no vertex with two (a hard edge)

    void use(Index vertex, std::optional<Index> normal, std::size_t vertices) {
        one_each = one_each && normal && vertex < vertices;
        if (!one_each) return;
        of_vertex.resize(vertices, none);
        one_each = of_vertex[vertex] == none || of_vertex[vertex] == *normal;
        of_vertex[vertex] = *normal;
    }
};

void read_corners(std::string_view text, std::size_t number, const Source& source, const Mesh& mesh,
                  ObjNormals& normals, std::vector<Index>& corners) {
    corners.clear();
    // A corner is v, v/vt, v/vt/vn or v//vn.
    for (std::string_view corner = word(text); !corner.empty(); corner = word(text)) {
        const std::size_t first = corner.find('/'), second = corner.find('/', first + 1);
        const auto vertex = index(corner.substr(0, first), mesh.positions.size());
        if (!vertex)
            source.broken(
                fmt::format("the corner \"{}\" of no vertex in line {}", corner.substr(0, 40), number));
        corners.push_back(*vertex);
        const bool has_normal = first != std::string_view::npos && second != std::string_view::npos;
        const auto normal =
            has_normal ? index(corner.substr(second + 1), normals.values.size()) : std::nullopt;
        normals.use(*vertex, normal, mesh.positions.size());
    }
    if (corners.size() < 3)
        source.broken(fmt::format("a face of {} corners in line {}", corners.size(), number));
}

void take_normals(ObjNormals normals, Mesh& mesh) {
    if (!normals.one_each || normals.of_vertex.empty()) return;
    normals.of_vertex.resize(mesh.positions.size(), none);
    for (Index n : normals.of_vertex) {
        if (n != none && n >= normals.values.size()) return mesh.normals.clear();
        mesh.normals.push_back(n == none ? vec3(0, 0, 1) : normals.values[n]);
    }
}

Mesh read_obj(Source source) {
    Mesh mesh;
    ObjNormals normals;
    std::vector<Index> corners;
    for (std::size_t number = 1; !source.rest.empty(); ++number) {
        std::string_view text = line(source.rest);
        const std::string_view key = word(text);
        if (key == "v") {
            mesh.positions.push_back(coordinates(text, number, source));
        } else if (key == "vn") {
            normals.values.push_back(coordinates(text, number, source));
        } else if (key == "f") {
            read_corners(text, number, source, mesh, normals, corners);
            add_face(mesh, corners);
        }
    }
    for (uvec3 t : mesh.triangles) {
        const Index last = std::max({t.x, t.y, t.z});
        if (last >= mesh.positions.size())
            source.broken(fmt::format("a face that names vertex {} of {}", std::size_t(last) + 1,
                                      mesh.positions.size()));
    }
    take_normals(normals, mesh);
    return mesh;
}

// --- both --------------------------------------------------------------------------------------------------

void check_finite(const std::vector<vec3>& vectors, std::string_view what, const Source& source) {
    for (std::size_t i = 0; i < vectors.size(); ++i)
        if (!std::isfinite(vectors[i].x) || !std::isfinite(vectors[i].y) || !std::isfinite(vectors[i].z))
            source.broken(fmt::format("{} {} of {} is not finite", what, i + 1, vectors.size()));
}

}  // namespace

Mesh read_mesh(const std::filesystem::path& path, Units units) {
    const std::string format = ending(path);
    if (format != ".ply" && format != ".obj")
        throw Error("cannot read the mesh format \"" + format + "\"", path.string(), "use .ply or .obj");
    try {
        const std::string text = read_text(path);
        const Source source{text, path};
        Mesh mesh = format == ".ply" ? read_ply(source) : read_obj(source);
        if (mesh.triangles.empty()) source.broken("no faces");
        check_finite(mesh.positions, "vertex", source);
        check_finite(mesh.normals, "normal", source);
        for (vec3& p : mesh.positions) p *= metres(units);
        return mesh;
    } catch (const std::bad_alloc&) {
        throw Error("more than the memory can hold", path.string(), "free some, or use a smaller mesh");
    }
}

}  // namespace palpate
