#include "palpate/mesh/formats/formats.h"

#include <fmt/format.h>

#include <unordered_map>

namespace palpate {
namespace {

// A backslash continues a line, so it and the line's end behind it are space.
constexpr std::string_view space = " \t\r\n\v\f\\";

// For each vector the first that equals it bit for bit.
template <class T>
std::vector<Index> firsts(const std::vector<T>& vectors) {
    std::vector<Index> first;
    first.reserve(vectors.size());
    std::unordered_map<std::string_view, Index> known(vectors.size());
    for (const T& v : vectors) {
        const std::string_view bytes(reinterpret_cast<const char*>(&v), sizeof v);
        first.push_back(known.try_emplace(bytes, Index(first.size())).first->second);
    }
    return first;
}

class Obj {
 public:
    explicit Obj(Source source) : source_(std::move(source)) {}

    Draft read() {
        source_.skip_mark();
        while (!source_.rest.empty()) {
            std::string_view words = line();
            const std::string_view key = word(words, space);
            if (key == "v") positions_.push_back(three_numbers(words));
            if (key == "vt") uvs_.push_back(texture_place(words));
            if (key == "vn") normals_.push_back(three_numbers(words));
            if (key == "f") add_face(words);
        }
        return joined();
    }

 private:
    // Up to the next end of a line without a backslash before it, and without a comment, which ends with its
    // line.
    std::string_view line() {
        const std::string_view text = source_.rest;
        for (;;) {
            const std::string_view last = source_.line();
            const std::size_t comment = last.find('#'), read = text.size() - source_.rest.size();
            if (comment != std::string_view::npos)
                return text.substr(0, std::size_t(last.data() - text.data()) + comment);
            if (source_.rest.empty() || !(last.ends_with('\\') || last.ends_with("\\\r")))
                return text.substr(0, read);
        }
    }

    dvec3 three_numbers(std::string_view words) const {
        dvec3 v;
        for (int k = 0; k < 3; ++k) v[k] = source_.number(word(words, space));
        return v;
    }

    // A second number may be missing, and a third means nothing to a picture.
    dvec2 texture_place(std::string_view words) const {
        const double u = source_.number(word(words, space));
        const std::string_view v = word(words, space);
        return {u, v.empty() ? 0 : source_.number(v)};
    }

    void add_face(std::string_view words) {
        Index size = 0;
        for (auto corner = word(words, space); !corner.empty(); corner = word(words, space), ++size) {
            corners_.push_back(index(until('/', corner), positions_.size(), "vertex"));
            const std::string_view uv = until('/', corner);
            all_uvs_ = all_uvs_ && !uv.empty();
            if (all_uvs_) corner_uvs_.push_back(index(uv, uvs_.size(), "texture coordinate"));
            all_normals_ = all_normals_ && !corner.empty();
            if (all_normals_) corner_normals_.push_back(index(corner, normals_.size(), "normal"));
        }
        if (size < 3) source_.broken_here(fmt::format("a face of {} corners", size));
        sizes_.push_back(size);
    }

    // OBJ counts from 1, or backwards from the last one so far.
    Index index(std::string_view text, std::size_t so_far, std::string_view what) const {
        const double number = spelled(text).value_or(0);
        if (!is_whole(number, -double(so_far), 0x7fffffffp0) || number == 0)
            source_.broken_here(fmt::format("a face naming {} {} of {}", what, in_quotes(text), so_far));
        return Index(number < 0 ? double(so_far) + number : number - 1);
    }

    void check(const std::vector<Index>& numbers, std::size_t count, std::string_view what) const {
        for (Index n : numbers)
            if (n >= count) source_.broken(fmt::format("a face naming {} {} of {}", what, n + 1, count));
    }

    // What the faces use, in that order, one vertex for each position, place in the texture and normal.
    Draft joined() const {
        const bool uvs = all_uvs_ && !corner_uvs_.empty(), normals = all_normals_ && !corner_normals_.empty();
        if (normals) check(corner_normals_, normals_.size(), "normal");
        if (uvs) check(corner_uvs_, uvs_.size(), "texture coordinate");
        check(corners_, positions_.size(), "vertex");
        const std::vector<Index> position = firsts(positions_), uv = firsts(uvs_), normal = firsts(normals_);
        std::vector<uvec3> corners(corners_.size(), uvec3(0));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i].x = position[corners_[i]];
            if (uvs) corners[i].y = uv[corner_uvs_[i]];
            if (normals) corners[i].z = normal[corner_normals_[i]];
        }
        Draft draft;
        draft.sizes = sizes_;
        draft.corners = firsts(corners);
        for (std::size_t i = 0; i < corners.size(); ++i) {
            Index& vertex = draft.corners[i];
            if (vertex != i) {
                vertex = draft.corners[vertex];
                continue;
            }
            vertex = Index(draft.positions.size());
            draft.positions.push_back(positions_[corners[i].x]);
            if (uvs) draft.uvs.push_back(uvs_[corners[i].y]);
            if (normals) draft.normals.push_back(normals_[corners[i].z]);
        }
        return draft;
    }

    Source source_;
    std::vector<dvec3> positions_, normals_;
    std::vector<dvec2> uvs_;
    std::vector<Index> corners_, corner_uvs_, corner_normals_, sizes_;
    bool all_uvs_ = true, all_normals_ = true;  // each corner has one
};

}  // namespace

Draft read_obj(Source source) { return Obj(std::move(source)).read(); }

}  // namespace palpate
