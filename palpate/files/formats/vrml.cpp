// VRML 2, and X3D in its syntax, as far as surfaces are concerned: face sets, triangle sets and primitive
// shapes, in Shapes, in grouping and transform nodes. Everything else is skipped. No tree is kept: faces go
// straight into the draft, in the node's own coordinates, and a Transform then moves what its children have
// added. DEF stores the position of a node in the text, and USE parses it there again.
#include "palpate/files/formats/formats.h"
#include "palpate/files/formats/solids.h"
#include "palpate/files/formats/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

namespace palpate {
namespace {

constexpr int most_nested = 200;

// How much text may be read again because of USE: enough for a forest, too little for a bomb.
constexpr std::size_t repeated_bytes = std::size_t(16) << 20, repeated_times = 16;

// How many solids, of which a round one takes 20 kB: enough for a molecule.
constexpr std::size_t solids = 10'000, bytes_a_solid = 400;

using Numbers = std::vector<double>;

using Rotation = std::array<double, 4>;  // an axis and an angle

// The fields of a Transform, with their defaults.
struct Placement {
    dvec3 center{0}, scale{1}, translation{0};
    Rotation rotation{0, 0, 1, 0}, scale_orientation{0, 0, 1, 0};
};

constexpr std::string_view groups[] = {
    "Group",         "Anchor",       "Billboard",   "Collision",   "Switch",        "LOD",   "StaticGroup",
    "PickableGroup", "HAnimSegment", "CADLayer",    "CADAssembly", "CADFace",       "Layer", "LayerSet",
    "LayoutLayer",   "LayoutGroup",  "ScreenGroup", "Viewport",    "ViewpointGroup"};
constexpr std::string_view transforms[] = {"Transform", "HAnimHumanoid", "HAnimJoint",
                                           "HAnimSite", "CADPart",       "EspduTransform"};
constexpr std::string_view child_fields[] = {"children", "choice", "level",    "shape",
                                             "layers",   "skin",   "skeleton", "viewport"};
constexpr std::string_view face_sets[] = {
    "IndexedFaceSet",        "IndexedTriangleSet", "IndexedTriangleStripSet",
    "IndexedTriangleFanSet", "IndexedQuadSet",     "TriangleSet",
    "TriangleStripSet",      "TriangleFanSet",     "QuadSet"};

bool is_in(std::span<const std::string_view> names, std::string_view name) {
    return std::ranges::count(names, name) > 0;
}

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();  // a missing texture coordinate

// Splits runs of corners, each ended by -1, into the faces of a set: triangles or quads.
Numbers as_faces(std::string_view set, const Numbers& runs) {
    const bool strip = set.ends_with("StripSet"), fan = set.ends_with("FanSet");
    const std::size_t each = set.ends_with("QuadSet") ? 4 : 3;
    Numbers faces;
    for (std::size_t start = 0, end; start < runs.size(); start = end + 1) {
        end = std::size_t(std::find(runs.begin() + std::ptrdiff_t(start), runs.end(), -1) - runs.begin());
        const double* const run = runs.data() + start;
        const std::size_t length = end - start;
        if (strip || fan) {
            for (std::size_t i = 0; i + 2 < length; ++i) {
                const std::size_t a = fan ? 0 : i + i % 2, b = fan ? i + 1 : i + 1 - i % 2;
                if (run[a] != run[b] && run[b] != run[i + 2] && run[i + 2] != run[a])
                    faces.insert(faces.end(), {run[a], run[b], run[i + 2], -1});
            }
        } else {
            for (std::size_t i = 0; i + each <= length; i += each) {
                faces.insert(faces.end(), run + i, run + i + each);
                faces.push_back(-1);
            }
        }
    }
    return faces;
}

// The size of the draft at some point.
struct Mark {
    std::size_t positions, corners, sizes;
};

class Vrml {
 public:
    explicit Vrml(Source source)
        : source_(std::move(source)),
          may_repeat_(repeated_bytes + repeated_times * source_.whole().size()),
          may_build_(solids + source_.whole().size() / bytes_a_solid) {}

    Draft read(bool has_header) {
        source_.skip_mark();
        if (has_header) read_header();
        while (!ahead().empty())
            if (!skip_statement(ahead())) node();
        note_others();
        note_textures();
        return std::move(draft_);
    }

 private:
    void read_header() {
        if (source_.rest.starts_with("#VRML V1.0")) source_.broken("VRML 1.0", "convert it to VRML 2 (97)");
        if (!source_.rest.starts_with("#VRML V2.0") && !source_.rest.starts_with("#X3D V"))
            source_.broken("no VRML 2 header");
    }

    void note_others() {
        std::vector<std::string> left_out;
        if (!others_.empty())
            left_out.push_back(fmt::format("shapes that are not read: {}", fmt::join(others_, " ")));
        for (const auto& [node, faces] : under_)
            left_out.push_back(fmt::format("{} faces under {}, a node that is not read", faces, node));
        if (hidden_ > 0) left_out.push_back(fmt::format("{} faces that are not visible", hidden_));
        if (draft_.sizes.empty() && !left_out.empty())
            source_.broken("no faces, only " + left_out[0], "convert it to triangles");
        for (const std::string& what : left_out) draft_.notes.push_back("left out " + what);
    }

    // Texture coordinates are kept if all parts have them.
    void note_textures() {
        if (astray_ > 0)
            draft_.notes.push_back(
                fmt::format("left the texture coordinates out: {} corners refer to missing ones", astray_));
        const auto missing = [](dvec2 uv) { return std::isnan(uv.x); };
        const auto without = std::ranges::count_if(draft_.uvs, missing);
        if (astray_ == 0 && without > 0 && without < std::ssize(draft_.uvs))
            draft_.notes.push_back("left the texture coordinates out: some parts have none");
        if (astray_ > 0 || without > 0) draft_.uvs.clear();
    }

    // --- words ---

    // The next word, without consuming it: a bracket, a string in quotes, or everything up to a space or one
    // of those.
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
        return word == "TRUE" || word == "FALSE" || word == "true" || word == "false" || word == "NULL" ||
               (!word.empty() && std::string_view("0123456789+-.\"").find(word[0]) != std::string_view::npos);
    }

    // All numbers of a list, or a few without brackets.
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

    Rotation rotation() {
        Rotation by = just<4>();
        by[3] *= angle_;
        return by;
    }

    static dmat3 turn(const Rotation& by) { return rotation_about({by[0], by[1], by[2]}, by[3]); }

    bool truth() {
        const std::string_view word = next();
        return word != "FALSE" && word != "false";
    }

    // One, or one for each of several.
    std::vector<bool> truths() {
        if (!take("[")) return {truth()};
        std::vector<bool> found;
        while (!take("]")) found.push_back(truth());
        return found;
    }

    dvec3 vector() {
        const auto [x, y, z] = just<3>();
        return {x, y, z};
    }

    // Skips the value of an unknown field. Its nodes are read, because they may have names, and then removed.
    // Returns how many faces they had.
    std::size_t skip_value() {
        const Mark before = mark();
        if (take("["))
            while (!take("]")) skip_one();
        else if (is_plain(ahead()))
            while (is_plain(ahead())) next();
        else if (begins_node())
            skip_one();
        return remove(before, mark());
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

    // A ROUTE (node.event TO node.event) does not affect a surface; a PROTO could do anything.
    bool skip_statement(std::string_view word) {
        if (word == "PROTO" || word == "EXTERNPROTO")
            source_.broken("a PROTO, a user-defined node,", "convert it with another program");
        if (word == "UNIT") {
            next();
            read_unit();
            return true;
        }
        constexpr std::pair<std::string_view, int> statements[] = {
            {"ROUTE", 4}, {"PROFILE", 2}, {"COMPONENT", 2}, {"META", 3}, {"IMPORT", 4}, {"EXPORT", 4}};
        const auto found = std::ranges::find(statements, word, &std::pair<std::string_view, int>::first);
        if (found == std::end(statements)) return false;
        if (word == "IMPORT" || word == "EXPORT")
            source_.line();
        else
            for (int k = 0; k < found->second; ++k) next();
        return true;
    }

    // category name factor
    void read_unit() {
        const std::string_view category = next();
        next();
        const double factor = source_.number(next());
        if (!(factor > 0) || std::isinf(factor)) source_.broken_here("a unit that is not above zero");
        if (category == "length") draft_.unit = factor;
        if (category == "angle") angle_ = factor;
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

    // USE: reads again the last node of this name that ended before.
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
        const bool is_geometry = std::exchange(in_geometry_, false);
        if (type == "Inline") source_.broken("an Inline, a part in another file,", "export it as one file");
        if (is_in(face_sets, type)) return read_faces(type);
        if (type == "Box" || type == "Sphere" || type == "Cylinder" || type == "Cone")
            return read_solid(type);
        if (type == "ElevationGrid") return read_elevation_grid();
        if (type == "Extrusion") return read_extrusion();
        if (is_in(groups, type) || is_in(transforms, type)) return read_group(type);
        if (is_geometry) others_.insert(type);
        if (type == "GeoCoordinate")
            source_.broken("a GeoCoordinate, which is not read,", "convert it to a Coordinate");
        const bool is_texture = type == "TextureCoordinate";
        const Mark start = mark();
        std::vector<bool> visible;
        read_fields([&](std::string_view field) {
            if (type == "Shape" && field == "geometry")
                in_geometry_ = true, node(), in_geometry_ = false;
            else if (field == "point" && (is_texture || type == "Coordinate" || type == "CoordinateDouble"))
                (is_texture ? uvs_ : points_) = numbers();
            else if (type == "Shape" && field == "visible")
                visible = truths();
            else if (const std::size_t faces = skip_value(); faces > 0)
                under_[type] += faces;
            return true;
        });
        if (visible == std::vector{false}) hidden_ += remove(start, mark());
    }

    // known(field) reads a field and returns true, or returns false if it does not know it.
    template <class F>
    void read_fields(F known) {
        for (std::string_view field = ahead(); !take("}"); field = ahead()) {
            if (skip_statement(field)) continue;
            if (std::string_view("{[]").find(next()[0]) != std::string_view::npos)
                source_.broken_here(in_quotes(field) + " where a field's name should be");
            if (!known(field)) skip_value();
        }
    }

    void read_faces(std::string_view type) {
        Numbers points, uvs, indices, uv_indices, counts;
        bool ccw = true;
        read_fields([&](std::string_view field) {
            if (field == "coord")
                points_.clear(), node(), points = std::move(points_);
            else if (field == "texCoord")
                uvs_.clear(), node(), uvs = std::move(uvs_);
            else if (field == "coordIndex" || field == "index")
                indices = numbers();
            else if (field == "texCoordIndex")
                uv_indices = numbers();
            else if (field == "stripCount" || field == "fanCount")
                counts = numbers();
            else if (field == "ccw")
                ccw = truth();
            else
                return false;
            return true;
        });
        if (points.size() % 3 != 0) source_.broken_here("a point of less than three numbers");
        if (!type.starts_with("Indexed")) indices = in_order(points.size() / 3, counts);
        if (type != "IndexedFaceSet") indices = as_faces(type, indices), uv_indices.clear();
        const Mark start = mark();
        add_faces(points, indices, uvs, uv_indices);
        if (!ccw) turn_over(start);
    }

    // The indices of all points in order, in runs of these lengths.
    Numbers in_order(std::size_t points, const Numbers& counts) const {
        Numbers runs;
        std::size_t run = 0, left = counts.empty() ? points : 0;
        for (std::size_t i = 0; i < points; ++i, --left) {
            for (; left == 0; ++run) {
                if (run == counts.size()) return runs;
                if (!is_whole(counts[run], 0, double(points)))
                    source_.broken_here(fmt::format("a strip of {} points", counts[run]));
                left = std::size_t(counts[run]);
                if (!runs.empty()) runs.push_back(-1);
            }
            runs.push_back(double(i));
        }
        return runs;
    }

    // `uv_indices` are parallel to `indices`; without them each point has one texture coordinate.
    void add_faces(const Numbers& points, Numbers indices, const Numbers& uvs, const Numbers& uv_indices) {
        const std::size_t count = points.size() / 3, first = draft_.positions.size();
        const bool by_corner = !uvs.empty() && !uv_indices.empty();
        if (first + std::max(count, by_corner ? indices.size() : 0) > ~Index(0))
            source_.broken("more than 2^32 points");
        const auto point = [&](std::size_t i) {
            return dvec3(points[3 * i], points[3 * i + 1], points[3 * i + 2]);
        };
        const auto uv = [&](double i) {
            if (is_whole(i, 0, double(uvs.size() / 2) - 1))
                return dvec2(uvs[2 * std::size_t(i)], uvs[2 * std::size_t(i) + 1]);
            if (!uvs.empty()) ++astray_;
            return dvec2(nothing);
        };
        if (!by_corner)
            for (std::size_t i = 0; i < count; ++i)
                draft_.positions.push_back(point(i)), draft_.uvs.push_back(uv(double(i)));
        std::map<std::pair<double, double>, Index> known;  // by point and texture coordinate
        indices.push_back(-1);  // which ends a face, and may be left out after the last
        Index size = 0;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const double index = indices[i];
            if (index == -1) {
                if (size > 0) draft_.sizes.push_back(std::exchange(size, 0));
                continue;
            }
            if (!is_whole(index, 0, double(count) - 1))
                source_.broken_here(
                    fmt::format("a face naming point {} of {}, counted from 0,", index, count));
            Index vertex = Index(double(first) + index);
            if (by_corner) {
                const double uv_index = i < uv_indices.size() && uv_indices[i] >= 0 ? uv_indices[i] : -1;
                const auto [at, is_new] =
                    known.try_emplace({index, uv_index}, Index(draft_.positions.size()));
                if (is_new)
                    draft_.positions.push_back(point(std::size_t(index))), draft_.uvs.push_back(uv(uv_index));
                vertex = at->second;
            }
            draft_.corners.push_back(vertex);
            ++size;
        }
    }

    void read_solid(std::string_view type) {
        dvec3 size(2);
        double radius = 1;
        Turned turned;
        if (type == "Cone") turned.top_radius = 0;
        read_fields([&](std::string_view field) {
            if (field == "size")
                size = vector();
            else if (field == "radius" || field == "bottomRadius")
                radius = just<1>()[0];
            else if (field == "height")
                turned.height = just<1>()[0];
            else if (field == "side")
                turned.side = truth();
            else if (field == "bottom")
                turned.bottom = truth();
            else if (field == "top")
                turned.top = truth();
            else
                return false;
            return true;
        });
        build(1);
        turned.bottom_radius = radius;
        if (type == "Cylinder") turned.top_radius = radius;
        if (type == "Box")
            add_box(draft_, size);
        else if (type == "Sphere")
            add_sphere(draft_, radius);
        else
            add_turned(draft_, turned);
        draft_.uvs.resize(draft_.positions.size(), dvec2(nothing));
    }

    // Limits the number of solids, which are far larger than their text.
    void build(std::size_t solids) {
        if (solids > may_build_) source_.broken("too many solids", "convert it to triangles");
        may_build_ -= solids;
    }

    // The numbers of a field, as vectors of N.
    template <class T>
    std::vector<T> vectors() {
        const Numbers found = numbers();
        constexpr std::size_t each = sizeof(T) / sizeof(double);
        std::vector<T> list(found.size() / each);
        for (std::size_t i = 0; i < list.size(); ++i)
            for (std::size_t k = 0; k < each; ++k) list[i][int(k)] = found[i * each + k];
        return list;
    }

    void read_extrusion() {
        Extruded shape{.section = {{1, 1}, {1, -1}, {-1, -1}, {-1, 1}, {1, 1}},
                       .scales = {},
                       .spine = {{0, 0, 0}, {0, 1, 0}},
                       .turns = {}};
        bool ccw = true;
        read_fields([&](std::string_view field) {
            if (field == "crossSection")
                shape.section = vectors<dvec2>();
            else if (field == "scale")
                shape.scales = vectors<dvec2>();
            else if (field == "spine")
                shape.spine = vectors<dvec3>();
            else if (field == "orientation")
                for (shape.turns.clear(); glm::dvec4 r : vectors<glm::dvec4>())
                    shape.turns.push_back(turn({r.x, r.y, r.z, angle_ * r.w}));
            else if (field == "beginCap")
                shape.begin_cap = truth();
            else if (field == "endCap")
                shape.end_cap = truth();
            else if (field == "ccw")
                ccw = truth();
            else
                return false;
            return true;
        });
        build(1 + shape.section.size() * shape.spine.size() / 500);
        const Mark start = mark();
        add_extrusion(draft_, shape);
        draft_.uvs.resize(draft_.positions.size(), dvec2(nothing));
        if (!ccw) turn_over(start);
    }

    void read_elevation_grid() {
        Numbers heights;
        double columns = 0, rows = 0, x_spacing = 1, z_spacing = 1;
        bool ccw = true;
        read_fields([&](std::string_view field) {
            if (field == "height")
                heights = numbers();
            else if (field == "xDimension")
                columns = just<1>()[0];
            else if (field == "zDimension")
                rows = just<1>()[0];
            else if (field == "xSpacing")
                x_spacing = just<1>()[0];
            else if (field == "zSpacing")
                z_spacing = just<1>()[0];
            else if (field == "ccw")
                ccw = truth();
            else
                return false;
            return true;
        });
        const double most = double(heights.size());
        if (!is_whole(columns, 0, most) || !is_whole(rows, 0, most) || columns * rows != most)
            source_.broken_here(fmt::format("a grid of {} x {} with {} heights", columns, rows, most));
        const Mark start = mark();
        add_elevation_grid(draft_, heights, std::size_t(columns), x_spacing, z_spacing);
        draft_.uvs.resize(draft_.positions.size(), dvec2(nothing));
        if (!ccw) turn_over(start);
    }

    void read_group(std::string_view type) {
        Placement placement;
        const Mark start = mark();
        std::vector<Mark> ends;  // of each child
        double choice = type == "LOD" ? 0 : -1;
        std::vector<bool> visible;  // of a CADLayer for each child, else one for all
        read_fields([&](std::string_view field) {
            if (is_in(child_fields, field)) {
                const auto child = [&] { node(), ends.push_back(mark()); };
                if (take("["))
                    while (!take("]")) child();
                else
                    child();
            } else if (field == "center") {
                placement.center = vector();
            } else if (field == "rotation") {
                placement.rotation = rotation();
            } else if (field == "scale") {
                placement.scale = vector();
            } else if (field == "scaleOrientation") {
                placement.scale_orientation = rotation();
            } else if (field == "translation") {
                placement.translation = vector();
            } else if (field == "whichChoice") {
                choice = just<1>()[0];
            } else if (field == "visible") {
                visible = truths();
            } else {
                return false;
            }
            return true;
        });
        if (is_in(transforms, type)) place(start, placement);
        if (type == "CADLayer")
            for (std::size_t i = std::min(visible.size(), ends.size()); i-- > 0;)
                hidden_ += visible[i] ? 0 : remove(i > 0 ? ends[i - 1] : start, ends[i]);
        else if (visible == std::vector{false})
            hidden_ += remove(start, mark());
        if ((type != "Switch" && type != "LOD") || visible == std::vector{false}) return;
        const bool any = is_whole(choice, 0, double(ends.size()) - 1);
        const auto chosen = any ? std::size_t(choice) : 0;
        remove(any ? ends[chosen] : start, mark());
        if (chosen > 0) remove(start, ends[chosen - 1]);
    }

    // --- the draft so far ---

    Mark mark() const { return {draft_.positions.size(), draft_.corners.size(), draft_.sizes.size()}; }

    // Removes what lies between two marks. Returns the number of faces.
    std::size_t remove(Mark from, Mark to) {
        auto cut = [](auto& list, std::size_t a, std::size_t b) {
            list.erase(list.begin() + std::ptrdiff_t(a), list.begin() + std::ptrdiff_t(b));
        };
        cut(draft_.positions, from.positions, to.positions);
        cut(draft_.uvs, from.positions, to.positions);  // one for each position
        cut(draft_.corners, from.corners, to.corners);
        cut(draft_.sizes, from.sizes, to.sizes);
        for (std::size_t i = from.corners; i < draft_.corners.size(); ++i)
            draft_.corners[i] -= Index(to.positions - from.positions);
        return to.sizes - from.sizes;
    }

    void turn_over(Mark start) {
        auto corner = draft_.corners.begin() + std::ptrdiff_t(start.corners);
        for (std::size_t face = start.sizes; face < draft_.sizes.size(); ++face) {
            std::reverse(corner, corner + draft_.sizes[face]);
            corner += draft_.sizes[face];
        }
    }

    // Scales along rotated axes and rotates, both about the centre, then translates.
    void place(Mark start, const Placement& by) {
        const dmat3 along = turn(by.scale_orientation);
        const Transform all{turn(by.rotation) * along * scaling_by(by.scale) * glm::transpose(along),
                            by.translation + by.center};
        for (std::size_t i = start.positions; i < draft_.positions.size(); ++i)
            draft_.positions[i] = all.of(draft_.positions[i] - by.center);
        if (all.mirrors()) turn_over(start);
    }

    Source source_;
    std::size_t may_repeat_, may_build_;
    int depth_ = 0;
    Draft draft_;
    double angle_ = 1;          // rad, the unit of angles
    bool in_geometry_ = false;  // of a Shape
    std::size_t astray_ = 0;    // corners that refer to missing texture coordinates
    Numbers points_, uvs_;      // of the last Coordinates
    std::map<std::string_view, std::map<std::size_t, std::size_t>> defined_;  // where nodes end and begin
    std::set<std::string_view> others_;              // kinds of shapes that are left out
    std::map<std::string_view, std::size_t> under_;  // faces that are left out, by the node that has them
    std::size_t hidden_ = 0;                         // faces that are left out because they are not visible
};

}  // namespace

Draft read_vrml(Source source) { return Vrml(std::move(source)).read(true); }

Draft read_vrml_nodes(Source source) { return Vrml(std::move(source)).read(false); }

}  // namespace palpate
