#pragma once
#include "palpate/base/vectors.h"
#include "palpate/gl/field.h"

#include <memory>
#include <string>

namespace palpate::gpu {

#include "palpate/solver_gl/bindings.inl"

/// The moving state at one moment; node_access.glsl says what it holds.
struct Moving {
    gl::Field positions, velocities;
};

/// What one pass reads and writes: no field is in both.
struct Fields {
    const Moving& now;     // where forces are taken
    const Moving& start;   // where the pass starts from
    const gl::Field& was;  // positions when the step began
    const Moving& sum;     // of the passes so far, where the integrator adds them up
    const Moving& next;
    const Moving& next_sum;
};

/// How a backend loads and stores the nodes of a pass. The rest of its inputs are bound by then.
class Pipeline {
 public:
    virtual ~Pipeline() = default;
    virtual void pass(const Fields& fields) = 0;
};

/// A body's physics as GLSL, for any stage: put what is special to the stage behind it.
struct Text {
    std::string physics;
    bool sums = false;  // the integrator adds up its passes
    int slots = 0;
    ivec3 tiles = ivec3(0);  // of a grid that is cut into tiles, how many along each axis
};

// The three, each in its folder.
std::unique_ptr<Pipeline> make_feedback(const Text& text);
std::unique_ptr<Pipeline> make_fragment(const Text& text);
std::unique_ptr<Pipeline> make_compute(const Text& text);

}  // namespace palpate::gpu
