#pragma once
#include "palpate/gl/program.h"

#include <string_view>

namespace palpate {

/// What draws surfaces whose vertices lie where `map_vertex`, the text of a shader that defines a function of
/// that name, says.
struct SurfacePrograms {
    gl::Program shown;  // for a picture
    gl::Program depth;  // for a shadow map

    explicit SurfacePrograms(std::string_view map_vertex);
};

/// What draws the parts of a picture. Each name is also that of its shader files, which say what they take.
struct Programs {
    gl::Program background;
    SurfacePrograms placed;  // surfaces that were mapped on the host, and balls
    gl::Program ground;
    gl::Program wires;

    Programs();
};

}  // namespace palpate
