// X3D, as XML and in VRML's words: what it has beyond VRML.
#include "palpate/files/read.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

namespace palpate {
namespace {

const std::string brick =
    "coordIndex='0 2 3 1 -1 4 5 7 6 -1 0 1 5 4 -1 2 6 7 3 -1 0 4 6 2 -1 1 3 7 5 -1'>"
    "<Coordinate point='0 0 0 2 0 0 0 3 0 2 3 0 0 0 5 2 0 5 0 3 5 2 3 5'/>";
const std::string shape = "<Shape><IndexedFaceSet " + brick + "</IndexedFaceSet></Shape>";

std::string file(const std::string& scene, const std::string& head = "") {
    return "<?xml version='1.0' encoding='UTF-8'?>\n<!DOCTYPE X3D PUBLIC 'ISO//Web3D//DTD X3D 3.3//EN' "
           "'http://www.web3d.org/specifications/x3d-3.3.dtd'>\n<X3D version='3.3'><head>" +
           head + "</head>\n<Scene>" + scene + "</Scene></X3D>";
}

Mesh parse(const std::string& text, std::vector<std::string>* notes = nullptr,
           std::optional<Units> units = {}) {
    return parse_mesh(text, "a.x3d", units, notes);
}

std::string refused(const std::string& scene) { return parse_error("a.x3d", file(scene)); }

void expect_box(const Mesh& mesh, vec3 low, vec3 high, double of_volume) {
    EXPECT_LE(glm::distance(bounds(mesh).low, low), 1e-3f * glm::length(high - low));
    EXPECT_LE(glm::distance(bounds(mesh).high, high), 1e-3f * glm::length(high - low));
    EXPECT_LE(std::abs(volume(mesh) / of_volume - 1), 1e-4);
}

TEST(X3d, AnAxisOfAnyLengthAndFacesOfEitherSide) {
    const vec3 low(-1.909f, -0.020f, -0.719f), high(3.953f, 3.414f, 5.441f);
    for (const char* axis : {"1 2 3", "0.26726124 0.53452248 0.80178373", "100 200 300"})
        expect_box(parse(file(fmt::format("<Transform rotation='{} 1.1'>{}</Transform>", axis, shape))), low,
                   high, 30);
    for (const char* no : {"false", "FALSE"})
        EXPECT_LE(std::abs(volume(parse(file(fmt::format(
                               "<Shape><IndexedFaceSet ccw='{}' {}</IndexedFaceSet></Shape>", no, brick)))) +
                           30),
                  1e-4);
    EXPECT_LE(std::abs(volume(parse(file("<Shape><IndexedFaceSet ccw='true' solid='false' " + brick +
                                         "</IndexedFaceSet></Shape>"))) -
                       30),
              1e-4);
    // Scaled along turned axes: the x axis of a turn by 90 degrees about z is the world's y.
    expect_box(parse(file("<Transform scale='2 1 1' scaleOrientation='0 0 9 1.5707963' translation='1 0 0'>" +
                          shape + "</Transform>")),
               vec3(1, 0, 0), vec3(3, 6, 5), 60);
    expect_box(parse(file("<Transform scale='1 1 -1' center='0 0 10'>" + shape + "</Transform>")),
               vec3(0, 0, 15), vec3(2, 3, 20), 30);
}

TEST(X3d, UnitsThatTheFileStates) {
    const std::string mm = "<unit category='length' name='millimetre' conversionFactor='0.001'/>";
    expect_box(parse(file(shape, mm)), vec3(0), vec3(0.002f, 0.003f, 0.005f), 30e-9);
    expect_box(parse(file(shape, "<unit category='force' name='dyne' conversionFactor='1e-5'/>")), vec3(0),
               vec3(2, 3, 5), 30);
    // Degrees count in rotations.
    const std::string degrees =
        "<unit category='angle' name='degree' conversionFactor='0.017453292519943295'/>";
    expect_box(parse(file("<Transform rotation='0 0 1 90'>" + shape + "</Transform>", mm + degrees)),
               vec3(-0.003f, 0, 0), vec3(0, 0.002f, 0.005f), 30e-9);
    // What is asked for counts, and a note says that the file means something else.
    std::vector<std::string> notes;
    expect_box(parse(file(shape, mm), &notes, Units::millimetres), vec3(0), vec3(0.002f, 0.003f, 0.005f),
               30e-9);
    EXPECT_TRUE(notes.empty());
    expect_box(parse(file(shape, mm), &notes, Units::metres), vec3(0), vec3(2, 3, 5), 30);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "read in m as asked, though the file says that its unit is 0.001 m");
    for (const char* bad : {"0", "-1", "nan", "inf", "", "x"})
        EXPECT_NE(
            parse_error("a.x3d",
                        file(shape, fmt::format("<unit category='length' conversionFactor='{}'/>", bad))),
            "")
            << bad;
}

TEST(X3d, InVrmlsWords) {
    const std::string text =
        "#X3D V3.3 utf8\nPROFILE Immersive\nCOMPONENT Geometry3D:2\nUNIT length millimetre 0.001\n"
        "UNIT angle degree 0.017453292519943295\nMETA \"title\" \"{ in quotes\"\nIMPORT a.b AS c\n"
        "Transform { rotation 0 0 5 90 children Shape { geometry IndexedFaceSet {\n"
        "coord Coordinate { point [ 0 0 0 2 0 0 0 3 0 2 3 0 0 0 5 2 0 5 0 3 5 2 3 5 ] }\n"
        "coordIndex [ 0 2 3 1 -1 4 5 7 6 -1 0 1 5 4 -1 2 6 7 3 -1 0 4 6 2 -1 1 3 7 5 ] } } }\n";
    for (const char* name : {"a.x3dv", "a.wrl", "a.x3d", "a.vrml"})
        expect_box(parse_mesh(text, name), vec3(-0.003f, 0, 0), vec3(0, 0.002f, 0.005f), 30e-9);
    EXPECT_HAS(parse_error("a.x3db", std::string("\xe0\0\0\1\0", 5)), "binary X3D");
}

TEST(X3d, EveryKindOfTriangles) {
    const std::string points = "<Coordinate point='0 0 0 1 0 0 0 1 0 1 1 0 0 2 0 1 2 0'/>";
    const auto faces = [&](const std::string& type, const std::string& fields, double of_area,
                           std::size_t triangles) {
        for (const char* ccw : {"true", "false"}) {
            const Mesh mesh = parse(
                file(fmt::format("<Shape><{0} {1} ccw='{2}'>{3}</{0}></Shape>", type, fields, ccw, points)));
            EXPECT_EQ(mesh.triangles.size(), triangles) << type;
            EXPECT_LE(std::abs(area(mesh) - of_area), 1e-6) << type;
            for (uvec3 t : mesh.triangles) {
                const vec3 a = mesh.positions[t.x];
                const float up = glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a).z;
                EXPECT_EQ(up > 0, *ccw == 't') << type;
            }
        }
    };
    faces("IndexedTriangleSet", "index='0 1 2 1 3 2'", 1, 2);
    faces("IndexedTriangleStripSet", "index='0 1 2 3 -1 2 3 4 5 -1'", 2, 4);
    faces("IndexedTriangleFanSet", "index='0 1 3 2 -1'", 1, 2);
    faces("IndexedQuadSet", "index='0 1 3 2 2 3 5 4'", 2, 4);
    faces("TriangleStripSet", "stripCount='4'", 1, 2);
    faces("TriangleStripSet", "stripCount='6'", 2, 4);
    EXPECT_EQ(parse(file("<Shape><TriangleSet>" + points + "</TriangleSet></Shape>")).triangles,
              (std::vector<uvec3>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_HAS(refused("<Shape><TriangleFanSet fanCount='-3'>" + points + "</TriangleFanSet></Shape>"),
               "strip of -3");
    EXPECT_HAS(
        refused("<Shape>\n<IndexedTriangleSet index='0 1 6'>" + points + "</IndexedTriangleSet></Shape>"),
        "point 6 of 6, counted from 0, in line 5");
}

TEST(X3d, NodesByNameOnceMore) {
    const Mesh mesh = parse(file(
        "<Transform DEF='a {strange} name' translation='10 0 0'><Shape DEF='Schädel'><Appearance><Material "
        "diffuseColor='1 0 0'/></Appearance><IndexedFaceSet coordIndex='0 1 2'><Coordinate DEF='c' "
        "point='0 0 0, 1 0 0, 0 1 0'/></IndexedFaceSet></Shape></Transform>"
        "<Group><Shape USE='Schädel'/><Switch whichChoice='1'><Shape USE='Schädel'/><Transform USE='a "
        "{strange} "
        "name'/></Switch><LOD><Shape><IndexedFaceSet coordIndex='2 1 0'><Coordinate "
        "USE='c'/></IndexedFaceSet>"
        "</Shape><Group/></LOD></Group>"
        "<Script DEF='s'><field name='x' type='SFNode' accessType='inputOutput'><Shape USE='none'/></field>"
        "<![CDATA[javascript: { ]]></Script><ROUTE fromNode='s' fromField='x' toNode='s' toField='x'/>"));
    EXPECT_EQ(mesh.positions, (std::vector<vec3>{{10, 0, 0},
                                                 {11, 0, 0},
                                                 {10, 1, 0},
                                                 {0, 0, 0},
                                                 {1, 0, 0},
                                                 {0, 1, 0},
                                                 {10, 0, 0},
                                                 {11, 0, 0},
                                                 {10, 1, 0},
                                                 {0, 0, 0},
                                                 {1, 0, 0},
                                                 {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles.back(), uvec3(11, 10, 9));
    EXPECT_EQ(
        parse_mesh(
            "#VRML V2.0 utf8\nDEF S Shape { geometry Box { } }\nGroup { children USE S children USE S }",
            "a.wrl")
            .triangles.size(),
        36u);  // X3D's children come one by one
    EXPECT_HAS(refused("<Shape USE='nothing'/>"), "which no DEF names");
    EXPECT_HAS(refused("<ProtoDeclare name='x'/>"), "PROTO");
    EXPECT_HAS(refused("<Inline url='\"b.x3d\"'/>"), "Inline");
}

TEST(X3d, TextureCoordinatesByCorner) {
    const std::string square =
        "<Coordinate point='0 0 0 1 0 0 1 1 0 0 1 0'/><TextureCoordinate point='0 0 1 0 1 1 0 1 0.5 0.5'/>";
    const Mesh one = parse(
        file("<Shape><IndexedFaceSet coordIndex='0 1 2 -1 0 2 3 -1' texCoordIndex='0 1 2 -1 4 2 3 -1'>" +
             square + "</IndexedFaceSet></Shape>"));
    EXPECT_EQ(one.uvs, (std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0.5f, 0.5f}, {0, 1}}));
    EXPECT_EQ(one.triangles, (std::vector<uvec3>{{0, 1, 2}, {3, 2, 4}}));
    const Mesh same =
        parse(file("<Shape><IndexedFaceSet coordIndex='0 1 2 3'>" + square + "</IndexedFaceSet></Shape>"));
    EXPECT_EQ(same.uvs, (std::vector<vec2>{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
    std::vector<std::string> notes;
    const Mesh astray = parse(file("<Shape><IndexedFaceSet coordIndex='0 1 2 3' texCoordIndex='0 1 2 9'>" +
                                   square + "</IndexedFaceSet></Shape>"),
                              &notes);
    EXPECT_TRUE(astray.uvs.empty());
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "1 corners refer to missing ones");
}

// Their volumes are those of prisms, pyramids and rings of 32 sides.
TEST(X3d, SolidsThatHaveAName) {
    const double pi = std::numbers::pi,
                 circle = 16 * std::sin(pi / 16);  // the area of 32 corners, of radius 1
    const auto read = [](const std::string& solid) { return parse(file("<Shape>" + solid + "</Shape>")); };
    expect_box(read("<Box size='2 3 5'/>"), vec3(-1, -1.5f, -2.5f), vec3(1, 1.5f, 2.5f), 30);
    expect_box(read("<Cylinder radius='0.5' height='3'/>"), vec3(-0.5f, -1.5f, -0.5f), vec3(0.5f, 1.5f, 0.5f),
               circle * 0.25 * 3);
    expect_box(read("<Cone bottomRadius='0.5' height='3'/>"), vec3(-0.5f, -1.5f, -0.5f),
               vec3(0.5f, 1.5f, 0.5f), circle * 0.25);
    const Mesh ball = read("<Sphere radius='2'/>");
    EXPECT_LE(std::abs(volume(ball) / (4.0 / 3 * pi * 8) - 1), 0.02);
    for (vec3 p : ball.positions) EXPECT_LE(std::abs(glm::length(p) - 2), 1e-6f);
    for (const Mesh& mesh : {ball, read("<Box/>"), read("<Cylinder/>"), read("<Cone/>")})
        EXPECT_TRUE(soundness(mesh).closed());
    EXPECT_FALSE(soundness(read("<Cylinder top='false'/>")).closed());
    const Mesh terrain =
        read("<ElevationGrid xDimension='3' zDimension='2' xSpacing='2' zSpacing='5' height='0 0 0 0 1 0'/>");
    EXPECT_EQ(terrain.triangles.size(), 4u);
    EXPECT_EQ(bounds(terrain).high, vec3(4, 1, 5));
    for (uvec3 t : terrain.triangles)
        EXPECT_GT(glm::cross(terrain.positions[t.y] - terrain.positions[t.x],
                             terrain.positions[t.z] - terrain.positions[t.x])
                      .y,
                  0);
    EXPECT_HAS(refused("<Shape><ElevationGrid xDimension='30000' zDimension='30000' height='1 2'/></Shape>"),
               "30000 x 30000 with 2 heights");
    std::vector<std::string> notes;
    parse(file(shape + "<Shape><Text string='\"a {b}\"'/></Shape><Shape><Disk2D/></Shape>"), &notes);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out shapes that are not read: Disk2D Text");
    EXPECT_HAS(refused("<Shape><Text/></Shape>"), "no faces, only shapes that are not read: Text");
}

TEST(X3d, CrossSectionsAlongASpine) {
    const auto read = [](const std::string& fields) {
        const Mesh mesh = parse(file("<Shape><Extrusion " + fields + "/></Shape>"));
        return std::pair(mesh, volume(mesh));
    };
    const auto closed = [&](const std::string& fields, double of_volume) {
        const auto [mesh, found] = read(fields);
        EXPECT_TRUE(soundness(mesh).closed()) << fields;
        EXPECT_LE(std::abs(found / of_volume - 1), 1e-5) << fields << ": " << found;
    };
    closed("", 4);
    closed("ccw='false'", -4);
    const std::string one = "crossSection='1 1 1 -1 -1 -1 -1 1 1 1' ";
    closed(one + "spine='0 0 0 0 3 0'", 12);
    closed(one + "spine='0 0 0 0 0 3'", 12);
    closed(one + "spine='0 0 0 -2 1 2'", 4 * 3);
    closed(one + "spine='0 3 0 0 0 0'", 12);  // downwards
    closed(one + "spine='0 0 0 0 3 0' scale='1 2'", 24);
    closed(one + "spine='0 0 0 0 3 0' orientation='0 1 0 0.7'", 12);
    closed(one + "spine='0 0 0 0 3 0' scale='1 1 0.5 0.5'", 3.0 / 3 * (4 + 1 + 2));  // a frustum
    closed(one + "spine='0 0 0 0 3 0 0 5 0 0 9 0'", 36);
    // A bar bent round a square of side 10: each corner's section lies in the mitre's plane but is not
    // stretched.
    const auto [bent, around] = read(
        "crossSection='0.1 0.1 0.1 -0.1 -0.1 -0.1 -0.1 0.1 0.1 0.1' "
        "spine='0 0 0 10 0 0 10 10 0 0 10 0 0 0 0'");
    EXPECT_TRUE(soundness(bent).closed());
    EXPECT_EQ(bent.triangles.size(), 4u * 4 * 2);
    EXPECT_LE(std::abs(around / (40 * 0.2 * 0.2 * std::numbers::sqrt2 / 2) - 1), 0.01);
    EXPECT_FALSE(soundness(read("endCap='false'").first).closed());
    std::string long_list;
    for (int i = 0; i < 3000; ++i) long_list += fmt::format("{} 0 0 ", i);
    EXPECT_HAS(
        refused("<Shape><Extrusion spine='" + long_list + "' crossSection='" + long_list + "'/></Shape>"),
        "too many solids");
}

TEST(X3d, WhatIsNotVisibleIsLeftOutWithANote) {
    const std::string far = "<Transform translation='10 0 0'>" + shape + "</Transform>";
    for (const std::string& hidden : {"<Group visible='false'>" + far + "</Group>",
                                      "<Transform visible='false'>" + shape + "</Transform>",
                                      "<CADLayer visible='false'>" + far + "</CADLayer>",
                                      "<CADLayer visible='false true'>" + far + "<Group></Group></CADLayer>",
                                      "<Shape visible='false'" + shape.substr(6)}) {
        for (const std::string& scene : {hidden + shape, shape + hidden}) {
            std::vector<std::string> notes;
            expect_box(parse(file(scene), &notes), vec3(0), vec3(2, 3, 5), 30);
            ASSERT_EQ(notes.size(), 1u) << scene;
            EXPECT_HAS(notes[0], "left out 6 faces that are not visible");
        }
        EXPECT_HAS(refused(hidden), "no faces, only 6 faces that are not visible");
    }
    // What a layer hides lies between what it shows, and a name in it still stands for its node.
    expect_box(parse(file("<CADLayer visible='true false true'>" + shape + "<Group DEF='a'>" + shape +
                          "</Group><Transform translation='0 0 5'><Group USE='a'/>"
                          "</Transform></CADLayer>")),
               vec3(0), vec3(2, 3, 10), 60);
}

TEST(X3d, ShapesUnderNodesThatAreNotReadAreCounted) {
    const std::string under = "<GeoLocation geoCoords='47 8 0'>" + shape + shape + "</GeoLocation>";
    std::vector<std::string> notes;
    expect_box(parse(file(under + shape), &notes), vec3(0), vec3(2, 3, 5), 30);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "left out 12 faces under GeoLocation, a node that is not read");
    EXPECT_HAS(refused(under), "no faces, only 12 faces under GeoLocation");
    EXPECT_HAS(refused("<Shape><IndexedFaceSet coordIndex='0 1 2'><GeoCoordinate point='0 0 0 1 0 0 0 1 0'/>"
                       "</IndexedFaceSet></Shape>"),
               "a GeoCoordinate, which is not read");
}

TEST(X3d, RefusesWhatIsDamaged) {
    EXPECT_HAS(parse_error("a.x3d", "<!DOCTYPE X3D [<!ENTITY a 'aaaa'>]>\n" + file("")), "entities");
    const auto with_attributes = [](const std::string& value) {
        return "<!DOCTYPE X3D [<!ATTLIST Box size CDATA " + value + ">]>\n<X3D><Scene>" + shape +
               "</Scene></X3D>";
    };
    EXPECT_HAS(parse_error("a.x3d", with_attributes("'9 9 9'")), "XML with defaults of its own");
    expect_box(parse(with_attributes("#IMPLIED")), vec3(0), vec3(2, 3, 5), 30);
    expect_box(parse(file("<x:/>" + shape)), vec3(0), vec3(2, 3, 5), 30);  // no name behind the prefix
    EXPECT_HAS(parse_error("a.x3d", "<svg></svg>"), "XML that is not X3D");
    EXPECT_HAS(refused("<Shape>\n</Box>"), "mismatched tag) in line 5");
    EXPECT_HAS(refused("<Shape><IndexedFaceSet coordIndex='0 { 1'/></Shape>"),
               "for a name or numbers in line 4");
    const std::string whole = file(shape);
    for (std::size_t length = 0; length < whole.size(); ++length)
        EXPECT_NE(parse_error("a.x3d", whole.substr(0, length)), "") << length;
    std::string deep;
    for (int i = 0; i < 200'000; ++i) deep += "<Group>";
    EXPECT_NE(refused(deep), "");
    // UTF-16, with its mark, is XML like any other.
    std::u16string wide = u"\ufeff";
    for (char c : whole.substr(whole.find('\n'))) wide += char16_t(c);
    expect_box(parse({reinterpret_cast<const char*>(wide.data()), 2 * wide.size()}), vec3(0), vec3(2, 3, 5),
               30);
}

}  // namespace
}  // namespace palpate
