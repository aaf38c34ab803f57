#include "palpate/gl/texture.h"

namespace palpate::gl {
namespace {

GLuint create(GLenum target) {
    GLuint name = 0;
    glCreateTextures(target, 1, &name);
    return name;
}

}  // namespace

Texture::Texture(GLenum format, int width, int height, int samples)
    : handle_(create(samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D)),
      width_(width),
      height_(height) {
    if (samples > 1)
        glTextureStorage2DMultisample(name(), samples, format, width, height, GL_TRUE);
    else
        glTextureStorage2D(name(), 1, format, width, height);
}

}  // namespace palpate::gl
