#pragma once
#include "palpate/base/names.h"
#include "palpate/body/embedding.h"
#include "palpate/body/simulation.h"

#include <string>

namespace palpate {

/// What a hand does to what it meets.
enum class Mode {
    pull,   // takes hold of a surface and pulls it along
    press,  // pushes a round tip into it, along the view
    dent,   // dents its picture and feels it, a thousand times a second; bodies do not feel it (2007)
    pin,    // holds nodes fast, or lets go of them
};

inline std::span<const Named<Mode>> names(Mode) {
    static constexpr Named<Mode> all[] = {
        {Mode::pull, "pull"}, {Mode::press, "press"}, {Mode::dent, "dent"}, {Mode::pin, "pin"}};
    return all;
}

/// How an experiment is shown. Nothing of it changes what moves.
struct Look3d {
    bool wireframe = false;  // the triangles' edges over the surfaces
    bool springs = false;    // the lattice's
    bool normals = false;    // as colours (2005, figure 6)
    bool normal_maps = true;
    bool culling = true;

    bool operator==(const Look3d&) const = default;
};

/// The same experiment twice, side by side: the right one with another mapping, or on another backend.
struct Compared {
    enum class With { nothing, mapping, backend } with = With::nothing;
    Mapping mapping = Mapping::trilinear;
    Backend backend = Backend::reference;
    bool operator==(const Compared&) const = default;
};

/// How well pictures are drawn.
enum class Care {
    automatic,  // as a draft until it is paused, where the CPU has to draw; else in full
    draft,
    full
};

/// All that a person can set about how they look and reach in; it is no part of what moves.
struct Options {
    Mode mode = Mode::pull;
    float tip = 0.01f;  // m, the radius of what presses and dents
    Look3d look;
    Care care = Care::automatic;
    bool paused = false;
    bool stereo = false;  // side by side, for the papers' immersive displays
    Compared compared;
    std::string device = "mouse";  // the name of its driver
    std::string device_file;       // its path, or its log
};

}  // namespace palpate
