// The palpate command: its output, its exit status, and the files it leaves behind.
#include "tests/app/command.h"

#include "palpate/base/files.h"
#include "palpate/base/pipe.h"
#include "palpate/body/tissues.h"
#include "palpate/files/write.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace palpate {
namespace {

const std::string brain = "/usr/share/mricron/templates/ch2bet.nii.gz";
bool have_brain() { return std::filesystem::exists(brain); }

TEST(Command, UsageErrorsEndWithTwo) {
    for (const char* arguments : {"",
                                  "fly",
                                  "run --headless",
                                  "run --frames 3",
                                  "run --set body.1.nodes=5",
                                  "run box --frames many",
                                  "run box --size 12",
                                  "run box --fast",
                                  "list",
                                  "import x.ply",
                                  "run box --frames 1 --steps 1",
                                  "run box --until-rest soon",
                                  "run box --until-rest none",
                                  "run box --until-rest --frames 3",
                                  "run box --threads 0",
                                  "run box --threads many",
                                  "run box --threads 1000",
                                  "run box --steps -5",
                                  "run box --frames -1",
                                  "run box --frames nan",
                                  "run box --image-every 1",
                                  "run box --images x --image-every nan",
                                  "run box --images x --image-every inf",
                                  "run box --images x --image-every 0",
                                  "run box --sequence-every 1",
                                  "run box --size 100000x100000",
                                  "run box --size 0x5",
                                  "run box --size 1.5x2",
                                  "import x.ply -o y.ply --weld nan",
                                  "import x.ply -o y.ply --rotate 0 nan 0",
                                  "import x.ply -o y.ply --size inf",
                                  "import x.ply -o y.ply --iso nan",
                                  "bench lattice --plot x.svg",
                                  "bench sing",
                                  "bench embed --rounds 0",
                                  "doctor me"})
        EXPECT_EQ(palpate(arguments).status, 2) << arguments;
    EXPECT_NE(palpate("run box --size 100000x100000").output.find("not from 1 to 16384 pixels"),
              std::string::npos);
    EXPECT_NE(palpate("import x.ply -o y.ply --units metre").output.find("did you mean m?"),
              std::string::npos);
    EXPECT_EQ(palpate("--help").status, 0);
    const Outcome version = palpate("--version");
    EXPECT_EQ(version.status, 0);
    EXPECT_TRUE(version.output.starts_with("palpate ")) << version.output;
    EXPECT_NE(version.output.find_first_of("0123456789"), std::string::npos) << version.output;
    EXPECT_EQ(palpate("run --help").status, 0);
}

TEST(Command, ListsWhatThereIs) {
    EXPECT_NE(palpate("list integrators").output.find("verlet"), std::string::npos);
    EXPECT_NE(palpate("list backends").output.find("reference"), std::string::npos);
    EXPECT_NE(palpate("list mappings").output.find("trilinear"), std::string::npos);
    EXPECT_NE(palpate("list devices").output.find("script"), std::string::npos);
    EXPECT_NE(palpate("list scenes").output.find("brain"), std::string::npos);
    const std::string listed = "\n" + palpate("list tissues").output;
    for (const Tissue& one : tissues())
        EXPECT_NE(listed.find(fmt::format("\n{} ", one.name)), std::string::npos) << one.name;
}

TEST(Command, RunsAndReports) {
    Scratch scratch;
    const Outcome outcome = palpate("run box --frames 30 --report " + (scratch / "r.json").string());
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("nodes, cells"), std::string::npos);
    EXPECT_NE(read_text(scratch / "r.json").find("\"diverged\": false"), std::string::npos);
}

TEST(Command, RunsAMeshOrAVolume) {
    Scratch scratch;
    write_mesh(ellipsoid(vec3(50, 40, 60), 10), scratch / "a \"ball\".ply");
    std::string voxels = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 12 12 12\nencoding: raw\n\n";
    for (int i = 0; i < 12 * 12 * 12; ++i)
        voxels += char(glm::length(vec3(i % 12, i / 12 % 12, i / 144) - 5.5f) < 4 ? 200 : 10);
    write_text(scratch / "ball.nrrd", voxels);
    for (const char* file : {"a \"ball\".ply", "ball.nrrd"}) {
        const Outcome outcome =
            palpate("run '" + (scratch / file).string() + "' --frames 2 --set body.it.nodes=300 --report " +
                    (scratch / "r.json").string());
        EXPECT_EQ(outcome.status, 0) << outcome.output;
        const auto report = nlohmann::json::parse(read_text(scratch / "r.json"));
        EXPECT_EQ(report["bodies"][0]["name"], "it");
        EXPECT_GT(report["bodies"][0]["nodes"], 200);
    }
    expect_one_line(palpate("run '" + (scratch / "ball.xyz").string() + "' --frames 2"),
                    {"ball.xyz", "no such"});
    write_text(scratch / "ball.xyz", "0 0 0");
    expect_one_line(palpate("run '" + (scratch / "ball.xyz").string() + "' --frames 2"),
                    {"ball.xyz", ".toml"});
    expect_one_line(palpate("run '" + (scratch / ".").string() + "' --frames 2"), {"no DICOM"});
    // Without a display it names a remedy.
    for (const std::string& file : {std::string(), "'" + (scratch / "ball.nrrd").string() + "'"})
        expect_one_line(shell("env -u DISPLAY -u WAYLAND_DISPLAY " PALPATE_COMMAND " run " + file),
                        {"--headless"});
}

TEST(Command, InfoReportsPercentiles) {
    Scratch scratch;
    std::string voxels = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 10 10 10\nencoding: raw\n\n";
    for (int i = 0; i < 1000; ++i) voxels += char(i < 700 ? 0 : i % 250);
    write_text(scratch / "v.nrrd", voxels);
    const auto about =
        nlohmann::json::parse(palpate("info --json " + (scratch / "v.nrrd").string()).output)["percentiles"];
    EXPECT_EQ(about["25"], 0);
    EXPECT_EQ(about["50"], 0);
    EXPECT_EQ(about["99"], 244);  // the 990th: 245 to 249 come twice each
}

TEST(Command, TheSameNodesOnAnyNumberOfThreads) {
    Scratch scratch;
    for (int threads : {1, 2, 3})
        EXPECT_EQ(palpate(fmt::format("run nodule --frames 20 --threads {} --nodes {}", threads,
                                      (scratch / fmt::format("{}.csv", threads)).string()))
                      .status,
                  0);
    EXPECT_EQ(read_text(scratch / "1.csv"), read_text(scratch / "2.csv"));
    EXPECT_EQ(read_text(scratch / "1.csv"), read_text(scratch / "3.csv"));
}

TEST(Command, BenchRuns) {
    Scratch scratch;
    const Outcome outcome = palpate("bench lattice --rounds 1 --json " + (scratch / "b.json").string());
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    EXPECT_NE(outcome.output.find("| 27³, springs in a table |"), std::string::npos) << outcome.output;
    EXPECT_NE(read_text(scratch / "b.json").find("links_per_second"), std::string::npos);
}

// The doctor's report with these environment variables; it always exits with 0.
nlohmann::json diagnosis(const std::string& variables) {
    const Outcome outcome = shell("{ " + variables + " " PALPATE_COMMAND " doctor --json; } 2>/dev/null");
    EXPECT_EQ(outcome.status, 0) << outcome.output;
    return nlohmann::json::parse(outcome.output, nullptr, false);
}

TEST(Command, TheDoctorChecksEveryPart) {
    const nlohmann::json found = diagnosis("PALPATE_DATA=/");
    for (const char* part :
         {"opengl", "reference", "cpu", "feedback", "fragment", "compute", "mapping", "films", "data"}) {
        ASSERT_TRUE(found.contains(part)) << part << found;
        EXPECT_EQ(found[part]["ok"], found[part]["problem"] == "") << part << found;
    }
    for (const char* part : {"reference", "cpu", "data"}) EXPECT_TRUE(found[part]["ok"]) << found[part];
    EXPECT_FALSE(diagnosis("PALPATE_DATA=/no-such-folder")["data"]["ok"]);
    const Outcome text = palpate("doctor");
    EXPECT_EQ(text.status, 0);
    EXPECT_NE(text.output.find("reference"), std::string::npos) << text.output;
    if (!found["opengl"]["ok"]) GTEST_SKIP() << "OpenGL is not available";
    const std::string renderer = found["driver"]["renderer"];
    EXPECT_NE(text.output.find(renderer), std::string::npos) << text.output;
    EXPECT_TRUE(found["driver"]["software"].is_boolean());
    for (const char* part : {"feedback", "fragment", "compute", "mapping"})
        EXPECT_FALSE(found[part]["needs"].empty()) << part;
    EXPECT_TRUE(found["mapping"]["ok"]) << found["mapping"];
}

TEST(Command, TheDoctorReportsWhatIsMissing) {
    for (const char* variables :
         {"__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere.json", "LIBGL_DRIVERS_PATH=/nowhere"}) {
        const nlohmann::json found = diagnosis(variables);
        EXPECT_FALSE(found["opengl"]["ok"]) << found;
        EXPECT_TRUE(found["driver"].is_null()) << found;
        EXPECT_NE(found["opengl"]["problem"].dump().find("; install libegl1"), std::string::npos) << found;
        for (const char* part : {"feedback", "fragment", "compute", "mapping"})
            EXPECT_FALSE(found[part]["ok"]) << found;
        EXPECT_TRUE(found["cpu"]["ok"]) << found;
    }
    if (!diagnosis("")["driver"].value("software", false))
        GTEST_SKIP() << "Mesa's software driver is not available";
    const std::string old = diagnosis("MESA_GL_VERSION_OVERRIDE=3.3")["opengl"]["problem"];
    EXPECT_NE(old.find("version 3.3, but 4.5 core is needed in OpenGL; update"), std::string::npos) << old;
}

TEST(Command, RunsUntilRest) {
    for (const char* arguments : {"run box --until-rest", "run box --until-rest speed"}) {
        const Outcome outcome = palpate(std::string(arguments) + " --set body.beam.damping=20");
        EXPECT_EQ(outcome.status, 0) << outcome.output;
        EXPECT_NE(outcome.output.find(", then at rest"), std::string::npos) << outcome.output;
    }
    const Outcome one = palpate("run box --until-rest move");
    EXPECT_NE(one.output.find("in 1 frames, then at rest"), std::string::npos) << one.output;
}

TEST(Command, BadScenes) {
    Scratch scratch;
    expect_one_line(palpate("run no-such-scene"), {"no-such-scene", "brain"});
    expect_one_line(palpate("run box --integrator rk9"), {"rk9", "verlet"});
    expect_one_line(palpate("run box --set body.beam.nods=3"), {"nods", "nodes"});
    write_text(
        scratch / "bad.toml",
        "[[body]]\nname = \"a\"\nvolume = \"missing.nii\"\niso = 1\nyoungs_modulus = 1\ndensity = 1\n");
    expect_one_line(palpate("run --headless " + (scratch / "bad.toml").string()),
                    {"missing.nii", "PALPATE_DATA"});
    write_text(scratch / "bad.toml", "[[body]]\nname = \"a\"\nnods = 3\n");
    expect_one_line(palpate("run --headless " + (scratch / "bad.toml").string()),
                    {"bad.toml", "line 3", "nods", "nodes"});
    expect_one_line(palpate("run --headless " + (scratch / ".").string()), {"DICOM", "folder"});
    expect_one_line(palpate("run box --headless --set simulation.step=0.5"), {"verlet", "--force"});
}

TEST(Command, DivergenceIsReported) {
    Scratch scratch;
    const Outcome outcome =
        palpate("run box --set simulation.step=0.0165 --force --report " + (scratch / "r.json").string());
    EXPECT_EQ(outcome.status, 1);
    EXPECT_NE(outcome.output.find("blew up"), std::string::npos) << outcome.output;
    EXPECT_NE(read_text(scratch / "r.json").find("\"diverged\": true"), std::string::npos);
}

TEST(Command, BadMeshesAndVolumes) {
    Scratch scratch;
    const std::string out = " -o " + (scratch / "out.ply").string();
    auto refuse = [&](const std::string& name, const std::string& content, const std::string& more = "") {
        write_text(scratch / name, content);
        expect_one_line(palpate("import " + (scratch / name).string() + out + more), {name});
        expect_one_line(palpate("info " + (scratch / name).string()), {name});
    };
    const std::string header = "ply\nformat ascii 1.0\nelement vertex ";
    const std::string rest =
        "\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    refuse("empty.ply", "");
    refuse("words.ply", "this is not a mesh\n");
    refuse("lying.ply", header + "1099511627776" + rest + "0 0 0\n");
    refuse("nan.ply", header + "3" + rest + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n");
    refuse("missing-vertex.ply", header + "3" + rest + "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
    refuse("truncated.ply", header + "3" + rest + "0 0 0\n1 0");
    refuse("empty.obj", "");
    refuse("empty.nii", "", " --iso 1");
    refuse("empty.nii.gz", "", " --iso 1");
    refuse("words.nii", std::string(400, 'x'), " --iso 1");
    expect_one_line(palpate("import " + (scratch / "none.ply").string() + out), {"none.ply"});
    expect_one_line(palpate("import " + (scratch / "a.xyz").string() + out), {"a.xyz"});
    write_mesh(block(vec3(0), vec3(0.1f)), scratch / "block.obj");
    EXPECT_EQ(palpate("import " + (scratch / "block.obj").string() + out + " --iso 3").status, 2);
    EXPECT_EQ(palpate("import " + (scratch / "block.obj").string() + out + " --size 1 --units mm").status, 2);
    EXPECT_EQ(palpate("import " + (scratch / "block.obj").string() + out + " --solid clay").status, 2);
    EXPECT_FALSE(std::filesystem::exists(scratch / "out.ply"));
    if (!have_brain()) GTEST_SKIP() << "mricron-data is not available";
    refuse("truncated.nii.gz", read_text(brain).substr(0, 500'000), " --iso 60.5");
    expect_one_line(palpate("import " + brain + out + " --iso 999"), {"ch2bet", "999"});
    EXPECT_FALSE(std::filesystem::exists(scratch / "out.ply"));
}

TEST(Command, ImportsABrain) {
    if (!have_brain()) GTEST_SKIP() << "mricron-data is not available";
    Scratch scratch;
    const std::string out = (scratch / "brain.ply").string();
    const Outcome made =
        palpate("import " + brain + " -o " + out + " --iso 60.5 --largest --faces 140000 --rotate -90 0 0");
    EXPECT_EQ(made.status, 0) << made.output;
    const Outcome info = palpate("info --json " + out);
    EXPECT_EQ(info.status, 0) << info.output;
    for (const char* fact : {"\"parts\": 1,", "\"open_edges\": 0,", "\"bad_edges\": 0,"})
        EXPECT_NE(info.output.find(fact), std::string::npos) << info.output;
}

TEST(Command, AFullDiskLeavesNothing) {
    // A limit on the size of files stands for a full disk: writing fails in the same way.
    Scratch scratch;
    write_mesh(ellipsoid(vec3(0.05f), 60), scratch / "ball.ply");
    const std::string limited = "trap '' XFSZ; ulimit -f 8; " + std::string(PALPATE_COMMAND) + " ";
    expect_one_line(shell(limited + "import " + (scratch / "ball.ply").string() + " -o " +
                          (scratch / "out.ply").string()),
                    {"out.ply", "disk"});
    expect_one_line(shell(limited + "run box --frames 2 --nodes " + (scratch / "nodes.csv").string()),
                    {"nodes.csv", "disk"});
    for (const char* name : {"s.glb", "s.mdd"})
        expect_one_line(shell(limited + "run box --frames 60 --sequence " + (scratch / name).string()),
                        {name, "disk"});
    EXPECT_EQ(scratch.entries(), 1u);
}

TEST(Command, AFilmThatFailsLeavesNothing) {
    if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not available";
    Scratch scratch;
    const Outcome outcome = shell("trap '' XFSZ; ulimit -f 8; " + std::string(PALPATE_COMMAND) +
                                  " run box --frames 30 --video " + (scratch / "film.mp4").string());
    if (outcome.output.find("OpenGL") != std::string::npos) GTEST_SKIP() << "OpenGL is not available";
    expect_one_line(outcome, {"ffmpeg"});
    EXPECT_EQ(scratch.entries(), 0u);
    // A name that ffmpeg would take for a protocol, and a failure of another output beside a film.
    EXPECT_EQ(shell("cd " + (scratch / ".").string() + "; " + PALPATE_COMMAND +
                    " run box --frames 2 --video 12:30.mp4 >o")
                  .status,
              0);
    write_text(scratch / "file", "");
    expect_one_line(palpate("run box --frames 2 --video " + (scratch / "f.mp4").string() + " --images " +
                            (scratch / "file").string()),
                    {"file"});
    EXPECT_EQ(scratch.entries(), 3u);
}

TEST(Command, BadOutputsAreReported) {
    Scratch scratch;
    EXPECT_EQ(shell(std::string(PALPATE_COMMAND) + " list scenes 2>/dev/null >/dev/full").status, 1);
    expect_one_line(palpate("run box --surface " + (scratch / "out.xyz").string()), {"out.xyz", ".ply"});
    expect_one_line(palpate("run box --sequence " + (scratch / "out.gltf").string()), {"out.gltf", ".glb"});
    expect_one_line(palpate("run box --report " + (scratch / ".").string()), {"folder"});
    std::filesystem::create_symlink("/dev/null",
                                    scratch / "null");  // a link, so that no bug can hurt the device
    EXPECT_EQ(palpate("run box --frames 1 --report " + (scratch / "null").string()).status, 0);
    EXPECT_TRUE(std::filesystem::is_symlink(scratch / "null"));
}

// An output's name must have the extension of its format, and no folder is made for it.
TEST(Command, OutputsNeedTheirExtension) {
    Scratch scratch;
    auto in = [&](const std::string& name) { return (scratch / name).string(); };
    expect_one_line(palpate("run nodule --plot " + in("x.png")), {"x.png", "x.svg"});
    expect_one_line(palpate("run box --video " + in("x.gif")), {"x.gif", "x.mp4"});
    expect_one_line(palpate("run box --nodes " + in("x.png")), {"x.png", "x.csv"});
    expect_one_line(palpate("run box --report " + in("x.csv")), {"x.csv", "x.json"});
    expect_one_line(palpate("run box --sequence " + in("x.mp4")), {"x.mp4", ".glb"});
    expect_one_line(palpate("run box --plot " + in("x.svg")), {"no tool", "[[tool]]"});
    expect_one_line(palpate("run nodule --plot " + in("none/y.svg")), {"no folder", "none", "make it first"});
    expect_one_line(palpate("run box --images " + in("none/deep")), {"no folder", "none"});
    write_mesh(block(vec3(0), vec3(0.1f)), scratch / "block.obj");
    expect_one_line(palpate("import " + in("block.obj") + " -o " + in("none/y.ply")),
                    {"none", "make it first"});
    expect_one_line(palpate("import " + in("block.obj") + " -o " + in("y.ply") + " --report " + in("r.csv")),
                    {"r.csv", "r.json"});
    expect_one_line(palpate("bench cloth --json " + in("b.csv")), {"b.csv", "b.json"});
    if (std::filesystem::is_directory("/proc"))
        expect_one_line(palpate("run box --report /proc/report.json"), {"/proc/report.json", "written to"});
    EXPECT_EQ(scratch.entries(), 1u);
    EXPECT_EQ(palpate("run box --frames 1 --report " + in("R.JSON")).status, 0);
    expect_one_line(palpate("run box --frames 1 --nodes " + in("nodes")), {"no extension", "nodes.csv"});
    expect_one_line(palpate("run box --video " + in("v")), {"no extension", "v.mp4"});
    expect_one_line(palpate("bench cloth --json " + in("b")), {"no extension", "b.json"});
    if (std::filesystem::is_directory("/proc"))
        expect_one_line(palpate("run box --images /proc"), {"/proc", "written to"});
}

TEST(Command, NoOutputReplacesAnInput) {
    Scratch scratch;
    auto in = [&](const std::string& name) { return (scratch / name).string(); };
    write_mesh(block(vec3(0), vec3(0.1f)), scratch / "k.ply");
    for (const char* name : {"z-0001.ply", "m.obj"}) write_mesh(block(vec3(0), vec3(0.1f)), scratch / name);
    std::filesystem::create_symlink("k.ply", scratch / "link.ply");
    write_text(scratch / "path.csv", "0, 0, 0.1, 0\n1, 0, 0, 0\n");
    write_text(scratch / "s.toml",
               "[[body]]\nname = \"b\"\nsurface = \"k.ply\"\nnodes = 50\nyoungs_modulus = 5000\ndensity = "
               "1000\n[[tool]]\npath = \"path.csv\"\n");
    std::filesystem::create_symlink("s.toml", scratch / "s.json");
    const std::string before = read_text(scratch / "k.ply");
    for (const std::string& arguments :
         {"run " + in("k.ply") + " --frames 1 --surface " + in("k.ply"),
          "run " + in("s.toml") + " --frames 1 --surface " + in("k.ply"),
          "run " + in("s.toml") + " --frames 1 --surface " + in("link.ply"),
          "run " + in("s.toml") + " --frames 1 --nodes " + in("path.csv"),
          "run " + in("s.toml") + " --frames 1 --report " + in("s.json"),
          "run " + in("z-0001.ply") + " --frames 1 --sequence " + in("z.ply"),
          "run " + in("m.obj") + " --frames 1 --sequence " + in("m.pc2"),
          "import " + in("k.ply") + " -o " + in("link.ply"), "import " + in("k.ply") + " -o " + in("k.ply")})
        expect_one_line(palpate(arguments), {"an input of the run would be replaced", "name another file"});
    EXPECT_EQ(read_text(scratch / "k.ply"), before);
    EXPECT_EQ(scratch.entries(), 7u);
    // A name that only resembles an input's is written, and files that are not inputs are replaced.
    for (int i = 0; i < 2; ++i)
        EXPECT_EQ(palpate("run " + in("s.toml") + " --frames 1 --sequence " + in("k.ply")).status, 0);
    EXPECT_EQ(read_text(scratch / "k.ply"), before);
}

TEST(Command, AnEmptyValueIsRefused) {
    for (const char* arguments : {"run box --frames 1 --report ''", "run box --frames 1 --images ''",
                                  "run box --frames 1 --backend ''", "run ''", "import x.ply -o ''",
                                  "import x.ply -o y.ply --units ''", "bench cloth --json ''"}) {
        const Outcome outcome = palpate(arguments);
        EXPECT_EQ(outcome.status, 2) << arguments << outcome.output;
        EXPECT_NE(outcome.output.find("the value is empty"), std::string::npos)
            << arguments << outcome.output;
    }
}

TEST(Command, SuggestsTheNearestName) {
    expect_one_line(palpate("run brian --frames 1"), {"did you mean brain?"});
    EXPECT_NE(palpate("run box --fames 5").output.find("did you mean --frames?"), std::string::npos);
    EXPECT_NE(palpate("run box --fames=5").output.find("did you mean --frames?"), std::string::npos);
    EXPECT_NE(palpate("lst").output.find("did you mean list?"), std::string::npos);
    EXPECT_NE(palpate("list scene").output.find("did you mean scenes?"), std::string::npos);
    EXPECT_NE(palpate("foo").output.find("foo is not one of run, import, info, list"), std::string::npos);
}

TEST(Command, AFilmThatIsTooSmallIsRefused) {
    Scratch scratch;
    const std::string film = (scratch / "one.mp4").string();
    for (const char* size : {"1x1", "15x40", "40x15"})
        expect_one_line(palpate(std::string("run box --frames 1 --video ") + film + " --size " + size),
                        {"too small", "--size 16x16"});
    EXPECT_EQ(scratch.entries(), 0u);
}

TEST(Command, OptionsWithoutEffectAreReported) {
    EXPECT_NE(palpate("run box --frames 1 --lattice").output.find("note: --lattice changes nothing"),
              std::string::npos);
    EXPECT_NE(palpate("run box --frames 1 --size 99x99").output.find("note: --size changes nothing"),
              std::string::npos);
    EXPECT_NE(palpate("run box --frames 1 --force").output.find("note: --force changes nothing"),
              std::string::npos);
    EXPECT_EQ(palpate("run box --frames 1").output.find("note:"), std::string::npos);
}

TEST(Command, InfoNamesSizesInMetres) {
    Scratch scratch;
    write_mesh(block(vec3(0), vec3(50, 100, 200)), scratch / "block.ply");
    const Outcome metres = palpate("info " + (scratch / "block.ply").string());
    EXPECT_NE(metres.output.find("unit right"), std::string::npos) << metres.output;
    const Outcome millimetres = palpate("info --units mm " + (scratch / "block.ply").string());
    EXPECT_NE(millimetres.output.find("0.05 x 0.1 x 0.2"), std::string::npos) << millimetres.output;
    EXPECT_EQ(millimetres.output.find("unit right"), std::string::npos) << millimetres.output;
    EXPECT_EQ(palpate("info --units miles " + (scratch / "block.ply").string()).status, 2);
}

TEST(Command, AnInterruptLeavesNothingHalfWritten) {
    if (!has_program("ffmpeg")) GTEST_SKIP() << "ffmpeg is not available";
    Scratch scratch;
    const std::string film = (scratch / "film.mp4").string();
    for (const char* signal : {"TERM", "INT", "HUP"}) {
        // Stopped as soon as the film has begun.
        const Outcome outcome =
            shell(fmt::format("{} run box --video {} & while kill -0 $! && [ ! -s {}.part$! ]; do sleep "
                              "0.05; done; kill -{} $!; wait $!",
                              PALPATE_COMMAND, film, film, signal));
        EXPECT_GT(outcome.status, 128) << outcome.output;
        EXPECT_EQ(scratch.entries(), 0u) << signal;
    }
}

}  // namespace
}  // namespace palpate
