#pragma once
#include "palpate/base/names.h"
#include "palpate/base/progress.h"
#include "palpate/run/report.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <optional>

namespace palpate {

/// When a run may end before its time.
enum class Rest {
    none,
    speed,  // for half a second no node has gone further in a frame than a thousandth of its body's spacing
    move,   // no node has moved by 0.001 m in the last step (the 2012 paper's rule)
};

inline std::span<const Named<Rest>> names(Rest) {
    static constexpr Named<Rest> all[] = {{Rest::none, "none"}, {Rest::speed, "speed"}, {Rest::move, "move"}};
    return all;
}

/// What a run shall last and leave behind. A path that is empty is not written. No folder is made but the one
/// for pictures, in one that is there.
struct RunSettings {
    // One of these, or the scene's own duration.
    std::optional<int> frames;  // of 1/60 s
    /// Of the solver: of exactly the scene's step where it gives one, and then a frame is as many of them as
    /// fit into 1/60 s, at least one; else for as long as so many take that nothing touches.
    std::optional<long> steps;
    /// Ends the run as soon as everything is at rest and every path has come to its end; without a number
    /// above, after ten times the scene's duration at the latest.
    Rest until_rest = Rest::none;

    std::filesystem::path video;  // MP4, 30 pictures a second
    std::filesystem::path
        images;  // a folder of PNG pictures, NAME-01.50s.png; older ones stay, and a note says so
    std::filesystem::path report;    // JSON
    std::filesystem::path plot;      // SVG: contact force and indentation over time
    std::filesystem::path nodes;     // CSV of the final state: body,id,x,y,z,vx,vy,vz
    std::filesystem::path surface;   // the final surface, see write_mesh; with several bodies NAME-BODY.ply
    std::filesystem::path sequence;  // the surface as it moves, see make_sequence; likewise

    double image_every = 1;            // s
    double sequence_every = 1.0 / 30;  // s, rounded to whole frames of 1/60 s, at least one
    int width = 1280, height = 720;    // pixels
    bool lattice = false;              // draw the springs over the surface
};

/// Runs a scene from its recipes to its files: build, then for each 1/60 s simulate, map, and draw if
/// anything wants pictures. A run that diverges stops there: what was good is kept and written, and the
/// report says so. Throws Error if the scene cannot be built, if a file cannot be written, would be named for
/// what it is not, or would replace one that the scene reads, or if it would hold nothing: a plot without a
/// tool.
Report run(const Scene& scene, const RunSettings& settings, const Progress& progress = {});

}  // namespace palpate
