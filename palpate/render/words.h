#pragma once

namespace palpate {

/// GLSL that gives mapping.inl and dent.inl their words, and GLSL behind which the words mean nothing again.
extern const char *const words_glsl, *const words_end_glsl;

}  // namespace palpate
