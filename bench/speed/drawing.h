#pragma once
#include "bench/speed/speed.h"
#include "palpate/gl/buffer.h"
#include "palpate/gl/context.h"
#include "palpate/gl/program.h"
#include "palpate/gl/texture.h"
#include "palpate/solver/solver.h"

#include <optional>
#include <span>

namespace palpate::speed {

/// The backends that work on this hardware, and its OpenGL context.
struct Hardware {
    /// Tries every backend. Reports on standard error what is missing.
    Hardware();

    const gl::Context* gl() const { return context ? &*context : nullptr; }
    std::string driver() const;

    std::optional<gl::Context> context;
    struct Mover {
        std::string name;  // "cpu, 2 threads"
        Backend backend;
        int threads = 1;
    };
    std::vector<Mover> movers;  // the cpu's with one thread, and with all
};

/// Draws nodes as points of one pixel into a texture of 1024².
class Points {
 public:
    explicit Points(const Body& body);

    /// From the GPU's memory if the nodes are there already, else from the host's.
    void draw(const Solver& solver);

 private:
    gl::Texture picture_;
    gl::Framebuffer framebuffer_;
    gl::Program program_;
    gl::VertexArray corners_;
    gl::Buffer sent_;
};

/// Repeated calls of `once`, and then a wait for the GPU.
Case repeating(std::string name, std::function<void()> once, const gl::Context* context);

/// `stepping`, counted in steps of the whole body.
Case steps(std::string name, const Body& body, const Hardware& hardware, const Hardware::Mover& mover,
           Integrator integrator);

/// 64 MB from one buffer of the GPU to another: bytes read and written.
Case copying_on_gpu(std::string name, const gl::Context& context);

/// Milliseconds for one: "best (median)"; "–" where there is no such case.
std::string milliseconds(const Timings& timings, const std::string& name);

/// A row of a table, in Markdown.
std::string row(std::span<const std::string> cells);
/// The same, with the line under it.
std::string head(std::span<const std::string> cells);

}  // namespace palpate::speed
