#include "palpate/render/target.h"

#include "palpate/base/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace palpate {
namespace {

constexpr int samples = 4;

// Checked before anything is made, so that no texture of an impossible size is asked for.
int checked_width(int width, int height) {
    check_size(width, height);
    return width;
}

}  // namespace

void check_size(int width, int height) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    if (width < 1 || height < 1 || width > most || height > most)
        throw Error(fmt::format("no image of {} x {} pixels can be drawn", width, height), "OpenGL",
                    fmt::format("choose 1 to {} pixels each way", most));
}

Target::Target(int width, int height)
    : samples_(GL_SRGB8_ALPHA8, checked_width(width, height), height, samples),
      depth_(GL_DEPTH_COMPONENT32F, width, height, samples),
      pixels_(GL_SRGB8_ALPHA8, width, height) {
    glNamedFramebufferTexture(drawn_.name(), GL_COLOR_ATTACHMENT0, samples_.name(), 0);
    glNamedFramebufferTexture(drawn_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
    glNamedFramebufferTexture(shown_.name(), GL_COLOR_ATTACHMENT0, pixels_.name(), 0);
    if (glCheckNamedFramebufferStatus(drawn_.name(), GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(fmt::format("no memory for an image of {} x {} pixels", width, height), "OpenGL",
                    "choose a smaller one");
    const GLfloat black[] = {0, 0, 0, 1};
    glClearNamedFramebufferfv(shown_.name(), GL_COLOR, 0, black);
}

void Target::begin() const {
    glBindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    glViewport(0, 0, width(), height());
    glEnable(GL_FRAMEBUFFER_SRGB);
    glDepthMask(GL_TRUE);
    const GLfloat far = 1;
    glClearNamedFramebufferfv(drawn_.name(), GL_DEPTH, 0, &far);
}

void Target::end() const {
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

}  // namespace palpate
