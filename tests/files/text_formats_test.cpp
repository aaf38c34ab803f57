// What is legal but rare, and what is not legal at all, in OBJ, PLY, STL and OFF.
#include "palpate/files/read.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <numbers>
#include <random>

namespace palpate {
namespace {

Mesh parse(const std::string& name, std::string_view bytes, std::vector<std::string>* notes = nullptr) {
    return parse_mesh(bytes, name, Units::metres, notes);
}

std::string bytes_of(auto value, bool swapped = false) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (swapped) std::reverse(raw, raw + sizeof value);
    return {raw, sizeof value};
}

// The text of one polygon, in each of the formats that have such.
struct Spelling {
    std::string name, text;
};

std::vector<Spelling> spellings(const std::vector<std::string>& points) {
    const std::size_t n = points.size();
    std::string obj, off = fmt::format("OFF\n{} 1 0\n", n), face = std::to_string(n), obj_face = "f";
    std::string ply = fmt::format(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list int int vertex_indices\nend_header\n",
        n);
    std::string stl = "solid\nfacet normal 0 0 1\nouter loop\n";
    std::string wrl = "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [";
    std::string wrl_face;
    for (std::size_t i = 0; i < n; ++i) {
        obj += "v " + points[i] + '\n';
        off += points[i] + '\n';
        ply += points[i] + '\n';
        stl += "vertex " + points[i] + '\n';
        wrl += points[i] + ' ';
        face += fmt::format(" {}", i);
        obj_face += fmt::format(" {}", i + 1);
        wrl_face += fmt::format(" {}", i);
    }
    stl += "endloop\nendfacet\nendsolid\n";
    wrl += "] } coordIndex [" + wrl_face + "] } }\n";
    return {{"a.obj", obj + obj_face + '\n'},
            {"a.off", off + face + '\n'},
            {"a.ply", ply + face + '\n'},
            {"a.stl", stl},
            {"a.wrl", wrl}};
}

TEST(TextFormats, PolygonsAreCutRightly) {
    // An L, in a plane across the axes.
    for (const auto& [name, text] : spellings({"0 0 0", "2 0 2", "2 1 2", "1 1 1", "1 2 1", "0 2 0"})) {
        const Mesh mesh = parse(name, text);
        ASSERT_EQ(mesh.triangles.size(), 4u) << name;
        EXPECT_LE(std::abs(area(mesh) - 3 * std::sqrt(2.0)), 1e-6) << name;
        for (uvec3 t : mesh.triangles) {
            const vec3 a = mesh.positions[t.x];
            EXPECT_GE(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a).z, 0) << name;
        }
    }
}

TEST(TextFormats, TwoHundredThousandCorners) {
    const int n = 200'000;
    std::vector<std::string> points;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n, r = i % 2 == 0 ? 1 : 0.5;
        points.push_back(fmt::format("{:.9f} {:.9f} 0", r * std::cos(angle), r * std::sin(angle)));
    }
    for (const auto& [name, text] : spellings(points)) {
        const Mesh mesh = parse(name, text);
        EXPECT_EQ(mesh.triangles.size(), std::size_t(n - 2)) << name;
        EXPECT_LE(std::abs(area(mesh) - std::numbers::pi / 2), 1e-4) << name;
    }
}

TEST(TextFormats, NumbersThatAreNone) {
    for (const char* bad : {"nan", "inf", "-inf", "1e39", "-1e400"})
        for (const auto& [name, text] : spellings({"0 0 0", std::string("1 0 ") + bad, "0 1 0"}))
            EXPECT_HAS(parse_error(name, text), "vertex 2 of 3 not finite") << name;
    for (const char* bad : {"x", "0x", "1..2", "--1", "\xff"})
        for (const auto& [name, text] : spellings({"0 0 0", std::string("1 0 ") + bad, "0 1 0"}))
            if (name != "a.wrl" || *bad != 'x') EXPECT_NE(parse_error(name, text), "") << name << bad;
    for (const auto& [name, text] : spellings({"0 0 0", "1,5 0 0", "0 1 0"}))
        if (name != "a.wrl") {  // where a comma is a space
            EXPECT_HAS(parse_error(name, text), "a decimal comma, \"1,5\",") << name;
            EXPECT_HAS(parse_error(name, text), "decimal points") << name;
        }
}

TEST(TextFormats, EverySizeLoads) {
    for (const char* size : {"1e30", "3e38", "1e-20", "1e-44"})
        for (const auto& [name, text] :
             spellings({"0 0 0", std::string(size) + " 0 0", std::string("0 ") + size + " 0"})) {
            const Mesh mesh = parse(name, text);
            EXPECT_EQ(mesh.positions[1], vec3(std::strtof(size, nullptr), 0, 0)) << name;
        }
}

// A millimetre at a thousand kilometres: floats there are 6 cm apart.
TEST(TextFormats, WhatIsFarAwayIsMovedToTheOrigin) {
    for (const auto& [name, text] :
         spellings({"1000000 2000000.0005 0", "1000000.001 2000000.0005 0", "1000000 2000000.0015 0"})) {
        std::vector<std::string> notes;
        const Mesh mesh = parse(name, text, &notes);
        ASSERT_EQ(notes.size(), 1u) << name;
        EXPECT_HAS(notes[0], "moved to the origin by (-1000000.0005, -2000000.001, 0) m") << name;
        EXPECT_LE(glm::length(mesh.positions[1] - mesh.positions[0] - vec3(1e-3f, 0, 0)), 1e-9f) << name;
        EXPECT_LE(glm::length(mesh.positions[2] - mesh.positions[0] - vec3(0, 1e-3f, 0)), 1e-9f) << name;
        EXPECT_LE(glm::length(bounds(mesh).centre()), 1e-9f) << name;
        parse(name, text);  // notes need not be wanted
    }
    // Near enough for floats: left where it is.
    for (const auto& [name, text] : spellings({"1000 0 0", "1001 0 0", "1000 1 0"})) {
        std::vector<std::string> notes;
        EXPECT_EQ(parse(name, text, &notes).positions[1], vec3(1001, 0, 0)) << name;
        EXPECT_TRUE(notes.empty()) << name;
    }
}

// ---- OBJ ----

TEST(Obj, RareButLegal) {
    const std::string rare =
        "\xef\xbb\xbf# rare\r\nv 0 0 0 1 0.5 0\r\n\tv\t1 0 0\r\nv 1 \\\r\n  1 0\r\nv 0 1 0 # a corner\r\n"
        "vt 0 0\r\nf 1/1 2/1 \\\r\n3/1\\\r\n 4/1 # a quad\r\nf -4 -3 -2\r\nl 1 2\r\np 1\r\n";
    const Mesh mesh = parse("a.obj", rare);
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}, {0, 1, 2}}));
    // A comment does not go on, whatever it ends with.
    EXPECT_EQ(parse("a.obj", "# in C:\\models\\\nv 0 0 0 # \\\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").triangles.size(),
              1u);
    // Faces before their vertices, and the line ends of an old Macintosh.
    EXPECT_EQ(parse("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0").triangles.size(), 1u);
    EXPECT_EQ(parse("a.obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r").triangles.size(), 1u);
    EXPECT_HAS(parse_error("a.obj", std::string("\xff\xfev\0 \0", 6)), "UTF-16");
}

// The corners and faces of a box of 2 x 3 x 5, as texts.
const Mesh brick = box(vec3(0), vec3(2, 3, 5));

std::string rows_of(const std::vector<vec3>& points, std::string_view before = "",
                    std::string_view behind = "\n") {
    std::string text;
    for (vec3 p : points) text += fmt::format("{}{} {} {}{}", before, p.x, p.y, p.z, behind);
    return text;
}

std::string rows_of(const std::vector<uvec3>& faces, unsigned first, std::string_view before,
                    std::string_view behind = "\n") {
    std::string text;
    for (uvec3 t : faces)
        text += fmt::format("{} {} {} {}{}", before, t.x + first, t.y + first, t.z + first, behind);
    return text;
}

std::string old_macintosh(std::string text) {
    std::replace(text.begin(), text.end(), '\n', '\r');
    return text;
}

// That it is read as the brick, with one note, or without one.
void expect_brick(const std::string& name, const std::string& text, const std::string& note = "") {
    std::vector<std::string> notes;
    const Mesh mesh = parse(name, text, &notes);
    EXPECT_EQ(mesh.triangles.size(), 12u) << text;
    EXPECT_EQ(bounds(mesh).low, vec3(0)) << text;
    EXPECT_EQ(bounds(mesh).high, vec3(2, 3, 5)) << text;
    EXPECT_LE(std::abs(volume(mesh) - 30), 1e-4) << text;
    ASSERT_EQ(notes.size(), note.empty() ? 0u : 1u) << text;
    if (!note.empty()) EXPECT_HAS(notes[0], note);
}

TEST(Obj, WhatBearsOnNoShapeCostsNone) {
    const std::string points = rows_of(brick.positions, "v "), faces = rows_of(brick.triangles, 1, "f");
    std::string textured, normals;
    for (uvec3 t : brick.triangles) {
        textured += fmt::format("f {0}/{0} {1}/{1} {2}/{2}\n", t.x + 1, t.y + 1, t.z + 1);
        normals += fmt::format("f {}//1 {}//1 {}//2\n", t.x + 1, t.y + 1, t.z + 1);
    }
    expect_brick("a.obj", points + faces + "f 1 2\nl 1 3\n", "left out 2 points and lines");
    expect_brick("a.obj", points + faces + "f 1\np 1 2 3\nf\n", "left out 3 points and lines");
    expect_brick("a.obj", points + textured, "left the texture coordinates out: 36 corners");
    expect_brick("a.obj", points + "vn 0 0 1\n" + normals, "left the normals out: 12 corners");
    expect_brick("a.obj", points + "vn 0 0 1\nvn -1.#IND -1.#IND 1.#QNAN\n" + normals,
                 "left the normals out");
    expect_brick("a.obj", points + "vn 0 0 1\nvn 0 0\n" + normals, "left the normals out");
    expect_brick("a.obj", points + "vn 0 0 1\nvn 0 0 x\n" + normals, "left the normals out");
    expect_brick("a.obj", points + faces + "cstype bspline\nsurf 0 1 0 1 1 2 3 4\nend\n",
                 "left out 1 free-form shape");
    expect_brick("a.obj", points + rows_of(brick.triangles, 1, "fo"));
    expect_brick("a.obj", old_macintosh(points + faces));
    expect_brick("a.obj", rows_of(brick.positions, "v ", " 0.5 0.5 0.5 # red\n") +
                              rows_of(brick.triangles, 1, "f", "# x\n"));
    EXPECT_HAS(parse_error("a.obj", points + "l 1 2\n"), "no faces, only points or lines");
    EXPECT_HAS(parse_error("a.obj", "v 0 0 -1.#IND\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
               "vertex 1 of 3 not finite");
    EXPECT_EQ(parse("a.obj", "v 0 0 0\nv 1.5D+00 0 0\nv 0 1d-1 0\nf 1 2 3\n").positions[1], vec3(1.5f, 0, 0));
}

TEST(Obj, AnyEndOfALine) {
    const std::string points = rows_of(brick.positions, "v "), faces = rows_of(brick.triangles, 1, "f");
    expect_brick("a.obj", old_macintosh(points + faces) + "\n");
    expect_brick("a.obj", old_macintosh(points) + faces);
    EXPECT_HAS(parse_error("a.off", "OFF\r\n3 1 0\r0 0 0\n1 0 0\r\n0 1 0\r\n3 0 1 3\n"), "in line 6");
}

TEST(Obj, WhatOnlySomeCornersHaveIsLeftOutWithANote) {
    const std::string points = rows_of(brick.positions, "v "), faces = rows_of(brick.triangles, 1, "f");
    const std::string start = points + "vt 0 0\nvn 0 0 1\n";
    const std::string some = faces.substr(faces.find('\n') + 1);  // all but the first
    const uvec3 t = brick.triangles[0] + 1u;
    expect_brick("a.obj", start + fmt::format("f {}/1 {}/1 {}/1\n", t.x, t.y, t.z) + some,
                 "left the texture coordinates out: some corners have none");
    expect_brick("a.obj", start + fmt::format("f {}//1 {}//1 {}//1\n", t.x, t.y, t.z) + some,
                 "left the normals out: some corners have none");
}

TEST(Obj, ALastFaceThatIsCutOff) {
    std::vector<std::string> notes;
    const std::string text = rows_of(brick.positions, "v ") + "f 1 3 4 2\nf 5 6 8";
    parse("a.obj", text + "\n", &notes);
    EXPECT_TRUE(notes.empty());
    parse("a.obj", text, &notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "the last line may be truncated");
}

// ---- PLY ----

std::string ply_head(const std::string& more = "", int faces = 12, const char* format = "ascii",
                     const char* index = "int") {
    return fmt::format(
        "ply\nformat {} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n{}"
        "element face {}\nproperty list uchar {} vertex_indices\nend_header\n",
        format, more, faces, index);
}

TEST(Ply, AsStrangersWriteIt) {
    const std::string points = rows_of(brick.positions), faces = rows_of(brick.triangles, 0, "3");
    expect_brick("a.ply", old_macintosh(ply_head() + points + faces));
    expect_brick("a.ply", ply_head("", 14) + points + faces + "2 0 1\n0\n", "left out 2 points and lines");
    expect_brick("a.ply",
                 ply_head() + points + rows_of(brick.triangles, 0, "3", " 6 0 0 1 0 0 1\n"));  // undeclared
    expect_brick("a.ply", ply_head() + rows_of(brick.positions, "", " 255 0 0 255\n") + faces);
    expect_brick("a.ply",
                 ply_head() + rows_of(brick.positions, "", " ") + rows_of(brick.triangles, 0, " 3", ""));
    expect_brick("a.ply", ply_head("property float nx\n") + rows_of(brick.positions, "", " 0\n") + faces,
                 "left the normals out");
    std::string head = ply_head();
    head.replace(head.find("vertex_indices"), 14, "vertex_indexes");
    expect_brick("a.ply", head + points + faces);
    for (const char* format : {"binary_little_endian", "binary_big_endian"})
        for (const char* index : {"int64", "uint64", "uint8", "int"}) {
            const bool swapped = format[7] == 'b';
            std::string bytes = old_macintosh(ply_head("", 12, format, index));
            for (vec3 p : brick.positions)
                for (int k = 0; k < 3; ++k) bytes += bytes_of(p[k], swapped);
            for (uvec3 t : brick.triangles) {
                bytes += '\3';
                for (int k = 0; k < 3; ++k)
                    bytes += std::string_view(index).ends_with("64") ? bytes_of(std::int64_t(t[k]), swapped)
                             : *index == 'u'                         ? std::string(1, char(t[k]))
                                                                     : bytes_of(int(t[k]), swapped);
            }
            expect_brick("a.ply", bytes);
        }
}

TEST(Ply, TextureCoordinatesOfCornersAreLeftOutWithANote) {
    std::string head = ply_head();
    head.replace(head.find("end_header"), 0, "property list uchar float texcoord\n");
    expect_brick("a.ply",
                 head + rows_of(brick.positions) + rows_of(brick.triangles, 0, "3", " 6 0 0 1 0 0 1\n"),
                 "left the texture coordinates out, which the corners of faces have");
}

TEST(Ply, StripsOfTriangles) {
    const std::string text =
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n1 2 0\n10 0 1 2 3 -1 2 3 3 4 5\n";
    EXPECT_EQ(parse("a.ply", text).triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 3}, {3, 4, 5}}));
}

TEST(Ply, BigEndianDoublesAmidOthers) {
    std::string bytes =
        "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty uchar red\r\n"
        "property float64 x\r\nproperty list uchar short tags\r\nproperty double y\r\nproperty double z\r\n"
        "element edge 1\r\nproperty int a\r\nelement face 1\r\nproperty list ushort float weights\r\n"
        "property list uint8 uint16 vertex_index\r\nproperty double area\r\nend_header\r\n";
    for (int i = 0; i < 3; ++i) {
        bytes += char(7);
        bytes += bytes_of(1e-3 * i + 1e6, true);
        bytes += char(i);
        for (int k = 0; k < i; ++k) bytes += bytes_of(std::int16_t(-1), true);
        bytes += bytes_of(1e-3 * i * i, true) + bytes_of(0.0, true);
    }
    bytes += bytes_of(5, true) + bytes_of(std::uint16_t(1), true) + bytes_of(0.5f, true) + char(3);
    for (int i : {2, 1, 0}) bytes += bytes_of(std::uint16_t(i), true);
    const std::string whole = bytes + bytes_of(0.5, true);
    std::vector<std::string> notes;
    const Mesh mesh = parse("a.ply", whole, &notes);
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{2, 1, 0}}));
    EXPECT_EQ(notes.size(), 1u) << "it lies far away";
    EXPECT_LE(glm::length(mesh.positions[2] - mesh.positions[1] - vec3(1e-3f, 3e-3f, 0)), 1e-9f);
    EXPECT_HAS(parse_error("a.ply", bytes), "face 1 of 1 promised");
}

TEST(Ply, RefusesWhatItCannotTakeRightly) {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    EXPECT_HAS(parse_error("a.ply", head + "element range_grid 1\nproperty list int int vertex_indices\n"
                                           "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
               "grid of ranges");
    EXPECT_HAS(parse_error("a.ply", head + "end_header\n0 0 0\n1 0 0\n0 1 0\n"), "no faces");
    // Floats have lost the shape of what lies so far away before we see them.
    Mesh mesh = box(vec3(1e6f), vec3(1e6f + 1));
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
        "property float z\nelement face 12\nproperty list uchar int vertex_indices\nend_header\n";
    for (vec3 p : mesh.positions) bytes += bytes_of(p);
    for (uvec3 t : mesh.triangles) bytes += char(3) + bytes_of(t);
    EXPECT_HAS(parse_error("a.ply", bytes), "move it to the origin first");
}

TEST(Ply, NormalsThatAreNotFiniteAreLeftOut) {
    std::vector<std::string> notes;
    const Mesh mesh = parse("a.ply",
                            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nproperty float nx\nproperty float ny\nproperty float nz\n"
                            "element face 1\nproperty list int int vertex_indices\nend_header\n"
                            "0 0 0 0 0 1\n1 0 0 nan nan nan\n0 1 0 0 0 1\n3 0 1 2\n",
                            &notes);
    EXPECT_TRUE(mesh.normals.empty());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "normals");
}

// ---- STL ----

std::string stl_of(const Mesh& mesh, const std::string& header, std::uint32_t count) {
    std::string bytes = header;
    bytes.resize(80);
    bytes += bytes_of(count);
    for (uvec3 t : mesh.triangles) {
        bytes += bytes_of(vec3(0));
        for (int k = 0; k < 3; ++k) bytes += bytes_of(mesh.positions[t[k]]);
        bytes += std::string(2, '\0');
    }
    return bytes;
}

TEST(Stl, BinaryWhateverItsHeaderSays) {
    const Mesh mesh = box(vec3(1), vec3(2));
    for (const char* header : {"", "solid", "solid facet normal endsolid", "\xff\xfe", "binary"}) {
        const Mesh back = parse("a.stl", stl_of(mesh, header, 12));
        ASSERT_EQ(back.triangles.size(), 12u) << header;
        for (std::size_t f = 0; f < 12; ++f)
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(back.positions[back.triangles[f][k]], mesh.positions[mesh.triangles[f][k]]);
    }
    for (const char* header : {"solid", "solid facet normal endsolid"})
        for (const char* more : {"12", "and more"})
            EXPECT_EQ(parse("a.stl", stl_of(mesh, header, 12) + more).triangles.size(), 12u);
    std::vector<std::string> notes;
    EXPECT_EQ(parse("a.stl", stl_of(mesh, "solid", 11), &notes).triangles.size(), 11u);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out 50 bytes behind the 11 facets");
    for (std::uint32_t lie : {13u, 1'000'000'000u, 4'294'967'295u})
        EXPECT_HAS(parse_error("a.stl", stl_of(mesh, "solid", lie)), "12 there");
    EXPECT_HAS(parse_error("a.stl", stl_of(Mesh(), "solid", 0)), "no faces");
    const std::string whole = stl_of(mesh, "solid", 12);
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(parse_error("a.stl", whole.substr(0, length)), "") << length;
    EXPECT_HAS(parse_error("a.stl", stl_of(box(vec3(1e6f), vec3(1e6f + 1)), "", 12)),
               "move it to the origin");
    EXPECT_HAS(parse_error("a.stl", stl_of(box(vec3(0), vec3(INFINITY)), "", 12)), "not finite");
}

// A solid's text, of whose lines one is another.
std::string stl_text(const std::string& line = "", const std::string& in_its_place = "") {
    std::string text = "solid box\n";
    for (uvec3 t : brick.triangles) {
        text += "facet normal 0 0 1\n  outer loop\n";
        for (int k = 0; k < 3; ++k) text += "    vertex " + rows_of({brick.positions[t[k]]});
        text += "  endloop\nendfacet\n";
    }
    text += "endsolid box\n";
    for (std::size_t at = line.empty() ? text.npos : text.find(line); at != text.npos;
         at = text.find(line, at + in_its_place.size()))
        text.replace(at, line.size(), in_its_place);
    return text;
}

TEST(Stl, TextAsStrangersWriteIt) {
    expect_brick("a.stl", stl_text());
    expect_brick("a.stl", old_macintosh(stl_text()));
    expect_brick("a.stl", stl_text("endloop", "end loop"));
    expect_brick("a.stl", stl_text("endfacet", "END FACET"));
    expect_brick("a.stl", stl_text("endsolid box", "end solid box"));
    expect_brick("a.stl", stl_text("facet normal 0 0 1", "facet normal -1.#IND -1.#IND -1.#IND"));
    expect_brick("a.stl", stl_text("facet normal 0 0 1", "facet"));
    expect_brick("a.stl", stl_text("facet normal 0 0 1", "facet normal"));
    expect_brick("a.stl", stl_text("solid box\nfacet", "solid box\ncolor 0.7 0.7 0.7\nfacet"),
                 "ignored 1 line outside of any facet, the first with \"color\"");
    expect_brick("a.stl", stl_text("solid box\nfacet", "solid box\n# in mm\nfacet"), "the first with \"#\"");
    expect_brick("a.stl", stl_text("endfacet", "attribute 0 vertex 1 2 3\nendfacet"), "ignored 12 lines");
    expect_brick("a.stl", "# by hand\n\n" + stl_text(), "ignored 1 line");
    expect_brick("a.stl", stl_text("endsolid box\n", ""), "ends without \"endsolid\"");
    std::string in_one_line = stl_text();
    std::replace(in_one_line.begin(), in_one_line.end(), '\n', ' ');
    expect_brick("a.stl", in_one_line);
    EXPECT_HAS(parse_error("a.stl", stl_text("endfacet\nendsolid box\n", "")), "truncated");
}

TEST(Stl, TextInAnyCapitalsAndSeveralSolids) {
    const std::string text =
        "Solid of vertex and facet\r\n\tFACET Normal 0 0 1\r\nOUTER Loop\r\nVertex 0 0 0\r\nvertex 1 0 0\r\n"
        "VERTEX 0 1 0\r\nEndLoop\r\nendFacet\r\nENDSOLID of vertex\r\n"
        "solid\nfacet normal nan nan nan outer loop vertex 0 0 1 vertex 1 0 1 vertex 0 1 1 endloop endfacet\n"
        "endsolid";
    const Mesh mesh = parse("a.STL", text);
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(mesh.positions[5], vec3(0, 1, 1));
    for (std::size_t length = 0; length < text.find("Facet\r\nENDSOLID") + 5; ++length)
        EXPECT_NE(parse_error("a.stl", text.substr(0, length)), "") << length;
    EXPECT_HAS(parse_error("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nendloop\nendsolid"),
               "1 corners in line 5");
    EXPECT_HAS(parse_error("a.stl", "solid\nfacet\nouter loop\nvertex 0 0\nvertex 1 1 1\nendsolid"),
               "line 5");
    EXPECT_HAS(parse_error("a.stl", "solid\nendsolid\n"), "no faces");
}

TEST(Stl, ANameFilledUpWithZeros) {
    expect_brick("a.stl", stl_text("solid box\n", std::string("solid box\0\0\0\n", 13)));
}

TEST(Stl, FacetsThatNobodyCounted) {
    expect_brick("a.stl", stl_of(brick, "", 0), "read the 12 facets that are there");
    EXPECT_HAS(parse_error("a.stl", stl_of(brick, std::string(80, ' '), 0xffffffffu)), "12 there");
}

// ---- OFF ----

TEST(Off, EveryHeaderThatTellsOfSurfaces) {
    const std::string faces = "3 0 1 2 255 0 0 # red\n3 2 1 0 0.5\n";
    const std::string plain = "0 0 0\n1 0 0\n\n# between\n0 1 0\n";
    for (const char* head :
         {"OFF\n3 2 0\n", "OFF 3 2 0\n", "3 2 0\n", "OFF # counts\n# follow\n\n3 2\n", "OFF\r\n3 2 0\r\n"}) {
        const Mesh mesh = parse("a.off", head + plain + faces);
        EXPECT_EQ(mesh.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << head;
        EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {2, 1, 0}})) << head;
    }
    const Mesh coloured =
        parse("a.off", "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 9 9 9 9\n0 1 0 0 0 0 0\n3 0 1 2");
    EXPECT_EQ(coloured.positions[2], vec3(0, 1, 0));
    const Mesh textured = parse("a.off", "STOFF 3 1 3\n0 0 0 .5 .5\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2");
    EXPECT_EQ(textured.positions[2], vec3(0, 1, 0));
    for (const char* head : {"NOFF", "CNOFF", "STNOFF", "STCNOFF"}) {
        const Mesh mesh = parse("a.off", std::string(head) +
                                             "\n3 1 0\n0 0 0 0 0 1 1 1 1\n1 0 0 1 0 0 1 1 1\n"
                                             "0 1 0 0 1 0 1 1 1\n3 0 1 2\n");
        EXPECT_EQ(mesh.normals, (std::vector<vec3>{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}})) << head;
    }
}

TEST(Off, WordsInAnyLines) {
    const std::string points = rows_of(brick.positions), faces = rows_of(brick.triangles, 0, "3");
    const auto in_a_line = [](std::string text) {
        std::replace(text.begin(), text.end(), '\n', ' ');
        return text;
    };
    for (const char* head :
         {"OFF8 12 0\n", "OFF 8 12 0\n", "OFF\n8\n12\n0\n", "off\n8 12 0\n", "OFF\n8 12\n", "8 12 18\n"}) {
        expect_brick("a.off", head + points + faces);
        expect_brick("a.off", old_macintosh(head + points + faces));
        expect_brick("a.off", head + in_a_line(points) + "\n" + in_a_line(faces));
    }
    expect_brick("a.off", in_a_line("OFF 8 12 0 " + points + faces));
    expect_brick("a.off", "OFF 8 12 0\n" + points + rows_of(brick.triangles, 0, "3", " 255 0 0# red\n"));
    expect_brick("a.off", "COFF 8 12 0\n" + rows_of(brick.positions, "", " 1 0 0\n") + faces);
    expect_brick("a.off",
                 "STCOFF 8 12 0 " + rows_of(brick.positions, "", " 0.5 1 0 1 1 1 ") + in_a_line(faces));
    EXPECT_HAS(parse_error("a.off", in_a_line("OFF 8 12 0 " + points + faces + "7")), "more numbers");
}

TEST(Off, ColoursBehindFacesInOtherLinesThanTheVertices) {
    const std::string colours = " 255 0 0\n";
    std::string pairs = "OFF\n8 12 0\n", wrapped;
    for (std::size_t i = 0; i < 8; i += 2)
        pairs += rows_of({brick.positions[i]}, "", " ") + rows_of({brick.positions[i + 1]});
    expect_brick("a.off", pairs + rows_of(brick.triangles, 0, "3", colours));
    for (uvec3 t : brick.triangles) wrapped += fmt::format("3 {}\n{} {}{}", t.x, t.y, t.z, colours);
    expect_brick("a.off", "OFF 8 12 0 " + rows_of(brick.positions, "", " ") + "\n" + wrapped);
}

TEST(Off, RefusesTheRest) {
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
    for (const char* head : {"4OFF", "nOFF", "4nOFF", "N4OFF"})
        EXPECT_HAS(parse_error("a.off", std::string(head) + "\n3 1 0\n" + three + "3 0 1 2\n"),
                   "not of three dimensions");
    EXPECT_HAS(parse_error("a.off", std::string("OFF BINARY\n\0\0\0\3\0\0\0\1", 19)), "binary OFF");
    EXPECT_HAS(parse_error("a.off", "PLY\n"), "no OFF header");
    EXPECT_HAS(parse_error("a.off", "OFF\n-3 1 0\n" + three), "number of vertices");
    EXPECT_HAS(parse_error("a.off", "OFF\n3 x 0\n" + three), "number of faces");
    for (const char* many : {"4294967294", "1000000"}) {
        EXPECT_HAS(parse_error("a.off", fmt::format("OFF\n{} 1 0\n{}3 0 1 2\n", many, three)), "truncated");
        EXPECT_HAS(parse_error("a.off", fmt::format("OFF\n3 {} 0\n{}3 0 1 2\n", many, three)), "truncated");
        EXPECT_HAS(parse_error("a.off", fmt::format("OFF\n3 1 0\n{}{} 0 1 2\n", three, many)), "in a.off");
    }
    for (const char* face : {"3 0 1 3", "3 0 1 -1", "3 0 1 nan", "3 0 1 0.5"})
        EXPECT_HAS(parse_error("a.off", "OFF\n3 1 0\n" + three + face + "\n"),
                   "of 3, counted from 0, in line 6");
    for (const char* face : {"-3 0 1 2", "2.5 0 1 2", "nan 0 1 2"})
        EXPECT_HAS(parse_error("a.off", "OFF\n3 1 0\n" + three + face + "\n"), "corners in line 6");
    EXPECT_HAS(parse_error("a.off", "OFF\n3 1 0\n" + three + "2 0 1\n"), "only points or lines");
    std::vector<std::string> notes;
    EXPECT_EQ(parse("a.off", "OFF\n3 3 0\n" + three + "2 0 1\n3 0 1 2\n1 2\n", &notes).triangles.size(), 1u);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "2 points and lines");
}

// ---- all ----

TEST(TextFormats, NoiseAndEmptyFilesAreRefused) {
    std::mt19937 random(5);
    for (const char* name : {"a.obj", "a.off", "a.ply", "a.stl", "a.wrl"}) {
        EXPECT_NE(parse_error(name, ""), "") << name;
        EXPECT_NE(parse_error(name, std::string(1000, '\0')), "") << name;
        EXPECT_HAS(parse_error(name, std::string("\xfe\xff\0v\0 ", 6)), "UTF-16") << name;
        for (std::size_t size : {1, 7, 100, 5000}) {
            std::string noise(size, '\0');
            for (char& c : noise) c = char(random());
            EXPECT_NE(parse_error(name, noise), "") << name;
        }
    }
}

TEST(TextFormats, DamagedTextsAreSoundOrRefused) {
    std::mt19937 random(6);
    const std::vector<std::string> corners = {"0 0 0", "2 0 0.5", "2 1 0", "1 1e-3 0", "1 -2 0"};
    for (const auto& [name, whole] : spellings(corners)) {
        for (std::size_t length = 0; length < whole.size(); ++length)
            expect_sound_or_error(name, std::string_view(whole).substr(0, length));
        for (int i = 0; i < 2000; ++i) {
            std::string text = whole;
            for (int flips = 1 + i % 4; flips > 0; --flips) text[random() % text.size()] = char(random());
            expect_sound_or_error(name, text);
        }
    }
}

}  // namespace
}  // namespace palpate
