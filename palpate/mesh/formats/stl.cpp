#include "palpate/mesh/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cstring>
#include <limits>

namespace palpate {
namespace {

static_assert(std::endian::native == std::endian::little, "a binary STL is read as it lies in memory");

// A binary file: 80 bytes of anything, the number of facets, then for each a normal, three corners, two
// bytes.
constexpr std::size_t header = 80, counted = header + 4, facet = 50;

std::size_t promised(std::string_view bytes) {
    std::uint32_t count = 0;
    if (bytes.size() >= counted) std::memcpy(&count, bytes.data() + header, sizeof count);
    return count;
}

// Whether two words are the same but for capitals.
bool alike(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char c, unsigned char d) { return std::tolower(c) == std::tolower(d); });
}

bool mentions(std::string_view text, std::string_view what) {
    return std::search(text.begin(), text.end(), what.begin(), what.end(),
                       [](unsigned char a, char b) { return std::tolower(a) == b; }) != text.end();
}

bool is_text(std::string_view bytes) {
    return alike(word(bytes), "solid") && (mentions(bytes, "facet") || mentions(bytes, "endsolid"));
}

Draft read_binary(const Source& source) {
    const std::string_view bytes = source.whole();
    if (bytes.size() < counted) source.broken("neither a text nor a binary STL");
    const std::size_t count = promised(bytes), there = (bytes.size() - counted) / facet;
    if (count > there) source.broken(fmt::format("{} facets promised and {} there", count, there));
    if (count > std::numeric_limits<Index>::max() / 3) source.broken("too many facets");
    Draft draft;
    draft.single = true;
    draft.sizes.assign(count, 3);
    draft.positions.reserve(3 * count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<vec3, 3> corners;
        std::memcpy(&corners, bytes.data() + counted + i * facet + sizeof(vec3), sizeof corners);
        for (vec3 p : corners) {
            draft.corners.push_back(Index(draft.positions.size()));
            draft.positions.emplace_back(p);
        }
    }
    return draft;
}

// solid NAME, then facets (facet normal X Y Z, outer loop, three times vertex X Y Z, endloop, endfacet), then
// endsolid NAME; all that perhaps several times, in any capitals.
Draft read_text(Source& source) {
    Draft draft;
    bool in_solid = false, in_loop = false;
    Index size = 0;  // corners of the face so far
    for (auto key = word(source.rest); !key.empty(); key = word(source.rest)) {
        if (alike(key, "solid") || alike(key, "endsolid")) {
            if (in_loop) source.broken_here("a loop without end");
            in_solid = key.size() == 5;
            source.line();  // a name
        } else if (alike(key, "outer") || alike(key, "endloop")) {
            in_loop = key.size() == 5;
            if (in_loop) continue;
            if (size < 3) source.broken_here(fmt::format("a loop of {} corners", size));
            draft.sizes.push_back(size);
            size = 0;
        } else if (alike(key, "vertex") && in_loop) {
            dvec3 p;
            for (int k = 0; k < 3; ++k) p[k] = source.number(word(source.rest));
            draft.corners.push_back(Index(draft.positions.size()));
            draft.positions.push_back(p);
            ++size;
        } else if (alike(key, "normal")) {
            for (int k = 0; k < 3; ++k) word(source.rest);  // faces know their own
        } else if (!alike(key, "facet") && !alike(key, "loop") && !alike(key, "endfacet")) {
            source.broken_here("the unknown word " + in_quotes(key));
        }
    }
    if (in_solid) source.broken("no end of the solid: truncated");
    return draft;
}

}  // namespace

Draft read_stl(Source source) {
    // Many a binary file begins with "solid" too. What has just the size that it promises is binary.
    const std::string_view bytes = source.whole();
    if (bytes.size() >= counted && bytes.size() == counted + facet * promised(bytes))
        return read_binary(source);
    source.skip_mark();
    return is_text(source.rest) ? read_text(source) : read_binary(source);
}

}  // namespace palpate
