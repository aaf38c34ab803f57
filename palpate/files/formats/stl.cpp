#include "palpate/base/error.h"
#include "palpate/files/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <limits>
#include <utility>

namespace palpate {
namespace {

static_assert(std::endian::native == std::endian::little, "a binary STL is read as it lies in memory");

// A binary file: 80 bytes of anything, the number of facets, then for each a normal, three corners, two
// bytes.
constexpr std::size_t header = 80, head_bytes = header + 4, facet = 50;

std::size_t promised(std::string_view bytes) {
    std::uint32_t count = 0;
    if (bytes.size() >= head_bytes) std::memcpy(&count, bytes.data() + header, sizeof count);
    return count;
}

// Whether two words are equal, ignoring case.
bool alike(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char c, unsigned char d) { return std::tolower(c) == std::tolower(d); });
}

// Finds a lower-case word in a text, ignoring case; npos if it is not there.
std::size_t place_of(std::string_view what, std::string_view text) {
    const auto found = std::search(text.begin(), text.end(), what.begin(), what.end(),
                                   [](unsigned char a, char b) { return std::tolower(a) == b; });
    return found == text.end() ? std::string_view::npos : std::size_t(found - text.begin());
}

// A text has no zero bytes, but a binary file has some in its facet count. Some programs pad the name in the
// first line of a text with zeros, though.
bool is_text(std::string_view bytes) {
    const auto has = [&](std::string_view what) { return place_of(what, bytes) != std::string_view::npos; };
    const std::size_t first_line = bytes.substr(0, 200).find_first_of("\r\n");
    const bool named = bytes.starts_with("solid") && first_line != std::string_view::npos;
    return bytes.substr(named ? first_line : 0, 1000).find('\0') == std::string_view::npos &&
           (has("facet") || has("endsolid"));
}

bool is_plain_text(std::string_view bytes) {
    return std::ranges::all_of(bytes, [](unsigned char c) { return c >= ' ' || std::isspace(c); });
}

Draft read_binary(const Source& source) {
    const std::string_view bytes = source.whole();
    if (bytes.size() < head_bytes) source.broken("neither a text nor a binary STL");
    const std::size_t there = (bytes.size() - head_bytes) / facet;
    const bool uncounted = promised(bytes) == 0 && there > 0 && bytes.size() == head_bytes + facet * there;
    const std::size_t count = uncounted ? there : promised(bytes);
    if (count > there && is_plain_text(bytes.substr(0, 1000)))
        source.broken("a text that is not STL", "give it the extension of its format");
    if (count > there) source.broken(fmt::format("{} facets promised and {} there", count, there));
    if (count > std::numeric_limits<Index>::max() / 3) source.broken("too many facets");
    Draft draft;
    draft.single = true;
    if (uncounted)
        draft.notes.push_back(
            fmt::format("read the {} facets that are there: the file says it has none", there));
    if (const std::size_t left = bytes.size() - head_bytes - count * facet; left >= facet)
        draft.notes.push_back(
            fmt::format("left out {} bytes behind the {} facets that the file says it has", left, count));
    draft.sizes.assign(count, 3);
    draft.positions.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<vec3, 3> corners;
        std::memcpy(&corners, bytes.data() + head_bytes + i * facet + sizeof(vec3), sizeof corners);
        for (vec3 p : corners) {
            draft.corners.push_back(Index(draft.positions.size()));
            draft.positions.emplace_back(p);
        }
    }
    return draft;
}

// solid NAME, then facets (facet normal X Y Z, outer loop, three times vertex X Y Z, endloop, endfacet), then
// endsolid NAME; perhaps several times, in any case, the ends in one word or two. Only the vertices count: a
// line that begins with another word (a colour, a comment) is ignored.
class StlText {
 public:
    explicit StlText(Source source) : source_(std::move(source)) {}

    Draft read() {
        for (auto key = word(source_.rest); !key.empty(); key = word(source_.rest)) take(key);
        if (in_loop_ || in_facet_) source_.broken("no end of the solid: truncated");
        if (in_solid_)
            draft_.notes.push_back("the text ends without \"endsolid\": facets may be missing from the file");
        if (!others_.empty())
            draft_.notes.push_back(fmt::format("ignored {} outside of any facet, the first with {}",
                                               counted(others_.size(), "line"), in_quotes(others_.front())));
        return std::move(draft_);
    }

 private:
    void take(std::string_view key) {
        const bool ends = key.size() > 3 && alike(key.substr(0, 3), "end");
        if (ends)
            end(key.substr(3));
        else if (alike(key, "end"))
            end(word(source_.rest));
        else if (alike(key, "solid"))
            in_solid_ = true, pass_name();
        else if (alike(key, "facet"))
            in_facet_ = true;
        else if (alike(key, "outer"))
            in_loop_ = true;
        else if (alike(key, "vertex") && in_loop_)
            add_vertex();
        else if (alike(key, "normal"))
            pass_numbers();  // normals are computed from the corners
        else if (!alike(key, "loop"))
            pass_line(key);
    }

    void end(std::string_view what) {
        if (alike(what, "solid")) {
            if (in_loop_) source_.broken_here("a loop without end");
            in_solid_ = false;
            pass_name();
        } else if (alike(what, "facet")) {
            in_facet_ = false;
        } else if (alike(what, "loop")) {
            if (size_ < 3) source_.broken_here(fmt::format("a loop of {} corners", size_));
            draft_.sizes.push_back(std::exchange(size_, 0));
            in_loop_ = false;
        } else {
            pass_line(what);
        }
    }

    void add_vertex() {
        dvec3 p;
        for (int k = 0; k < 3; ++k) p[k] = source_.number(word(source_.rest));
        draft_.corners.push_back(Index(draft_.positions.size()));
        draft_.positions.push_back(p);
        ++size_;
    }

    void pass_numbers() {
        std::string_view ahead = source_.rest;
        for (int k = 0; k < 3 && parse_number(word(ahead)); ++k) source_.rest = ahead;
    }

    // Skips the rest of the line, or up to its first facet.
    void pass_name() {
        const std::string_view text = source_.rest, line = source_.line();
        if (const std::size_t facet = place_of("facet normal", line); facet != std::string_view::npos)
            source_.rest = text.substr(facet);
    }

    void pass_line(std::string_view key) {
        const std::string_view text = source_.rest;
        const bool whole = text.starts_with('\n') || text.starts_with('\r');
        if (!whole) source_.line();
        others_.push_back(key);
    }

    Source source_;
    Draft draft_;
    bool in_solid_ = false, in_facet_ = false, in_loop_ = false;
    Index size_ = 0;                        // corners of the face so far
    std::vector<std::string_view> others_;  // the first words of ignored lines
};

}  // namespace

Draft read_stl(Source source) {
    // Many binary files begin with "solid", too. A file of exactly the size that its facet count implies is
    // binary.
    const std::string_view bytes = source.whole();
    if (bytes.size() >= head_bytes && bytes.size() == head_bytes + facet * promised(bytes))
        return read_binary(source);
    source.skip_mark();
    return is_text(source.rest) ? StlText(std::move(source)).read() : read_binary(source);
}

}  // namespace palpate
