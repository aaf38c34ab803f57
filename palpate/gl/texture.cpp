#include "palpate/gl/texture.h"

#include <algorithm>
#include <bit>

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

Texture Texture::with_mipmaps(GLenum format, int width, int height, const std::uint8_t* pixels) {
    Texture made(Handle<TextureKind>(create(GL_TEXTURE_2D)), width, height);
    const int levels = std::bit_width(unsigned(std::max(width, height)));
    glTextureStorage2D(made.name(), levels, format, width, height);
    glTextureSubImage2D(made.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    glGenerateTextureMipmap(made.name());
    return made;
}

}  // namespace palpate::gl
