#pragma once
#include "palpate/run/play.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace palpate {

/// All that holds of a scene's changes from a frame on.
struct SetChanges {
    std::vector<Change> changes;
};
/// Back to where things were some time before; see Experiment.
struct ReturnToGood {};

/// What came into an experiment before one of its frames.
struct Input {
    long at = 0;  // the number of the frame, from 0
    std::variant<Hands, SetChanges, ReturnToGood> what;
};

/// An experiment from its beginning, so that it can be done again to the bit: docs/viewer.md describes the
/// file.
struct Recording {
    SceneText scene;  // its text is carried along; files that it names are not
    std::vector<Change> changes;
    std::vector<Input> inputs;  // in their order
    long frames = 0;            // in all
    std::string fingerprint;    // of the state after the last
};

/// Writes it as JSON, whole or not at all. Throws Error.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Throws Error, which names the place, where something does not fit.
Recording read_recording(const std::filesystem::path& file);

}  // namespace palpate
