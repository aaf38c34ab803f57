// The figures of the 2005 paper, section 3.4.
#include "bench/speed/drawing.h"
#include "palpate/base/error.h"
#include "palpate/base/team.h"
#include "palpate/body/cloth.h"
#include "palpate/body/embedding.h"
#include "palpate/body/lattice.h"
#include "palpate/render/renderer.h"
#include "palpate/render/view.h"
#include "palpate/scene/build.h"
#include "tests/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <tuple>

namespace palpate::speed {
namespace {

constexpr int steps_a_frame = 15;
constexpr double one_step = 1e-5;  // s
constexpr Mapping mappings[] = {Mapping::constant, Mapping::interpolated, Mapping::trilinear, Mapping::frames,
                                Mapping::one_to_one};

const Material flesh{
    .youngs_modulus = 40'000, .density = 1060, .damping = 20, .model = MaterialModel::springs};

// A body and the surfaces embedded in it.
struct Subject {
    std::string about;
    Body body;
    std::vector<Mesh> surfaces;
};

int rings_for(double faces) { return int(std::lround(0.5 * (1 + std::sqrt(1 + faces)))); }  // 4 r (r - 1)

Subject the_heart() {
    Subject heart{"the shipped scene heart", {}, {}};
    constexpr int faces[] = {50'000, 76'000};
    try {
        for (int count : faces) {
            const Change change = fmt::format("body.heart.faces={}", count);
            Models made = build(read_scene("heart", std::span(&change, 1)));
            heart.surfaces.push_back(std::move(made.models.front().surface));
            if (count == faces[0]) heart.body = std::move(made.models.front().body);
        }
    } catch (const Error& error) {
        fmt::print(stderr, "heart: not available, an ellipsoid stands in: {}\n", error.what());
        heart = {"an ellipsoid in place of the heart, which is not in PALPATE_DATA", {}, {}};
        for (int count : faces)
            heart.surfaces.push_back(ellipsoid(vec3(0.05f, 0.06f, 0.08f), rings_for(count)));
        heart.body = lattice(heart.surfaces[0], {.nodes = 20'000, .material = flesh});
    }
    return heart;
}

Subject the_dragon() {
    try {
        Model made = std::move(build(read_scene("dragon")).models.front());
        return {"the shipped scene dragon", std::move(made.body), {std::move(made.surface)}};
    } catch (const Error& error) {
        fmt::print(stderr, "dragon: not available, an ellipsoid stands in: {}\n", error.what());
        Subject sheet{"an ellipsoid in place of the dragon, which is not in PALPATE_DATA",
                      cloth(ivec2(6, 3), 0.042f, {.density = 5, .damping = 10}),
                      {ellipsoid(vec3(0.1f, 0.05f, 0.03f), rings_for(9'971))}};
        for (vec3& at : sheet.surfaces[0].positions) at += vec3(0.105f, 0.042f, 0);
        return sheet;
    }
}

Simulation with(const Hardware::Mover& mover) {
    return {.backend = mover.backend,
            .threads = mover.threads,
            .step = one_step,
            .force = true,
            .shortest_step = 0};
}

bool on_gpu(const Solver& solver) { return solver.gpu_nodes().positions != 0; }

// A surface drawn on a solver's nodes: mapped on the GPU if the nodes are there, else on the CPU.
class Shown {
 public:
    Shown(Renderer& renderer, const Mesh& surface, const Body& body, Mapping mapping,
          std::shared_ptr<Solver> solver, int threads)
        : renderer_(renderer),
          solver_(std::move(solver)),
          skin_(embed(surface, body, mapping)),
          mesh_(on_gpu(*solver_) ? renderer.add(surface, skin_) : renderer.add(surface)),
          team_(threads),
          box_(bounds_of(surface.positions)) {
        look(0, 2.5f);
    }

    /// Places the camera `away` times the surface's size in front of it, and `beside` times off its centre.
    void look(float beside, float away) {
        const float size = glm::length(box_.size());
        picture_.camera.look_at = box_.centre() + vec3(beside * size, 0, 0);
        picture_.camera.eye = picture_.camera.look_at + vec3(0, 0, away * size);
    }

    void cull(bool culls) { picture_.culls = culls; }
    Culled culled() const { return renderer_.culled(mesh_); }

    void step() { solver_->step(steps_a_frame * one_step); }

    void draw() {
        Surface shown{.mesh = mesh_};
        if (on_gpu(*solver_)) {
            shown.gpu_nodes = solver_->gpu_nodes();
        } else {
            deform(skin_, solver_->nodes(), positions_, normals_, nullptr, &team_);
            shown.positions = positions_;
            shown.normals = normals_;
        }
        picture_.surfaces = {shown};
        renderer_.draw(picture_);
    }

 private:
    Renderer& renderer_;
    std::shared_ptr<Solver> solver_;
    Embedding skin_;
    int mesh_;
    Team team_;
    Bounds box_;
    std::vector<vec3> positions_, normals_;
    Picture picture_;
};

std::string described(const Subject& subject, const Mesh& surface) {
    return fmt::format("{} ({} nodes, {} faces)", subject.about, subject.body.count(),
                       surface.triangles.size());
}

// Where the nodes are for frames in which nothing moves: the first of the GPU, or the last of the CPU.
const Hardware::Mover* mover_at_rest(const Hardware& hardware, bool gpu) {
    const Hardware::Mover* found = nullptr;
    for (const auto& mover : hardware.movers) {
        const bool here = mover.backend == Backend::cpu;
        if (gpu ? !here && mover.backend != Backend::reference && !found : here) found = &mover;
    }
    return found;
}

const std::string step_table = "Milliseconds a simulation step (2005: 2.22)";
const std::string frame_table =
    "Milliseconds a drawn frame, mapped by the CPU or by the GPU (2005: 5.26 constant, 6.67 interpolated)";
const std::string culling_table =
    "Milliseconds a drawn frame, mapped by the GPU, by what is left out before it is mapped";
const std::string whole_table = "Frames a second with 15 steps a frame (2005: 25)";

Timings run(int rounds) {
    const Hardware hardware;
    const Subject heart = the_heart(), dragon = the_dragon();
    std::vector<Case> cases;
    const Subject box{"a box of 27³", lattice(ivec3(27), 0.01f, flesh), {}};
    for (const Subject* subject : {&heart, &box})
        for (const auto& mover : hardware.movers)
            cases.push_back(
                steps(Cell{step_table, fmt::format("{} ({} nodes)", subject->about, subject->body.count()),
                           mover.name}
                          .name(),
                      subject->body, hardware, mover, Integrator::verlet));
    std::optional<Renderer> renderer;
    if (hardware.gl()) renderer.emplace(Offscreen(), hardware.gl());
    // Frames in which nothing moves, and frames with steps.
    auto add = [&](const std::string& table, const Subject& subject, const Mesh& surface, Mapping mapping,
                   const Hardware::Mover& mover, const std::string& column, bool moves) {
        std::shared_ptr<Solver> solver = make_solver(subject.body, with(mover), hardware.gl());
        auto shown =
            std::make_shared<Shown>(*renderer, surface, subject.body, mapping, solver, mover.threads);
        const std::string row = described(subject, surface) + ", " + std::string(name_of(mapping));
        cases.push_back(repeating(
            Cell{table, row, column}.name(),
            [=] {
                if (moves) shown->step();
                shown->draw();
            },
            hardware.gl()));
    };
    for (bool gpu : {false, true}) {
        const Hardware::Mover* still = mover_at_rest(hardware, gpu);
        if (!renderer || !still) continue;
        const std::string column = gpu ? "GPU" : still->name;
        for (const Mesh& surface : heart.surfaces)
            for (Mapping mapping : mappings) add(frame_table, heart, surface, mapping, *still, column, false);
        for (Mapping mapping : {Mapping::constant, Mapping::interpolated})
            add(frame_table, dragon, dragon.surfaces[0], mapping, *still, column, false);
    }
    if (const Hardware::Mover* still = mover_at_rest(hardware, true); renderer && still)
        for (const auto& [where, beside, away] : {std::tuple{"all of it in the picture", 0.0f, 2.5f},
                                                  {"a third of it", 0.5f, 0.8f},
                                                  {"none of it", 5.0f, 2.5f}}) {
            std::shared_ptr<Solver> solver = make_solver(heart.body, with(*still), hardware.gl());
            auto shown =
                std::make_shared<Shown>(*renderer, heart.surfaces[1], heart.body, Mapping::frames, solver, 1);
            shown->look(beside, away);
            shown->draw();
            const Culled of = shown->culled();
            const std::string row =
                fmt::format("{}, {}: {} of {} vertices mapped", described(heart, heart.surfaces[1]), where,
                            of.vertices_drawn, of.vertices);
            for (bool culls : {false, true})
                cases.push_back(repeating(
                    Cell{culling_table, row, culls ? "culled" : "all drawn"}.name(),
                    [=] {
                        shown->cull(culls);
                        shown->draw();
                    },
                    hardware.gl()));
        }
    for (const auto& mover : hardware.movers)
        for (Mapping mapping : {Mapping::constant, Mapping::interpolated})
            if (renderer) add(whole_table, heart, heart.surfaces[0], mapping, mover, mover.name, true);
    Timings timings = time(std::move(cases), rounds, 0);
    for (Case& of : timings.cases) of.run = {};  // before the context ends
    timings.driver = hardware.driver();
    return timings;
}

// The CPU, or a picture without culling.
bool is_baseline(const std::string& column) {
    return column.starts_with("cpu") || column == "reference" || column == "all drawn";
}

std::string text(const Timings& timings) {
    std::string text = timings.driver + "\n\nBest, and in brackets median. 2005 was a GeForce 6800 Ultra.\n";
    for (const std::string& table : {step_table, frame_table, culling_table, whole_table}) {
        Outline outline;
        for (const Case& of : timings.cases)
            if (const Cell cell = cell_of(of.name); cell.table == table) outline.add(cell);
        const auto& [rows, columns] = outline;
        if (rows.empty()) continue;
        std::vector<std::string> cells{""};
        cells.insert(cells.end(), columns.begin(), columns.end());
        cells.emplace_back(table == culling_table ? "times as fast" : "GPU over CPU");
        text += "\n" + table + ":\n\n" + head(cells);
        for (const std::string& which : rows) {
            cells = {which};
            double slower = 0, faster = 0;  // the best rates of the two sides
            for (const std::string& column : columns) {
                const std::string name = Cell{table, which, column}.name();
                const Rate* rate = timings.find(name);
                if (rate) {
                    double& side = is_baseline(column) ? slower : faster;
                    side = std::max(side, rate->best);
                }
                cells.push_back(rate && table == whole_table
                                    ? fmt::format("{:.1f} ({:.1f})", rate->best, rate->median)
                                    : milliseconds(timings, name));
            }
            cells.push_back(slower > 0 && faster > 0 ? fmt::format("{:.2f}", faster / slower) : "–");
            text += row(cells);
        }
    }
    return text;
}

}  // namespace

Benchmark heart() {
    return {"heart", "a detailed surface on a coarse body, the figures of 2005", false, run, text};
}

}  // namespace palpate::speed
