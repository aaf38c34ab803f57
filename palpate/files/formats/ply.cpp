#include "palpate/files/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <set>
#include <utility>

namespace palpate {
namespace {

// A number type; all are exact in double for practical sizes.
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
    {"int64", "long", 8, load<std::int64_t>},  {"uint64", "ulong", 8, load<std::uint64_t>},
    {"float", "float32", 4, load<float>},      {"double", "float64", 8, load<double>}};

// The properties that a mesh can hold.
constexpr std::string_view columns[] = {"x", "y", "z", "nx", "ny", "nz", "u", "v"};
constexpr int corners = 8, other = 9;

// Texture coordinates go by several names.
std::string_view column_name(std::string_view name) {
    if (name == "s" || name == "texture_u") return "u";
    if (name == "t" || name == "texture_v") return "v";
    return name;
}

struct Property {
    int place;  // among columns, or one of the two above
    const Kind* kind;
    const Kind* length;  // what a list's length is stored as; a plain property has none
};

struct Element {
    std::string_view name;
    double count;
    std::vector<Property> properties;
};

class Ply {
 public:
    explicit Ply(Source source) : source_(std::move(source)) {}

    Draft read() {
        source_.skip_mark();
        read_header();
        double rows = 0;
        for (const Element& element : elements_) rows += element.properties.empty() ? 0 : element.count;
        rows_are_lines_ = ascii() && source_.lines_with_words(rows) >= rows;
        for (const Element& element : elements_)
            if (!element.properties.empty()) read_rows(element);
        return std::move(draft_);
    }

 private:
    bool ascii() const { return format_ == "ascii"; }

    void read_header() {
        if (word(source_.rest) != "ply") source_.broken("no PLY header");
        const std::size_t end = source_.rest.find_first_of("\r\n");
        const std::string_view rest = source_.rest.substr(std::min(end, source_.rest.size()));
        end_of_line_ =
            rest.starts_with('\r') && !rest.starts_with("\r\n") ? '\r' : '\n';  // of old Macintoshs
        for (std::string_view key; key != "end_header";) {
            if (source_.rest.empty()) source_.broken("a PLY header without end");
            std::string_view text = until(end_of_line_, source_.rest);
            key = word(text);
            if (key == "format" && elements_.empty()) format_ = word(text);
            if (key == "element") add_element(text);
            if (key == "property") add_property(text);
        }
        check_header();
    }

    void check_header() {
        const auto has = [&](std::string_view name) { return found_.contains(name); };
        if (!has("face") && !has("tristrips"))
            source_.broken(has("range_grid") ? "no faces, only a grid of ranges," : "no faces, only points,",
                           "make a surface of them first, as MeshLab can");
        for (std::string_view name : {"vertex", "x", "y", "z", "vertex_indices"})
            if (!has(name)) source_.broken("no " + std::string(name) + " in its header");
        for (std::string_view name : {"vertex", "x", "y", "z", "nx", "ny", "nz", "face", "tristrips"})
            if (found_.count(name) > 1)
                source_.broken("more than one " + std::string(name) + " in its header");
        normals_ = has("nx") && has("ny") && has("nz");
        if (!normals_ && (has("nx") || has("ny") || has("nz")))
            draft_.notes.push_back("left the normals out, because nx, ny or nz is missing");
        uvs_ = found_.count("u") == 1 && found_.count("v") == 1;  // else they may mean anything
    }

    void add_element(std::string_view text) {
        if (!ascii() && format_ != "binary_little_endian" && format_ != "binary_big_endian")
            source_.broken(fmt::format("the unknown PLY format {}", in_quotes(format_)));
        const std::string_view name = word(text);
        const auto count = parse_number(word(text));
        if (!count || !is_whole(*count, 0, std::min(double(source_.rest.size()), 0x7fffffffp0)))
            source_.broken(fmt::format("an impossible count of the element {} promised", in_quotes(name)));
        elements_.push_back({name, *count, {}});
        found_.insert(name);
    }

    void add_property(std::string_view text) {
        if (elements_.empty()) source_.broken("a property before any element");
        Element& element = elements_.back();
        const std::string_view type = word(text);
        const Kind* length = type == "list" ? &kind(word(text)) : nullptr;
        const Kind& of = kind(length ? word(text) : type);
        const std::string_view name = word(text);
        const auto column = std::ranges::find(columns, column_name(name));
        int place = other;
        const bool of_faces = element.name == "face" || element.name == "tristrips";
        if (of_faces && length && name.starts_with("vertex_ind")) {  // its end differs
            if (found_.contains("vertex_indices")) source_.broken("two lists of the corners of faces");
            place = corners;
            found_.insert("vertex_indices");
        } else if (of_faces && length && name == "texcoord") {
            draft_.notes.push_back("left the texture coordinates out, which the corners of faces have");
        } else if (element.name == "vertex" && !length && column != std::end(columns)) {
            place = int(column - columns);
            found_.insert(*column);
            if (place < 3 && of.name == "float" && !ascii()) draft_.single = true;
        }
        element.properties.push_back({place, &of, length});
    }

    const Kind& kind(std::string_view name) const {
        for (const Kind& k : kinds)
            if (name == k.name || name == k.other_name) return k;
        source_.broken(fmt::format("the unknown number type {}", in_quotes(name)));
    }

    void read_rows(const Element& element) {
        for (element_ = &element, row_ = 1; row_ <= element.count; ++row_) {
            std::array<double, 10> values;
            for (const Property& p : element.properties)
                if (p.length)
                    read_list(p);
                else
                    values[std::size_t(p.place)] = number(*p.kind);
            if (rows_are_lines_) source_.line();  // which may hold more than the header declares
            if (element.name != "vertex") continue;
            draft_.positions.push_back({values[0], values[1], values[2]});
            if (normals_) draft_.normals.push_back({values[3], values[4], values[5]});
            if (uvs_) draft_.uvs.push_back({values[6], values[7]});
        }
    }

    void read_list(const Property& p) {
        const double length = number(*p.length);
        if (!is_whole(length, 0, 0xffffffffp0)) bad(fmt::format("with {} corners", length));
        const bool strip = element_->name == "tristrips";
        for (double i = 0; i < length; ++i) {
            const double value = number(*p.kind);
            if (p.place != corners) continue;
            if (strip) {
                add_to_strip(value);
                continue;
            }
            if (!is_whole(value, 0, 0x7fffffffp0)) bad(fmt::format("naming vertex {}", value));
            draft_.corners.push_back(Index(value));
        }
        if (p.place == corners && !strip) draft_.sizes.push_back(Index(length));
        strip_.clear();
    }

    // Each corner makes a triangle with the two before it, with alternating orientation; -1 begins a new
    // strip.
    void add_to_strip(double value) {
        if (value == -1) return strip_.clear();
        if (!is_whole(value, 0, 0x7fffffffp0)) bad(fmt::format("naming vertex {}", value));
        strip_.push_back(Index(value));
        const std::size_t n = strip_.size();
        if (n < 3) return;
        Index a = strip_[n - 3], b = strip_[n - 2], c = strip_[n - 1];
        if (a == b || b == c || c == a) return;  // degenerate: it only continues the strip
        if (n % 2 == 0) std::swap(a, b);
        draft_.corners.insert(draft_.corners.end(), {a, b, c});
        draft_.sizes.push_back(3);
    }

    double number(const Kind& kind) {
        const std::string_view text = ascii() ? word(source_.rest) : source_.rest.substr(0, kind.bytes);
        if (text.size() < (ascii() ? 1 : kind.bytes)) bad("promised, but the file is truncated");
        if (ascii()) {
            if (const auto value = parse_number(text)) return *value;
            source_.not_a_number(text);
        }
        source_.rest.remove_prefix(kind.bytes);
        return kind.load(text.data(), format_ == "binary_big_endian");
    }

    [[noreturn]] void bad(std::string_view what) const {
        source_.broken(fmt::format("{} {} of {} {}", element_->name, row_, element_->count, what));
    }

    Source source_;
    std::string_view format_;
    std::vector<Element> elements_;
    std::multiset<std::string_view> found_;  // the elements and properties that a mesh has a place for
    char end_of_line_ = '\n';
    bool normals_ = false, uvs_ = false, rows_are_lines_ = false;
    std::vector<Index> strip_;          // the corners of one so far
    const Element* element_ = nullptr;  // where we are
    double row_ = 0;
    Draft draft_;
};

}  // namespace

Draft read_ply(Source source) { return Ply(std::move(source)).read(); }

}  // namespace palpate
