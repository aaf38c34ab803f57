#include "palpate/viewer/gui.h"

#include "palpate/base/clock.h"
#include "palpate/viewer/style.h"

#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace palpate {
namespace {

struct KeyHelp {
    const char *key, *what;
};
constexpr KeyHelp keys[] = {
    {"left drag", "touch and press the surface; or pin it, if that is chosen"},
    {"Shift + left drag", "grasp it and pull"},
    {"left drag beside it, right drag, Alt + left", "turn the view"},
    {"middle drag, Shift + right drag", "shift the view"},
    {"wheel", "nearer or farther; while you hold something: deeper or less deep"},
    {"1  2", "the hand, pins"},
    {"K", "leave what you pull there and take another hand; again: let all go"},
    {"Space", "pause and go on"},
    {".", "a single frame"},
    {"R", "from the beginning"},
    {"F", "look at what you touched last, or at everything"},
    {"Home", "the view of the scene"},
    {"Ctrl + Z, Ctrl + Y", "undo and redo pins and settings; undo a dent that stays"},
    {"B", "back to how it was two seconds ago"},
    {"W  L  N", "wireframe, lattice, normals as colours"},
    {"Ctrl + S", "save the scene with all that was changed"},
    {"P", "save a picture"},
    {"V", "begin or end a film"},
    {"E", "save the surface as it is now"},
    {"J", "save all inputs as a recording; drop it here to replay it"},
    {"Tab", "hide or show the controls"},
    {"?", "this list"},
    {"Esc", "close it; stop opening a file"},
};

struct KeyAction {
    char key;
    void (*act)(Viewer&);
};
constexpr KeyAction actions[] = {
    {'1', [](Viewer& viewer) { viewer.options.mode = Mode::hand; }},
    {'2', [](Viewer& viewer) { viewer.options.mode = Mode::pin; }},
    {'K', [](Viewer& viewer) { viewer.keep(); }},
    {' ', [](Viewer& viewer) { viewer.pause(); }},
    {'.', [](Viewer& viewer) { viewer.step_once(); }},
    {'R', [](Viewer& viewer) { viewer.restart(); }},
    {'F', [](Viewer& viewer) { viewer.frame_selection(); }},
    {Gui::home_key, [](Viewer& viewer) { viewer.reset_camera(); }},
    {'B', [](Viewer& viewer) { viewer.return_to_good(); }},
    {'W', [](Viewer& viewer) { viewer.options.look.wireframe ^= true; }},
    {'L', [](Viewer& viewer) { viewer.options.look.springs ^= true; }},
    {'N', [](Viewer& viewer) { viewer.options.look.normals ^= true; }},
    {'P', [](Viewer& viewer) { viewer.save(Output::picture); }},
    {'V', [](Viewer& viewer) { viewer.save(Output::film); }},
    {'E', [](Viewer& viewer) { viewer.save(Output::surface); }},
    {'J', [](Viewer& viewer) { viewer.save(Output::recording); }},
};

void colours(float scale) {
    ImGui::StyleColorsDark();
    ImGuiStyle& style = ImGui::GetStyle();
    style.WindowRounding = 0;
    style.FrameRounding = style.GrabRounding = style.ScrollbarRounding = 4;
    style.WindowBorderSize = 0;
    style.ItemSpacing = {8, 6};
    style.ScaleAllSizes(scale);
    style.Colors[ImGuiCol_WindowBg] = {0.10f, 0.11f, 0.13f, 0.88f};
    for (int which : {ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive, ImGuiCol_PlotLines})
        style.Colors[which] = {0.36f, 0.68f, 0.96f, 1};
    for (int which : {ImGuiCol_Header, ImGuiCol_Button}) style.Colors[which] = {0.22f, 0.25f, 0.30f, 1};
    for (int which :
         {ImGuiCol_HeaderHovered, ImGuiCol_ButtonHovered, ImGuiCol_HeaderActive, ImGuiCol_ButtonActive})
        style.Colors[which] = accent;
}

// ---- over the picture ----

constexpr ImGuiWindowFlags bare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                  ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

// A line of text over the picture, at this distance from its upper edge.
void over_picture(const Viewer& viewer, float height, float pivot) {
    ImGui::SetNextWindowPos({float(viewer.left()) + 0.5f * float(viewer.size().x), height}, 0, {0.5f, pivot});
}

void in_middle(const Viewer& viewer, float part) {
    over_picture(viewer, part * float(viewer.size().y), 0.5f);
}

// Converts a position in the picture to the window.
ImVec2 in_window(const Viewer& viewer, vec2 pixel) { return {float(viewer.left()) + pixel.x, pixel.y}; }

void show_start(Viewer& viewer) {
    in_middle(viewer, 0.5f);
    ImGui::Begin("start", nullptr, bare);
    ImGui::Text("Drop a mesh, a volume or a scene here, or choose one:");
    int number = 0;
    for (const ShippedScene& scene : shipped_scenes()) {
        if (number++ % 4 != 0) ImGui::SameLine();
        if (ImGui::Button(scene.name.c_str(), {9 * ImGui::GetFontSize(), 0}))
            viewer.open({scene.text, scene.name, std::filesystem::current_path()});
        about(scene.about.c_str());
    }
    ImGui::End();
}

void show_import(Viewer& viewer) {
    const Import::State state = viewer.importing()->state();
    in_middle(viewer, viewer.experiment() ? 0.9f : 0.7f);
    ImGui::Begin("import", nullptr, bare);
    ImGui::Text("opening %s", viewer.importing()->name().c_str());
    ImGui::ProgressBar(float(state.fraction), {22 * ImGui::GetFontSize(), 0});
    ImGui::TextColored(quiet, "%s", viewer.importing()->cancelled() ? "stopping" : state.doing.c_str());
    if (ImGui::Button("cancel")) viewer.cancel_import();
    ImGui::End();
}

void show_message(const Viewer& viewer, float scale) {
    const Message& message = viewer.message();
    const double age = now() - message.since;
    const bool is_long = message.bad || message.text.find('\n') != std::string::npos;
    if (message.text.empty() || age > (is_long ? 20 : 6)) return;
    over_picture(viewer, float(viewer.size().y) - 12 * scale, 1);
    ImGui::Begin("message", nullptr, bare | ImGuiWindowFlags_NoInputs);
    ImGui::PushTextWrapPos(0.7f * float(viewer.size().x));
    if (message.bad)
        ImGui::TextColored(warning, "%s", message.text.c_str());
    else
        ImGui::TextUnformatted(message.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

// A hint for beginners, until they have done it.
void show_hint(const Viewer& viewer, float scale) {
    if (viewer.touched() || viewer.importing()) return;
    over_picture(viewer, 14 * scale, 0);
    ImGui::Begin("hint", nullptr, bare | ImGuiWindowFlags_NoInputs);
    ImGui::Text(
        "Press the surface with the left button, pull it with Shift.  The right button turns, the wheel "
        "zooms.");
    ImGui::End();
}

void show_help_window(bool& open) {
    const ImVec2 window = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos({0.5f * window.x, 0.5f * window.y}, 0, {0.5f, 0.5f});
    ImGui::SetNextWindowBgAlpha(0.97f);
    ImGui::SetNextWindowFocus();
    ImGui::Begin("keys", nullptr, bare & ~ImGuiWindowFlags_NoFocusOnAppearing);
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit)) {
        for (const KeyHelp& one : keys) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextColored({0.55f, 0.78f, 0.98f, 1}, "%s", one.key);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(one.what);
        }
        ImGui::EndTable();
    }
    if (ImGui::Button("close")) open = false;
    ImGui::End();
}

// An arrow for a force at the hand, with the square root of its size, and its size as text.
void draw_arrow(const Viewer& viewer, const Arrow& arrow, float scale) {
    const float newtons = glm::length(arrow.force);
    if (!(newtons > 0)) return;
    const ivec2 size = viewer.view_size();
    const float reach = glm::distance(viewer.camera().eye, viewer.camera().look_at);
    const float shown = 0.06f * reach * std::sqrt(std::min(newtons, 20.0f));
    const auto from = pixel_of(viewer.camera(), arrow.at, size);
    const auto to = pixel_of(viewer.camera(), arrow.at + arrow.force / newtons * shown, size);
    if (!from || !to) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const ImU32 colour = ImGui::GetColorU32(warning), dark = IM_COL32(0, 0, 0, 160);
    const vec2 way = *to - *from;
    const float length = glm::length(way);
    if (length > 4) {
        const vec2 along = way / length, across(-along.y, along.x);
        const vec2 neck = *to - 10 * scale * along;
        auto at = [&](vec2 p) { return in_window(viewer, p); };
        list.AddLine(at(*from), at(neck), dark, 5 * scale);
        list.AddLine(at(*from), at(neck), colour, 3 * scale);
        list.AddTriangleFilled(at(*to), at(neck + 6 * scale * across), at(neck - 6 * scale * across), colour);
    }
    const std::string text = fmt::format("{:.2f} N", newtons);
    const ImVec2 corner = in_window(viewer, *to + vec2(8, -8) * scale);
    const ImVec2 box = ImGui::CalcTextSize(text.c_str());
    list.AddRectFilled({corner.x - 3, corner.y - 2}, {corner.x + box.x + 3, corner.y + box.y + 2}, dark, 3);
    list.AddText(corner, IM_COL32_WHITE, text.c_str());
}

// A ring of the size of the tip that touches.
void draw_tip(const Viewer& viewer, float scale) {
    if (!viewer.shows_tip()) return;
    const Camera camera = viewer.camera();
    const vec3 centre = viewer.feeling()->felt().proxy, to = camera.look_at - camera.eye;
    const vec3 aside = viewer.options.tip * glm::normalize(glm::cross(to, camera.up));
    const auto middle = pixel_of(camera, centre, viewer.view_size());
    const auto rim = pixel_of(camera, centre + aside, viewer.view_size());
    if (!middle || !rim) return;
    ImGui::GetBackgroundDrawList()->AddCircle(in_window(viewer, *middle), glm::distance(*middle, *rim),
                                              IM_COL32(90, 175, 245, 255), 48, 2 * scale);
}

void label_views(const Viewer& viewer, float scale) {
    if (!viewer.beside()) return;
    const Compared& compared = viewer.options.compared;
    const bool backend = compared.with == Compared::With::backend;
    auto name = [&](const Experiment& one) {
        return std::string(backend ? name_of(one.models().simulation.backend)
                                   : name_of(one.scene().bodies.front().mapping));
    };
    constexpr ImU32 dark = IM_COL32(20, 22, 26, 255);
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float middle = float(viewer.left() + viewer.view_size().x), top = 52 * scale;
    list.AddLine({middle, 0}, {middle, float(viewer.size().y)}, IM_COL32(0, 0, 0, 200), 2 * scale);
    const std::string left = name(*viewer.experiment()), right = name(*viewer.beside());
    list.AddText({middle - ImGui::CalcTextSize(left.c_str()).x - 12 * scale, top}, dark, left.c_str());
    list.AddText({middle + 12 * scale, top}, dark, right.c_str());
}

}  // namespace

Gui::Gui(float scale) : context_(ImGui::CreateContext()), scale_(scale) {
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    const char* font = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
    static constexpr ImWchar ranges[] = {0x20, 0xff, 0x3b1, 0x3c9, 0x2010, 0x2030, 0x2070, 0x209f, 0};
    if (std::error_code error; std::filesystem::exists(font, error))
        io.Fonts->AddFontFromFileTTF(font, letters * scale, nullptr, ranges);
    else
        io.FontGlobalScale = std::round(scale);
    colours(scale);
    ImGui_ImplOpenGL3_Init("#version 450 core");
}

Gui::~Gui() {
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext(context_);
}

int Gui::beside(const Viewer& viewer, int window) const {
    const int width = int(panel_width * scale_);
    return shows_panel && viewer.experiment() && window >= 2 * width ? width : 0;
}

bool Gui::wants_pointer() const { return ImGui::GetIO().WantCaptureMouse; }
bool Gui::wants_keys() const { return ImGui::GetIO().WantTextInput; }

void Gui::build(Viewer& viewer) {
    if (!viewer.experiment() && !viewer.importing()) show_start(viewer);
    if (viewer.experiment()) {
        for (const Arrow& arrow : viewer.arrows()) draw_arrow(viewer, arrow, scale_);
        draw_tip(viewer, scale_);
        label_views(viewer, scale_);
        if (shows_panel) controls_.show(viewer, scale_);
        show_hint(viewer, scale_);
    }
    if (viewer.importing()) show_import(viewer);
    if (shows_help) show_help_window(shows_help);
    show_message(viewer, scale_);
    ImGui::Render();
}

void Gui::draw() { ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData()); }

void Gui::key(Viewer& viewer, char key, bool control, bool shift) {
    if (control) {
        if (key == 'Z') shift ? viewer.redo() : viewer.undo();
        if (key == 'Y') viewer.redo();
        if (key == 'S') viewer.save(Output::scene);
        return;
    }
    for (const KeyAction& one : actions)
        if (one.key == key) one.act(viewer);
    if (key == '\t') shows_panel = !shows_panel;
    if (key == '?') shows_help = !shows_help;
    if (key != escape_key) return;
    if (!shows_help) viewer.cancel_import();
    shows_help = false;
}

}  // namespace palpate
