// What the viewer shows, opens and saves, and its controls, without a window and with events that are made
// up.
#include "palpate/viewer/viewer.h"

#include "palpate/base/files.h"
#include "palpate/body/hull.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/files/write.h"
#include "palpate/viewer/gui.h"
#include "tests/scratch.h"
#include "tests/shapes.h"
#include "tests/viewer/viewer_test.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <gtest/gtest.h>
#include <imgui.h>

namespace palpate {
namespace {

// ---- pictures ----

TEST_F(ViewerTest, TheSameSceneSideBySideIsTheSame) {
    open("box");
    viewer.advance(20);
    viewer.options.compared = {.with = Compared::With::backend, .backend = Backend::reference};
    viewer.advance(1);
    ASSERT_TRUE(viewer.beside()) << viewer.message().text;
    for (int f = 0; f < 20; ++f) viewer.advance(1);
    const Image both = viewer.image();
    ASSERT_EQ(both.width, 320);
    Image halves[2];
    for (int h = 0; h < 2; ++h) {
        halves[h] = {160, 240, {}};
        for (int y = 0; y < 240; ++y) {
            const auto from = both.pixels.begin() + 4 * (320 * y + 160 * h);
            halves[h].pixels.insert(halves[h].pixels.end(), from, from + 4 * 160);
        }
    }
    EXPECT_TRUE(difference(halves[0], halves[1]) < 0.1) << difference(halves[0], halves[1]);
    viewer.options.compared = {};
    viewer.advance(1);
    EXPECT_FALSE(viewer.beside());
}

TEST_F(ViewerTest, AnotherComparisonIsShownAnew) {
    open("drape", {"body.1.cloth=[12,12]"});
    viewer.advance(20);
    Image seen[2];
    for (int i = 0; i < 2; ++i) {
        viewer.options.compared = {.with = Compared::With::mapping,
                                   .mapping = i == 0 ? Mapping::frames : Mapping::one_to_one};
        viewer.advance(0);
        ASSERT_TRUE(viewer.beside()) << viewer.message().text;
        seen[i] = viewer.image();
    }
    EXPECT_EQ(seen[0].width, seen[1].width);
    open("box");  // and of another scene nothing is left
    viewer.options.compared = {.with = Compared::With::backend, .backend = Backend::reference};
    viewer.advance(1);
    EXPECT_GT(difference(viewer.image(), seen[1]), 1);
}

TEST_F(ViewerTest, StereoShowsTwoEyes) {
    open("box");
    const Image mono = viewer.image();
    viewer.options.stereo = true;
    const Image stereo = viewer.image();
    EXPECT_EQ(stereo.width, mono.width);
    EXPECT_EQ(stereo.height, mono.height);
    EXPECT_EQ(viewer.view_size(), ivec2(160, 240));
    // The eyes see nearly the same, but not quite.
    double apart = 0;
    for (int y = 0; y < 240; ++y)
        for (int x = 0; x < 4 * 160; ++x)
            apart += std::abs(int(stereo.pixels[std::size_t(4 * 320 * y + x)]) -
                              int(stereo.pixels[std::size_t(4 * 320 * y + 4 * 160 + x)]));
    apart /= 4 * 160 * 240;
    EXPECT_TRUE(apart > 0.05 && apart < 20) << apart;
}

TEST_F(ViewerTest, EveryLookShows) {
    open("box");
    const Image plain = viewer.image();
    for (bool Look3d::*look : {&Look3d::wireframe, &Look3d::springs, &Look3d::normals}) {
        viewer.options.look = {};
        viewer.options.look.*look = true;
        EXPECT_GT(difference(viewer.image(), plain), 0.3);
    }
    viewer.options.look = {};
    viewer.options.look.culling = false;
    EXPECT_EQ(difference(viewer.image(), plain), 0);
}

TEST_F(ViewerTest, OnAGpuItLooksTheSame) {
    open("box");
    viewer.advance(20);
    const Image before = viewer.image();
    viewer.change({"simulation.backend=\"compute\""});
    EXPECT_FALSE(viewer.message().bad) << viewer.message().text;
    EXPECT_TRUE(difference(viewer.image(), before) < 0.5) << difference(viewer.image(), before);
    viewer.advance(3);
    EXPECT_TRUE(viewer.experiment()->trouble().empty());
    viewer.move_pointer(middle());
    viewer.press(Button::left, true);
    EXPECT_TRUE(viewer.is_holding()) << viewer.message().text;
    viewer.change({"simulation.backend=\"cpu\""});  // while it is held
    viewer.advance(3);
    EXPECT_TRUE(viewer.is_holding());
}

// ---- what is opened and saved ----

TEST_F(ViewerTest, ABrokenFileIsSaidAndWhatWasOpenStays) {
    const Scratch scratch;
    open("box");
    write_text(scratch / "broken.ply", "ply\nformat ascii 1.0\nelement vertex 5\n");
    write_text(scratch / "broken.toml", "[[body]\n");
    write_text(scratch / "broken.json", "{");
    write_text(scratch / "odd \"name\".obj", "v 0 0 0\n");
    const std::string name = viewer.experiment()->source().name;
    for (const char* file : {"broken.ply", "broken.toml", "broken.json", "odd \"name\".obj", "nowhere.stl"}) {
        viewer.open_file(scratch / file);
        wait_until_open(viewer);
        EXPECT_TRUE(viewer.message().bad) << file;
        EXPECT_NE(viewer.message().text.find(file), std::string::npos) << viewer.message().text;
        ASSERT_TRUE(viewer.experiment());
        EXPECT_EQ(viewer.experiment()->source().name, name);
        viewer.advance(1);
    }
}

TEST_F(ViewerTest, TellsTheNotesOfARun) {
    viewer.open(
        {"[[body]]\nname = \"loose\"\ndims = [3, 3, 3]\nspacing = 0.01\nyoungs_modulus = 5000\ndensity = "
         "1000\n",
         "loose.toml", "."});
    wait_until_open(viewer);
    EXPECT_NE(viewer.message().text.find("nothing holds it"), std::string::npos) << viewer.message().text;
    EXPECT_FALSE(viewer.message().bad);
}

TEST_F(ViewerTest, AMeshBecomesABodyAndCanBeCancelled) {
    const Scratch scratch;
    const Mesh ball = ellipsoid(vec3(1), 30);
    write_mesh(ball, scratch / "ball.ply");
    viewer.open_file(scratch / "ball.ply");
    viewer.cancel_import();
    wait_until_open(viewer);
    EXPECT_FALSE(viewer.experiment());
    viewer.open_file(scratch / "ball.ply");
    wait_until_open(viewer);
    ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
    EXPECT_GT(viewer.experiment()->models().models[0].body.count(), 1000u);
    // It is the scene that the command runs off screen, and all of it is seen.
    EXPECT_EQ(viewer.experiment()->source().text, find_scene((scratch / "ball.ply").string()).text);
    for (vec3 p : viewer.experiment()->play().skins()[0].positions) {
        const vec2 at = *pixel_of(viewer.camera(), p, size);
        ASSERT_TRUE(at.x > 0 && at.x < float(size.x) && at.y > 0 && at.y < float(size.y));
    }
    viewer.advance(2);
    viewer.open_file(scratch / "ball.ply");  // and is destroyed while it opens another
}

TEST_F(ViewerTest, SavesWhatCanBeOpenedAgain) {
    const Scratch scratch;
    open("box", {"body.1.damping=4"});
    viewer.folder = scratch / "";
    viewer.advance(10);
    drag(middle(), middle() + vec2(10, 10), 10);
    viewer.release(Button::left);
    viewer.change({"simulation.integrator=\"rk4\""});
    viewer.advance(5);
    viewer.save(Output::picture);
    viewer.save(Output::surface);
    viewer.save(Output::recording);
    const std::string print = viewer.experiment()->fingerprint();
    for (const char* file : {"box-1.png", "box-1.ply", "box-1.json"})
        EXPECT_TRUE(std::filesystem::exists(scratch / file)) << file << ": " << viewer.message().text;
    viewer.save(Output::picture);
    EXPECT_TRUE(std::filesystem::exists(scratch / "box-2.png"));
    viewer.open_file(scratch / "box-1.json");
    const Experiment* open_before = viewer.experiment();
    while (viewer.importing()) {  // what was open goes on meanwhile, and not by the recording
        viewer.advance(1);
        EXPECT_TRUE(viewer.experiment() != open_before || !viewer.replaying());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_TRUE(viewer.replaying()) << viewer.message().text;
    for (int f = 0; f < 100 && viewer.replaying(); ++f) viewer.advance(1);
    EXPECT_FALSE(viewer.message().bad) << viewer.message().text;
    EXPECT_EQ(viewer.experiment()->fingerprint(), print);
    EXPECT_TRUE(viewer.options.paused);
}

TEST_F(ViewerTest, WhatBlowsUpIsHeldAndReturnedFrom) {
    open("box");
    viewer.advance(40);
    const double bound = viewer.experiment()->stable_step(0);
    viewer.change({"simulation.step=" + std::to_string(1.4 * bound)});
    for (int f = 0; f < 900 && viewer.experiment()->trouble().empty(); ++f) viewer.advance(1);
    ASSERT_FALSE(viewer.experiment()->trouble().empty());
    EXPECT_TRUE(viewer.message().bad);
    viewer.advance(5);
    viewer.look();
    viewer.draw();
    viewer.undo();
    viewer.return_to_good();
    EXPECT_TRUE(viewer.experiment()->trouble().empty()) << viewer.message().text;
}

TEST_F(ViewerTest, NothingIsOpenAndAllIsAsked) {
    viewer.advance(3);
    viewer.look();
    viewer.draw();
    viewer.move_pointer(vec2(10));
    viewer.press(Button::left);
    viewer.wheel(1);
    viewer.release(Button::left);
    viewer.undo(), viewer.redo(), viewer.restart(), viewer.step_once(), viewer.return_to_good();
    viewer.save(Output::scene), viewer.save(Output::picture), viewer.save(Output::surface),
        viewer.save(Output::recording);
    viewer.save(Output::film), viewer.keep(), viewer.frame_selection();
    viewer.change({"simulation.step=1"});
    viewer.resize(ivec2(0, 0));
    EXPECT_EQ(viewer.size(), size);
    viewer.resize(ivec2(7, 5));
    viewer.look();
    viewer.draw();
}

// What a program made, without a text of a scene.
TEST_F(ViewerTest, ShowsWhatAProgramMade) {
    Body jelly = lattice({9, 4, 4}, 0.02f, {.youngs_modulus = 20'000, .density = 1000, .damping = 2});
    pin(jelly, nodes_below(jelly, 0.01f, vec3(-1, 0, 0)));
    viewer.begin(prepare(jelly, hull_mesh(jelly)));
    ASSERT_TRUE(viewer.experiment()) << viewer.message().text;
    drag(middle(), middle() + vec2(0, -30), 10);
    EXPECT_EQ(viewer.holds().size(), 1u) << viewer.message().text;
    viewer.release(Button::left);
    viewer.options.mode = Mode::pin;
    viewer.options.tip = 0.001f;
    viewer.press(Button::left);
    EXPECT_TRUE(viewer.can_undo()) << viewer.message().text;
    viewer.undo();
    EXPECT_FALSE(viewer.message().bad) << viewer.message().text;
    for (auto act :
         {+[](Viewer& one) { one.save(Output::scene); }, +[](Viewer& one) { one.save(Output::recording); },
          +[](Viewer& one) { one.change({"body.1.damping=3"}); }}) {
        act(viewer);
        EXPECT_NE(viewer.message().text.find("a scene without a text"), std::string::npos)
            << viewer.message().text;
    }
    viewer.advance(5);
    viewer.look();
    viewer.draw();
    EXPECT_GT(viewer.image().pixels.size(), 0u);
}

// ---- the controls ----

class GuiTest : public ViewerTest {
 protected:
    Gui gui{1};

    // One picture of the controls, with the pointer there.
    void frame(vec2 pointer, bool down = false) {
        ImGuiIO& io = ImGui::GetIO();
        io.DisplaySize = {float(size.x * 3), float(size.y * 3)};
        io.DeltaTime = 1.0f / 60;
        io.MousePos = {pointer.x, pointer.y};
        io.MouseDown[0] = down;
        ImGui_ImplOpenGL3_NewFrame();
        ImGui::NewFrame();
        gui.build(viewer);
        gui.draw();
    }
    void click(vec2 at) { frame(at), frame(at, true), frame(at), frame(at); }
};

TEST_F(GuiTest, ClicksReachTheControls) {
    viewer.resize(3 * size);
    open("box");
    viewer.advance(2);
    for (int i = 0; i < 3; ++i) frame(vec2(900, 700));  // sizes are found over a few pictures
    EXPECT_FALSE(gui.wants_pointer());
    frame(vec2(30, 40));
    EXPECT_TRUE(gui.wants_pointer());
    EXPECT_FALSE(viewer.options.paused);
    click(vec2(25, 40));
    EXPECT_TRUE(viewer.options.paused);
    const double before = viewer.experiment()->time();
    click(vec2(90, 40));  // a frame
    EXPECT_GT(viewer.experiment()->time(), before);
    click(vec2(86, 94));
    EXPECT_EQ(viewer.options.mode, Mode::pin);
}

TEST_F(GuiTest, KeysDoWhatTheHelpSays) {
    open("box");
    viewer.advance(2);
    gui.key(viewer, '2', false, false);
    EXPECT_EQ(viewer.options.mode, Mode::pin);
    gui.key(viewer, '1', false, false);
    gui.key(viewer, 'W', false, false);
    gui.key(viewer, 'L', false, false);
    gui.key(viewer, 'N', false, false);
    EXPECT_TRUE(viewer.options.look.wireframe && viewer.options.look.springs && viewer.options.look.normals);
    gui.key(viewer, ' ', false, false);
    EXPECT_TRUE(viewer.options.paused);
    gui.key(viewer, '\t', false, false);
    EXPECT_FALSE(gui.shows_panel);
    gui.key(viewer, '?', false, false);
    EXPECT_TRUE(gui.shows_help);
    frame(vec2(0));
    gui.key(viewer, Gui::escape_key, false, false);
    EXPECT_FALSE(gui.shows_help);
    viewer.change({"body.1.damping=9"});
    gui.key(viewer, 'Z', true, false);
    EXPECT_EQ(viewer.experiment()->scene().bodies[0].material.damping, 3);
    gui.key(viewer, 'Z', true, true);
    EXPECT_EQ(viewer.experiment()->scene().bodies[0].material.damping, 9);
    for (int key = 0; key < 128; ++key)  // whatever comes
        if (std::string("VPEJ").find(char(key)) == std::string::npos)
            gui.key(viewer, char(key), false, false), frame(vec2(5));
    viewer.options.paused = false;
    viewer.advance(1);
}

TEST_F(GuiTest, DrawsItselfOverThePicture) {
    viewer.resize(3 * size);
    open("drape");
    viewer.options.care = Care::full;
    viewer.advance(2);
    GLuint buffer = 0, frame_buffer = 0;
    glCreateRenderbuffers(1, &buffer);
    glNamedRenderbufferStorage(buffer, GL_RGBA8, 960, 720);
    glCreateFramebuffers(1, &frame_buffer);
    glNamedFramebufferRenderbuffer(frame_buffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffer);
    Image shown{960, 720, std::vector<std::uint8_t>(4 * 960 * 720)};
    auto show = [&](bool controls) {
        glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
        glViewport(0, 0, 960, 720);
        viewer.look();
        viewer.draw();
        glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer);
        if (controls) frame(vec2(-1000));
        glReadPixels(0, 0, 960, 720, GL_RGBA, GL_UNSIGNED_BYTE, shown.pixels.data());
        return shown;
    };
    const Image bare = show(false);
    for (int i = 0; i < 3; ++i) show(true);
    const Image with = show(true);
    EXPECT_GT(difference(bare, with), 5);  // the panel
    // Where no control is, the picture is the same.
    double right = 0;
    for (int y = 100; y < 500; ++y)
        for (int x = 4 * 500; x < 4 * 900; ++x)
            right += std::abs(int(bare.pixels[std::size_t(4 * 960 * y + x)]) -
                              int(with.pixels[std::size_t(4 * 960 * y + x)]));
    EXPECT_TRUE(right / (400 * 1600) < 1) << right / (400 * 1600);
    glDeleteFramebuffers(1, &frame_buffer);
    glDeleteRenderbuffers(1, &buffer);
}

}  // namespace
}  // namespace palpate
