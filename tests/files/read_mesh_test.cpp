#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "palpate/files/write.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>

namespace palpate {
namespace {

std::string mesh_error(const std::filesystem::path& path, const std::string& text) {
    put(path, text);
    return refusal(path, [&] { read_mesh(path, Units::metres); });
}

// Finite floats of every size, with -0 and the smallest and largest there are.
Mesh odd_mesh(unsigned vertices, bool normals) {
    std::mt19937 random(vertices);
    auto any = [&] {
        for (;;)
            if (float f = std::bit_cast<float>(std::uint32_t(random())); std::isfinite(f)) return f;
    };
    Mesh mesh;
    for (unsigned i = 0; i < vertices; ++i) {
        mesh.positions.push_back({any(), any(), any()});
        if (normals) mesh.normals.push_back({any(), any(), any()});
    }
    mesh.positions[0] = {-0.0f, std::numeric_limits<float>::denorm_min(), std::numeric_limits<float>::max()};
    for (unsigned i = 0; i < vertices; ++i)
        mesh.triangles.push_back({i, unsigned(random()) % vertices, (i + 1) % vertices});
    return mesh;
}

bool same_bytes(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    return a.size() == b.size() &&
           (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0);
}

TEST(WriteMesh, PlyComesBackFloatForFloatAndIndexForIndex) {
    Scratch scratch;
    for (const char* name : {"a.ply", "A.PLY"})
        for (unsigned vertices : {3, 10, 257, 5001, 60000})  // the last is more than assimp reads at once
            for (bool normals : {false, true}) {
                const Mesh mesh = odd_mesh(vertices, normals);
                write_mesh(mesh, scratch / name);
                const Mesh back = read_mesh(scratch / name, Units::metres);
                EXPECT_TRUE(same_bytes(back.positions, mesh.positions)) << name;
                EXPECT_TRUE(same_bytes(back.normals, mesh.normals)) << name;
                EXPECT_EQ(back.triangles, mesh.triangles) << name;
            }
}

TEST(WriteMesh, PlyComesBackWhateverItsFirstByte) {
    Scratch scratch;
    for (unsigned byte : {0, 9, 10, 13, 32, 255}) {  // assimp skips a line feed after the header
        Mesh mesh = box(vec3(1), vec3(2));
        mesh.positions[0].x = std::bit_cast<float>(0x3f800000u + byte);
        write_mesh(mesh, scratch / "a.ply");
        EXPECT_TRUE(same_bytes(read_mesh(scratch / "a.ply", Units::metres).positions, mesh.positions))
            << byte;
    }
}

// How many floats apart two are; they have the same sign.
unsigned apart(float a, float b) {
    return unsigned(std::abs(std::bit_cast<std::int32_t>(a) - std::bit_cast<std::int32_t>(b)));
}

// An OBJ file's vertices come back in the order in which its faces use them: so compare the faces' corners.
void expect_same_corners(const Mesh& back, const Mesh& mesh, const char* name) {
    ASSERT_EQ(back.triangles.size(), mesh.triangles.size()) << name;
    ASSERT_EQ(back.normals.empty(), mesh.normals.empty()) << name;
    auto check = [&](vec3 a, vec3 b) {
        for (int k = 0; k < 3; ++k) {
            const bool exact = b[k] == 0 || (std::abs(b[k]) > 1.5e-8f && std::abs(b[k]) < 1e18f);
            EXPECT_LE(apart(a[k], b[k]), exact ? 0u : 4u) << name << ' ' << b[k];
        }
    };
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
        for (int k = 0; k < 3; ++k) {
            const unsigned from = mesh.triangles[f][k], to = back.triangles[f][k];
            check(back.positions[to], mesh.positions[from]);
            if (!mesh.normals.empty()) check(back.normals[to], mesh.normals[from]);
        }
}

TEST(WriteMesh, ObjComesBackFloatForFloatCornerForCorner) {
    Scratch scratch;
    for (const char* name : {"a.obj", "b.Obj"})
        for (unsigned vertices : {3, 10, 257, 5001, 60000})
            for (bool normals : {false, true}) {
                const Mesh mesh = odd_mesh(vertices, normals);
                write_mesh(mesh, scratch / name);
                const Mesh back = read_mesh(scratch / name, Units::metres);
                EXPECT_EQ(back.positions.size(), mesh.positions.size()) << name;
                expect_same_corners(back, mesh, name);
            }
    // Shared vertices are shared again, and what is in the order of use keeps its indices.
    Mesh mesh = sphere(vec3(0), 1, 2);
    compute_normals(mesh);
    write_mesh(mesh, scratch / "c.obj");
    const Mesh once = read_mesh(scratch / "c.obj", Units::metres);
    EXPECT_EQ(once.positions.size(), mesh.positions.size());
    write_mesh(once, scratch / "c.obj");
    const Mesh twice = read_mesh(scratch / "c.obj", Units::metres);
    EXPECT_TRUE(same_bytes(twice.positions, once.positions));
    EXPECT_TRUE(same_bytes(twice.normals, once.normals));
    EXPECT_EQ(twice.triangles, once.triangles);
}

TEST(ReadMesh, ScalesByUnits) {
    Scratch scratch;
    write_mesh(box(vec3(0), vec3(1000)), scratch / "a.ply");
    EXPECT_EQ(bounds(read_mesh(scratch / "a.ply", Units::millimetres)).high, vec3(1));
    EXPECT_EQ(bounds(read_mesh(scratch / "a.ply", Units::centimetres)).high, vec3(10));
}

TEST(ReadMesh, PlyAsOthersWriteIt) {
    Scratch scratch;
    // Ascii, Windows line ends, unknown elements and properties, doubles, a quad.
    put(scratch / "a.ply",
        "ply\r\nformat ascii 1.0\r\ncomment hello\r\nelement vertex 4\r\nproperty uchar red\r\n"
        "property double x\r\nproperty double y\r\nproperty list uchar int tags\r\nproperty double z\r\n"
        "element thing 1\r\nproperty int a\r\nelement face 1\r\nproperty float q\r\n"
        "property list uchar int vertex_index\r\nend_header\r\n"
        "255 0 0 2 7 8 0\r\n1 1 0 0 0\r\n1 +1 1e0 1 5 0\r\n0 0 1 0 -0.5\r\n42\r\n0.25 4 0 1 2 3\r\n");
    const Mesh ascii = read_mesh(scratch / "a.ply", Units::metres);
    EXPECT_EQ(ascii.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, -0.5f}}));
    EXPECT_EQ(ascii.triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}}));

    // Big-endian, as the Stanford scans are.
    std::string big =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property short z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    auto append = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        std::reverse(raw, raw + sizeof value);
        big.append(raw, sizeof value);
    };
    for (int i = 0; i < 3; ++i) append(float(i)), append(0.5f), append(std::int16_t(-300 * i));
    append(std::uint8_t(3));
    for (int i : {2, 1, 0}) append(i);
    put(scratch / "b.ply", big);
    const Mesh binary = read_mesh(scratch / "b.ply", Units::metres);
    EXPECT_EQ(binary.positions[2], vec3(2, 0.5f, -600));
    EXPECT_EQ(binary.triangles[0], uvec3(2, 1, 0));
}

TEST(ReadMesh, ObjAsOthersWriteIt) {
    Scratch scratch;
    put(scratch / "a.obj",
        "# hello\r\nmtllib missing.mtl\no one\nv 0 0 0 1 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        "g first\nusemtl red\nf 1/1/1 2/1/1 3/1/1 4/1/1\no two\n\tv 0 0 5\ng second\ns off\nf -1 -2/1 -3\n");
    const Mesh mesh = read_mesh(scratch / "a.obj", Units::metres);
    EXPECT_EQ(mesh.positions.size(), 5u);
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {0, 2, 3}, {4, 3, 2}}));
    EXPECT_TRUE(mesh.normals.empty()) << "not every corner has one";

    // At a hard edge a vertex has several normals, and comes once for each.
    put(scratch / "b.obj",
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn 1 0 0\nf 1//1 2//1 3//1\nf 3//2 2//1 1//-2\n");
    const Mesh hard = read_mesh(scratch / "b.obj", Units::metres);
    EXPECT_EQ(hard.positions, (std::vector<vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(hard.normals, (std::vector<vec3>{{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}}));
    EXPECT_EQ(hard.triangles, (std::vector<uvec3>{{0, 1, 2}, {3, 1, 0}}));
}

TEST(ReadMesh, TakesWhatAssimpAloneWouldMisread) {
    Scratch scratch;
    auto read = [&](const char* name, const std::string& text) {
        put(scratch / name, text);
        return read_mesh(scratch / name, Units::metres);
    };
    // It drops vertices that begin with a point or have five numbers, divides by a fourth, reads 01 as 0 and
    // 1, 21 digits as 0, and in a longer file drops a last line without an end.
    const std::string odd = "v .5 -.5 +1.\nv 1 0 0 1 1\nv 0 100000000000000000000 0 0.5\n";
    const std::vector<vec3> positions = {{0.5f, -0.5f, 1}, {1, 0, 0}, {0, 1e20f, 0}};
    EXPECT_EQ(read("a.obj", odd + "f 01 +2 3.0").positions, positions);
    EXPECT_EQ(read("a.obj", "#" + std::string(5000, ' ') + "\n" + odd + "f 1 2 3").positions, positions);
    // It opens a file that the text names, and leaves out what is between cstype and end.
    EXPECT_EQ(read("a.obj", "mtllib /dev/stdin\ncstype x\n" + odd + "f 1 2 3\nend\n").positions, positions);

    // It wants a row a line, knows no sign in front of an index, and takes a comment for an element.
    const Mesh ply = read("a.ply",
                          "ply\ncomment element vertex 1000000000\nformat ascii 1.0\ncomment face 9\n"
                          "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                          "element face 1\nproperty list uchar float texcoord\n"
                          "property list uchar int vertex_index\nend_header\n"
                          "\n.5 -.5 +1 1\n0 0 0 100000000000000000000\n\n0 6 1 2 3 4 5 6 +3 +0 1.0 2e0");
    EXPECT_EQ(ply.positions, positions);
    EXPECT_EQ(ply.triangles, (std::vector<uvec3>{{0, 1, 2}}));
}

std::string ply_header(const std::string& format, const std::string& vertices, const std::string& faces) {
    return "ply\nformat " + format + " 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n";
}

TEST(ReadMesh, RefusesClaimsThatTheFileCannotHold) {
    Scratch scratch;
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n", face = "3 0 1 2\n";
    for (const char* many : {"1099511627776", "4294967294", "1000000", "18446744073709551615"})
        for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
            const std::string rest = *format == 'a' ? three + face : std::string(36, '0') + "1234";
            EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header(format, many, "1") + rest), " promised");
            EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header(format, "3", many) + rest), " promised");
        }
    EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "99999999999999999999999", "1") + three),
               "count");
    EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "-3", "1") + three), "count");
    EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "3", "1") + three + "200 0 1 2\n"),
               "truncated");
    // A list's length may be negative, not whole, or more than any memory holds.
    for (const char* type : {"char", "int", "float", "uint"}) {
        std::string header = ply_header("ascii", "3", "1");
        header.replace(header.find("uchar"), 5, type);
        for (const char* length : {"-1", "3.5", "nan", "1e300", "4294967295", "4294967299"})
            EXPECT_HAS(mesh_error(scratch / "a.ply", header + three + length + " 0 1 2\n"), "face 1 of 1");
        header.replace(header.find("ascii"), 5, "binary_little_endian");
        for (const char* length : {"\xff\xff\xff\xff", "\x7f\x7f\x7f\x7f"})
            EXPECT_HAS(mesh_error(scratch / "a.ply", header + std::string(36, '0') + length + "1234"),
                       "face 1 of 1");
    }
    // Two elements of one name, of which a reader may make room for the first alone.
    const std::string two = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    EXPECT_HAS(mesh_error(scratch / "a.ply", "ply\nformat ascii 1.0\n" + two + two +
                                                 "element face 1\nproperty list uchar int vertex_index\n"
                                                 "end_header\n" +
                                                 three + three + face),
               "more than one vertex");
    // A second format, after the properties.
    std::string again = ply_header("ascii", "3", "1");
    again.insert(again.find("end_header"), "format binary_little_endian 1.0\n");
    put(scratch / "a.ply", again + three + face);
    EXPECT_EQ(read_mesh(scratch / "a.ply", Units::metres).triangles.size(), 1u);
    // Far more properties than numbers.
    std::string endless = ply_header("ascii", "3", "1"), properties;
    for (int i = 0; i < 100000; ++i) properties += "property float a\n";
    endless.insert(endless.find("end_header"), properties);
    EXPECT_HAS(mesh_error(scratch / "a.ply", endless + three + face), "truncated");
    // A million elements of no bytes would pass any check of sizes.
    EXPECT_HAS(
        mesh_error(scratch / "a.ply", "ply\nformat ascii 1.0\nelement void 1000000000000\nend_header\n"),
        "void");
}

TEST(ReadMesh, RefusesWhatIsNotFinite) {
    Scratch scratch;
    for (const char* bad : {"nan", "inf", "-inf", "1e39", "-1e400"}) {
        const std::string numbers = std::string("0 0 0\n1 0 ") + bad + "\n0 1 0\n";
        EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "3", "1") + numbers + "3 0 1 2\n"),
                   "vertex 2 of 3");
        EXPECT_HAS(
            mesh_error(scratch / "a.obj", std::string("v 0 0 0\nv 1 0 ") + bad + "\nv 0 1 0\nf 1 2 3\n"),
            "vertex 2 of 3");
    }
    Mesh mesh = box(vec3(0), vec3(1));
    mesh.normals.clear();
    write_mesh(mesh, scratch / "b.ply");
    std::string bytes = read_text(scratch / "b.ply");
    const float none = NAN;
    const std::string end = "end_header\n";
    std::memcpy(bytes.data() + bytes.find(end) + end.size() + 6 * sizeof(vec3) + sizeof none, &none,
                sizeof none);
    write_text(scratch / "b.ply", bytes);
    EXPECT_HAS(refusal(scratch / "b.ply", [&] { read_mesh(scratch / "b.ply", Units::metres); }),
               "vertex 7 of 8");
}

TEST(ReadMesh, RefusesFacesWithoutVertices) {
    Scratch scratch;
    const std::string three = "0 0 0\n1 0 0\n0 1 0\n";
    for (const char* face : {"3 0 1 3\n", "3 0 1 -1\n", "3 0 1 2147483647\n", "3 0 1 nan\n", "3 0 1 1e300\n"})
        EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "3", "1") + three + face), "face 1");
    EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "3", "1") + three + "2 0 1\n"),
               "only points or lines");
    const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const char* face : {"f 1 2 4\n", "f 1 2 0\n", "f 1 2 -4\n", "f 1 2 99999999999\n", "f 1 2 x\n",
                             "f 1 2 4294967295//1\n"})
        EXPECT_HAS(mesh_error(scratch / "a.obj", obj + face), "vertex");
    EXPECT_HAS(mesh_error(scratch / "a.obj", obj + "f 1 2\n"), "only points or lines");
    EXPECT_HAS(mesh_error(scratch / "a.obj", "v 0 0\nf 1 1 1\n"), "line 1");
}

TEST(ReadMesh, RefusesEmptyMissingAndOtherFiles) {
    Scratch scratch;
    for (const char* name : {"a.ply", "a.obj"}) {
        EXPECT_NE(mesh_error(scratch / name, ""), "");
        EXPECT_NE(mesh_error(scratch / name, std::string("\0\xff\n\n\n", 5)), "");
        EXPECT_NE(
            refusal(scratch / "none" / name, [&] { read_mesh(scratch / "none" / name, Units::metres); }), "");
    }
    EXPECT_HAS(mesh_error(scratch / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), "no faces");
    EXPECT_HAS(mesh_error(scratch / "a.ply", ply_header("ascii", "1", "0") + "0 0 0\n"), "no faces");
    EXPECT_HAS(mesh_error(scratch / "a.xyz", "1 2 3"), ".ply, .obj");
    std::filesystem::create_directory(scratch / "folder.ply");
    EXPECT_HAS(refusal(scratch / "folder.ply", [&] { read_mesh(scratch / "folder.ply", Units::metres); }),
               "folder");
}

TEST(ReadMesh, RefusesAPlyCutAnywhere) {
    Scratch scratch;
    write_mesh(box(vec3(0), vec3(1)), scratch / "whole.ply");
    const std::string whole = read_text(scratch / "whole.ply");
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(mesh_error(scratch / "a.ply", whole.substr(0, length)), "") << length;
}

TEST(ReadMesh, SurvivesDamagedFilesInSilence) {
    Scratch scratch;
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Mesh mesh = box(vec3(0), vec3(1));
    compute_normals(mesh);
    std::mt19937 random(3);
    for (const char* name : {"a.ply", "a.obj"}) {
        write_mesh(mesh, scratch / name);
        const std::string whole = read_text(scratch / name);
        for (int i = 0; i < 1000; ++i) {
            std::string text = whole;
            for (int flips = 1 + i % 4; flips > 0; --flips) text[random() % text.size()] = char(random());
            expect_sound_or_error(name, text);
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// ---- gzip ----

TEST(ReadMesh, WhatAFileIsStandsInItsBytes) {
    Scratch scratch;
    const Mesh mesh = odd_mesh(50, true);
    write_mesh(mesh, scratch / "plain.ply");
    const std::string bytes = read_text(scratch / "plain.ply");
    const std::filesystem::path zipped = scratch / "packed.ply";  // without .gz
    gzFile file = gzopen(zipped.c_str(), "wb");
    ASSERT_EQ(gzwrite(file, bytes.data(), unsigned(bytes.size())), int(bytes.size()));
    gzclose(file);
    EXPECT_TRUE(same_bytes(read_mesh(zipped).positions, mesh.positions));
    put(scratch / "plain.ply.gz", bytes);  // with, but not packed
    EXPECT_TRUE(same_bytes(read_mesh(scratch / "plain.ply.gz").positions, mesh.positions));
    std::vector<std::string> notes;  // of a PLY that is said to be something else
    for (const char* name : {"a.stl", "a.fbx"})
        EXPECT_TRUE(same_bytes(parse_mesh(bytes, name, {}, &notes).positions, mesh.positions));
    ASSERT_EQ(notes.size(), 2u);
    EXPECT_HAS(notes[0], "read as .ply, because its first bytes say so");
    const std::pair<const char*, const char*> foreign_files[] = {
        {"<!DOCTYPE html><html>", "a web page"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:0\n", "git lfs pull"},
        {"PK\3\4", "a ZIP archive"},
        {"BZh91AY", "bzip2"}};
    for (const auto& [start, what] : foreign_files)
        for (const char* name : {"a.stl", "a.obj", "a.ply", "a.glb", "a.fbx"})
            EXPECT_HAS(parse_error(name, start), what) << name;
}

TEST(ReadMesh, WhatIsWrongIsNamedFirst) {
    Scratch scratch;
    const auto error = [](const std::filesystem::path& path) {
        return refusal(path, [&] { read_mesh(path, Units::metres); });
    };
    EXPECT_HAS(error(scratch / "gone"), "cannot find the file");
    EXPECT_HAS(error(scratch / "gone.stl"), "cannot find the file");
    EXPECT_HAS(mesh_error(scratch / "plain", "x"), "no extension that identifies the format");
    EXPECT_HAS(mesh_error(scratch / "a.vti", "x"), ".nii, .nrrd");
    for (const char* name : {"a.stl", "a.obj", "a.ply", "a.off", "a.glb", "a.3mf", "a.x3d", "a.wrl", "a.fbx"})
        EXPECT_HAS(parse_error(name, ""), "an empty file") << name;
}

TEST(ReadMesh, ContentOfAnotherKindIsNamed) {
    std::string nifti(352, '\0'), dicom(132, '\0');
    nifti.replace(344, 3, "n+1");
    dicom.replace(128, 4, "DICM");
    for (const char* name : {"a.stl", "a.obj", "a.fbx"}) {
        EXPECT_HAS(parse_error(name, nifti), "a NIfTI volume") << name;
        EXPECT_HAS(parse_error(name, dicom), "a DICOM file") << name;
        EXPECT_HAS(parse_error(name, "NRRD0004\ntype: float\n"), "an NRRD volume") << name;
    }
    const std::string words =
        "A text that tells of a mesh, at some length, and is none. It goes on and on, so that "
        "eighty-four bytes are there.";
    EXPECT_HAS(parse_error("a.stl", words), "a text that is not STL");
    std::vector<std::string> notes;
    const char* const stl =
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
        "endfacet\nendsolid a\n";
    EXPECT_EQ(parse_mesh(stl, "a.obj", Units::metres, &notes).triangles.size(), 1u);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "read as .stl");
}

TEST(ReadMesh, AGzipReadsAsWhatIsInIt) {
    Scratch scratch;
    const Mesh mesh = odd_mesh(500, true);
    write_mesh(mesh, scratch / "plain.ply");
    const std::string bytes = read_text(scratch / "plain.ply");
    gzFile file = gzopen((scratch / "a.ply.gz").c_str(), "wb");
    ASSERT_EQ(gzwrite(file, bytes.data(), unsigned(bytes.size())), int(bytes.size()));
    gzclose(file);
    const Mesh back = read_mesh(scratch / "a.ply.gz", Units::metres);
    EXPECT_TRUE(same_bytes(back.positions, mesh.positions));
    EXPECT_EQ(back.triangles, mesh.triangles);

    const std::string whole = read_text(scratch / "a.ply.gz");
    for (std::size_t kept : {std::size_t(5), whole.size() / 2, whole.size() - 1})
        EXPECT_HAS(mesh_error(scratch / "cut.ply.gz", whole.substr(0, kept)), "gzip");
    std::string damaged = whole;
    damaged[whole.size() / 2] ^= 0x55;
    EXPECT_HAS(mesh_error(scratch / "damaged.ply.gz", damaged), "gzip");
    EXPECT_HAS(mesh_error(scratch / "a.xyz.gz", whole), "format");
    EXPECT_HAS(refusal(scratch / "none.ply.gz", [&] { read_mesh(scratch / "none.ply.gz", Units::metres); }),
               ";");
}

}  // namespace
}  // namespace palpate
