#pragma once
#include "palpate/run/play.h"
#include "palpate/scene/scene.h"

#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace palpate {

/// All changes of a scene that hold from a frame on.
struct SetChanges {
    std::vector<Change> changes;
};
/// A return to an earlier state; see Experiment.
struct ReturnToGood {};

/// An input to an experiment before it advances.
struct Input {
    long at = 0;  // how often it had advanced
    std::variant<Interaction, SetChanges, ReturnToGood> what;
    int slices = slices_per_frame;  // of an interaction: by so many it advances then
};

/// All inputs of an experiment from its beginning, for a replay that is exact to the bit; docs/viewer.md
/// describes the file.
struct Recording {
    SceneText scene;  // its text is included; the files that it names are not
    std::vector<Change> changes;
    std::vector<Input> inputs;  // in order of time
    long advances = 0;          // how often it advanced: by a frame, where no input says otherwise
    std::string fingerprint;    // of the state after the last
};

/// Writes it as JSON, atomically. Throws Error.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Throws an Error that names the place of what is invalid.
Recording read_recording(const std::filesystem::path& file);

}  // namespace palpate
