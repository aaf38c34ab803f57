// VRML 2 as far as it tells of surfaces: IndexedFaceSets, in Shapes, in nodes that group and move them. All
// else is read over. Nothing is kept of the tree: faces go straight to the draft, in the node's own
// coordinates, and a Transform then moves what its children have added. DEF keeps where in the text a node
// stands, and USE reads it there once more.
#include "palpate/mesh/formats/formats.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace palpate {
namespace {

constexpr int most_nested = 200;

// How much may be read in all because a USE repeats it: enough for a forest, too little for a bomb.
constexpr std::size_t repeated_bytes = std::size_t(16) << 20, repeated_times = 16;

using Numbers = std::vector<double>;

// The fields of a Transform; what they are where it does not say.
struct Placement {
    dvec3 center{0}, scale{1}, translation{0};
    std::array<double, 4> rotation{0, 0, 1, 0}, scale_orientation{0, 0, 1, 0};
};

// By an angle about an axis; about none, if that has no length.
dmat3 turn(const std::array<double, 4>& by) {
    dvec3 a(by[0], by[1], by[2]);
    const double length = glm::length(a);
    if (!(length > 0)) return dmat3(1);
    a /= length;
    const double s = std::sin(by[3]), c = std::cos(by[3]);
    const dmat3 cross(0, a.z, -a.y, -a.z, 0, a.x, a.y, -a.x, 0);
    return c * dmat3(1) + s * cross + (1 - c) * glm::outerProduct(a, a);
}

// How much of the draft there was at some time.
struct Mark {
    std::size_t positions, corners, sizes;
};

class Vrml {
 public:
    explicit Vrml(Source source)
        : source_(std::move(source)), may_repeat_(repeated_bytes + repeated_times * source_.whole().size()) {}

    Draft read() {
        source_.skip_mark();
        if (source_.rest.starts_with("#VRML V1.0")) source_.broken("VRML 1.0", "convert it to VRML 2 (97)");
        if (!source_.rest.starts_with("#VRML V2.0")) source_.broken("no VRML 2 header");
        while (!ahead().empty())
            if (!skip_statement(ahead())) node();
        if (others_.empty()) return std::move(draft_);
        std::string left_out = "no IndexedFaceSet:";
        for (std::string_view other : others_) left_out += ' ' + std::string(other);
        if (draft_.sizes.empty()) source_.broken(left_out, "convert it to triangles");
        draft_.notes.push_back("left out what is " + left_out);
        return std::move(draft_);
    }

 private:
    // --- words ---

    // The next word, left where it is: a bracket, a text in quotes, or what runs up to a space or one of
    // those.
    std::string_view ahead() {
        std::string_view& rest = source_.rest;
        for (;;) {
            rest.remove_prefix(std::min(rest.find_first_not_of(" \t\r\n\v\f,"), rest.size()));
            if (!rest.starts_with('#')) break;
            source_.line();
        }
        if (!rest.starts_with('"')) {
            const std::size_t end = rest.find_first_of(" \t\r\n\v\f,{}[]\"#");
            return rest.substr(0, end == 0 ? 1 : end);
        }
        std::size_t end = 1;
        while (end < rest.size() && rest[end] != '"') end += rest[end] == '\\' ? 2 : 1;
        if (end >= rest.size()) source_.broken("a text without end: truncated");
        return rest.substr(0, end + 1);
    }

    std::string_view next() {
        const std::string_view word = ahead();
        if (word.empty()) source_.broken("a node without end: truncated");
        source_.rest.remove_prefix(word.size());
        return word;
    }

    bool take(std::string_view expected) {
        const bool found = ahead() == expected;
        if (found) next();
        return found;
    }

    std::size_t position() const { return source_.whole().size() - source_.rest.size(); }

    // --- values ---

    static bool is_plain(std::string_view word) {
        return word == "TRUE" || word == "FALSE" || word == "NULL" ||
               (!word.empty() && std::string_view("0123456789+-.\"").find(word[0]) != std::string_view::npos);
    }

    // All numbers of a list, or the few that stand without brackets.
    Numbers numbers() {
        Numbers found;
        const bool list = take("[");
        while (list ? !take("]") : is_plain(ahead())) found.push_back(source_.number(next()));
        return found;
    }

    template <std::size_t N>
    std::array<double, N> just() {
        const Numbers found = numbers();
        if (found.size() != N)
            source_.broken_here(fmt::format("{} numbers where {} should be", found.size(), N));
        std::array<double, N> values{};
        std::copy(found.begin(), found.end(), values.begin());
        return values;
    }

    dvec3 vector() {
        const auto [x, y, z] = just<3>();
        return {x, y, z};
    }

    // Whatever an unknown field holds. Its nodes are read, because they may have names, and left out again.
    void skip_value() {
        const Mark before = mark();
        if (take("["))
            while (!take("]")) skip_one();
        else if (is_plain(ahead()))
            while (is_plain(ahead())) next();
        else if (begins_node())
            skip_one();
        keep(before, before, before);
    }

    void skip_one() {
        if (is_plain(ahead()) || take("USE"))
            next();
        else
            node();
    }

    bool begins_node() {
        if (ahead() == "DEF" || ahead() == "USE") return true;
        const std::string_view here = source_.rest;
        if (!ahead().empty()) next();
        const bool found = ahead() == "{";
        source_.rest = here;
        return found;
    }

    // --- nodes ---

    // ROUTE node.event TO node.event says nothing of a surface; a PROTO could say anything.
    bool skip_statement(std::string_view word) {
        if (word == "PROTO" || word == "EXTERNPROTO")
            source_.broken("a PROTO, a node of its own making,", "convert it with another program");
        if (word != "ROUTE") return false;
        for (int k = 0; k < 4; ++k) next();
        return true;
    }

    void node() {
        if (++depth_ > most_nested)
            source_.broken(fmt::format("nodes nested more than {} deep", most_nested));
        const std::string_view type = next();
        if (type == "USE") {
            repeat(next());
        } else if (type == "DEF") {
            const std::string_view name = next();
            const std::size_t start = position();
            node();
            defined_[name].emplace(position(), start);
        } else if (type != "NULL") {
            if (!take("{")) source_.broken_here("no { after " + in_quotes(type));
            read_body(type);
        }
        --depth_;
    }

    // Of all nodes of this name, the last that ended before.
    void repeat(std::string_view name) {
        const std::map<std::size_t, std::size_t>& known = defined_[name];
        const auto after = known.upper_bound(position());
        if (after == known.begin())
            source_.broken_here("USE of " + in_quotes(name) + ", which no DEF names,");
        const auto [end, start] = *std::prev(after);
        if (end - start > may_repeat_)
            source_.broken("too much repeated by USE", "convert it with another program");
        may_repeat_ -= end - start;
        const std::string_view here = source_.rest;
        source_.rest = source_.whole().substr(start);
        node();
        source_.rest = here;
    }

    void read_body(std::string_view type) {
        constexpr std::string_view groups[] = {"Group",     "Transform", "Anchor", "Billboard",
                                               "Collision", "Switch",    "LOD"};
        constexpr std::string_view surfaces[] = {"Box",  "Sphere",    "Cylinder",
                                                 "Cone", "Extrusion", "ElevationGrid"};
        if (type == "Inline") source_.broken("an Inline, a part in another file,", "export it as one file");
        if (const auto other = std::ranges::find(surfaces, type); other != std::end(surfaces))
            others_.insert(*other);
        if (type == "IndexedFaceSet") return read_faces();
        if (std::ranges::count(groups, type) > 0) return read_group(type);
        read_fields([&](std::string_view field) {
            if (type == "Shape" && field == "geometry")
                node();
            else if (type == "Coordinate" && field == "point")
                points_ = numbers();
            else
                return false;
            return true;
        });
    }

    // `known` reads the fields that it knows, and says so.
    template <class F>
    void read_fields(F known) {
        for (std::string_view field = ahead(); !take("}"); field = ahead()) {
            if (skip_statement(field)) continue;
            if (std::string_view("{[]").find(next()[0]) != std::string_view::npos)
                source_.broken_here(in_quotes(field) + " where a field's name should be");
            if (!known(field)) skip_value();
        }
    }

    void read_faces() {
        Numbers points, indices;
        bool ccw = true;
        read_fields([&](std::string_view field) {
            if (field == "coord")
                points_.clear(), node(), points = points_;
            else if (field == "coordIndex")
                indices = numbers();
            else if (field == "ccw")
                ccw = next() != "FALSE";
            else
                return false;
            return true;
        });
        const Mark start = mark();
        if (points.size() % 3 != 0) source_.broken_here("a point of less than three numbers");
        for (std::size_t i = 0; i < points.size(); i += 3)
            draft_.positions.push_back({points[i], points[i + 1], points[i + 2]});
        if (draft_.positions.size() > ~Index(0)) source_.broken("more than 2^32 points");
        indices.push_back(-1);  // which ends a face, and may be left out after the last
        for (Index size = 0; double index : indices) {
            if (index != -1) {
                if (!is_whole(index, 0, double(points.size() / 3) - 1))
                    source_.broken_here(fmt::format("a face naming point {} of {}, counted from 0,", index,
                                                    points.size() / 3));
                draft_.corners.push_back(Index(double(start.positions) + index));
                ++size;
            } else if (size > 0) {
                draft_.sizes.push_back(std::exchange(size, 0));
            }
        }
        if (!ccw) turn_over(start);
    }

    void read_group(std::string_view type) {
        Placement placement;
        const Mark start = mark();
        std::vector<Mark> ends;  // of each child
        double choice = type == "LOD" ? 0 : -1;
        read_fields([&](std::string_view field) {
            if (field == "children" || field == "choice" || field == "level") {
                const bool list = take("[");
                while (list ? !take("]") : ends.empty()) node(), ends.push_back(mark());
            } else if (field == "center") {
                placement.center = vector();
            } else if (field == "rotation") {
                placement.rotation = just<4>();
            } else if (field == "scale") {
                placement.scale = vector();
            } else if (field == "scaleOrientation") {
                placement.scale_orientation = just<4>();
            } else if (field == "translation") {
                placement.translation = vector();
            } else if (field == "whichChoice") {
                choice = just<1>()[0];
            } else {
                return false;
            }
            return true;
        });
        if (type == "Transform") place(start, placement);
        if (type != "Switch" && type != "LOD") return;
        const bool any = is_whole(choice, 0, double(ends.size()) - 1);
        const auto chosen = any ? std::size_t(choice) : 0;
        keep(any && chosen > 0 ? ends[chosen - 1] : start, any ? ends[chosen] : start, start);
    }

    // --- what has been read ---

    Mark mark() const { return {draft_.positions.size(), draft_.corners.size(), draft_.sizes.size()}; }

    // Of all that came after `start` only what lies between two marks.
    void keep(Mark from, Mark to, Mark start) {
        auto cut = [](auto& list, std::size_t a, std::size_t b, std::size_t first) {
            list.resize(b);
            list.erase(list.begin() + std::ptrdiff_t(first), list.begin() + std::ptrdiff_t(a));
        };
        cut(draft_.positions, from.positions, to.positions, start.positions);
        cut(draft_.corners, from.corners, to.corners, start.corners);
        cut(draft_.sizes, from.sizes, to.sizes, start.sizes);
        for (std::size_t i = start.corners; i < draft_.corners.size(); ++i)
            draft_.corners[i] -= Index(from.positions - start.positions);
    }

    void turn_over(Mark start) {
        auto corner = draft_.corners.begin() + std::ptrdiff_t(start.corners);
        for (std::size_t face = start.sizes; face < draft_.sizes.size(); ++face) {
            std::reverse(corner, corner + draft_.sizes[face]);
            corner += draft_.sizes[face];
        }
    }

    // Scaled along turned axes, turned, both about the centre, and moved.
    void place(Mark start, const Placement& by) {
        const dmat3 along = turn(by.scale_orientation);
        const dmat3 scale(by.scale.x, 0, 0, 0, by.scale.y, 0, 0, 0, by.scale.z);
        const dmat3 all = turn(by.rotation) * along * scale * glm::transpose(along);
        for (std::size_t i = start.positions; i < draft_.positions.size(); ++i)
            draft_.positions[i] = by.translation + by.center + all * (draft_.positions[i] - by.center);
        if (glm::determinant(all) < 0) turn_over(start);
    }

    Source source_;
    std::size_t may_repeat_;
    int depth_ = 0;
    Draft draft_;
    Numbers points_;                                                          // of the last Coordinate
    std::map<std::string_view, std::map<std::size_t, std::size_t>> defined_;  // where nodes end and begin
    std::set<std::string_view> others_;  // kinds of surfaces that are left out
};

}  // namespace

Draft read_vrml(Source source) { return Vrml(std::move(source)).read(); }

}  // namespace palpate
