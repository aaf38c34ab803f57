#include "palpate/base/error.h"
#include "palpate/files/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <unordered_map>

namespace palpate {
namespace {

// A backslash continues a line, so it counts as a space together with the end of the line.
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
            if (key == "v") positions_.push_back(position(words));
            if (key == "vt") uvs_.push_back(texture_coordinates(words));
            if (key == "vn") normals_.push_back(normal(words));
            if (key == "f" || key == "fo") add_face(words);
            if (key == "l" || key == "p") ++loose_;
            if (key == "curv" || key == "curv2" || key == "surf") ++free_forms_;
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
            const std::size_t comment = before_comment(last).size(), read = text.size() - source_.rest.size();
            if (comment < last.size())
                return text.substr(0, std::size_t(last.data() - text.data()) + comment);
            if (source_.rest.empty() || !last.ends_with('\\')) return text.substr(0, read);
        }
    }

    dvec3 position(std::string_view words) const {
        dvec3 v;
        for (int k = 0; k < 3; ++k) v[k] = source_.number(word(words, space));
        return v;
    }

    // Attributes that do not affect the shape need not be finite: they are dropped later.
    static double any_number(std::string_view& words) {
        return parse_number(word(words, space)).value_or(std::numeric_limits<double>::quiet_NaN());
    }

    static dvec3 normal(std::string_view words) {
        dvec3 v;
        for (int k = 0; k < 3; ++k) v[k] = any_number(words);
        return v;
    }

    // A second number may be missing, and a third is not used.
    static dvec2 texture_coordinates(std::string_view words) {
        const double u = any_number(words);
        std::string_view ahead = words;
        return {u, word(ahead, space).empty() ? 0 : any_number(words)};
    }

    void add_face(std::string_view words) {
        Index size = 0;
        for (auto corner = word(words, space); !corner.empty(); corner = word(words, space), ++size) {
            corners_.push_back(vertex(until('/', corner)));
            const std::string_view uv = until('/', corner);
            any_uv_ = any_uv_ || !uv.empty();
            any_normal_ = any_normal_ || !corner.empty();
            all_uvs_ = all_uvs_ && !uv.empty();
            if (all_uvs_) corner_uvs_.push_back(index(uv, uvs_.size()));
            all_normals_ = all_normals_ && !corner.empty();
            if (all_normals_) corner_normals_.push_back(index(corner, normals_.size()));
        }
        cut_off_ = source_.rest.empty() && !source_.whole().ends_with('\n') &&
                   !source_.whole().ends_with('\r') && !sizes_.empty() && size < sizes_.back();
        if (size >= 3) return sizes_.push_back(size);
        ++loose_;
        corners_.resize(corners_.size() - size);
        if (all_uvs_) corner_uvs_.resize(corners_.size());
        if (all_normals_) corner_normals_.resize(corners_.size());
    }

    // OBJ counts from 1, or backwards from the last one so far. An invalid index becomes `nowhere`.
    static constexpr Index nowhere = ~Index(0);
    static Index index(std::string_view text, std::size_t so_far) {
        const double number = parse_number(text).value_or(0);
        if (!is_whole(number, -double(so_far), 0x7fffffffp0) || number == 0) return nowhere;
        return Index(number < 0 ? double(so_far) + number : number - 1);
    }

    Index vertex(std::string_view text) const {
        const Index found = index(text, positions_.size());
        if (found == nowhere)
            source_.broken_here(
                fmt::format("a face naming vertex {} of {}", in_quotes(text), positions_.size()));
        return found;
    }

    // Whether all corners have a valid index; otherwise a note says how many do not.
    static bool all_there(const std::vector<Index>& numbers, std::size_t count, std::string_view what,
                          Draft& draft) {
        const auto astray = std::ranges::count_if(numbers, [&](Index n) { return n >= count; });
        if (astray > 0)
            draft.notes.push_back(
                fmt::format("left the {} out: {} corners refer to missing ones", what, astray));
        return astray == 0 && !numbers.empty();
    }

    // One vertex for each combination of position, texture coordinates and normal that faces use, in that
    // order.
    Draft joined() const {
        Draft draft;
        const bool uvs = all_uvs_ && all_there(corner_uvs_, uvs_.size(), "texture coordinates", draft);
        const bool normals = all_normals_ && all_there(corner_normals_, normals_.size(), "normals", draft);
        for (Index n : corners_)
            if (n >= positions_.size())
                source_.broken(fmt::format("a face naming vertex {} of {}", n + 1, positions_.size()));
        if (any_uv_ && !all_uvs_)
            draft.notes.push_back("left the texture coordinates out: some corners have none");
        if (any_normal_ && !all_normals_)
            draft.notes.push_back("left the normals out: some corners have none");
        if (cut_off_)
            draft.notes.push_back("the last line may be truncated: a face of fewer corners, without an end");
        draft.loose = loose_;
        if (free_forms_ > 0)
            draft.notes.push_back(fmt::format("left out {}", counted(free_forms_, "free-form shape")));
        const std::vector<Index> position = firsts(positions_), uv = firsts(uvs_), normal = firsts(normals_);
        std::vector<uvec3> corners(corners_.size(), uvec3(0));
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i].x = position[corners_[i]];
            if (uvs) corners[i].y = uv[corner_uvs_[i]];
            if (normals) corners[i].z = normal[corner_normals_[i]];
        }
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
    bool any_uv_ = false, any_normal_ = false;  // some corner has one
    bool cut_off_ = false;                      // the last line may be
    std::size_t loose_ = 0, free_forms_ = 0;    // what is skipped
};

}  // namespace

Draft read_obj(Source source) { return Obj(std::move(source)).read(); }

}  // namespace palpate
