#pragma once
#include "palpate/gl/buffer.h"
#include "palpate/gl/context.h"
#include "palpate/solver/solver.h"

#include <deque>

namespace palpate::gpu {

/// What a call found.
struct Answer {
    Stats stats;
    Bounds bounds;  // of the nodes
};

/// Brings what calls found to the host, when they have found it: a few bytes that the GPU writes into memory
/// which the host sees too, so that neither stops for the other.
class Answers {
 public:
    /// `adders`: invocations of touch.comp.
    Answers(const gl::Context& context, int adders);
    ~Answers();

    void bind_findings() const;
    void clear_impulses() const;
    void bind_impulses() const;

    /// After all of a call was sent off: `stats` holds what is known of it.
    void ask(const Stats& stats, const Influences& influences);

    /// How many calls have not been told of.
    int pending() const { return int(asked_.size()); }
    /// Waits for the oldest of them. Throws Error if the card is lost meanwhile.
    Answer oldest();
    void drop_newest();
    void drop_all();

 private:
    struct Asked {
        Stats stats;
        std::size_t tips, drags;
        int letter;
        GLsync done;
    };
    struct Findings;
    void reset_findings() const;

    const gl::Context& context_;
    const int adders_;
    gl::Buffer findings_, impulses_, letters_;
    std::size_t letter_bytes_;
    const std::byte* seen_ = nullptr;  // the letters, as the host sees them
    int next_letter_ = 0;
    std::deque<Asked> asked_;
};

}  // namespace palpate::gpu
