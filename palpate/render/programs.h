#pragma once
#include "palpate/gl/program.h"

#include <string_view>

namespace palpate {

/// Whether a surface has dents, and where its normals are then turned.
enum class Dented { no, at_vertices, at_fragments };

/// What draws surfaces whose vertices lie where `map_vertex`, the text of a shader that defines a function of
/// that name, says; moved and turned by the GpuDents that are bound to `dents_binding`. What has no dents has
/// programs of its own, since a software driver runs both sides of every branch.
struct SurfacePrograms {
    static constexpr GLuint dents_binding = 1;

    gl::Program shown;  // for a picture
    gl::Program depth;  // for a shadow map

    explicit SurfacePrograms(std::string_view map_vertex, Dented dented = Dented::no);
};

/// The map_vertex of surfaces that were mapped on the host, and of balls.
extern const char* const placed_glsl;

/// What draws the parts of a picture. Each name is also that of its shader files, which say what they take.
struct Programs {
    gl::Program background;
    SurfacePrograms placed;  // by placed_glsl, without dents
    gl::Program ground;
    gl::Program wires;

    Programs();
};

}  // namespace palpate
