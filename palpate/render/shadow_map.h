#pragma once
#include "palpate/gl/texture.h"

namespace palpate {

/// The depth of what parallel light meets first. What lies outside the map is lit.
class ShadowMap {
 public:
    /// `size` pixels wide and high.
    explicit ShadowMap(int size);

    /// What is drawn next, as seen from the light, casts shadows; only its depth is kept.
    void begin() const;

    /// Binds it for shaders: to texture unit 0 as a sampler2DShadow (1 where lit, 0 in shadow), and to unit 1
    /// as a sampler2D (the depth at which the light was stopped, 0 to 1).
    void bind() const;

    int size() const { return depth_.width(); }

 private:
    gl::Texture depth_;
    gl::Sampler lit_, stopped_;
    gl::Framebuffer framebuffer_;
};

}  // namespace palpate
