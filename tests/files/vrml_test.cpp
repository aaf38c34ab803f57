#include "palpate/files/read.h"
#include "tests/files/reading.h"
#include "tests/mesh/shapes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

namespace palpate {
namespace {

const std::string head = "#VRML V2.0 utf8\n";
const std::string set =
    "IndexedFaceSet { coord Coordinate { point [ 1 0 0, 0 1 0, 0 0 1 ] } coordIndex [ 0, 1, 2, -1 ] }";
const std::string shape = "Shape { geometry " + set + " }";

Mesh parse(const std::string& text, std::vector<std::string>* notes = nullptr) {
    return parse_mesh(head + text, "a.wrl", Units::metres, notes);
}

std::string refused(const std::string& text) { return parse_error("a.wrl", head + text); }

TEST(Vrml, FacesWhereverTheyStand) {
    const std::vector<vec3> corners = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (const std::string& text :
         {shape, "DEF a Group { children [ " + shape + " ] }", "Group { children " + shape + " }",
          "Anchor{children[Billboard{children[Collision{children[" + shape + "]}]}]url\"[{\"}",
          "Group { children [ NULL, " + shape + " ] } # a comment {",
          "Group { bboxSize 1 1 1 bboxCenter 0,0,0 children [ " + shape + " ] }",
          "Collision { proxy " + shape + " children [ " + shape + " ] }",
          "LOD { range [ 1 2 ] level [ " + shape + shape + shape + " ] }",
          "Switch { choice [ " + shape + shape + shape + " ] whichChoice 1 }"}) {
        const Mesh mesh = parse(text);
        EXPECT_EQ(mesh.positions, corners) << text;
        EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}})) << text;
    }
    EXPECT_HAS(refused("Switch { choice [ " + shape + " ] }"), "no faces");
    EXPECT_HAS(refused("Switch { whichChoice 7 choice [ " + shape + " ] }"), "no faces");
}

TEST(Vrml, ReadsOverTheRest) {
    const Mesh mesh = parse(
        "WorldInfo { title \"a \\\"{\\\" in quotes\" info [ \"one\", \"# two\" ] }\n"
        "Viewpoint { position 0 0 10 description \"x\" }\n"
        "DEF sensor TouchSensor { enabled TRUE }\n"
        "DEF s Script { eventIn SFTime go field SFNode a USE sensor field MFString b [ \"x\" ] mustEvaluate "
        "FALSE\n"
        "  url [ \"javascript: function go() { if (1) { } }\" ] }\n"
        "Shape { appearance DEF red Appearance { material Material { diffuseColor 1 0 0 }\n"
        "  texture PixelTexture { image 2 1 3 0xFF00FF 0x00FF00 } } geometry " +
        set + " }\n" +
        "Shape { appearance USE red geometry IndexedLineSet { coord DEF lines Coordinate { point [ 0 0 0, 1 "
        "1 1, 2 0 0 ] }\n"
        "  coordIndex [ 0 1 -1 ] } }\n"
        "Shape { geometry IndexedFaceSet { coord USE lines texCoord TextureCoordinate { point [ 0 0 ] }\n"
        "  normal Normal { vector [ 0 0 1 ] } convex FALSE creaseAngle 0.5 coordIndex [ 0 1 2 -1 -1 ] } }\n"
        "ROUTE sensor.touchTime TO s.go\n");
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(mesh.positions[4], vec3(1, 1, 1));
}

TEST(Vrml, OtherShapesAreLeftOutWithANote) {
    std::vector<std::string> notes;
    EXPECT_EQ(
        parse(shape + " Shape { geometry Text { string \"a\" } } Shape { geometry DEF x NurbsCurve { } }",
              &notes)
            .triangles.size(),
        1u);
    ASSERT_EQ(notes.size(), 1u);
    EXPECT_HAS(notes[0], "NurbsCurve Text");
    EXPECT_HAS(refused("Shape { geometry Text { } }"), "no faces, only shapes that are not read: Text");
    EXPECT_EQ(parse("Shape { geometry Box { size 1 2 3 } }").triangles.size(), 12u);
}

// Turns v about a unit axis by Rodrigues' formula.
dvec3 turned(dvec3 v, dvec3 axis, double angle) {
    return v * std::cos(angle) + glm::cross(axis, v) * std::sin(angle) +
           axis * glm::dot(axis, v) * (1 - std::cos(angle));
}

TEST(Vrml, TransformsByTheLetterOfTheStandard) {
    std::mt19937 random(4);
    auto number = [&] { return std::uniform_real_distribution(-2.0, 2.0)(random); };
    auto vector = [&] { return dvec3(number(), number(), number()); };
    auto spelled = [](dvec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); };
    for (int trial = 0; trial < 50; ++trial) {
        struct {
            dvec3 center, axis, scale, scale_axis, translation;
            double angle, scale_angle;
        } t[2];
        std::string text = shape;
        for (auto& one : t) {
            one = {vector(), vector(), vector(), vector(), vector(), number(), number()};
            // Children come first here, so all that moves them is read after them.
            text = fmt::format(
                "Transform {{ children [ {} ] center {} rotation {} {} scale {} scaleOrientation {} {} "
                "translation {} }}",
                text, spelled(one.center), spelled(one.axis), one.angle, spelled(one.scale),
                spelled(one.scale_axis), one.scale_angle, spelled(one.translation));
        }
        const Mesh mesh = parse(text);
        bool mirrored = false;
        for (int corner = 0; corner < 3; ++corner) {
            dvec3 p(corner == 0, corner == 1, corner == 2);
            for (const auto& one : t) {
                const dvec3 axis = glm::normalize(one.axis), scale_axis = glm::normalize(one.scale_axis);
                p = turned(p - one.center, scale_axis, -one.scale_angle) * one.scale;
                p = turned(turned(p, scale_axis, one.scale_angle), axis, one.angle);
                p += one.center + one.translation;
                if (corner == 0) mirrored ^= one.scale.x * one.scale.y * one.scale.z < 0;
            }
            EXPECT_LE(glm::length(dvec3(mesh.positions[std::size_t(corner)]) - p), 1e-5);
        }
        EXPECT_EQ(mesh.triangles[0], mirrored ? uvec3(2, 1, 0) : uvec3(0, 1, 2));
    }
    EXPECT_EQ(parse("Transform { rotation 0 0 0 0 children " + shape + " }").positions[0], vec3(1, 0, 0));
}

TEST(Vrml, CcwFalseTurnsFacesOver) {
    const Mesh mesh =
        parse("Shape { geometry IndexedFaceSet { ccw FALSE " + set.substr(set.find("coord")) + " }");
    EXPECT_EQ(mesh.triangles, (std::vector<uvec3>{{2, 1, 0}}));
}

TEST(Vrml, UseRepeatsTheLastOfItsName) {
    const Mesh mesh = parse("DEF A Transform { translation 1 0 0 children DEF S " + shape +
                            " } DEF B Group { children [ USE A, USE S ] } DEF A Group { } "
                            "Transform { translation 0 10 0 children [ USE B USE A ] }");
    ASSERT_EQ(mesh.triangles.size(), 5u);  // A; B: the first A and S; B again, and nothing
    const float x[] = {2, 2, 1, 2, 1}, y[] = {0, 0, 0, 10, 10};
    for (std::size_t f = 0; f < 5; ++f)
        EXPECT_EQ(mesh.positions[mesh.triangles[f].x], vec3(x[f], y[f], 0)) << f;
    EXPECT_HAS(refused("Group { children USE nothing }"), "\"nothing\", which no DEF names, in line 2");
    EXPECT_HAS(refused("USE A DEF A " + shape), "no DEF");
}

TEST(Vrml, CyclesBombsAndDepthsEnd) {
    EXPECT_HAS(refused("DEF A Group { children [ USE A ] }"), "no DEF");
    EXPECT_HAS(refused("DEF A Group { children DEF B Group { children [ USE A " + shape + "] } }"), "no DEF");
    std::string bomb = "DEF A0 " + shape;
    for (int i = 1; i < 60; ++i)
        bomb += fmt::format("DEF A{0} Group {{ children [ USE A{1} USE A{1} ] }}\n", i, i - 1);
    EXPECT_HAS(refused(bomb), "USE");
    for (const char* opening :
         {"Group { children ", "Group { children [ ", "DEF A ", "Foo { bar ", "Foo { bar [ "}) {
        std::string deep;
        for (int i = 0; i < 200'000; ++i) deep += opening;
        EXPECT_HAS(refused(deep), "deep") << opening;
    }
    EXPECT_HAS(refused(std::string(100'000, '[')), "no {");
    EXPECT_HAS(refused("Foo { bar " + std::string(100'000, '[')), "no {");
}

TEST(Vrml, RefusesWhatItCannotTakeRightly) {
    EXPECT_HAS(parse_error("a.wrl", "#VRML V1.0 ascii\nSeparator { }"), "VRML 1.0");
    EXPECT_HAS(parse_error("a.wrl", shape), "no VRML 2 header");
    EXPECT_HAS(refused("PROTO Foo [ field SFBool x TRUE ] { Group { } } Foo { }"), "PROTO");
    EXPECT_HAS(refused("Group { children EXTERNPROTO Foo [ ] \"x\" }"), "no {");
    EXPECT_HAS(refused("Group { children Inline { url \"x.wrl\" } }"), "Inline");
    const auto with = [](const std::string& points, const std::string& faces) {
        return refused("Shape { geometry IndexedFaceSet { coord Coordinate { point [" + points +
                       "] } coordIndex [" + faces + "] } }");
    };
    EXPECT_HAS(with("0 0 0 1 0 0 0 1 0", "0 1 3 -1"), "point 3 of 3");
    EXPECT_HAS(with("0 0 0 1 0 0 0 1 0", "0 1 -2 -1"), "point -2 of 3");
    EXPECT_HAS(with("0 0 0 1 0 0 0 1", "0 1 0 -1"), "less than three");
    EXPECT_HAS(with("0 0 0 1 0 x 0 1 0", "0 1 2 -1"), "\"x\" instead of a number in line 2");
    EXPECT_HAS(with("0 0 0 1 0 nan 0 1 0", "0 1 2 -1"), "vertex 2 of 3 not finite");
    EXPECT_HAS(with("", "0 1 2 -1"), "point 0 of 0");
    EXPECT_HAS(refused(shape + " Shape { geometry IndexedFaceSet { coord NULL coordIndex [ 0 1 2 ] } }"),
               "point 0 of 0");
    EXPECT_HAS(refused("Transform { scale 1e300 1 1 children " + shape + " }"), "not finite");
    EXPECT_HAS(refused("Transform { scale 1 1 children " + shape + " }"), "2 numbers where 3");
    const std::string whole = head + "DEF A Group { children [ " + shape + " USE A0 \"text\" ] }";
    for (std::size_t length = 0; length + 1 < whole.size(); ++length)
        EXPECT_NE(parse_error("a.wrl", whole.substr(0, length)), "") << length;
}

}  // namespace
}  // namespace palpate
