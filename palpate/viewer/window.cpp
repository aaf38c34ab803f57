#include "palpate/viewer/window.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/realtime.h"
#include "palpate/viewer/show.h"

#define GLFW_INCLUDE_NONE  // epoxy has OpenGL's names
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string>

namespace palpate {
namespace {

constexpr double round_seconds = 1.0 / 60;  // the shortest round
constexpr int most_frames = 2;              // frames of the scene per round: rather slower than real time
                                            // than unresponsive

// GLFW's description of its last error.
std::string complaint() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

// Initialises GLFW, for the lifetime of a window.
struct Glfw {
    Glfw() {
        if (!glfwInit())
            throw Error("no display to open a window on (" + complaint() + ")", "the viewer",
                        "run it on a desktop; or run a scene off screen, by palpate run SCENE --headless");
    }
    ~Glfw() { glfwTerminate(); }
};

GLFWwindow* make_window(ivec2 size, bool visible = true) {
    glfwWindowHint(GLFW_VISIBLE, visible);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
    GLFWwindow* window = glfwCreateWindow(size.x, size.y, "Palpate", nullptr, nullptr);
    if (!window)
        throw Error("no window with OpenGL 4.5 (" + complaint() + ")", "the viewer",
                    "update the graphics driver; or run a scene off screen, by palpate run SCENE --headless");
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    return window;
}

float density(GLFWwindow* window) {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window, &x, &y);
    return std::clamp(std::max(x, y), 1.0f, 4.0f);
}

ivec2 pixels(GLFWwindow* window) {
    ivec2 size(0);
    glfwGetFramebufferSize(window, &size.x, &size.y);
    return size;
}

// Converts from screen units to pixels, which may differ.
vec2 pixels_a_unit(GLFWwindow* window) {
    ivec2 units(0);
    glfwGetWindowSize(window, &units.x, &units.y);
    return vec2(pixels(window)) / vec2(glm::max(units, ivec2(1)));
}

}  // namespace

void check_window() {
    const Glfw glfw;
    make_window(ivec2(64), false);
    gl::Context::adopt();
}

struct Window::Parts {
    Glfw glfw;
    GLFWwindow* window;
    gl::Context context;
    Viewer viewer;
    Gui gui;
    double last = now();
    double due = 0;        // frames
    bool repeats = false;  // a key that is held down repeats

    explicit Parts(ivec2 size)
        : window(make_window(size)),
          context(gl::Context::adopt()),
          viewer(context, pixels(window)),
          gui(density(window)) {
        glfwSetWindowUserPointer(window, this);
        ImGui_ImplGlfw_InitForOpenGL(window, false);
        listen();
    }
    ~Parts() {
        ImGui_ImplGlfw_Shutdown();  // the window is destroyed with GLFW, after everything in its context
    }

    static Parts& of(GLFWwindow* window) { return *static_cast<Parts*>(glfwGetWindowUserPointer(window)); }

    void listen();
    void key(int key, int scancode, int mods);
    void letter(unsigned code);
    void button(int button, bool down, int mods);
    void begin_gui();
};

// ImGui gets all events; the viewer gets those that are not meant for a control.
void Window::Parts::listen() {
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        of(w).viewer.move_pointer(vec2(x, y) * pixels_a_unit(w));
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int mods) {
        ImGui_ImplGlfw_MouseButtonCallback(w, button, action, mods);
        of(w).button(button, action == GLFW_PRESS, mods);
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
        ImGui_ImplGlfw_ScrollCallback(w, x, y);
        if (!of(w).gui.wants_pointer()) of(w).viewer.wheel(float(y));
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
        ImGui_ImplGlfw_KeyCallback(w, key, scancode, action, mods);
        of(w).repeats = action == GLFW_REPEAT;
        if (action == GLFW_PRESS && !of(w).gui.wants_keys()) of(w).key(key, scancode, mods);
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code) {
        ImGui_ImplGlfw_CharCallback(w, code);
        if (!of(w).gui.wants_keys() && !of(w).repeats) of(w).letter(code);
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** files) {
        if (count > 0) of(w).viewer.open_file(files[0]);
    });
}

// Keys that type no letter, and keys with Ctrl; the latter by what is printed on them.
void Window::Parts::key(int key, int scancode, int mods) {
    const bool control = mods & (GLFW_MOD_CONTROL | GLFW_MOD_SUPER), shift = mods & GLFW_MOD_SHIFT;
    if (key == GLFW_KEY_HOME) gui.key(viewer, Gui::home_key, false, shift);
    if (key == GLFW_KEY_TAB) gui.key(viewer, '\t', false, shift);
    if (key == GLFW_KEY_ESCAPE) gui.key(viewer, Gui::escape_key, false, shift);
    if (!control) return;
    if (const char* name = glfwGetKeyName(key, scancode); name && name[0] && !name[1])
        gui.key(viewer, char(std::toupper(static_cast<unsigned char>(name[0]))), true, shift);
}

void Window::Parts::letter(unsigned code) {
    if (code < 0x80) gui.key(viewer, char(std::toupper(int(code))), false, false);
}

void Window::Parts::button(int button, bool down, int mods) {
    const Button which = button == GLFW_MOUSE_BUTTON_LEFT    ? Button::left
                         : button == GLFW_MOUSE_BUTTON_RIGHT ? Button::right
                                                             : Button::middle;
    if (!down)
        viewer.release(which);
    else if (!gui.wants_pointer())
        viewer.press(which, mods & GLFW_MOD_SHIFT, mods & GLFW_MOD_ALT);
}

// ImGui counts in pixels here, as the viewer does.
void Window::Parts::begin_gui() {
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGuiIO& io = ImGui::GetIO();
    const ivec2 size = pixels(window);
    const vec2 scale = pixels_a_unit(window);
    io.DisplaySize = {float(size.x), float(size.y)};
    io.DisplayFramebufferScale = {1, 1};
    if (io.MousePos.x > -1e6f) io.MousePos = {io.MousePos.x * scale.x, io.MousePos.y * scale.y};
    ImGui::NewFrame();
}

Window::Window(ivec2 size) : parts_(std::make_unique<Parts>(size)) {}
Window::~Window() = default;
Viewer& Window::viewer() { return parts_->viewer; }
Gui& Window::gui() { return parts_->gui; }

bool Window::round() {
    Parts& p = *parts_;
    // Waits until it is due, and for longer if nothing moves.
    const bool idle = p.viewer.options.paused && !p.viewer.importing() && !p.viewer.is_holding();
    const double wait = p.last + (idle ? 3 : 1) * round_seconds - now();
    if (p.viewer.is_live()) {
        sleep_until(p.last + round_seconds);
        p.viewer.hold_still();
        glfwPollEvents();
    } else {
        wait > 1e-4 ? glfwWaitEventsTimeout(wait) : glfwPollEvents();
    }
    if (glfwWindowShouldClose(p.window)) return false;
    const double time = now();
    p.due = std::min(p.due + (time - p.last) / round_seconds, double(most_frames));
    p.last = time;
    const int frames = int(p.due);
    p.due -= frames;
    p.viewer.advance(frames);
    const ivec2 size = pixels(p.window);
    if (size.x < 1 || size.y < 1) return true;  // it is minimised
    const int beside = p.gui.beside(p.viewer, size.x);
    p.viewer.resize({size.x - beside, size.y}, beside);
    p.begin_gui();
    p.viewer.look();
    p.gui.build(p.viewer);
    p.viewer.go_on();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, size.x, size.y);
    glClearColor(0.16f, 0.18f, 0.21f, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    p.viewer.draw();
    p.gui.draw();
    glfwSwapBuffers(p.window);
    return true;
}

void Window::run() {
    while (round()) {}
}

}  // namespace palpate
