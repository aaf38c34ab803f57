#pragma once
#include "palpate/run/experiment.h"
#include "palpate/viewer/import.h"
#include "palpate/viewer/message.h"
#include "palpate/viewer/options.h"

#include <memory>
#include <optional>

namespace palpate {

/// What is open: an experiment, perhaps the same once more beside it, perhaps a recording that leads it; and
/// what is being opened meanwhile.
class Session {
 public:
    Session(const gl::Context& context, Message& message) : context_(context), message_(message) {}

    Experiment* experiment() { return experiment_.get(); }
    const Experiment* experiment() const { return experiment_.get(); }
    const Experiment* beside() const { return beside_.get(); }

    void open(SceneText source, std::vector<Change> changes);
    void replay(Recording recording);
    const Import* importing() const { return import_.get(); }
    void cancel_import();
    /// What has been built meanwhile; nothing if there is none, or if it failed, which is said.
    std::optional<Prepared> take_import();

    /// In the place of what was open. Throws Error, and that stays.
    void begin(Prepared prepared);

    bool replaying() const { return bool(replay_); }
    void stop_replaying() { replay_.reset(); }

    /// Puts beside it what is asked for, if it is not there; then true. Where that cannot be, nothing is
    /// asked for any more.
    bool compare(Compared& asked);
    /// The next compare() makes it anew.
    void compare_anew() { compared_ = {}; }

    /// One frame, of all, under these hands; or as the recording says. False after its last. Throws Error.
    bool advance(const Hands& hands);

 private:
    bool replay_frame();

    const gl::Context& context_;
    Message& message_;
    std::unique_ptr<Import> import_;
    std::unique_ptr<Experiment> experiment_, beside_;
    Compared compared_;                         // what beside_ is
    std::optional<Recording> replay_, coming_;  // what is replayed; what import_ is for
};

/// The simulation on all cores: the motion is the same, and drawing waits for it.
Change all_cores();

}  // namespace palpate
