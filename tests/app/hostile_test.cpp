// Bad files given to `palpate import`: each ends in one clear line, or in a sound solid. An import that hangs
// is ended after a minute of CPU time, a hundred times what any of them takes. Formats have tests of their
// own; these cover the whole way from file to solid.
#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "palpate/files/write.h"
#include "palpate/mesh/repair.h"
#include "tests/app/command.h"
#include "tests/scratch.h"
#include "tests/shapes.h"
#include "tests/threemf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <fstream>
#include <random>

namespace palpate {
namespace {

std::string off(const Mesh& mesh) {
    std::string text = fmt::format("OFF\n{} {} 0\n", mesh.positions.size(), mesh.triangles.size());
    for (vec3 p : mesh.positions) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
    for (uvec3 t : mesh.triangles) text += fmt::format("3 {} {} {}\n", t.x, t.y, t.z);
    return text;
}

// Coordinates and faces as VRML and X3D list them.
std::string points(const Mesh& mesh) {
    std::string text;
    for (vec3 p : mesh.positions) text += fmt::format("{} {} {}, ", p.x, p.y, p.z);
    return text;
}
std::string faces(const Mesh& mesh) {
    std::string text;
    for (uvec3 t : mesh.triangles) text += fmt::format("{} {} {} -1 ", t.x, t.y, t.z);
    return text;
}

std::string wrl(const Mesh& mesh) {
    return fmt::format(
        "#VRML V2.0 utf8\nShape {{ geometry IndexedFaceSet {{\n coord Coordinate {{ point [ {} ] }}\n"
        " coordIndex [ {} ] }} }}\n",
        points(mesh), faces(mesh));
}

std::string x3d(const Mesh& mesh) {
    return fmt::format(
        "<?xml version=\"1.0\"?>\n<X3D version=\"3.0\" profile=\"Interchange\"><Scene><Shape>\n"
        "<IndexedFaceSet coordIndex=\"{}\"><Coordinate point=\"{}\"/></IndexedFaceSet>\n"
        "</Shape></Scene></X3D>\n",
        faces(mesh), points(mesh));
}

std::string threemf(const Mesh& mesh) {
    const std::string object = "<object id='1'>" + mesh_of_3mf(mesh) + "</object>";
    return zipped({{"3D/3dmodel.model", model(object, "<item objectid='1'/>", "unit='meter'")}});
}

const char* const extensions[] = {".ply", ".obj", ".stl", ".off", ".wrl", ".glb", ".gltf", ".x3d", ".3mf"};

enum class End { solid, error };

class Hostile : public ::testing::Test {
 protected:
    Scratch scratch;

    // The bytes of a file of this format.
    std::string file_of(const Mesh& mesh, const std::string& extension) const {
        if (extension == ".off") return off(mesh);
        if (extension == ".wrl") return wrl(mesh);
        if (extension == ".x3d") return x3d(mesh);
        if (extension == ".3mf") return threemf(mesh);
        const auto path = scratch / ("good" + extension);
        write_mesh(mesh, path);
        const std::string bytes = read_text(path);
        std::filesystem::remove(path);
        return bytes;
    }

    // Imports these bytes, and checks all that holds for every file.
    End import(const std::string& name, const std::string& bytes, const std::string& more = "") {
        const auto in = scratch / name, out = scratch / "out.ply";
        std::ofstream(in, std::ios::binary) << bytes;
        const Outcome outcome = shell(fmt::format("ulimit -t 60; {} import {} -o {} {}", PALPATE_COMMAND,
                                                  in.string(), out.string(), more));
        output = outcome.output;
        SCOPED_TRACE(name);
        if (outcome.status != 0) {
            expect_one_line(outcome, {name, "; "});
            EXPECT_FALSE(std::filesystem::exists(out));
        } else {
            expect_solid(read_mesh(out, Units::metres));
        }
        std::filesystem::remove(in);
        std::filesystem::remove(out);
        EXPECT_EQ(scratch.entries(), 0u);
        return outcome.status == 0 ? End::solid : End::error;
    }

    void expect_error(const std::string& name, const std::string& bytes, const std::string& word = "") {
        EXPECT_EQ(import(name, bytes), End::error) << name << ": " << output;
        EXPECT_NE(output.find(word), std::string::npos) << name << ": " << output;
    }
    void expect_solid(const std::string& name, const std::string& bytes, const std::string& more = "") {
        EXPECT_EQ(import(name, bytes, more), End::solid) << name << ": " << output;
    }

    std::string output;  // of the last import

 private:
    static void expect_solid(const Mesh& mesh) {
        for (vec3 p : mesh.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
        for (vec3 n : mesh.normals) ASSERT_NEAR(glm::length(n), 1, 1e-3);
        const Soundness sound = soundness(mesh);
        EXPECT_EQ(sound.open_edges, 0u);
        EXPECT_EQ(sound.bad_edges, 0u);
        EXPECT_GT(volume(mesh), 0);
    }
};

const Mesh ball = ellipsoid({0.03f, 0.04f, 0.05f}, 12);

TEST_F(Hostile, GoodFilesOfAllFormatsAreSolids) {
    for (const std::string extension : extensions) expect_solid("good" + extension, file_of(ball, extension));
}

TEST_F(Hostile, FilesOfNoFormat) {
    std::mt19937 random(4);
    std::string noise(10'000, ' ');
    for (char& c : noise) c = char(random());
    for (const std::string extension : extensions) {
        expect_error("empty" + extension, "");
        expect_error("noise" + extension, noise);
        expect_error("nul" + extension, std::string(10'000, '\0'));
        expect_error("words" + extension, "these are words, and no mesh\n");
        expect_error("newlines" + extension, std::string(10'000, '\n'));
    }
}

TEST_F(Hostile, TruncatedFiles) {
    for (const std::string extension : extensions) {
        const std::string good = file_of(ball, extension);
        for (const double part : {0.1, 0.5, 0.93}) {
            // The beginning of an OBJ may be a complete file itself.
            const std::string bytes = good.substr(0, std::size_t(double(good.size()) * part));
            if (import("cut" + extension, bytes) == End::solid)
                EXPECT_TRUE(extension == ".obj") << extension << " " << part;
        }
    }
}

TEST_F(Hostile, FlippedBits) {
    std::mt19937 random(5);
    for (const std::string extension : extensions) {
        const std::string good = file_of(ball, extension);
        for (int i = 0; i < 6; ++i) {
            std::string bytes = good;
            for (int flips = 1 + i; flips > 0; --flips)
                bytes[random() % bytes.size()] ^= char(1 << random() % 8);
            import("bits" + extension, bytes);
        }
    }
}

std::string ply(const std::string& vertices, const std::string& faces, const std::string& rows) {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices +
           "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
           "\nproperty list uchar int vertex_indices\nend_header\n" + rows;
}

TEST_F(Hostile, WrongCounts) {
    expect_error("faces.ply", ply("3", "4294967296", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    expect_error("vertices.ply", ply("4294967295", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
    expect_error("corners.ply", ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"));
    expect_error("faces.off", "OFF\n3 4294967296 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_error("vertices.off", "OFF\n4294967296 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    std::string stl(80, ' ');
    stl += std::string("\xff\xff\xff\xff", 4) + std::string(500, 'x');
    expect_error("faces.stl", stl);
    std::string glb = file_of(ball, ".glb");
    glb.replace(12, 4, "\xf0\xff\xff\xff");  // the length of its first chunk
    expect_error("length.glb", glb);
    std::string gltf = file_of(ball, ".gltf");
    const std::size_t count = gltf.find("\"count\":");
    ASSERT_NE(count, std::string::npos);
    gltf.insert(count + 8, "4294967");
    expect_error("count.gltf", gltf);
}

TEST_F(Hostile, InvalidNumbers) {
    const std::string face = "f 1 2 3\n";
    for (const std::string bad : {"nan", "inf", "-Infinity", "1e39", "1,5", "0x1p3", "one", "1.2.3"}) {
        expect_error("number.obj", "v 0 0 0\nv 1 0 0\nv 0 " + bad + " 0\n" + face);
        expect_error("number.ply", ply("3", "1", "0 0 0\n1 0 0\n0 " + bad + " 0\n3 0 1 2\n"));
        expect_error("number.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 " + bad + " 0\n3 0 1 2\n");
        expect_error("number.stl",
                     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 " + bad +
                         " 0\nendloop\nendfacet\nendsolid a\n");
        expect_error(
            "number.wrl",
            "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 0 0 0 " +
                bad + " 0 ] } coordIndex [ 0 1 2 -1 ] } }\n");
    }
    expect_error("comma.obj", "v 0,0 0,0 0,0\nv 1,5 0,0 0,0\nv 0,0 1,5 0,0\n" + face, "decimal comma");
}

TEST_F(Hostile, FacesWithInvalidIndices) {
    for (const char* corner : {"0", "4", "-4", "99999999999", "1.5", "x"})
        expect_error("corner.obj", fmt::format("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 {}\n", corner));
    for (const char* corner : {"-1", "3", "4294967295", "1.5", "x"}) {
        expect_error("corner.ply", ply("3", "1", fmt::format("0 0 0\n1 0 0\n0 1 0\n3 0 1 {}\n", corner)));
        expect_error("corner.off", fmt::format("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 {}\n", corner));
        expect_error("corner.wrl", fmt::format("#VRML V2.0 utf8\nShape {{ geometry IndexedFaceSet {{ coord "
                                               "Coordinate {{ point [ 0 0 0 1 0 0 0 1 0 ] }} coordIndex "
                                               "[ 0 1 {} ] }} }}\n",
                                               corner));
    }
}

// ---- shapes that are not solids ----

std::string obj(const std::vector<dvec3>& positions, const std::vector<std::vector<int>>& faces) {
    std::string text;
    for (dvec3 p : positions) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
    for (const std::vector<int>& face : faces) {
        text += "f";
        for (const int corner : face) text += fmt::format(" {}", corner + 1);
        text += "\n";
    }
    return text;
}

std::string obj(const Mesh& mesh, double size = 1, dvec3 move = dvec3(0)) {
    std::vector<dvec3> positions;
    for (vec3 p : mesh.positions) positions.push_back(size * dvec3(p) + move);
    std::vector<std::vector<int>> faces;
    for (uvec3 t : mesh.triangles) faces.push_back({int(t.x), int(t.y), int(t.z)});
    return obj(positions, faces);
}

TEST_F(Hostile, ShapesWithoutAnInside) {
    const std::vector<std::vector<int>> three{{0, 1, 2}}, four{{0, 1, 2}, {1, 3, 2}};
    expect_error("triangle.obj", obj({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, three));
    expect_error("line.obj", obj({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, four));
    expect_error("point.obj", obj({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, four));
    std::vector<dvec3> sheet;
    std::vector<std::vector<int>> quads;
    for (int j = 0; j < 30; ++j)
        for (int i = 0; i < 30; ++i) {
            sheet.push_back({0.01 * i, 0.01 * j, 0});
            if (i > 0 && j > 0)
                quads.push_back({30 * j + i - 31, 30 * j + i - 30, 30 * j + i, 30 * j + i - 1});
        }
    expect_error("sheet.obj", obj(sheet, quads));
    std::vector<dvec3> band;
    quads.clear();
    for (int i = 0; i < 60; ++i) {
        const double angle = 2 * M_PI * i / 60;
        for (const double side : {-0.02, 0.02}) {
            const double radius = 0.1 + side * std::cos(angle / 2);
            band.push_back({radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2)});
        }
        const int a = 2 * i, c = (a + 2) % 120;
        quads.push_back(i < 59 ? std::vector{a, a + 1, c + 1, c} : std::vector{a, a + 1, 0, 1});
    }
    expect_error("moebius.obj", obj(band, quads));
}

TEST_F(Hostile, ExtremeSizesAndPlaces) {
    for (const double size : {1e-20, 1e-6, 1e6, 1e30}) expect_solid("size.obj", obj(ball, size));
    const double millimetre = 0.01;  // of a ball 100 mm long
    expect_solid("far.obj", obj(ball, millimetre, {1e6, -1e6, 1e6}));
    EXPECT_NE(output.find("note: "), std::string::npos) << output;
}

TEST_F(Hostile, AFanOfFiveThousandFacesAndAPolygonOfTwentyThousandCorners) {
    const auto ring = [](int n, double z) {
        std::vector<dvec3> points;
        for (int i = 0; i < n; ++i)
            points.push_back({0.1 * std::cos(2 * M_PI * i / n), 0.1 * std::sin(2 * M_PI * i / n), z});
        return points;
    };
    std::vector<dvec3> cone = ring(5000, 0);
    cone.push_back({0, 0, 0.1});
    std::vector<std::vector<int>> faces(1);
    for (int i = 0; i < 5000; ++i) {
        faces[0].insert(faces[0].begin(), i);
        faces.push_back({i, (i + 1) % 5000, 5000});
    }
    expect_solid("fan.obj", obj(cone, faces));

    constexpr int n = 20'000;
    std::vector<dvec3> drum = ring(n, 0), top = ring(n, 0.1);
    drum.insert(drum.end(), top.begin(), top.end());
    faces.assign(2, {});
    for (int i = 0; i < n; ++i) {
        faces[0].push_back(n - 1 - i);
        faces[1].push_back(n + i);
        faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    expect_solid("drum.obj", obj(drum, faces));
}

// ---- volumes ----

std::string nrrd(const std::string& sizes, const std::string& type, const std::string& data,
                 const std::string& more = "") {
    return "NRRD0004\ntype: " + type + "\ndimension: 3\nsizes: " + sizes +
           "\nendian: little\nencoding: raw\n" + more + "\n" + data;
}

std::string mha(const std::string& sizes, const std::string& data, const std::string& more = "") {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = " +
           sizes + "\n" + more + "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + data;
}

// A ball of 200 in a box of 10, 16 voxels wide.
std::string voxels() {
    std::string bytes;
    for (int z = 0; z < 16; ++z)
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) bytes += char(glm::length(dvec3(x, y, z) - 7.5) < 5 ? 200 : 10);
    return bytes;
}

TEST_F(Hostile, Volumes) {
    const std::string good = voxels();
    expect_solid("good.nrrd", nrrd("16 16 16", "uint8", good));
    expect_solid("good.mha", mha("16 16 16", good));
    expect_error("terabyte.nrrd", nrrd("10000 10000 10000", "uint8", good));
    expect_error("terabyte.mha", mha("10000 10000 10000", good));
    for (const std::string extension : {".nrrd", ".mha", ".nii", ".nii.gz", ".dcm"}) {
        expect_error("empty" + extension, "");
        expect_error("noise" + extension, good);
        expect_error("nul" + extension, std::string(10'000, '\0'));
    }
    expect_error("cut.nrrd", nrrd("16 16 16", "uint8", good.substr(0, 3000)));
    expect_error("cut.mha", mha("16 16 16", good.substr(0, 3000)));
    expect_error("zero.nrrd", nrrd("0 16 16", "uint8", good));
    expect_error("negative.mha", mha("-16 16 16", good));
    expect_error("nan.nrrd", nrrd("8 8 8", "float", std::string(2048, '\xff')));
    expect_error("spacing.mha", mha("16 16 16", good, "ElementSpacing = 0 1 nan\n"));
    expect_error("flat.nrrd", nrrd("16 16 16", "uint8", std::string(4096, 'x')));
}

// What a file leaves out is assumed, and reported wherever it is read.
TEST_F(Hostile, AssumptionsAboutAVolumeAreReported) {
    const std::string name = (scratch / "bare.nrrd").string(), note = "it states no spacing: 1 mm is assumed";
    write_text(name, nrrd("16 16 16", "uint8", voxels()));
    for (const std::string& arguments : {"info " + name, "info --json " + name,
                                         "import " + name + " -o " + (scratch / "out.ply").string()}) {
        const Outcome outcome = palpate(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.output;
        EXPECT_NE(outcome.output.find(note), std::string::npos) << outcome.output;
    }
    write_text(scratch / "scene.toml",
               "[[body]]\nname = \"ball\"\nvolume = \"bare.nrrd\"\nyoungs_modulus = 5000\ndensity = 1000\n"
               "nodes = 100\n");
    const Outcome run = palpate("run " + (scratch / "scene.toml").string() + " --steps 1 --report " +
                                (scratch / "report.json").string());
    EXPECT_EQ(run.status, 0) << run.output;
    EXPECT_NE(run.output.find("note: body ball: " + note), std::string::npos) << run.output;
    EXPECT_NE(read_text(scratch / "report.json").find("body ball: " + note), std::string::npos);
}

TEST_F(Hostile, MemoryIsBounded) {
    for (const std::string extension : extensions) import("good" + extension, file_of(ball, extension));
    rusage used{};
    getrusage(RUSAGE_CHILDREN, &used);  // the largest of all commands so far
    EXPECT_LT(used.ru_maxrss / 1024, 600) << "MB";
}

}  // namespace
}  // namespace palpate
