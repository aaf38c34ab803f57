#include "palpate/gl/program.h"
#include "palpate/solver_gl/pipeline.h"

#include <map>

namespace palpate::gpu {
namespace {

const char* pass_frag =
#include "embedded/pass.frag.h"
    ;
const char* whole_vert =
#include "embedded/whole.vert.h"
    ;

gl::Program fragment_program(const Text& text) {
    const std::string whole = text.physics + pass_frag,
                      corners = std::string("#version 450 core\n") + whole_vert;
    return gl::Program({{GL_VERTEX_SHADER, "whole.vert", corners}, {GL_FRAGMENT_SHADER, "pass.frag", whole}});
}

// The pipeline of 2005 (section 3.1): a triangle over the whole of a texture moves every node in it.
class Fragment final : public Pipeline {
 public:
    explicit Fragment(const Text& text) : program_(fragment_program(text)), sums_(text.sums) {}

    void pass(const Fields& fields) override {
        fields.start.positions.bind(start_positions_unit);
        fields.start.velocities.bind(start_velocities_unit);
        fields.was.bind(was_positions_unit);
        fields.sum.positions.bind(sum_positions_unit);
        fields.sum.velocities.bind(sum_velocities_unit);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target(fields).name());
        glViewport(0, 0, fields.next.positions.width(), fields.next.positions.height());
        program_.use();
        glBindVertexArray(no_corners_.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
    }

 private:
    const gl::Framebuffer& target(const Fields& fields) {
        const GLuint outputs[] = {fields.next.positions.texture(), fields.next.velocities.texture(),
                                  fields.next_sum.positions.texture(), fields.next_sum.velocities.texture()};
        const auto [found, fresh] = targets_.try_emplace({outputs[0], outputs[2]});
        if (fresh) {
            constexpr GLenum places[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2,
                                         GL_COLOR_ATTACHMENT3};
            const GLsizei count = sums_ ? 4 : 2;
            for (GLsizei i = 0; i < count; ++i)
                glNamedFramebufferTexture(found->second.name(), places[i], outputs[i], 0);
            glNamedFramebufferDrawBuffers(found->second.name(), count, places);
        }
        return found->second;
    }

    gl::Program program_;
    gl::VertexArray no_corners_;
    std::map<std::pair<GLuint, GLuint>, gl::Framebuffer> targets_;  // by the textures of next and next_sum
    bool sums_;
};

}  // namespace

std::unique_ptr<Pipeline> make_fragment(const Text& text) { return std::make_unique<Fragment>(text); }

}  // namespace palpate::gpu
