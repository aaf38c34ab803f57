#include "palpate/solver_gl/answers.h"

#include "palpate/base/error.h"
#include "palpate/solver/pass.h"

#include <array>
#include <bit>
#include <cstring>
#include <limits>

namespace palpate::gpu {

// As in closing.comp.
struct Answers::Found {
    unsigned torn = 0, speed = 0, move = 0;
    std::array<int, 3> low, high;
};

namespace {

constexpr std::size_t before_impulses = 64;  // bytes of a letter
constexpr std::size_t most_tools = std::size(Pass{}.tip) + std::size(Pass{}.drag);

// The float whose bits closing.comp put in order.
float from_order(int ordered) { return std::bit_cast<float>(ordered ^ (ordered >> 31 & 0x7fffffff)); }

}  // namespace

Answers::Answers(const gl::Context& context, int adders)
    : context_(context),
      adders_(adders),
      findings_(gl::Buffer::room(sizeof(Found))),
      impulses_(gl::Buffer::room(most_tools * std::size_t(adders) * sizeof(vec4))) {
    constexpr GLbitfield how = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto bytes = GLsizeiptr(before_impulses + most_tools * std::size_t(adders) * sizeof(vec4));
    glNamedBufferStorage(letter_.name(), bytes, nullptr, how | GL_CLIENT_STORAGE_BIT);
    seen_ = static_cast<const std::byte*>(glMapNamedBufferRange(letter_.name(), 0, bytes, how));
    if (!seen_)
        throw Error("no memory that both the host and the graphics card see", "OpenGL",
                    "use the backend cpu");
    reset_findings();
}

void Answers::reset_findings() const {
    Found none;
    none.low.fill(std::numeric_limits<int>::max());
    none.high.fill(std::numeric_limits<int>::min());
    glNamedBufferSubData(findings_.name(), 0, sizeof none, &none);
}

void Answers::bind_findings() const {
    reset_findings();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, findings_buffer, findings_.name());
}

void Answers::clear_impulses() const {
    glClearNamedBufferData(impulses_.name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
}

void Answers::bind_impulses() const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, impulses_buffer, impulses_.name());
}

void Answers::wait_for_gpu() const {
    glMemoryBarrier(GL_CLIENT_MAPPED_BUFFER_BARRIER_BIT);
    const GLsync done = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    constexpr GLuint64 a_second = 1'000'000'000;
    GLenum state;
    while ((state = glClientWaitSync(done, GL_SYNC_FLUSH_COMMANDS_BIT, a_second)) == GL_TIMEOUT_EXPIRED)
        context_.make_current();  // finds out whether the card is lost
    if (state == GL_WAIT_FAILED) context_.make_current();
    glDeleteSync(done);
}

Answer Answers::wait(const Influences& influences) {
    const std::size_t tips = influences.presses.size(), tools = tips + influences.drags.size();
    glCopyNamedBufferSubData(findings_.name(), letter_.name(), 0, 0, sizeof(Found));
    if (tools > 0)
        glCopyNamedBufferSubData(impulses_.name(), letter_.name(), 0, before_impulses,
                                 GLsizeiptr(tools * std::size_t(adders_) * sizeof(vec4)));
    wait_for_gpu();

    Found found;
    std::memcpy(&found, seen_, sizeof found);
    Answer answer;
    answer.findings.torn = found.torn > 0;
    answer.findings.largest_speed = std::bit_cast<float>(found.speed);
    answer.findings.largest_move = std::bit_cast<float>(found.move);
    if (found.low[0] <= found.high[0])
        for (int k = 0; k < 3; ++k) {
            answer.bounds.low[k] = from_order(found.low[std::size_t(k)]);
            answer.bounds.high[k] = from_order(found.high[std::size_t(k)]);
        }
    const std::byte* next = seen_ + before_impulses;
    for (std::size_t t = 0; t < tools; ++t) {
        dvec3 sum(0);
        for (int i = 0; i < adders_; ++i, next += sizeof(vec4)) {
            vec4 part;
            std::memcpy(&part, next, sizeof part);
            sum += dvec3(part);
        }
        (t < tips ? answer.findings.by_presses : answer.findings.by_drags).push_back(sum);
    }
    return answer;
}

}  // namespace palpate::gpu
