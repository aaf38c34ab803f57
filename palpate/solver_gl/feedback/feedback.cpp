#include "palpate/gl/program.h"
#include "palpate/solver_gl/pipeline.h"

namespace palpate::gpu {
namespace {

const char* pass_vert =
#include "embedded/pass.vert.h"
    ;

struct TransformFeedbackKind {
    static GLuint create() {
        GLuint name = 0;
        glCreateTransformFeedbacks(1, &name);
        return name;
    }
    static void remove(GLuint name) { glDeleteTransformFeedbacks(1, &name); }
};

constexpr const char* captured[] = {"next_position", "next_velocity", "next_sum_position",
                                    "next_sum_velocity"};

gl::Program feedback_program(const Text& text) {
    const std::string whole = text.physics + pass_vert;
    return gl::Program({{GL_VERTEX_SHADER, "pass.vert", whole}},
                       std::span(captured).first(text.sums ? 4 : 2));
}

// The pipeline of 2012 (section 4): positions and velocities go from one set of buffers to another through
// the vertex shader.
class Feedback final : public Pipeline {
 public:
    explicit Feedback(const Text& text)
        : program_(feedback_program(text)), sums_(text.sums), slots_(text.slots) {
        for (GLuint attribute = 0; attribute < attributes(); ++attribute) {
            glEnableVertexArrayAttrib(nodes_.name(), attribute);
            glVertexArrayAttribFormat(nodes_.name(), attribute, 4, GL_FLOAT, GL_FALSE, 0);
            glVertexArrayAttribBinding(nodes_.name(), attribute, attribute);
        }
        for (GLenum side : {GL_FRAMEBUFFER_DEFAULT_WIDTH, GL_FRAMEBUFFER_DEFAULT_HEIGHT})
            glNamedFramebufferParameteri(nothing_.name(), side, 1);
    }

    void pass(const Fields& fields) override {
        const gl::Field* inputs[] = {
            &fields.now.positions, &fields.now.velocities, &fields.start.positions, &fields.start.velocities,
            &fields.was,           &fields.sum.positions,  &fields.sum.velocities};
        const gl::Field* outputs[] = {&fields.next.positions, &fields.next.velocities,
                                      &fields.next_sum.positions, &fields.next_sum.velocities};
        for (GLuint i = 0; i < attributes(); ++i)
            glVertexArrayVertexBuffer(nodes_.name(), i, inputs[i]->buffer(), 0, 4 * sizeof(float));
        for (GLuint i = 0; i < (sums_ ? 4u : 2u); ++i)
            glTransformFeedbackBufferBase(captured_.name(), i, outputs[i]->buffer());
        program_.use();
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, nothing_.name());
        glBindVertexArray(nodes_.name());
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, captured_.name());
        glEnable(GL_RASTERIZER_DISCARD);
        glBeginTransformFeedback(GL_POINTS);
        glDrawArrays(GL_POINTS, 0, slots_);
        glEndTransformFeedback();
        glDisable(GL_RASTERIZER_DISCARD);
        glBindTransformFeedback(GL_TRANSFORM_FEEDBACK, 0);
    }

 private:
    GLuint attributes() const { return sums_ ? 7 : 5; }

    gl::Program program_;
    gl::VertexArray nodes_;
    gl::Framebuffer nothing_;  // never drawn into; but without a complete framebuffer no draw is allowed
    gl::Handle<TransformFeedbackKind> captured_;
    bool sums_;
    GLsizei slots_;
};

}  // namespace

std::unique_ptr<Pipeline> make_feedback(const Text& text) { return std::make_unique<Feedback>(text); }

}  // namespace palpate::gpu
