#include "palpate/render/shadow_map.h"

namespace palpate {

ShadowMap::ShadowMap(int size) : depth_(GL_DEPTH_COMPONENT32F, size, size) {
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

void ShadowMap::begin() const {
    const GLfloat far = 1;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, size(), size());
    glEnable(GL_DEPTH_TEST);
    glClearNamedFramebufferfv(framebuffer_.name(), GL_DEPTH, 0, &far);
}

void ShadowMap::bind() const {
    glBindTextureUnit(0, depth_.name());
    glBindTextureUnit(1, depth_.name());
    glBindSampler(0, lit_.name());
    glBindSampler(1, stopped_.name());
}

}  // namespace palpate
