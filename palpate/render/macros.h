#pragma once

namespace palpate {

/// Macros that let GLSL compile mapping.inl and dent.inl, which it shares with C++; and the lines that
/// undefine them.
extern const char *const macros_glsl, *const macros_end_glsl;

}  // namespace palpate
