#pragma once
#include "palpate/base/names.h"
#include "palpate/body/embedding.h"
#include "palpate/body/simulation.h"

#include <string>

namespace palpate {

/// What the pointer or a device does.
enum class Mode {
    hand,  // feels surfaces, presses the bodies that it feels, dents what nothing moves (2007), and pulls
    pin,   // pins nodes, or releases them
};

inline std::span<const Named<Mode>> names(Mode) {
    static constexpr Named<Mode> all[] = {{Mode::hand, "hand"}, {Mode::pin, "pin"}};
    return all;
}

/// How an experiment is drawn. It does not affect the simulation.
struct Look3d {
    bool wireframe = false;  // the edges of triangles
    bool springs = false;    // the springs of the lattice
    bool normals = false;    // as colours (2005, figure 6)
    bool normal_maps = true;
    bool culling = true;

    bool operator==(const Look3d&) const = default;
};

/// A second experiment beside the first for comparison, with another mapping or on another backend.
struct Compared {
    enum class With { nothing, mapping, backend } with = With::nothing;
    Mapping mapping = Mapping::trilinear;
    Backend backend = Backend::reference;
    bool operator==(const Compared&) const = default;
};

/// The drawing quality.
enum class Care {
    automatic,  // if the CPU draws, as a draft until it is paused; else in full
    draft,
    full
};

/// All options of viewing and interacting; they are not part of the simulation.
struct Options {
    Mode mode = Mode::hand;
    float tip = 0.01f;  // m, the radius of the tip that touches
    Look3d look;
    Care care = Care::automatic;
    bool paused = false;
    bool stereo = false;  // side by side, for the papers' immersive displays
    Compared compared;
    std::string device = "mouse";  // the name of its driver
    std::string device_file;       // its path, or its log
};

}  // namespace palpate
