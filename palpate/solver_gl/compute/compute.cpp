#include "palpate/gl/program.h"
#include "palpate/solver_gl/pipeline.h"

namespace palpate::gpu {
namespace {

const char* pass_comp =
#include "embedded/pass.comp.h"
    ;

gl::Program compute_program(const Text& text) {
    const std::string whole = text.physics + pass_comp;
    return gl::Program({{GL_COMPUTE_SHADER, "pass.comp", whole}});
}

ivec3 groups(const Text& text) {
    return text.tiles.x > 0 ? text.tiles : ivec3((text.slots + group_size - 1) / group_size, 1, 1);
}

class Compute final : public Pipeline {
 public:
    explicit Compute(const Text& text)
        : program_(compute_program(text)), sums_(text.sums), groups_(groups(text)) {}

    void pass(const Fields& fields) override {
        fields.start.positions.bind(start_positions_unit);
        fields.start.velocities.bind(start_velocities_unit);
        fields.was.bind(was_positions_unit);
        if (sums_) {
            fields.sum.positions.bind(sum_positions_unit);
            fields.sum.velocities.bind(sum_velocities_unit);
        }
        const GLuint outputs[] = {fields.next.positions.buffer(), fields.next.velocities.buffer(),
                                  fields.next_sum.positions.buffer(), fields.next_sum.velocities.buffer()};
        glBindBuffersBase(GL_SHADER_STORAGE_BUFFER, next_positions_buffer, sums_ ? 4 : 2, outputs);
        program_.use();
        glDispatchCompute(GLuint(groups_.x), GLuint(groups_.y), GLuint(groups_.z));
        glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                        GL_BUFFER_UPDATE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    }

 private:
    gl::Program program_;
    bool sums_;
    ivec3 groups_;
};

}  // namespace

std::unique_ptr<Pipeline> make_compute(const Text& text) { return std::make_unique<Compute>(text); }

}  // namespace palpate::gpu
