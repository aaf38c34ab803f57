#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/context.h"
#include "palpate/solver/machine.h"
#include "palpate/solver_gl/pipeline.h"

namespace palpate::gpu {

/// What a call found, and the box around the nodes.
struct Answer {
    Findings findings;
    Bounds bounds;
};

/// Brings what a call found to the host: a few bytes that the GPU writes into memory which the host sees too.
class Answers {
 public:
    /// `adders`: invocations of touch.comp.
    Answers(const gl::Context& context, int adders);

    void bind_findings() const;
    void clear_impulses() const;
    void bind_impulses() const;

    /// After all of a call was sent off. Throws Error if the card is lost meanwhile.
    Answer wait(const Influences& influences);

 private:
    struct Found;
    void reset_findings() const;
    void wait_for_gpu() const;

    const gl::Context& context_;
    const int adders_;
    gl::Buffer findings_, impulses_, letter_;
    const std::byte* seen_ = nullptr;  // the letter, as the host sees it
};

}  // namespace palpate::gpu
