#pragma once
#include "palpate/gl/program.h"

namespace palpate {

/// What draws the parts of a picture. Each name is also that of its shader files, which say what they take.
struct Programs {
    gl::Program background;
    gl::Program surface;  // balls, too
    gl::Program ground;
    gl::Program wires;

    Programs();
};

}  // namespace palpate
