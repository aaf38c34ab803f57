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
    std::array<float, 3> first_node = {}, first_velocity = {};
};

namespace {

constexpr std::size_t before_impulses = 64;  // bytes of a letter

// The float whose bits closing.comp put in order.
float from_order(int ordered) { return std::bit_cast<float>(ordered ^ (ordered >> 31 & 0x7fffffff)); }

}  // namespace

Answers::Answers(const gl::Context& context, int adders)
    : context_(context), adders_(adders), findings_(gl::Buffer::room(sizeof(Found))) {
    make_room(1);
    reset_findings();
}

void Answers::make_room(std::size_t impulses) {
    room_ = impulses;
    impulses_ = gl::Buffer::room(impulses * sizeof(vec4));
    constexpr GLbitfield how = GL_MAP_READ_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
    const auto bytes = GLsizeiptr(before_impulses + impulses * sizeof(vec4));
    letter_.emplace();
    glNamedBufferStorage(letter_->name(), bytes, nullptr, how | GL_CLIENT_STORAGE_BIT);
    seen_ = static_cast<const std::byte*>(glMapNamedBufferRange(letter_->name(), 0, bytes, how));
    if (!seen_)
        throw Error("no memory that both the host and the graphics card see", "OpenGL",
                    "use the backend cpu");
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

std::size_t Answers::impulses_of(const Influences& influences) const {
    return influences.pushes.size() + influences.presses.size() * std::size_t(adders_);
}

void Answers::clear_impulses(const Influences& influences) {
    if (const std::size_t needed = impulses_of(influences); needed > room_) make_room(2 * needed);
    glClearNamedBufferData(impulses_->name(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
}

void Answers::bind_impulses() const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, impulses_buffer, impulses_->name());
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
    const std::size_t impulses = impulses_of(influences);
    glCopyNamedBufferSubData(findings_.name(), letter_->name(), 0, 0, sizeof(Found));
    if (impulses > 0)
        glCopyNamedBufferSubData(impulses_->name(), letter_->name(), 0, before_impulses,
                                 GLsizeiptr(impulses * sizeof(vec4)));
    wait_for_gpu();

    Found found;
    std::memcpy(&found, seen_, sizeof found);
    Answer answer;
    answer.findings.torn = found.torn > 0;
    answer.findings.largest_speed = std::bit_cast<float>(found.speed);
    answer.findings.largest_move = std::bit_cast<float>(found.move);
    auto vector = [](const std::array<float, 3>& v) { return dvec3(v[0], v[1], v[2]); };
    answer.findings.first_node = vector(found.first_node);
    answer.findings.first_velocity = vector(found.first_velocity);
    if (found.low[0] <= found.high[0])
        for (int k = 0; k < 3; ++k) {
            answer.bounds.low[k] = from_order(found.low[std::size_t(k)]);
            answer.bounds.high[k] = from_order(found.high[std::size_t(k)]);
        }
    const std::byte* next = seen_ + before_impulses;
    auto sum_of = [&](int parts) {
        dvec3 sum(0);
        for (int i = 0; i < parts; ++i, next += sizeof(vec4)) {
            vec4 part;
            std::memcpy(&part, next, sizeof part);
            sum += dvec3(part);
        }
        return sum;
    };
    for (std::size_t p = 0; p < influences.pushes.size(); ++p) answer.findings.by_pushes.push_back(sum_of(1));
    for (std::size_t t = 0; t < influences.presses.size(); ++t)
        answer.findings.by_presses.push_back(sum_of(adders_));
    return answer;
}

}  // namespace palpate::gpu
