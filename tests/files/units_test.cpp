// Units that files state themselves, and 3MF, which always does.
#include "palpate/base/files.h"
#include "palpate/files/read.h"
#include "tests/files/collada.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"
#include "tests/threemf.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr vec3 brick(2, 3, 5);

void expect_size(const Mesh& mesh, vec3 size, double of_volume) {
    EXPECT_LE(glm::distance(bounds(mesh).size(), size), 1e-5f * glm::length(size)) << bounds(mesh).size().x;
    EXPECT_LE(std::abs(volume(mesh) / of_volume - 1), 1e-4);
}

void expect_brick_of(const Mesh& mesh, double metre) {
    expect_size(mesh, float(metre) * brick, 30 * metre * metre * metre);
}

// ---- 3MF ----

const std::string one = "<object id='1' type='model'>" + mesh_of_3mf(box(vec3(0), brick)) + "</object>",
                  built = "<item objectid='1'/>";

std::string archive(const std::string& text) { return zipped({{"3D/3dmodel.model", text}}); }
Mesh parse(const std::string& text, std::vector<std::string>* notes = nullptr) {
    return parse_mesh(archive(text), "a.3mf", {}, notes);
}
std::string refused(const std::string& text) { return parse_error("a.3mf", archive(text)); }

TEST(ThreeMf, ItsUnit) {
    for (auto [name, metre] : {std::pair("micron", 1e-6),
                               {"millimeter", 1e-3},
                               {"centimeter", 1e-2},
                               {"inch", 0.0254},
                               {"foot", 0.3048},
                               {"meter", 1.0}})
        expect_brick_of(parse(model(one, built, fmt::format("unit='{}'", name))), metre);
    expect_brick_of(parse(model(one, built)), 1e-3);  // where it does not say
    EXPECT_HAS(refused(model(one, built, "unit='cubit'")), "unknown unit \"cubit\"");
    std::vector<std::string> notes;
    expect_brick_of(parse_mesh(archive(model(one, built)), "a.3mf", Units::centimetres, &notes), 1e-2);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "read in cm as asked, though the file says that its unit is 0.001 m");
}

TEST(ThreeMf, PartsStandWhereTheirTransformsSay) {
    // Turned by 90 degrees about z, moved by 10 along x, and twice; then mirrored as a whole.
    const std::string parts =
        "<object id='2'><components><component objectid='1' transform='0 1 0 -1 0 0 0 0 1 10 0 0'/>"
        "<component objectid='1'/></components></object>";
    const Mesh mesh = parse(model(one + parts, "<item objectid='2' transform='1 0 0 0 1 0 0 0 -2 0 0 0'/>"));
    EXPECT_EQ(mesh.triangles.size(), 24u);
    EXPECT_LE(glm::distance(bounds(mesh).low, vec3(0, 0, -0.010f)), 1e-8f);
    EXPECT_LE(glm::distance(bounds(mesh).high, vec3(0.010f, 0.003f, 0)), 1e-8f);
    EXPECT_LE(std::abs(volume(mesh) - 120e-9), 1e-13);
    EXPECT_HAS(refused(model(one, "<item objectid='1' transform='1 0 0'/>")), "not 12 numbers in line 2");
    EXPECT_HAS(refused(model(one, "<item objectid='7'/>")), "\"7\" that is missing");
    EXPECT_HAS(
        refused(model("<object id='1'><components><component objectid='1'/></components></object>", built)),
        "an object that contains itself");
}

TEST(ThreeMf, ObjectsInFilesOfTheirOwn) {
    const std::string root = model(
        "<object id='8'><components><component p:path='/3D/Objects/part 1.model' "
        "objectid='1'/></components></object>",
        "<item objectid='8'/>", "requiredextensions='p'");
    const Mesh mesh =
        parse_mesh(zipped({{"_rels/.rels",
                            "<Relationships><Relationship Target='/3D/other.model' Id='r' "
                            "Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/>"
                            "</Relationships>"},
                           {"3D/other.model", root},
                           {"3D/Objects/part 1.model", model(one, "")}}),
                   "a.3mf");
    expect_brick_of(mesh, 1e-3);
    EXPECT_HAS(refused(root), "no \"3D/Objects/part 1.model\" in the archive");
}

TEST(ThreeMf, SlicesAreNoPartOfAnObject) {
    const std::string slices =
        "<s:slicestack xmlns:s='http://schemas.microsoft.com/3dmanufacturing/slice/2015/07' id='9'>"
        "<s:slice ztop='1'><s:vertices><s:vertex x='90' y='90'/></s:vertices></s:slice></s:slicestack>";
    expect_brick_of(parse(model(one + slices, built)), 1e-3);
    expect_brick_of(parse(model(slices + one, built)), 1e-3);
}

TEST(ThreeMf, PartsThatASlicerTakesOtherwiseAreNoted) {
    const std::string whole = model(one, built);
    for (const auto& [name, text] : {std::pair("Metadata/model_settings.config",
                                               "<config><object id='3'><part id='1' subtype='normal_part'/>"
                                               "<part id='2' subtype='negative_part'/></object></config>"),
                                     {"Metadata/Slic3r_PE_model.config",
                                      "<config><metadata key='volume_type' value='ModelPart'/>"
                                      "<metadata key='volume_type' value='ParameterModifier'/></config>"}}) {
        std::vector<std::string> notes;
        parse_mesh(zipped({{"3D/3dmodel.model", whole}, {name, text}}), "a.3mf", {}, &notes);
        ASSERT_EQ(notes.size(), 1u) << name;
        EXPECT_HAS(notes[0], "read 1 parts like the others");
    }
}

TEST(ThreeMf, WhatIsLeftOutIsSaid) {
    std::vector<std::string> notes;
    const std::string support =
        "<object id='2' type='support'>" + mesh_of_3mf(box(vec3(0), brick)) + "</object>";
    expect_brick_of(parse(model(one + support, built + "<item objectid='2'/>"), &notes), 1e-3);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out 1 support");
    notes.clear();
    expect_brick_of(parse(model(one, ""), &notes), 1e-3);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "read all objects");
    EXPECT_HAS(refused(model(one, built, "requiredextensions='b'")),
               "beamlattice/2017/02\", which is not read");
    EXPECT_HAS(refused(model(one, built, "requiredextensions='zz'")), "\"zz\", which is not read");
}

TEST(ThreeMf, RefusesWhatIsDamaged) {
    const std::string whole = archive(model(one, built));
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(parse_error("a.3mf", whole.substr(0, length)), "") << length;
    EXPECT_HAS(parse_error("a.3mf", zipped({{"x", "y"}})), "no \"3D/3dmodel.model\" in the archive");
    EXPECT_HAS(refused(model("<object id='1'><mesh><vertices/><triangles><triangle v1='0' v2='1' v3='2'/>"
                             "</triangles></mesh></object>",
                             built)),
               "vertex 0 of 0");
    EXPECT_HAS(refused(model(
                   "<object id='1'><mesh><vertices><vertex x='1' y='one' z='2'/></vertices></mesh></object>",
                   built)),
               "y = \"one\" in line 2");
    EXPECT_HAS(refused("<model>"), "damaged or truncated");
    std::string bomb = one, item = "<item objectid='40'/>";
    for (int i = 2; i <= 40; ++i)
        bomb += fmt::format(
            "<object id='{0}'><components><component objectid='{1}'/><component objectid='{1}'/>"
            "</components></object>",
            i, i - 1);
    EXPECT_HAS(refused(model(bomb, item)), "more than the file's size warrants");
    EXPECT_HAS(parse_error("a.stl", whole), "a ZIP archive");
}

TEST(ThreeMf, WhatIsRepeatedIsCountedBeforeItIsMade) {
    std::string components, items;
    for (int i = 0; i < 600; ++i) {
        components += "<component objectid='1'/>";
        items += "<item objectid='2'/>";
    }
    const auto parts = [&](const std::string& of) {
        return of + "<object id='2'><components>" + components + "</components></object>";
    };
    EXPECT_HAS(refused(model(parts("<object id='1' type='support'/>"), items)),
               "more than the file's size warrants");
    // Each component says in which file its object is: here, in one of a long name.
    for (int i = 0; i < 3; ++i) components += components;
    const std::string name(60'000, 'n'), root = "<object id='1'><components><component p:path='/" + name +
                                                "' objectid='2'/></components></object>";
    EXPECT_HAS(parse_error("a.3mf",
                           zipped({{"3D/3dmodel.model", model(root, built)}, {name, model(parts(""), "")}})),
               "more than the file's size warrants");
}

// ---- what assimp reads ----

TEST(StatedUnits, OfCollada) {
    expect_brick_of(parse_mesh(collada("<unit name='cm' meter='0.01'/>"), "a.dae"), 1e-2);
    expect_brick_of(parse_mesh(collada(""), "a.dae"), 1);
    // Asked for once, and not applied twice.
    std::vector<std::string> notes;
    expect_brick_of(parse_mesh(collada("<unit meter='0.01'/>"), "a.dae", Units::centimetres, &notes), 1e-2);
    EXPECT_TRUE(notes.empty());
    expect_brick_of(parse_mesh(collada("<unit meter='0.01'/>"), "a.dae", Units::millimetres, &notes), 1e-3);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "its unit is 0.01 m");
}

TEST(StatedUnits, OfAmf) {
    const auto amf = [](const std::string& attributes) {
        std::string text =
            "<?xml version='1.0' encoding='utf-8'?><amf " + attributes + "><object id='0'><mesh><vertices>";
        const Mesh mesh = box(vec3(0), brick);
        for (vec3 p : mesh.positions)
            text += fmt::format("<vertex><coordinates><x>{}</x><y>{}</y><z>{}</z></coordinates></vertex>",
                                p.x, p.y, p.z);
        text += "</vertices><volume>";
        for (uvec3 t : mesh.triangles)
            text += fmt::format("<triangle><v1>{}</v1><v2>{}</v2><v3>{}</v3></triangle>", t.x, t.y, t.z);
        return text + "</volume></mesh></object></amf>";
    };
    for (auto [name, metre] :
         {std::pair("millimeter", 1e-3), {"inch", 0.0254}, {"meter", 1.0}, {"micron", 1e-6}})
        expect_brick_of(parse_mesh(amf(fmt::format("unit='{}'", name)), "a.amf"), metre);
    expect_brick_of(parse_mesh(amf("version='1.1'"), "a.amf"), 1e-3);
    EXPECT_HAS(parse_error("a.amf", amf("unit='cubit'")), "cubit");
}

// assimp turns what is up along z up along y.
TEST(StatedUnits, OfDxf) {
    const auto dxf = [](const std::string& header) {
        std::string text = "0\nSECTION\n2\nHEADER\n" + header + "0\nENDSEC\n0\nSECTION\n2\nENTITIES\n";
        const Mesh mesh = box(vec3(0), brick);
        for (uvec3 t : mesh.triangles) {
            text += "0\n3DFACE\n8\n0\n";
            for (int k = 0; k < 4; ++k) {
                const vec3 p = mesh.positions[t[std::min(k, 2)]];
                text += fmt::format("{}\n{}\n{}\n{}\n{}\n{}\n", 10 + k, p.x, 20 + k, p.y, 30 + k, p.z);
            }
        }
        return text + "0\nENDSEC\n0\nEOF\n";
    };
    const vec3 turned(2, 5, 3);
    const auto size = [&](const std::string& header) {
        return bounds(parse_mesh(dxf(header), "a.dxf")).size();
    };
    EXPECT_LE(glm::distance(size("9\n$INSUNITS\n70\n4\n"), 1e-3f * turned), 1e-8f);
    EXPECT_LE(glm::distance(size("9\n$INSUNITS\n 70\n     1\n"), 0.0254f * turned), 1e-6f);
    EXPECT_LE(glm::distance(size("9\n$INSUNITS\n70\n0\n"), turned), 1e-5f);
    EXPECT_LE(glm::distance(size(""), turned), 1e-5f);
}

std::string fbx(const std::string& unit) {
    std::string text =
        "; FBX 7.3.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7300\n}\n"
        "GlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n" +
        unit +
        "\t}\n}\nObjects:  {\n\tGeometry: 10, \"Geometry::\", \"Mesh\" {\n\t\tVertices: *24 {\n\t\t\ta: ";
    const Mesh mesh = box(vec3(0), brick);
    for (vec3 p : mesh.positions) text += fmt::format("{},{},{},", p.x, p.y, p.z);
    text.back() = '\n';
    text += "\t\t}\n\t\tPolygonVertexIndex: *36 {\n\t\t\ta: ";
    for (uvec3 t : mesh.triangles) text += fmt::format("{},{},{},", t.x, t.y, -int(t.z) - 1);
    text.back() = '\n';
    return text +
           "\t\t}\n\t\tGeometryVersion: 124\n\t}\n\tModel: 20, \"Model::a\", \"Mesh\" {\n\t\tVersion: "
           "232\n\t}\n}\n"
           "Connections:  {\n\tC: \"OO\",20,0\n\tC: \"OO\",10,20\n}\n";
}

TEST(StatedUnits, OfFbx) {
    const auto unit = [](const char* number) {
        return fmt::format("\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{}\n", number);
    };
    expect_brick_of(parse_mesh(fbx(unit("1")), "a.fbx"), 1e-2);  // the format's own: a centimetre
    expect_brick_of(parse_mesh(fbx(unit("100")), "a.fbx"), 1);
    expect_brick_of(parse_mesh(fbx(unit("2.54")), "a.fbx"), 0.0254);
    expect_brick_of(parse_mesh(fbx(""), "a.fbx"), 1e-2);
    std::vector<std::string> notes;
    expect_brick_of(parse_mesh(fbx(unit("1")), "a.fbx", Units::metres, &notes), 1);
    ASSERT_EQ(notes.size(), 1u);
}

}  // namespace
}  // namespace palpate
