// The window on a display of its own (Xvfb), driven by the events of a real mouse and keyboard as the X
// server makes them.
#include "palpate/viewer/window.h"

#include "palpate/base/files.h"
#include "palpate/files/write.h"
#include "tests/refusal.h"
#include "tests/scratch.h"
#include "tests/shapes.h"
#include "tests/viewer/display.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace palpate {
namespace {

// The rows between the hint above and the messages below, which come and go with time.
std::vector<std::uint8_t> middle_rows(const std::vector<std::uint8_t>& pixels) {
    const auto quarter = std::ptrdiff_t(pixels.size() / 4);
    return {pixels.begin() + quarter, pixels.end() - quarter};
}

double difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    if (a.size() != b.size() || a.empty()) return NAN;
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(int(a[i]) - int(b[i]));
    return sum / double(a.size());
}

class WindowTest : public testing::Test {
 protected:
    void SetUp() override {
        if (xvfb.name().empty()) GTEST_SKIP() << "not available: the program Xvfb";
        setenv("DISPLAY", xvfb.name().c_str(), 1);
        window = std::make_unique<palpate::Window>(ivec2(640, 480));
        person = std::make_unique<Person>(xvfb.name());
        window->viewer().options.care = Care::full;
        window->gui().shows_panel = false;
    }
    void rounds(int count) {
        for (int i = 0; i < count; ++i) window->round();
    }
    void open(const char* scene) {
        window->viewer().open(find_scene(scene));
        while (window->viewer().importing()) rounds(1);
        ASSERT_TRUE(window->viewer().experiment()) << window->viewer().message().text;
        rounds(3);
    }
    Viewer& viewer() { return window->viewer(); }
    vec2 middle() {
        vec3 sum(0);
        const auto& positions = viewer().experiment()->play().skins()[0].positions;
        for (vec3 p : positions) sum += p;
        return *pixel_of(viewer().camera(), sum / float(positions.size()), viewer().view_size());
    }
    void drag(vec2 from, vec2 to, unsigned button) {
        person->move(from);
        rounds(1);
        if (button == 1) person->hold(XK_Shift_L, true);  // so that it grasps
        person->button(button, true);
        rounds(1);
        if (button == 1) person->hold(XK_Shift_L, false);
        for (int i = 1; i <= 8; ++i) {
            person->move(glm::mix(from, to, float(i) / 8));
            rounds(1);
        }
    }

    Xvfb xvfb;
    std::unique_ptr<palpate::Window> window;
    std::unique_ptr<Person> person;
};

TEST_F(WindowTest, OpensTurnsAndComesBack) {
    open("box");
    person->move(vec2(20, 460));
    person->key(XK_space);  // pause
    rounds(3);
    ASSERT_TRUE(viewer().options.paused);
    const vec3 eye = viewer().camera().eye;
    rounds(2);
    const auto before = middle_rows(person->look());
    drag(vec2(30, 440), vec2(200, 380), 3);
    person->button(3, false);
    rounds(3);
    EXPECT_GT(glm::distance(viewer().camera().eye, eye), 0.05f);
    EXPECT_GT(difference(middle_rows(person->look()), before), 1);
    person->button(4, true), person->button(4, false);  // the wheel
    rounds(2);
    EXPECT_LT(glm::distance(viewer().camera().eye, viewer().camera().look_at),
              0.95f * glm::distance(eye, viewer().camera().look_at));
    person->key(XK_Home);
    rounds(3);
    EXPECT_EQ(viewer().camera().eye, eye);
    EXPECT_TRUE(difference(middle_rows(person->look()), before) < 1);
}

TEST_F(WindowTest, GrabsDragsAndReleasesWhileTheBackendChanges) {
    open("box");
    rounds(20);
    const double before = viewer().experiment()->play().save()[0].positions[456].y;
    const vec2 from = middle();
    drag(from, from + vec2(0, -120), 1);
    ASSERT_EQ(viewer().holds().size(), 1u);
    for (const char* backend : {"reference", "feedback", "cpu"}) {
        viewer().change({std::string("simulation.backend=\"") + backend + "\""});
        rounds(4);
        EXPECT_EQ(viewer().holds().size(), 1u) << backend << ": " << viewer().message().text;
    }
    for (int i = 0; i < 120 && viewer().experiment()->time() < 3; ++i) rounds(1);
    EXPECT_GT(viewer().experiment()->play().save()[0].positions[456].y, before + 0.002);
    person->button(1, false);
    rounds(2);
    EXPECT_TRUE(viewer().holds().empty());
    EXPECT_TRUE(viewer().experiment()->trouble().empty());
}

TEST_F(WindowTest, KeysAreHeard) {
    open("box");
    person->move(vec2(300, 200));
    rounds(1);
    person->key(XK_2);
    rounds(2);
    EXPECT_EQ(viewer().options.mode, Mode::pin);
    person->key(XK_w);
    rounds(2);
    EXPECT_TRUE(viewer().options.look.wireframe);
    viewer().change({"body.1.damping=7"});
    person->key(XK_z, true);
    rounds(3);
    EXPECT_EQ(viewer().experiment()->scene().bodies[0].material.damping, 3);
    person->key(XK_Tab);
    rounds(2);
    EXPECT_TRUE(window->gui().shows_panel);
}

TEST_F(WindowTest, ABrokenFileIsDroppedThenAGoodOne) {
    const Scratch scratch;
    open("box");
    write_text(scratch / "broken.ply", "ply\nformat ascii 1.0\n");
    person->drop((scratch / "broken.ply").string(), [&] { rounds(1); });
    while (!viewer().message().bad) rounds(1);
    EXPECT_NE(viewer().message().text.find("broken.ply"), std::string::npos) << viewer().message().text;
    EXPECT_EQ(viewer().experiment()->source().name, "box");
    write_mesh(ellipsoid(vec3(0.1f), 12), scratch / "ball.ply");
    person->drop((scratch / "ball.ply").string(), [&] { rounds(1); });
    while (viewer().experiment()->source().name == "box") rounds(1);
    EXPECT_EQ(viewer().experiment()->source().name, "ball") << viewer().message().text;
}

TEST_F(WindowTest, ResizesToNothingAndBack) {
    open("box");
    for (auto [width, height] : {std::pair(1u, 1u), {2u, 900u}, {1100u, 3u}, {800u, 600u}}) {
        person->resize(width, height);
        rounds(4);
        EXPECT_EQ(viewer().size(), ivec2(width, height));
    }
    EXPECT_EQ(person->look().size(), 3u * 800 * 600);
    drag(middle(), middle() + vec2(20, 0), 1);
    EXPECT_EQ(viewer().holds().size(), 1u);
    person->button(1, false);
}

TEST_F(WindowTest, ClosesWhileItImports) {
    viewer().open(find_scene("brain"));
    rounds(3);
    ASSERT_TRUE(viewer().importing());
    person->close();
    bool open = true;
    for (int i = 0; i < 20 && open; ++i) open = window->round();
    EXPECT_FALSE(open);
    window.reset();
}

TEST(ShowTest, AProgramShowsABodyUntilItsWindowIsClosed) {
    const Xvfb xvfb;
    if (xvfb.name().empty()) GTEST_SKIP() << "not available: the program Xvfb";
    const pid_t program = fork();
    if (program == 0) {
        setenv("DISPLAY", xvfb.name().c_str(), 1);
        // Drivers are unloaded when the program ends, so that what they kept has no name to be forgiven by.
        setenv("ASAN_OPTIONS", "detect_leaks=0", 1);
        execl(PALPATE_SHOWS, PALPATE_SHOWS, static_cast<char*>(nullptr));
        _exit(127);
    }
    Person person(xvfb.name());
    int status = -1;
    auto goes_on = [&] { return waitpid(program, &status, WNOHANG) == 0; };
    while (!person.sees_window() && goes_on()) usleep(20'000);
    auto colours = [&] {
        std::set<int> all;
        for (std::uint8_t value : person.look()) all.insert(value);
        return all.size();
    };
    while (colours() < 100 && goes_on()) usleep(20'000);  // a body in the light, and the controls
    person.close();
    while (goes_on()) usleep(20'000);
    EXPECT_TRUE(WIFEXITED(status)) << status;
    EXPECT_EQ(WEXITSTATUS(status), 0);
}

TEST(NoWindow, WithoutADisplayItSaysSo) {
    const char* before = std::getenv("DISPLAY");
    const std::string kept = before ? before : "";
    setenv("DISPLAY", ":6553", 1);
    expect_refused("--headless", [] { const palpate::Window window; });
    before ? setenv("DISPLAY", kept.c_str(), 1) : unsetenv("DISPLAY");
}

}  // namespace
}  // namespace palpate
