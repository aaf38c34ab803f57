#pragma once
#include "palpate/base/names.h"
#include "palpate/base/progress.h"
#include "palpate/run/report.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <optional>

namespace palpate {

/// When a run may end early: the criterion for rest.
enum class Rest {
    none,
    speed,  // for half a second no node has moved farther in a frame than a thousandth of its body's spacing
    move,   // no node has moved by 0.001 m in the last step (the 2012 paper's rule)
};

inline std::span<const Named<Rest>> names(Rest) {
    static constexpr Named<Rest> all[] = {{Rest::none, "none"}, {Rest::speed, "speed"}, {Rest::move, "move"}};
    return all;
}

/// The duration and the outputs of a run. An empty path means no output. Only the folder for pictures is
/// created, in an existing one.
struct RunSettings {
    // One of these, or the scene's own duration.
    std::optional<int> frames;  // of 1/60 s
    /// Steps of the solver. If the scene gives the step, they have exactly that length, and a frame is as
    /// many of them as fit into 1/60 s, at least one. Otherwise the run lasts as long as so many steps of
    /// untouched bodies.
    std::optional<long> steps;
    /// Ends the run once everything is at rest and every path has ended; if neither of the above is given,
    /// after ten times the scene's duration at the latest.
    Rest until_rest = Rest::none;

    std::filesystem::path video;  // MP4, 30 pictures a second
    std::filesystem::path
        images;  // a folder of PNG pictures, NAME-01.50s.png; older ones are kept, with a note
    std::filesystem::path report;    // JSON
    std::filesystem::path plot;      // SVG: contact force and indentation over time
    std::filesystem::path contacts;  // CSV: what each tool that presses does to each body, each millisecond
    std::filesystem::path nodes;     // CSV of the final state: body,id,x,y,z,vx,vy,vz
    std::filesystem::path surface;   // the final surface, see write_mesh; with several bodies NAME-BODY.ply.
                                     // If contacts are written, with the pressure on each vertex, Pa
    std::filesystem::path sequence;  // the moving surface, see make_sequence; likewise

    double image_every = 1;            // s
    double sequence_every = 1.0 / 30;  // s, rounded to whole frames of 1/60 s, at least one
    int width = 1280, height = 720;    // pixels
    bool lattice = false;              // draw the springs over the surface
};

/// Runs a scene: builds it, then simulates, maps and, if needed, draws each 1/60 s, and writes all outputs. A
/// run that diverges stops there: the good part is written, and the report says so. Throws Error if the scene
/// cannot be built, if an output cannot be written, has a wrong extension, would replace a file that the
/// scene reads, or would be empty (a plot without a tool).
Report run(const Scene& scene, const RunSettings& settings, const Progress& progress = {});

}  // namespace palpate
