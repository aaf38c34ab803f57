#include "palpate/render/target.h"

#include "palpate/base/error.h"
#include "palpate/gl/visit.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

// Checked first, so that no texture of an impossible size is requested.
int checked_width(int width, int height) {
    check_size(width, height);
    return width;
}

int possible(int samples) {
    GLint colour = 0, depth = 0;
    glGetIntegerv(GL_MAX_COLOR_TEXTURE_SAMPLES, &colour);
    glGetIntegerv(GL_MAX_DEPTH_TEXTURE_SAMPLES, &depth);
    return std::min({samples, colour, depth});
}

}  // namespace

void check_size(int width, int height) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (width < 1 || height < 1 || width > most || height > most)
        throw Error(fmt::format("no image of {} x {} pixels can be drawn", width, height), "OpenGL",
                    fmt::format("choose 1 to {} pixels each way", most));
}

Target::Target(int width, int height, int samples)
    : pixels_(GL_SRGB8_ALPHA8, checked_width(width, height), height),
      depth_(GL_DEPTH_COMPONENT32F, width, height, possible(samples)) {
    samples = possible(samples);
    if (samples > 1) samples_.emplace(GL_SRGB8_ALPHA8, width, height, samples);
    const GLuint drawn_into = samples_ ? samples_->name() : pixels_.name();
    glNamedFramebufferTexture(drawn_.name(), GL_COLOR_ATTACHMENT0, drawn_into, 0);
    glNamedFramebufferTexture(drawn_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
    glNamedFramebufferTexture(shown_.name(), GL_COLOR_ATTACHMENT0, pixels_.name(), 0);
    if (glCheckNamedFramebufferStatus(drawn_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("no memory for an image of {} x {} pixels", width, height), "OpenGL",
                    "choose a smaller one");
    const gl::Visit visit;
    const GLfloat black[] = {0, 0, 0, 1};
    glClearNamedFramebufferfv(shown_.name(), GL_COLOR, 0, black);
}

void Target::begin() const {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glViewport(0, 0, width(), height());
    glEnable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_DEPTH_TEST);
    const GLfloat far = 1;
    glClearNamedFramebufferfv(drawn_.name(), GL_DEPTH, 0, &far);
}

void Target::end() const {
    if (!samples_) return;
    glBlitNamedFramebuffer(drawn_.name(), shown_.name(), 0, 0, width(), height(), 0, 0, width(), height(),
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

Image Target::read(const gl::Context& context) const {
    Image image{width(), height(), std::vector<std::uint8_t>(4u * width() * height())};
    context.read_texture(pixels_.name(), GL_RGBA, GL_UNSIGNED_BYTE,
                         std::as_writable_bytes(std::span(image.pixels)));
    // OpenGL's rows go up.
    const auto row = image.pixels.begin();
    const std::ptrdiff_t bytes = 4 * image.width;
    for (int above = 0, below = image.height - 1; above < below; ++above, --below)
        std::swap_ranges(row + bytes * above, row + bytes * (above + 1), row + bytes * below);
    return image;
}

// While GL_FRAMEBUFFER_SRGB is off, a blit neither decodes what it reads nor encodes what it writes.
void Target::show(ivec2 low, ivec2 high) const {
    GLint bound = 0;
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &bound);
    const bool stretched = high - low != ivec2(width(), height());
    glBlitNamedFramebuffer(shown_.name(), static_cast<GLuint>(bound), 0, 0, width(), height(), low.x, low.y,
                           high.x, high.y, GL_COLOR_BUFFER_BIT, stretched ? GL_LINEAR : GL_NEAREST);
}

}  // namespace palpate
