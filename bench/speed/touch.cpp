// The table of the 2007 paper: what a hand feels and what people see, at the same time.
#include "bench/speed/drawing.h"
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/realtime.h"
#include "palpate/render/renderer.h"
#include "palpate/render/view.h"
#include "palpate/scene/build.h"
#include "palpate/touch/devices/virtual_hand.h"
#include "palpate/touch/loop.h"
#include "tests/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace palpate::speed {
namespace {

constexpr double seconds_a_round = 4;  // so that 15 rounds are a minute
constexpr double tip = 0.003;          // m

struct Surfaces {
    std::string name;
    std::vector<Mesh> meshes;
    bool shared = true;  // whether the drawn triangles share vertices
};

// Three vertices for each triangle, as old graphics libraries store them.
Mesh unshared(const Mesh& mesh) {
    Mesh apart;
    for (uvec3 t : mesh.triangles) {
        const auto first = unsigned(apart.positions.size());
        for (int k = 0; k < 3; ++k) {
            apart.positions.push_back(mesh.positions[t[k]]);
            apart.normals.push_back(mesh.normals[t[k]]);
        }
        apart.triangles.emplace_back(first, first + 1, first + 2);
    }
    return apart;
}

// The paper's counts: 30,069 faces of skin and 22,952 of brain.
std::vector<Mesh> skin_and_brain(int skin_faces, int brain_faces) {
    const Change changes[] = {fmt::format("surface.skin.faces={}", skin_faces),
                              fmt::format("surface.brain.faces={}", brain_faces)};
    Models made = build(read_scene("catheter", changes));
    std::vector<Mesh> list;
    for (StaticSurface& still : made.static_surfaces) list.push_back(std::move(still.surface));
    return list;
}

std::vector<Surfaces> subjects() {
    std::vector<Mesh> both, fine;
    try {
        both = skin_and_brain(30'069, 22'952);
        fine = skin_and_brain(180'000, 140'000);
    } catch (const Error& error) {
        fmt::print(stderr, "skin and brain: not available, ellipsoids stand in: {}\n", error.what());
        both = {ellipsoid(vec3(0.08f, 0.1f, 0.09f), 87), ellipsoid(vec3(0.06f, 0.08f, 0.07f), 76)};
        fine = {ellipsoid(vec3(0.08f, 0.1f, 0.09f), 212), ellipsoid(vec3(0.06f, 0.08f, 0.07f), 188)};
        for (auto* list : {&both, &fine})
            for (vec3& p : (*list)[1].positions) p.x += 0.21f;
    }
    for (auto* list : {&both, &fine})
        for (Mesh& mesh : *list)
            if (mesh.normals.empty()) compute_normals(mesh);
    return {{"brain", {both[1]}, false},
            {"skin", {both[0]}, false},
            {"skin and brain", both, false},
            {"the same, vertices shared", both},
            {"skin and brain, finer", fine}};
}

// Presses the surface from the front, 8 mm deep, and strokes it, again and again.
Path strokes(const Mesh& surface) {
    const Bounds box = bounds(surface);
    vec3 front = surface.positions.front();
    for (vec3 p : surface.positions)
        if (p.z > front.z) front = p;
    Path path{{0, front + vec3(0, 0, 0.03f)}};
    double time = 1;
    for (int i = 0; i < 1000; ++i) {
        const float side = (i % 2 ? 0.1f : -0.1f) * box.size().x;
        path.push_back({time += 0.3, front + vec3(0, 0, 0.01f)});
        path.push_back({time += 0.3, front + vec3(0, 0, -0.005f)});
        path.push_back({time += 0.5, front + vec3(side, 0, -0.01f)});
        path.push_back({time += 0.3, front + vec3(side, 0, 0.02f)});
    }
    return path;
}

// What is drawn beside a hand.
class Scenery {
 public:
    Scenery(Renderer& renderer, const Surfaces& subject) : renderer_(renderer) {
        Bounds all;
        for (const Mesh& mesh : subject.meshes) {
            drawn_.push_back(subject.shared ? mesh : unshared(mesh));
            meshes_.push_back(renderer.add(drawn_.back()));
            all.include(bounds(mesh).low);
            all.include(bounds(mesh).high);
        }
        picture_.camera.look_at = all.centre();
        picture_.camera.eye = all.centre() + vec3(0, 0, 2.2f * glm::length(all.size()));
        picture_.camera.angle = 30;
    }

    // Each surface with its own dents.
    void draw(std::span<const std::vector<Dent>> dents, bool coarse = false) {
        picture_.surfaces.clear();
        for (std::size_t s = 0; s < meshes_.size(); ++s) {
            Surface surface{
                .mesh = meshes_[s], .positions = drawn_[s].positions, .normals = drawn_[s].normals};
            surface.look.coarse_dents = coarse;
            if (s < dents.size()) surface.dents = dents[s];
            picture_.surfaces.push_back(surface);
        }
        renderer_.draw(picture_);
    }

    std::size_t vertices() const {
        std::size_t count = 0;
        for (const Mesh& mesh : drawn_) count += mesh.positions.size();
        return count;
    }

 private:
    Renderer& renderer_;
    std::vector<Mesh> drawn_;
    std::vector<int> meshes_;
    Picture picture_;
};

std::size_t faces(const Surfaces& subject) {
    std::size_t count = 0;
    for (const Mesh& mesh : subject.meshes) count += mesh.triangles.size();
    return count;
}

// A line of the table.
struct Line {
    std::string name;
    std::size_t vertices = 0, faces = 0;
    double frames = 0;                               // a second
    double rate = 0;                                 // of the hand, Hz
    double p50 = 0, p99 = 0, p999 = 0, longest = 0;  // s, of the period
    double missed = 0, run = 0;                      // ticks
    double work = 0, proxy = 0;                      // s of CPU time, p99.9
    double contact = 0;                              // the share of frames in which it touched something
};

Line measure(const Surfaces& subject, Renderer* renderer, double seconds, Granted& granted, Panel& periods) {
    Line line{.name = subject.name, .faces = faces(subject)};
    std::vector<Touchable> surfaces;
    for (const Mesh& mesh : subject.meshes) surfaces.push_back({mesh.positions, mesh.triangles});
    const std::vector<Feel> feels(surfaces.size(), Feel{.stiffness = 300, .dent_width = 0.008});
    Touch hand(std::make_unique<VirtualHand>(strokes(subject.meshes.back())),
               {.radius = tip, .feels = feels});
    hand.feel(Patch(surfaces));
    std::optional<Scenery> scenery;
    if (renderer) scenery.emplace(*renderer, subject);
    line.vertices = scenery ? scenery->vertices() : 0;
    if (scenery) scenery->draw({});  // warm-up: a driver may compile shaders

    TouchLoop loop({&hand});
    granted = loop.granted();
    const double start = now();
    long frames = 0, touched = 0;
    while (now() - start < seconds) {
        const Felt felt = hand.felt();
        touched += felt.count > 0;
        ++frames;
        std::vector<std::vector<Dent>> dents;
        for (std::size_t s = 0; s < surfaces.size(); ++s) dents.push_back(felt.dents_of(int(s)));
        if (scenery) {
            scenery->draw(dents);
            renderer->context().finish();
        } else {
            sleep_until(now() + 1.0 / 60);
        }
    }
    const double span = now() - start;
    const LoopTiming& timing = loop.timing();
    line.frames = renderer ? double(frames) / span : 0;
    line.rate = double(timing.periods.count()) / span;
    line.p50 = timing.periods.quantile(0.5);
    line.p99 = timing.periods.quantile(0.99);
    line.p999 = timing.periods.quantile(0.999);
    line.longest = timing.periods.longest();
    line.missed = double(timing.missed);
    line.run = double(timing.longest_run);
    line.work = timing.work.quantile(0.999);
    line.proxy = timing.proxy.quantile(0.999);
    line.contact = double(touched) / double(frames);
    Curve curve{subject.name, {}, {}};
    const double all = double(timing.periods.count());
    double beyond = all;
    for (const auto& bin : timing.periods.bins()) {
        beyond -= double(bin.count);
        if (!(beyond > 0)) break;
        curve.x.push_back(1e3 * bin.to);
        curve.y.push_back(beyond / all);
    }
    periods.curves.push_back(std::move(curve));
    return line;
}

// ---- what dents cost where they are drawn ----

constexpr int dent_counts[] = {0, 1, 2, 4, 8, 16};

std::string dent_case(int count, bool coarse) {
    return fmt::format("{} dents, normals by {}", count, coarse ? "vertex" : "fragment");
}

std::vector<Case> dent_cases(Renderer& renderer, const Surfaces& subject) {
    auto scenery = std::make_shared<Scenery>(renderer, subject);
    std::vector<Case> cases;
    for (bool coarse : {false, true})
        for (int count : dent_counts) {
            std::vector<std::vector<Dent>> dents(1);
            const Mesh& mesh = subject.meshes[0];
            for (int i = 0; i < count; ++i)
                dents[0].push_back(
                    {mesh.positions[mesh.positions.size() * std::size_t(i) / std::size_t(count)], 0.006f,
                     0.008f});
            cases.push_back(repeating(
                dent_case(count, coarse), [=] { scenery->draw(dents, coarse); }, &renderer.context()));
        }
    return cases;
}

// ---- the benchmark ----

std::string figure(const std::string& line, const char* what) { return line + ": " + what; }

Timings run(int rounds) {
    const Hardware hardware;
    std::optional<Renderer> renderer;
    if (hardware.gl()) renderer.emplace(Offscreen(), hardware.gl());
    const std::vector<Surfaces> all = subjects();
    std::vector<Line> lines;
    Granted granted;
    Panel periods{"period (ms)", "fraction of longer periods", {}, true};
    for (const Surfaces& subject : all)
        lines.push_back(
            measure(subject, renderer ? &*renderer : nullptr, rounds * seconds_a_round, granted, periods));
    Timings timings;
    if (renderer) timings = time(dent_cases(*renderer, all[1]), rounds, 0);
    for (Case& of : timings.cases) of.run = {};
    timings.driver = hardware.driver();
    timings.driver +=
        fmt::format("{}The loop was granted: {}{}. {}.", timings.driver.empty() ? "" : " ", granted.schedule,
                    granted.memory_locked ? ", its memory locked" : ", its memory not locked", kernel());
    for (const Line& line : lines) {
        auto add = [&](const char* what, double value) {
            timings.figures.push_back({figure(line.name, what), value});
        };
        add("vertices", double(line.vertices));
        add("faces", double(line.faces));
        add("frames_per_second", line.frames);
        add("rate_hz", line.rate);
        add("period_p50_s", line.p50);
        add("period_p99_s", line.p99);
        add("period_p999_s", line.p999);
        add("period_longest_s", line.longest);
        add("missed", line.missed);
        add("longest_run_of_misses", line.run);
        add("tick_p999_s", line.work);
        add("proxy_p999_s", line.proxy);
        add("in_contact", line.contact);
    }
    timings.figures.push_back({"seconds_each", rounds * seconds_a_round});
    timings.panels.push_back(std::move(periods));
    return timings;
}

std::string text(const Timings& timings) {
    auto value = [&](const std::string& name) {
        for (const auto& one : timings.figures)
            if (one.name == name) return one.value;
        return 0.0;
    };
    std::string text =
        timings.driver +
        fmt::format(
            "\n\nA virtual hand presses and strokes the surface for {} s a line, while pictures of 1280 × "
            "720 are "
            "drawn one after the other with its dent. 2007, on two processors and a Quadro FX 3400: brain 61 "
            "frames a second at 1000 Hz, skin 60 at 1000, both 59 at 999.\n\n",
            value("seconds_each"));
    const std::string columns[] = {"",
                                   "vertices drawn",
                                   "faces",
                                   "frames a second",
                                   "ticks a second",
                                   "period p50, ms",
                                   "p99",
                                   "p99.9",
                                   "longest",
                                   "ticks missed",
                                   "longest run of missed ticks",
                                   "tick p99.9, µs of CPU time",
                                   "proxy p99.9, µs",
                                   "frames in contact"};
    text += head(columns);
    for (const auto& one : timings.figures) {
        const auto end = one.name.find(": vertices");
        if (end == std::string::npos) continue;
        const std::string name = one.name.substr(0, end);
        auto of = [&](const char* what) { return value(figure(name, what)); };
        const std::string cells[] = {name,
                                     fmt::format("{:.0f}", of("vertices")),
                                     fmt::format("{:.0f}", of("faces")),
                                     fmt::format("{:.1f}", of("frames_per_second")),
                                     fmt::format("{:.1f}", of("rate_hz")),
                                     fmt::format("{:.3f}", 1e3 * of("period_p50_s")),
                                     fmt::format("{:.3f}", 1e3 * of("period_p99_s")),
                                     fmt::format("{:.3f}", 1e3 * of("period_p999_s")),
                                     fmt::format("{:.2f}", 1e3 * of("period_longest_s")),
                                     fmt::format("{:.0f}", of("missed")),
                                     fmt::format("{:.0f}", of("longest_run_of_misses")),
                                     fmt::format("{:.1f}", 1e6 * of("tick_p999_s")),
                                     fmt::format("{:.1f}", 1e6 * of("proxy_p999_s")),
                                     fmt::format("{:.2f}", of("in_contact"))};
        text += row(cells);
    }
    if (timings.cases.empty()) return text;
    text +=
        "\nMilliseconds a frame of the skin, by its number of dents and where they change its normals:\n\n";
    const std::string heads[] = {"dents", "in each fragment", "at each vertex"};
    text += head(heads);
    for (int count : dent_counts) {
        const std::string cells[] = {std::to_string(count), milliseconds(timings, dent_case(count, false)),
                                     milliseconds(timings, dent_case(count, true))};
        text += row(cells);
    }
    return text;
}

}  // namespace

Benchmark touch() {
    return {"touch", "a hand at 1 kHz beside pictures, the table of 2007", false, run,
            text,    [](const Timings& timings) { return timings.panels; }};
}

}  // namespace palpate::speed
