// The viewer with the scene "brain" while somebody pulls at it and feels it: pictures of 1280 × 720 a second,
// and the time that each takes.
#include "palpate/viewer/viewer.h"

#include "bench/speed/drawing.h"
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/gl/handle.h"
#include "palpate/viewer/gui.h"

#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>

namespace palpate::speed {
namespace {

constexpr ivec2 size(1280, 720);
constexpr double seconds_a_round = 1;

enum class Doing { watching, pulling, pressing };  // pressing: something is pulled as well

constexpr std::pair<Doing, const char*> all_doings[] = {
    {Doing::watching, "watching"}, {Doing::pulling, "pulling"}, {Doing::pressing, "pulling and pressing"}};

// Stands in for a window's framebuffer.
struct Screen {
    gl::Framebuffer framebuffer;
    GLuint pixels = 0;
    Screen() {
        glCreateRenderbuffers(1, &pixels);
        glNamedRenderbufferStorage(pixels, GL_RGBA8, size.x, size.y);
        glNamedFramebufferRenderbuffer(framebuffer.name(), GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixels);
    }
    ~Screen() { glDeleteRenderbuffers(1, &pixels); }
};

// The mean times of a picture, ms.
struct Line {
    std::string name;
    double pictures = 0;  // a second
    double simulate = 0, map = 0, draw = 0, controls = 0;
    double pace = 0;                  // s of the scene per second
    double haptics = 0, longest = 0;  // Hz; ms
};

vec2 around(vec2 middle, double time) {
    return middle + 40.0f * vec2(std::cos(3 * time), std::sin(3 * time));
}

void begin(Viewer& viewer, Doing doing, vec2 middle) {
    if (doing == Doing::watching) return;
    viewer.move_pointer(middle);
    viewer.press(Button::left, true);
    if (doing == Doing::pulling) return;
    viewer.keep();
    viewer.release(Button::left);
    viewer.move_pointer(middle + vec2(150, 60));
    viewer.advance(1);
    viewer.press(Button::left);
}

Line measure(Viewer& viewer, Gui& gui, const Screen& screen, Doing doing, double seconds) {
    const vec2 middle(800, 330);
    begin(viewer, doing, middle);
    Line line;
    double start = now(), last = start, due = 0, simulated = 0, mapped = 0, began = 0;
    int pictures = -10;  // warm-up: the first ten do not count
    while (now() - start < seconds || pictures < 5) {
        const double time = now();
        if (pictures == 0) {
            start = time;
            simulated = viewer.experiment()->report().seconds.simulate;
            mapped = viewer.experiment()->report().seconds.map;
            began = viewer.experiment()->time();
            line.draw = line.controls = 0;
        }
        if (doing != Doing::watching)
            viewer.move_pointer(around(middle + (doing == Doing::pressing ? vec2(150, 60) : vec2(0)), time));
        due = std::min(due + 60 * (time - last), 2.0);
        last = time;
        viewer.hold_still();
        viewer.advance(int(due));
        due -= int(due);
        {
            Timed timed(line.controls);
            ImGui::GetIO().DisplaySize = {float(size.x), float(size.y)};
            ImGui::GetIO().DeltaTime = 1.0f / 30;
            ImGui_ImplOpenGL3_NewFrame();
            ImGui::NewFrame();
            gui.build(viewer);
        }
        glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer.name());
        {
            Timed timed(line.draw);
            viewer.look();
            viewer.go_on();
            viewer.draw();
        }
        Timed timed(line.controls);
        glBindFramebuffer(GL_FRAMEBUFFER, screen.framebuffer.name());
        gui.draw();
        glFinish();
        ++pictures;
    }
    viewer.hold_still();
    const double passed = now() - start;
    const Report& report = viewer.experiment()->report();
    line.pictures = pictures / passed;
    line.simulate = 1000 * (report.seconds.simulate - simulated) / pictures;
    line.map = 1000 * (report.seconds.map - mapped) / pictures;
    line.draw *= 1000.0 / pictures;
    line.controls *= 1000.0 / pictures;
    line.pace = (viewer.experiment()->time() - began) / passed;
    if (const FeltHand* hand = viewer.feeling()) {
        line.haptics = 1 / hand->loop().timing().periods.mean();
        line.longest = 1000 * hand->loop().timing().periods.longest();
    }
    viewer.release(Button::left);
    viewer.keep();
    return line;
}

Timings run(int rounds) {
    const gl::Context context;
    Viewer viewer(context, size);
    Gui gui(1);
    const Screen screen;
    const int beside = 330;  // as wide as the controls
    viewer.resize({size.x - beside, size.y}, beside);
    viewer.open(find_scene("brain"));
    while (viewer.importing()) {
        viewer.advance(0);
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    if (!viewer.experiment()) throw Error(viewer.message().text);
    Timings timings;
    timings.driver = fmt::format(
        "OpenGL by {}. {} nodes, {} vertices, {} faces, {} threads.", context.renderer(),
        viewer.experiment()->report().bodies[0].nodes, viewer.experiment()->report().bodies[0].vertices,
        viewer.experiment()->report().bodies[0].faces, viewer.experiment()->models().simulation.threads);
    for (auto [doing, name] : all_doings) {
        const Line line = measure(viewer, gui, screen, doing, rounds * seconds_a_round);
        auto add = [&](const char* what, double value) {
            timings.figures.push_back({fmt::format("{}: {}", name, what), value});
        };
        add("pictures_per_second", line.pictures);
        add("simulate_ms", line.simulate);
        add("map_ms", line.map);
        add("draw_ms", line.draw);
        add("controls_ms", line.controls);
        add("pace", line.pace);
        add("haptics_hz", line.haptics);
        add("longest_period_ms", line.longest);
    }
    return timings;
}

std::string text(const Timings& timings) {
    const std::string columns[] = {"",
                                   "pictures a second",
                                   "simulate, ms a picture",
                                   "map",
                                   "draw",
                                   "controls",
                                   "of real time",
                                   "haptics, Hz",
                                   "longest period, ms"};
    constexpr std::size_t figures_a_line = std::size(columns) - 1;
    std::string text = timings.driver + "\n\n" + head(columns);
    for (std::size_t first = 0; first < timings.figures.size(); first += figures_a_line) {
        const std::string& name = timings.figures[first].name;
        std::vector<std::string> cells = {name.substr(0, name.find(':'))};
        for (std::size_t i = 0; i < figures_a_line; ++i) {
            const double value = timings.figures[first + i].value;
            cells.push_back(value > 0 ? fmt::format("{:.{}f}", value, value < 1.5 ? 2 : 1) : "–");
        }
        text += row(cells);
    }
    return text;
}

}  // namespace

Benchmark viewer() {
    return {"viewer", "the brain at 1280 × 720, while somebody pulls at it and feels it", false, run, text};
}

}  // namespace palpate::speed
