#pragma once
#include "palpate/gl/texture.h"

namespace palpate {

/// How far parallel light gets before something stops it. What lies outside of the map is lit.
class ShadowMap {
 public:
    /// `size` pixels wide and high.
    explicit ShadowMap(int size);

    /// What is drawn next, seen from the light and its depth only, stops that.
    void begin() const;

    /// For shaders to read, at texture unit 0 as a sampler2DShadow (1 where lit, 0 where shadowed), and at 1
    /// as a sampler2D (the depth at which the light stopped, 0 to 1).
    void bind() const;

    int size() const { return depth_.width(); }

 private:
    gl::Texture depth_;
    gl::Sampler lit_, stopped_;
    gl::Framebuffer framebuffer_;
};

}  // namespace palpate
