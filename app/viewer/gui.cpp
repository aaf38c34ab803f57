#include "app/viewer/gui.h"

#include "palpate/base/clock.h"
#include "palpate/run/run.h"
#include "palpate/solver/stability.h"

#include <backends/imgui_impl_opengl3.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace palpate {
namespace {

// Blue and orange, which all people can tell apart; red only beside words.
const ImVec4 accent(0.16f, 0.47f, 0.76f, 1), warning(0.95f, 0.62f, 0.10f, 1), quiet(0.66f, 0.69f, 0.74f, 1);
constexpr float letters = 15, panel_width = 330;  // pixels, times the scale

struct KeyHelp {
    const char *key, *what;
};
constexpr KeyHelp keys[] = {
    {"left drag", "reach in: pull, press, dent or pin, whichever is chosen"},
    {"left drag beside it, right drag, Alt + left", "turn the view"},
    {"middle drag, Shift + right drag", "shift the view"},
    {"wheel", "nearer or farther; while you hold something: deeper or less deep"},
    {"1  2  3  4", "pull, press, dent, pin"},
    {"K", "leave what you hold there and take another hand; again: let all go"},
    {"Space", "pause and go on"},
    {".", "a single frame"},
    {"R", "from the beginning"},
    {"F", "look at what you touched last, or at everything"},
    {"Home", "the view of the scene"},
    {"Ctrl + Z, Ctrl + Y", "undo and redo pins and settings"},
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

// A name out of all of an enumeration's.
template <class E>
bool choose(const char* label, E& value) {
    bool chosen = false;
    if (!ImGui::BeginCombo(label, std::string(name_of(value)).c_str())) return false;
    for (const auto& one : names(E{}))
        if (ImGui::Selectable(std::string(one.name).c_str(), one.value == value)) {
            value = one.value;
            chosen = true;
        }
    ImGui::EndCombo();
    return chosen;
}

void about(const char* text) {
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text);
}

// Whether a slider has moved, and whether it has been moving before: then both are one change.
struct Slid {
    bool moved = false, again = false;
};

// There is one pointer, and it holds one slider at a time.
Slid slid(bool moved) {
    static bool has_moved = false;  // since it was taken hold of
    if (ImGui::IsItemActivated()) has_moved = false;
    const Slid result{moved, moved && has_moved};
    has_moved |= moved;
    return result;
}

Slid slide(const char* label, float& value, float low, float high, const char* format,
           bool logarithmic = false) {
    return slid(
        ImGui::SliderFloat(label, &value, low, high, format,
                           (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp));
}

// The same for what takes the solver a while: it counts when it is let go of.
bool slide_and_let_go(const char* label, float& value, float low, float high, const char* format) {
    static ImGuiID held = 0;
    static float at = 0;  // where that is
    const ImGuiID here = ImGui::GetID(label);
    if (held == here) value = at;
    ImGui::SliderFloat(label, &value, low, high, format,
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) {
        held = here;
        at = value;
    } else if (held == here) {
        held = 0;
        return ImGui::IsItemDeactivatedAfterEdit();
    }
    return false;
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

// ---- the parts of the panel ----

void show_hand(Viewer& viewer) {
    Options& options = viewer.options;
    for (const auto& mode : names(Mode{})) {
        if (mode.value != Mode::pull) ImGui::SameLine();
        if (ImGui::RadioButton(std::string(mode.name).c_str(), options.mode == mode.value))
            options.mode = mode.value;
    }
    const float most = std::max(0.05f, 2 * options.tip);
    float millimetres = 1000 * options.tip;
    if (ImGui::SliderFloat("tip", &millimetres, 1, 1000 * most, "%.1f mm",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        options.tip = millimetres / 1000;
    about("the radius of what presses, dents and pins");
    if (options.mode == Mode::pin) return;
    choose("device", options.device);
    about("what moves the hand; a mouse is felt only where it dents");
    if (options.device == DeviceKind::mouse) return;
    static char file[512] = "";
    ImGui::InputTextWithHint(options.device == DeviceKind::playback ? "log" : "path",
                             options.device == DeviceKind::playback ? "felt.csv" : "rows of t, x, y, z", file,
                             sizeof file);
    if (ImGui::IsItemDeactivatedAfterEdit()) options.device_file = file;
}

void show_dent_width(Viewer& viewer) {
    auto show = [&](const char* kind, std::size_t i, const BodyRecipe recipe) {
        float width = 1000 * float(recipe.feel.dent_width);
        if (const Slid s = slide(("dent in " + recipe.name).c_str(), width, 1, 50, "%.1f mm", true); s.moved)
            viewer.change({fmt::format("{}.{}.touch.width={}", kind, i + 1, number(width / 1000))}, s.again);
        about("the width of dents in it: their standard deviation");
    };
    // Asked for anew each time, since a change makes another scene.
    auto scene = [&]() -> const Scene& { return viewer.experiment()->scene(); };
    for (std::size_t i = 0; i < scene().bodies.size(); ++i) show("body", i, scene().bodies[i]);
    for (std::size_t i = 0; i < scene().surfaces.size(); ++i) show("surface", i, scene().surfaces[i]);
}

void show_motion(Viewer& viewer) {
    const Simulation simulation = viewer.experiment()->models().simulation;  // a change makes another
    Integrator integrator = simulation.integrator;
    if (choose("integrator", integrator))
        viewer.change({fmt::format("simulation.integrator=\"{}\"", name_of(integrator))});
    Backend backend = simulation.backend;
    if (choose("backend", backend))
        viewer.change({fmt::format("simulation.backend=\"{}\"", name_of(backend))});
    about("where it is computed; the motion goes on from where it is");
    if (backend == Backend::cpu) {
        int threads = simulation.threads;
        if (const Slid s =
                slid(ImGui::SliderInt("threads", &threads, 1, 8, "%d", ImGuiSliderFlags_AlwaysClamp));
            s.moved)
            viewer.change({fmt::format("simulation.threads={}", threads)}, s.again);
    }
}

// The step beside the longest that is stable.
void show_step(Viewer& viewer) {
    const Experiment& experiment = *viewer.experiment();
    const double step = experiment.models().simulation.step;  // a change makes other models
    double bound = 1;
    for (std::size_t m = 0; m < experiment.models().models.size(); ++m)
        bound = std::min(bound, experiment.stable_step(m));
    bool automatic = step == 0;
    double taken = automatic ? frame_seconds / experiment.play().steps_per_frame() : step;
    for (const Stats& stats : experiment.play().stats())
        if (automatic) taken = std::max(taken, stats.step);
    if (ImGui::Checkbox("automatic step", &automatic))
        viewer.change({automatic ? std::string("simulation.step=\"auto\"")
                                 : "simulation.step=" + number(std::clamp(taken, 1e-5, 0.0166))});
    if (!automatic) {
        float milliseconds = float(1000 * step);
        const float high = float(std::min(1.5 * 1000 * bound, 16.6));
        if (slide_and_let_go("step", milliseconds, 0.02f, std::max(high, 0.05f), "%.3f ms"))
            viewer.change({"simulation.step=" + number(milliseconds / 1000.0)});
    } else {
        ImGui::Text("step %.3f ms", 1000 * taken);
    }
    const bool unstable = step > bound;
    if (unstable)
        ImGui::TextColored(warning, "unstable above %.3f ms", 1000 * bound);
    else
        ImGui::TextColored(quiet, "stable up to %.3f ms, untouched", 1000 * bound);
}

void show_body(Viewer& viewer, std::size_t b) {
    const BodyRecipe recipe = viewer.experiment()->scene().bodies[b];  // a change makes another scene
    auto change = [&](const std::string& key, const std::string& value) {
        viewer.change({fmt::format("body.{}.{}={}", b + 1, key, value)});
    };
    Mapping mapping = recipe.mapping;
    if (choose("mapping", mapping)) change("mapping", fmt::format("\"{}\"", name_of(mapping)));
    about("how the surface follows the nodes");
    const Material& material = recipe.material;
    auto amount = [&](const char* label, const char* key, float value, const char* format) {
        if (!(value > 0)) return;
        const float middle = std::pow(10.0f, std::round(std::log10(value)));
        if (slide_and_let_go(label, value, middle / 100, middle * 100, format)) change(key, number(value));
    };
    amount("Young's mod.", "youngs_modulus", material.youngs_modulus, "%.3g Pa");
    amount("stiffness", "stiffness", material.stiffness, "%.3g N/m");
    if (recipe.springs) {
        amount("structural", "springs.structural", recipe.springs->structural, "%.3g N/m");
        amount("shear", "springs.shear", recipe.springs->shear, "%.3g N/m");
        amount("flexion", "springs.flexion", recipe.springs->flexion, "%.3g N/m");
    }
    amount("density", "density", material.density, recipe.is_cloth() ? "%.3g kg/m²" : "%.4g kg/m³");
    amount("mass", "mass", material.mass, "%.3g kg");
    float damping = material.damping;
    if (slide_and_let_go("damping", damping, 0, 50, "%.2f 1/s")) change("damping", number(damping));
}

void show_surroundings(Viewer& viewer) {
    const Experiment& experiment = *viewer.experiment();
    vec3 gravity = experiment.scene().simulation.gravity;
    if (const Slid s = slid(ImGui::SliderFloat3("gravity", &gravity.x, -20, 20, "%.1f")); s.moved)
        viewer.change({fmt::format("simulation.gravity=[{},{},{}]", gravity.x, gravity.y, gravity.z)},
                      s.again);
    about("m/s²");
    constexpr float usual_air = 1.2f;  // kg/m³
    const float air = experiment.scene().simulation.air;
    vec3 wind =
        experiment.scene().wind.empty() ? vec3(0) : position(experiment.scene().wind, experiment.time());
    if (const Slid s = slid(ImGui::SliderFloat3("wind", &wind.x, -15, 15, "%.1f")); s.moved)
        viewer.change({fmt::format("wind={{velocity=[{},{},{}]}}", wind.x, wind.y, wind.z),
                       "simulation.air=" + number(air > 0 ? air : usual_air)},
                      s.again);
    about("m/s; moves sheets and surfaces");
    for (std::size_t c = 0; c < experiment.scene().colliders.size(); ++c) {
        const Collider collider = experiment.scene().colliders[c].collider;  // a change makes another scene
        ImGui::PushID(int(c));
        auto change = [&](const std::string& key, const std::string& value, bool again) {
            viewer.change({fmt::format("collider.{}.{}={}", c + 1, key, value)}, again);
        };
        ImGui::TextColored(quiet, "collider %d", int(c) + 1);
        float friction = collider.friction;
        if (const Slid s = slide("friction", friction, 0, 2, "%.2f"); s.moved)
            change("friction", number(friction), s.again);
        if (const auto* plane = std::get_if<Plane>(&collider.shape)) {
            float offset = plane->offset;
            if (const Slid s = slide("height", offset, -1, 1, "%.3f m"); s.moved)
                change("plane.offset", number(offset), s.again);
        } else if (const auto* sphere = std::get_if<Sphere>(&collider.shape)) {
            vec3 centre = sphere->centre;
            if (const Slid s = slid(ImGui::SliderFloat3("centre", &centre.x, -1, 1, "%.3f")); s.moved)
                change("sphere.centre", fmt::format("[{},{},{}]", centre.x, centre.y, centre.z), s.again);
        }
        ImGui::PopID();
    }
}

void show_look(Viewer& viewer) {
    Options& options = viewer.options;
    ImGui::Checkbox("wireframe", &options.look.wireframe);
    ImGui::SameLine();
    ImGui::Checkbox("lattice", &options.look.springs);
    ImGui::Checkbox("normals as colours", &options.look.normals);
    ImGui::Checkbox("normal maps", &options.look.normal_maps);
    ImGui::SameLine();
    ImGui::Checkbox("culling", &options.look.culling);
    about("what cannot be seen is left out before it is mapped");
    static constexpr const char* cares[] = {"automatic", "draft", "full"};
    int care = int(options.care);
    if (ImGui::Combo("quality", &care, cares, 3)) options.care = Care(care);
    about("automatic: a draft while things move, where the CPU has to draw");
    ImGui::Checkbox("stereo, side by side", &options.stereo);
}

void show_comparison(Viewer& viewer) {
    Compared& compared = viewer.options.compared;
    static constexpr const char* with[] = {"nothing", "another mapping", "another backend"};
    int which = int(compared.with);
    if (ImGui::Combo("beside it", &which, with, 3)) compared.with = Compared::With(which);
    about("the same scene once more on the right, under the same hands");
    if (compared.with == Compared::With::mapping) choose("its mapping", compared.mapping);
    if (compared.with == Compared::With::backend) choose("its backend", compared.backend);
}

void plot(const char* name, const Recent& curve) {
    auto value = [](void* data, int i) { return static_cast<const Recent*>(data)->at(std::size_t(i)); };
    const std::string text = fmt::format("{} {:.1f} ms", name, curve.mean());
    ImGui::PlotLines("##", value, const_cast<Recent*>(&curve), int(curve.count()), 0, text.c_str(), 0,
                     std::max(curve.most(), 1.0f),
                     {ImGui::GetContentRegionAvail().x, 2.6f * ImGui::GetFontSize()});
}

void show_readings(const Viewer& viewer) {
    const Viewer::Readings& readings = viewer.readings();
    for (auto [name, curve] :
         {std::pair("simulate", &readings.simulate), {"map", &readings.map}, {"draw", &readings.draw}}) {
        ImGui::PushID(name);
        plot(name, *curve);
        ImGui::PopID();
    }
    const float sum = readings.simulate.mean() + readings.map.mean() + readings.draw.mean();
    ImGui::Text("%.0f pictures a second, %.2f of real time", ImGui::GetIO().Framerate, readings.pace.mean());
    about(fmt::format("the three together: {:.1f} ms", sum).c_str());
    if (readings.energy)
        ImGui::Text("energy %.3g J moving, %.3g J in springs", readings.energy->kinetic,
                    readings.energy->elastic);
    else
        ImGui::TextColored(quiet, "energy: on the GPU");
    ImGui::Text("largest speed %.3g m/s", readings.largest_speed);
    ImGui::Text("state %.1f MB", double(readings.memory) / 1e6);
    if (const FeelingHand* hand = viewer.feeling()) {
        const LoopTiming& timing = hand->timing();
        const double mean = timing.periods.mean();
        ImGui::Text("haptics %.1f Hz of %.0f", mean > 0 ? 1 / mean : 0, hand->rate());
        ImGui::Text("period 99.9 %% %.2f ms, longest %.2f ms", 1000 * timing.periods.quantile(0.999),
                    1000 * timing.periods.longest());
        ImGui::TextColored(quiet, "scheduled: %s", hand->granted().c_str());
        const Felt felt = hand->felt();
        ImGui::Text("force %.2f N", double(glm::length(felt.force)));
        if (felt.held != Held::no) ImGui::TextColored(quiet, "%s", std::string(name_of(felt.held)).c_str());
    }
}

void show_files(Viewer& viewer) {
    if (ImGui::Button("scene")) viewer.save_scene();
    ImGui::SameLine();
    if (ImGui::Button("picture")) viewer.save_picture();
    ImGui::SameLine();
    if (ImGui::Button("surface")) viewer.save_surface();
    if (ImGui::Button(viewer.filming() ? "end film" : "film")) viewer.start_or_stop_film();
    ImGui::SameLine();
    if (ImGui::Button("recording")) viewer.save_recording();
    about("all inputs with their times, to replay to the bit");
}

void show_steering(Viewer& viewer) {
    const Experiment& experiment = *viewer.experiment();
    if (ImGui::Button(viewer.options.paused ? "go on" : "pause")) viewer.pause();
    ImGui::SameLine();
    if (ImGui::Button("a frame")) viewer.step_once();
    ImGui::SameLine();
    if (ImGui::Button("restart")) viewer.restart();
    ImGui::SameLine();
    ImGui::BeginDisabled(!experiment.can_undo());
    if (ImGui::Button("undo")) viewer.undo();
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!experiment.can_redo());
    if (ImGui::Button("redo")) viewer.redo();
    ImGui::EndDisabled();
    if (experiment.trouble().empty()) return;
    ImGui::PushStyleColor(ImGuiCol_Text, warning);
    ImGui::TextWrapped("The motion blew up and is held where it was last sound: %s.",
                       experiment.trouble().c_str());
    ImGui::PopStyleColor();
    if (ImGui::Button("return to the last good state")) viewer.return_to_good();
}

void show_panel(Viewer& viewer, float scale) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({panel_width * scale, ImGui::GetIO().DisplaySize.y});
    const Experiment& experiment = *viewer.experiment();
    const std::string title =
        fmt::format("{}   {:.1f} s###panel", std::filesystem::path(experiment.source().name).stem().string(),
                    experiment.time());
    if (ImGui::Begin(title.c_str(), nullptr,
                     ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse)) {
        ImGui::PushItemWidth(-110 * scale);
        auto part = [](const char* name, bool open, auto show) {
            if (ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : 0)) show();
        };
        show_steering(viewer);
        part("hand", true, [&] {
            show_hand(viewer);
            if (viewer.options.mode == Mode::dent) show_dent_width(viewer);
        });
        if (!experiment.scene().bodies.empty())
            part("motion", true, [&] {
                show_motion(viewer);
                show_step(viewer);
            });
        for (std::size_t b = 0; b < viewer.experiment()->scene().bodies.size(); ++b) {
            ImGui::PushID(int(b));
            const std::string name = "body " + viewer.experiment()->scene().bodies[b].name;
            part(name.c_str(), b == 0, [&] { show_body(viewer, b); });
            ImGui::PopID();
        }
        part("surroundings", false, [&] { show_surroundings(viewer); });
        part("look", false, [&] {
            show_look(viewer);
            show_comparison(viewer);
        });
        part("readings", true, [&] { show_readings(viewer); });
        part("save", false, [&] { show_files(viewer); });
        ImGui::TextColored(quiet, "? lists all keys");
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

// ---- what lies over the picture ----

constexpr ImGuiWindowFlags bare = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                  ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings |
                                  ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

// Over the picture, so far from its upper edge.
void over_picture(const Viewer& viewer, float height, float pivot) {
    ImGui::SetNextWindowPos({float(viewer.left()) + 0.5f * float(viewer.size().x), height}, 0, {0.5f, pivot});
}

void in_middle(const Viewer& viewer, float part) {
    over_picture(viewer, part * float(viewer.size().y), 0.5f);
}

// A place in the picture as a place in the window.
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
    const Viewer::Message& message = viewer.message();
    const double age = now() - message.since;
    if (message.text.empty() || age > (message.bad ? 20 : 6)) return;
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

// The first thing to do, until it is done.
void show_hint(const Viewer& viewer, bool touched, float scale) {
    if (touched || viewer.importing()) return;
    over_picture(viewer, 14 * scale, 0);
    ImGui::Begin("hint", nullptr, bare | ImGuiWindowFlags_NoInputs);
    ImGui::Text("Drag the surface with the left button.  The right button turns, the wheel zooms.");
    ImGui::End();
}

void show_help_window(const Viewer& viewer, bool& open) {
    in_middle(viewer, 0.5f);
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

// A force's arrow from a hand's place, by the root of its size, and that in words.
void draw_arrow(const Viewer& viewer, const Viewer::Arrow& arrow, float scale) {
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

// How large the tip is that dents.
void draw_tip(const Viewer& viewer, float scale) {
    if (!viewer.feeling() || viewer.options.mode != Mode::dent) return;
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
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float middle = float(viewer.left() + viewer.view_size().x),
                bottom = float(viewer.size().y) - 40 * scale;
    list.AddLine({middle, 0}, {middle, float(viewer.size().y)}, IM_COL32(0, 0, 0, 200), 2 * scale);
    const std::string left = name(*viewer.experiment()), right = name(*viewer.beside());
    list.AddText({middle - ImGui::CalcTextSize(left.c_str()).x - 12 * scale, bottom}, IM_COL32_WHITE,
                 left.c_str());
    list.AddText({middle + 12 * scale, bottom}, IM_COL32_WHITE, right.c_str());
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

void Gui::draw(Viewer& viewer) {
    if (!viewer.experiment() && !viewer.importing()) show_start(viewer);
    if (viewer.experiment()) {
        for (const Viewer::Arrow& arrow : viewer.arrows()) draw_arrow(viewer, arrow, scale_);
        draw_tip(viewer, scale_);
        label_views(viewer, scale_);
        if (shows_panel) show_panel(viewer, scale_);
        show_hint(viewer, viewer.touched(), scale_);
    }
    if (viewer.importing()) show_import(viewer);
    if (shows_help) show_help_window(viewer, shows_help);
    show_message(viewer, scale_);
    ImGui::Render();
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

void Gui::key(Viewer& viewer, char key, bool control, bool shift) {
    Options& options = viewer.options;
    if (control) {
        if (key == 'Z') shift ? viewer.redo() : viewer.undo();
        if (key == 'Y') viewer.redo();
        if (key == 'S') viewer.save_scene();
        return;
    }
    switch (key) {
        case '1':
            options.mode = Mode::pull;
            break;
        case '2':
            options.mode = Mode::press;
            break;
        case '3':
            options.mode = Mode::dent;
            break;
        case '4':
            options.mode = Mode::pin;
            break;
        case 'K':
            viewer.keep();
            break;
        case ' ':
            viewer.pause();
            break;
        case '.':
            viewer.step_once();
            break;
        case 'R':
            viewer.restart();
            break;
        case 'F':
            viewer.frame_selection();
            break;
        case home_key:
            viewer.reset_camera();
            break;
        case 'B':
            viewer.return_to_good();
            break;
        case 'W':
            options.look.wireframe = !options.look.wireframe;
            break;
        case 'L':
            options.look.springs = !options.look.springs;
            break;
        case 'N':
            options.look.normals = !options.look.normals;
            break;
        case 'P':
            viewer.save_picture();
            break;
        case 'V':
            viewer.start_or_stop_film();
            break;
        case 'E':
            viewer.save_surface();
            break;
        case 'J':
            viewer.save_recording();
            break;
        case '\t':
            shows_panel = !shows_panel;
            break;
        case '?':
            shows_help = !shows_help;
            break;
        case escape_key:
            if (shows_help)
                shows_help = false;
            else if (viewer.importing())
                viewer.cancel_import();
            break;
        default:
            break;
    }
}

}  // namespace palpate
