#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/context.h"
#include "palpate/solver/machine.h"
#include "palpate/solver_gl/pipeline.h"

#include <optional>

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
    /// Makes room for the impulses of these, all zero.
    void clear_impulses(const Influences& influences);
    void bind_impulses() const;

    /// After all of a call was sent off. Throws Error if the card is lost meanwhile.
    Answer wait(const Influences& influences);

 private:
    struct Found;
    void reset_findings() const;
    std::size_t impulses_of(const Influences& influences) const;
    void wait_for_gpu() const;

    const gl::Context& context_;
    const int adders_;
    void make_room(std::size_t impulses);

    gl::Buffer findings_;
    std::size_t room_ = 0;  // for so many impulses
    std::optional<gl::Buffer> impulses_, letter_;
    const std::byte* seen_ = nullptr;  // the letter, as the host sees it
};

}  // namespace palpate::gpu
