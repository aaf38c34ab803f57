#include "palpate/solver/gpu/answers.h"

#include "palpate/base/error.h"
#include "palpate/solver/pass.h"

#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace palpate::gpu {

// As in closing.comp.
struct Answers::Findings {
    unsigned torn = 0, speed = 0, move = 0;
    std::array<int, 3> low, high;
};

namespace {

constexpr int letters = 3;  // two calls on their way, and one that was dropped
constexpr std::size_t most_tools = std::size(Pass{}.tip) + std::size(Pass{}.drag);

// The float whose bits closing.comp put in order.
float from_order(int ordered) { return std::bit_cast<float>(ordered ^ (ordered >> 31 & 0x7fffffff)); }

}  // namespace

Answers::Answers(const gl::Context& context, int adders)
    : context_(context),
      adders_(adders),
      findings_(gl::Buffer::room(sizeof(Findings))),
      impulses_(gl::Buffer::room(most_tools * std::size_t(adders) * sizeof(vec4))),
      letter_bytes_(64 + most_tools * std::size_t(adders) * sizeof(vec4)) {
    constexpr GLbitfield how = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto bytes = GLsizeiptr(letters * letter_bytes_);
    glNamedBufferStorage(letters_.name(), bytes, nullptr, how | GL_CLIENT_STORAGE_BIT);
    seen_ = static_cast<const std::byte*>(glMapNamedBufferRange(letters_.name(), 0, bytes, how));
    if (!seen_)
        throw Error("no memory that both the host and the graphics card see", "OpenGL",
                    "use the backend cpu");
    reset_findings();
}

Answers::~Answers() { drop_all(); }

void Answers::reset_findings() const {
    Findings none;
    none.low.fill(std::numeric_limits<int>::max());
    none.high.fill(std::numeric_limits<int>::min());
    glNamedBufferSubData(findings_.name(), 0, sizeof none, &none);
}

void Answers::bind_findings() const {
    reset_findings();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, findings_.name());
}

void Answers::clear_impulses() const {
    glClearNamedBufferData(impulses_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
}

void Answers::bind_impulses() const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, impulses_.name()); }

void Answers::ask(const Stats& stats, const Influences& influences) {
    const Asked asked{stats, influences.presses.size(), influences.drags.size(), next_letter_, nullptr};
    next_letter_ = (next_letter_ + 1) % letters;
    const auto at = GLintptr(std::size_t(asked.letter) * letter_bytes_);
    glCopyNamedBufferSubData(findings_.name(), letters_.name(), 0, at, sizeof(Findings));
    const std::size_t sums = (asked.tips + asked.drags) * std::size_t(adders_);
    if (sums > 0)
        glCopyNamedBufferSubData(impulses_.name(), letters_.name(), 0, at + 64,
                                 GLsizeiptr(sums * sizeof(vec4)));
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    asked_.push_back(asked);
    asked_.back().done = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    glFlush();
}

Answer Answers::oldest() {
    Asked asked = asked_.front();
    constexpr GLuint64 a_second = 1'000'000'000;
    GLenum done;
    while ((done = glClientWaitSync(asked.done, GL_SYNC_FLUSH_COMMANDS_BIT, a_second)) == GL_TIMEOUT_EXPIRED)
        context_.make_current();  // finds out whether the card is lost
    if (done == GL_WAIT_FAILED) context_.make_current();
    glDeleteSync(asked.done);
    asked_.pop_front();

    const std::byte* letter = seen_ + std::size_t(asked.letter) * letter_bytes_;
    Findings found;
    std::memcpy(&found, letter, sizeof found);
    Answer answer{asked.stats, {}};
    answer.stats.diverged = found.torn > 0;
    answer.stats.largest_speed = std::bit_cast<float>(found.speed);
    answer.stats.largest_move = std::bit_cast<float>(found.move);
    if (found.low[0] <= found.high[0])
        for (int k = 0; k < 3; ++k) {
            answer.bounds.low[k] = from_order(found.low[std::size_t(k)]);
            answer.bounds.high[k] = from_order(found.high[std::size_t(k)]);
        }
    for (std::size_t t = 0; t < asked.tips + asked.drags; ++t) {
        dvec3 sum(0);
        for (int i = 0; i < adders_; ++i) {
            vec4 part;
            std::memcpy(&part, letter + 64 + (t * std::size_t(adders_) + std::size_t(i)) * sizeof part,
                        sizeof part);
            sum += dvec3(part);
        }
        (t < asked.tips ? answer.stats.reactions[t] : answer.stats.pulls[t - asked.tips]) = -sum;
    }
    return answer;
}

void Answers::drop_newest() {
    glDeleteSync(asked_.back().done);
    asked_.pop_back();
}

void Answers::drop_all() {
    while (!asked_.empty()) drop_newest();
}

}  // namespace palpate::gpu
