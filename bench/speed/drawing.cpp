#include "bench/speed/drawing.h"

#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/body/cloth.h"
#include "palpate/render/view.h"

#include <fmt/format.h>

#include <cassert>
#include <memory>
#include <thread>

namespace palpate::speed {
namespace {

const char* points_vert =
#include "embedded/points.vert.h"
    ;
const char* points_frag =
#include "embedded/points.frag.h"
    ;

constexpr int side = 1024;  // pixels

bool works(Backend backend, const gl::Context* context) {
    std::string why = "not in this build";
    try {
        const Body body = cloth(ivec2(4), 0.01f, {.density = 0.15f, .damping = 2});
        const bool gpu = backend != Backend::reference && backend != Backend::cpu;
        if (gpu && !context) return false;
        if (make_solver(body, {.backend = backend}, context)) return true;
    } catch (const Error& error) {
        why = error.what();
    }
    fmt::print(stderr, "{}: not available: {}\n", name_of(backend), why);
    return false;
}

}  // namespace

Hardware::Hardware() {
    try {
        context.emplace();
    } catch (const Error& error) {
        fmt::print(stderr, "OpenGL is not available: {}\n", error.what());
    }
    const int cores = int(std::max(1u, std::thread::hardware_concurrency()));
    for (const auto& [backend, name] : names(Backend{})) {
        if (!works(backend, gl())) continue;
        if (backend == Backend::cpu) movers.push_back({"cpu, 1 thread", backend});
        if (backend != Backend::cpu) movers.push_back({std::string(name), backend});
        if (backend == Backend::cpu && cores > 1)
            movers.push_back({fmt::format("cpu, {} threads", cores), backend, cores});
    }
}

std::string Hardware::driver() const {
    if (!context) return "OpenGL is not available: nothing was drawn, and nothing moved on a GPU.";
    return fmt::format(
        "OpenGL by {}, {}. {}", context->renderer(), context->version(),
        context->software()
            ? "That is a software driver, which shares the CPU's cores: what a graphics card does "
              "is not measured yet."
            : "");
}

Points::Points(const Body& body)
    : picture_(GL_RGBA8, side, side),
      program_({{GL_VERTEX_SHADER, "points.vert", points_vert},
                {GL_FRAGMENT_SHADER, "points.frag", points_frag}}) {
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, picture_.name(), 0);
    glEnableVertexArrayAttrib(corners_.name(), 0);
    glVertexArrayAttribFormat(corners_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(corners_.name(), 0, 0);
    program_.set("to_clip", light_projection(vec3(0, 0, -1), around(bounds_of(body.positions))));
}

void Points::draw(const Solver& solver) {
    const GpuNodes there = solver.gpu_nodes();
    std::size_t count = there.count;
    if (there.positions != 0) {
        assert(there.width == 0);
        glVertexArrayVertexBuffer(corners_.name(), 0, there.positions, 0, sizeof(vec4));
    } else {
        const auto positions = solver.nodes().positions;
        count = positions.size();
        sent_.upload(positions);
        glVertexArrayVertexBuffer(corners_.name(), 0, sent_.name(), 0, sizeof(vec3));
    }
    constexpr float black[4] = {0, 0, 0, 1};
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, side, side);
    glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, black);
    program_.use();
    glBindVertexArray(corners_.name());
    glDrawArrays(GL_POINTS, 0, GLsizei(count));
}

Case repeating(std::string name, std::function<void()> once, const gl::Context* context) {
    auto go = [=](int times) {
        const double start = now();
        for (int i = 0; i < times; ++i) once();
        if (context) context->finish();
        return now() - start;
    };
    go(2);  // warm-up: a driver may compile shaders
    const int times = times_for(go(2) / 2);
    return {std::move(name), [=] { return Work{go(times), double(times)}; }};
}

Case steps(std::string name, const Body& body, const Hardware& hardware, const Hardware::Mover& mover,
           Integrator integrator) {
    Case timed = stepping(std::move(name), body,
                          {.backend = mover.backend, .threads = mover.threads, .integrator = integrator},
                          hardware.gl());
    const double nodes = double(body.count());
    timed.run = [run = std::move(timed.run), nodes] {
        const Work work = run();
        return Work{work.seconds, work.amount / nodes};
    };
    timed.links *= nodes;
    timed.bytes *= nodes;
    timed.memory *= nodes;
    return timed;
}

Case copying_on_gpu(std::string name, const gl::Context& context) {
    constexpr std::size_t bytes = 64 << 20;
    auto from = std::make_shared<gl::Buffer>(gl::Buffer::room(bytes)),
         to = std::make_shared<gl::Buffer>(gl::Buffer::room(bytes));
    return {std::move(name), [from, to, &context] {
                const double start = now();
                glCopyNamedBufferSubData(from->name(), to->name(), 0, 0, GLsizeiptr(bytes));
                context.finish();
                return Work{now() - start, 2.0 * double(bytes)};
            }};
}

std::string milliseconds(const Timings& timings, const std::string& name) {
    const Rate* rate = timings.find(name);
    if (!rate) return "–";
    auto text = [](double a_second) {
        const double ms = 1e3 / a_second;
        return fmt::format("{:.{}f}", ms, ms < 0.1 ? 4 : ms < 10 ? 2 : 1);
    };
    return text(rate->best) + " (" + text(rate->median) + ")";
}

std::string row(std::span<const std::string> cells) {
    std::string line = "|";
    for (const std::string& cell : cells) line += " " + cell + " |";
    return line + "\n";
}

std::string head(std::span<const std::string> cells) {
    return row(cells) + row(std::vector<std::string>(cells.size(), "---"));
}

}  // namespace palpate::speed
