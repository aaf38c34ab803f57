#include "palpate/render/shadow_map.h"

namespace palpate {
namespace {

const char* depth_vert =
#include "embedded/depth.vert.h"
    ;

}  // namespace

ShadowMap::ShadowMap(int size)
    : program_({{GL_VERTEX_SHADER, "depth.vert", depth_vert}}), depth_(GL_DEPTH_COMPONENT32F, size, size) {
    glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_ATTACHMENT, depth_.name(), 0);
    glNamedFramebufferDrawBuffer(framebuffer_.name(), GL_NONE);
    for (const gl::Sampler* sampler : {&lit_, &stopped_}) {
        const GLfloat far[] = {1, 1, 1, 1};
        glSamplerParameteri(sampler->name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
        glSamplerParameteri(sampler->name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
        glSamplerParameterfv(sampler->name(), GL_TEXTURE_BORDER_COLOR, far);
    }
    glSamplerParameteri(lit_.name(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glSamplerParameteri(lit_.name(), GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glSamplerParameteri(lit_.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glSamplerParameteri(lit_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glSamplerParameteri(stopped_.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(stopped_.name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

const gl::Program& ShadowMap::begin(const mat4& light) const {
    const GLfloat far = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, size(), size());
    glEnable(GL_DEPTH_TEST);
    glDepthMask(GL_TRUE);
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, &far);
    program_.use();
    program_.set("to_clip", light);
    return program_;
}

void ShadowMap::bind() const {
    glBindTextureUnit(0, depth_.name());
    glBindTextureUnit(1, depth_.name());
    glBindSampler(0, lit_.name());
    glBindSampler(1, stopped_.name());
}

}  // namespace palpate
