#include "palpate/mesh/formats/formats.h"

#include <fmt/format.h>

#include <unordered_map>

namespace palpate {
namespace {

// A backslash continues a line, so it and the line's end behind it are space.
constexpr std::string_view space = " \t\r\n\v\f\\";

// For each vector the first that equals it bit for bit.
std::vector<Index> firsts(const std::vector<dvec3>& vectors) {
    std::vector<Index> first;
    first.reserve(vectors.size());
    std::unordered_map<std::string_view, Index> known(vectors.size());
    for (const dvec3& v : vectors) {
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

    void add_face(std::string_view words) {
        Index size = 0;
        for (auto corner = word(words, space); !corner.empty(); corner = word(words, space), ++size) {
            corners_.push_back(index(until('/', corner), positions_.size(), "vertex"));
            until('/', corner);  // its place in a texture
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

    // What the faces use, in that order, one vertex for each position and normal.
    Draft joined() const {
        const bool normals = all_normals_ && !corner_normals_.empty();
        for (Index n : corner_normals_)
            if (normals && n >= normals_.size())
                source_.broken(fmt::format("a face naming normal {} of {}", n + 1, normals_.size()));
        for (Index p : corners_)
            if (p >= positions_.size())
                source_.broken(fmt::format("a face naming vertex {} of {}", p + 1, positions_.size()));
        Draft draft;
        draft.sizes = sizes_;
        draft.corners.reserve(corners_.size());
        const std::vector<Index> position = firsts(positions_), normal = firsts(normals_);
        std::unordered_map<std::uint64_t, Index> known;
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            const Index p = position[corners_[i]], n = normals ? normal[corner_normals_[i]] : 0;
            const Index next = Index(draft.positions.size());
            const Index vertex = known.try_emplace(std::uint64_t(p) << 32 | n, next).first->second;
            draft.corners.push_back(vertex);
            if (vertex != next) continue;
            draft.positions.push_back(positions_[p]);
            if (normals) draft.normals.push_back(normals_[n]);
        }
        return draft;
    }

    Source source_;
    std::vector<dvec3> positions_, normals_;
    std::vector<Index> corners_, corner_normals_, sizes_;
    bool all_normals_ = true;  // each corner has one
};

}  // namespace

Draft read_obj(Source source) { return Obj(std::move(source)).read(); }

}  // namespace palpate
