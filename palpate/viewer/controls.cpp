#include "palpate/viewer/controls.h"

#include "palpate/run/notes.h"
#include "palpate/run/run.h"
#include "palpate/viewer/style.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace palpate {
namespace {

// ---- controls ----

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

void choose_device(std::string& name) {
    if (!ImGui::BeginCombo("device", name.c_str())) return;
    for (const Driver& one : drivers())
        if (ImGui::Selectable(std::string(one.name).c_str(), one.name == name)) name = one.name;
    ImGui::EndCombo();
}

std::string number(double value) { return fmt::format("{:.6g}", value); }

// ---- parts that keep nothing ----

// A plane under everything, for what is let go of.
void show_ground(Viewer& viewer) {
    if (!ImGui::Button("add a ground")) return;
    const Experiment& experiment = *viewer.experiment();
    const Bounds box = bounds_of(experiment.play().skins());
    if (box.empty()) return;
    const float height = box.low.y - 0.05f * box.size().y;
    viewer.change({fmt::format("collider.{}={{plane={{offset={}}},friction=0.4}}",
                               experiment.scene().colliders.size() + 1, number(height))});
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
    about("automatic: a draft until it is paused, where the CPU has to draw");
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

// The force on the hand over how far the surface has moved under it.
void plot_touch(const std::vector<vec2>& touch) {
    vec2 most(1e-6f);
    for (vec2 one : touch) most = glm::max(most, one);
    const ImVec2 corner = ImGui::GetCursorScreenPos(), size{ImGui::CalcItemWidth() + 100, 90};
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(corner, {corner.x + size.x, corner.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                       4);
    std::vector<ImVec2> line;
    for (vec2 one : touch)
        line.push_back({corner.x + 4 + (size.x - 8) * one.x / most.x,
                        corner.y + size.y - 4 - (size.y - 24) * one.y / most.y});
    list.AddPolyline(line.data(), int(line.size()), ImGui::GetColorU32(ImGuiCol_PlotLines), 0, 1.5f);
    const std::string text = fmt::format("force up to {:.2f} N, over up to {:.1f} mm", most.y, 1000 * most.x);
    list.AddText({corner.x + 6, corner.y + 3}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
}

void show_readings(const Viewer& viewer) {
    const Readings& readings = viewer.readings();
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
        ImGui::Text("energy %.3g J moving, %.3g J elastic", readings.energy->kinetic,
                    readings.energy->elastic);
    else
        ImGui::TextColored(quiet, "energy: on the GPU");
    ImGui::Text("largest speed %.3g m/s", readings.largest_speed);
    ImGui::Text("state %.1f MB", double(readings.memory) / 1e6);
    if (const FeltHand* hand = viewer.feeling()) {
        const LoopTiming& timing = hand->loop().timing();
        const double mean = timing.periods.mean();
        ImGui::Text("haptics %.1f Hz of %.0f", mean > 0 ? 1 / mean : 0, hand->loop().rate());
        ImGui::Text("period 99.9 %% %.2f ms, longest %.2f ms", 1000 * timing.periods.quantile(0.999),
                    1000 * timing.periods.longest());
        ImGui::TextColored(quiet, "scheduled: %s", hand->loop().granted().schedule.c_str());
        const Felt& felt = hand->felt();
        ImGui::Text("force %.2f N", double(glm::length(felt.force)));
        if (felt.held != Held::no) ImGui::TextColored(quiet, "%s", std::string(name_of(felt.held)).c_str());
        if (readings.touch.size() > 1) plot_touch(readings.touch);
    }
}

void show_files(Viewer& viewer) {
    if (ImGui::Button("scene")) viewer.save(Output::scene);
    ImGui::SameLine();
    if (ImGui::Button("picture")) viewer.save(Output::picture);
    ImGui::SameLine();
    if (ImGui::Button("surface")) viewer.save(Output::surface);
    if (ImGui::Button(viewer.filming() ? "end film" : "film")) viewer.save(Output::film);
    ImGui::SameLine();
    if (ImGui::Button("recording")) viewer.save(Output::recording);
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
    ImGui::BeginDisabled(!viewer.can_undo());
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

}  // namespace

// ---- sliders ----

Sliders::Slid Sliders::slid(bool moved) {
    if (ImGui::IsItemActivated()) has_moved_ = false;
    const Slid result{moved, moved && has_moved_};
    has_moved_ |= moved;
    return result;
}

Sliders::Slid Sliders::slide(const char* label, float& value, float low, float high, const char* format,
                             bool logarithmic) {
    return slid(
        ImGui::SliderFloat(label, &value, low, high, format,
                           (logarithmic ? ImGuiSliderFlags_Logarithmic : 0) | ImGuiSliderFlags_AlwaysClamp));
}

bool Sliders::slide_and_let_go(const char* label, float& value, float low, float high, const char* format) {
    const ImGuiID here = ImGui::GetID(label);
    if (held_ == here) value = at_;
    ImGui::SliderFloat(label, &value, low, high, format,
                       ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
    if (ImGui::IsItemActive()) {
        held_ = here;
        at_ = value;
    } else if (held_ == here) {
        held_ = 0;
        return ImGui::IsItemDeactivatedAfterEdit();
    }
    return false;
}

// ---- parts with sliders ----

void Controls::show_hand(Viewer& viewer) {
    Options& options = viewer.options;
    for (const auto& mode : names(Mode{})) {
        if (mode.value != Mode::hand) ImGui::SameLine();
        if (ImGui::RadioButton(std::string(mode.name).c_str(), options.mode == mode.value))
            options.mode = mode.value;
    }
    const float most = std::max(0.05f, 2 * options.tip);
    float millimetres = 1000 * options.tip;
    if (ImGui::SliderFloat("tip", &millimetres, 1, 1000 * most, "%.1f mm",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp))
        options.tip = millimetres / 1000;
    about("the radius of what touches, grasps and pins");
    if (options.mode == Mode::pin) return;
    choose_device(options.device);
    about("what moves the hand; its first button grasps what it touches");
    const DeviceNeeds needs = driver(options.device).needs;
    if (needs == DeviceNeeds::pointer) return;
    const bool log = needs == DeviceNeeds::log;
    ImGui::InputTextWithHint(log ? "log" : "path", log ? "felt.csv" : "rows of t, x, y, z", file_,
                             sizeof file_);
    if (ImGui::IsItemDeactivatedAfterEdit()) options.device_file = file_;
}

void Controls::show_feel(Viewer& viewer) {
    // A copy, since a change makes another scene.
    auto stiffness = [&](const char* kind, std::size_t i, const BodyRecipe recipe) {
        float value = float(recipe.feel.stiffness);
        if (sliders_.slide_and_let_go(("feel of " + recipe.name).c_str(), value, 10, 5000, "%.0f N/m"))
            viewer.change({fmt::format("{}.{}.touch.stiffness={}", kind, i + 1, number(value))});
        about("the stiffness of the contact between it and the hand");
    };
    auto width = [&](std::size_t i, const BodyRecipe recipe) {
        float value = 1000 * float(recipe.feel.dent_width);
        if (const auto s = sliders_.slide(("dent in " + recipe.name).c_str(), value, 1, 50, "%.1f mm", true);
            s.moved)
            viewer.change({fmt::format("surface.{}.touch.width={}", i + 1, number(value / 1000))}, s.again);
        about("the width of dents in it: their standard deviation");
    };
    auto scene = [&]() -> const Scene& { return viewer.experiment()->scene(); };
    for (std::size_t i = 0; i < scene().bodies.size(); ++i) stiffness("body", i, scene().bodies[i]);
    for (std::size_t i = 0; i < scene().surfaces.size(); ++i) {
        stiffness("surface", i, scene().surfaces[i]);
        width(i, scene().surfaces[i]);
    }
}

void Controls::show_motion(Viewer& viewer) {
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
        if (const auto s = sliders_.slid(
                ImGui::SliderInt("threads", &threads, 1, 8, "%d", ImGuiSliderFlags_AlwaysClamp));
            s.moved)
            viewer.change({fmt::format("simulation.threads={}", threads)}, s.again);
    }
}

// The step beside the longest that is stable.
void Controls::show_step(Viewer& viewer) {
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
        if (sliders_.slide_and_let_go("step", milliseconds, 0.02f, std::max(high, 0.05f), "%.3f ms"))
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

namespace {

void show_inverted_cells(const Viewer& viewer, std::size_t b) {
    const Experiment& experiment = *viewer.experiment();
    const Report::Body& body = experiment.report().bodies[b];
    if (body.inverted_now == 0) return;
    const std::string remedy = viewer.is_holding() ? "press or pull it less hard"
                                                   : how_to_ask_less(experiment.scene(), experiment.report());
    ImGui::PushStyleColor(ImGuiCol_Text, warning);
    ImGui::TextWrapped("%zu of %zu cells are inside out: %s", body.inverted_now, body.cells, remedy.c_str());
    ImGui::PopStyleColor();
}

}  // namespace

void Controls::show_body(Viewer& viewer, std::size_t b) {
    show_inverted_cells(viewer, b);
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
        if (sliders_.slide_and_let_go(label, value, middle / 100, middle * 100, format))
            change(key, number(value));
    };
    const TissueCells* cells = tissue_of(viewer.experiment()->models().models[b].body);
    amount("Young's mod.", "youngs_modulus", cells ? cells->youngs_modulus : material.youngs_modulus,
           "%.3g Pa");
    if (float ratio = material.poisson;
        cells && sliders_.slide_and_let_go("Poisson's ratio", ratio, 0, 0.499f, "%.3f"))
        change("poisson", number(ratio));
    amount("stiffness", "stiffness", material.stiffness, "%.3g N/m");
    if (recipe.springs) {
        amount("structural", "springs.structural", recipe.springs->structural, "%.3g N/m");
        amount("shear", "springs.shear", recipe.springs->shear, "%.3g N/m");
        amount("flexion", "springs.flexion", recipe.springs->flexion, "%.3g N/m");
    }
    amount("bending", "bending", recipe.bending, "%.3g N·m");
    amount("density", "density", material.density, recipe.is_cloth() ? "%.3g kg/m²" : "%.4g kg/m³");
    amount("mass", "mass", material.mass, "%.3g kg");
    float damping = material.damping;
    if (sliders_.slide_and_let_go("damping", damping, 0, 50, "%.2f 1/s")) change("damping", number(damping));
}

void Controls::show_surroundings(Viewer& viewer) {
    const Experiment& experiment = *viewer.experiment();
    vec3 gravity = experiment.scene().simulation.gravity;
    if (const auto s = sliders_.slid(ImGui::SliderFloat3("gravity", &gravity.x, -20, 20, "%.1f")); s.moved)
        viewer.change({fmt::format("simulation.gravity=[{},{},{}]", gravity.x, gravity.y, gravity.z)},
                      s.again);
    about("m/s²");
    constexpr float usual_air = 1.2f;  // kg/m³
    const float air = experiment.scene().simulation.air;
    vec3 wind =
        experiment.scene().wind.empty() ? vec3(0) : position(experiment.scene().wind, experiment.time());
    if (const auto s = sliders_.slid(ImGui::SliderFloat3("wind", &wind.x, -15, 15, "%.1f")); s.moved)
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
        if (const auto s = sliders_.slide("friction", friction, 0, 2, "%.2f"); s.moved)
            change("friction", number(friction), s.again);
        if (const auto* plane = std::get_if<Plane>(&collider.shape)) {
            float offset = plane->offset;
            if (const auto s = sliders_.slide("height", offset, -1, 1, "%.3f m"); s.moved)
                change("plane.offset", number(offset), s.again);
        } else if (const auto* sphere = std::get_if<Sphere>(&collider.shape)) {
            vec3 centre = sphere->centre;
            if (const auto s = sliders_.slid(ImGui::SliderFloat3("centre", &centre.x, -1, 1, "%.3f"));
                s.moved)
                change("sphere.centre", fmt::format("[{},{},{}]", centre.x, centre.y, centre.z), s.again);
        }
        ImGui::PopID();
    }
}

void Controls::show(Viewer& viewer, float scale) {
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
        const bool has_text = experiment.has_text();  // all that is changed below is changed in it
        part("hand", true, [&] {
            show_hand(viewer);
            if (has_text && viewer.options.mode == Mode::hand) show_feel(viewer);
        });
        if (has_text && !experiment.scene().bodies.empty())
            part("motion", true, [&] {
                show_motion(viewer);
                show_step(viewer);
            });
        for (std::size_t b = 0; has_text && b < viewer.experiment()->scene().bodies.size(); ++b) {
            ImGui::PushID(int(b));
            const std::string name = "body " + viewer.experiment()->scene().bodies[b].name;
            part(name.c_str(), b == 0, [&] { show_body(viewer, b); });
            ImGui::PopID();
        }
        if (has_text)
            part("surroundings", false, [&] {
                show_surroundings(viewer);
                show_ground(viewer);
            });
        part("look", false, [&] {
            show_look(viewer);
            if (has_text) show_comparison(viewer);
        });
        part("readings", true, [&] { show_readings(viewer); });
        part("save", false, [&] { show_files(viewer); });
        ImGui::TextColored(quiet, "? lists all keys");
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

}  // namespace palpate
