#pragma once
#include "palpate/run/experiment.h"
#include "palpate/viewer/import.h"
#include "palpate/viewer/message.h"
#include "palpate/viewer/options.h"

#include <memory>
#include <optional>

namespace palpate {

/// What is open: an experiment, possibly a second one beside it for comparison, possibly a recording that is
/// replayed; and what is being opened.
class Session {
 public:
    Session(const gl::Context& context, Message& message) : context_(context), message_(message) {}

    Experiment* experiment() { return experiment_.get(); }
    const Experiment* experiment() const { return experiment_.get(); }
    Experiment* beside() { return beside_.get(); }
    const Experiment* beside() const { return beside_.get(); }

    void open(SceneText source, std::vector<Change> changes);
    void replay(Recording recording);
    const Import* importing() const { return import_.get(); }
    void cancel_import();
    /// The scene that has been built meanwhile; nothing if there is none, or if it failed, which the message
    /// says.
    std::optional<Prepared> take_import();

    /// Replaces what was open. Throws Error; then nothing has changed.
    void begin(Prepared prepared);

    bool replaying() const { return bool(replay_); }
    void stop_replaying() { replay_.reset(); }

    /// Makes the experiment for comparison, if needed; then true. If that fails, `asked` is reset.
    bool compare(Compared& asked);
    /// Makes the next compare() make it again.
    void compare_anew() { compared_ = {}; }

    /// Advances all by one frame with this interaction, or as recorded. False after the recording's last
    /// frame. Throws Error.
    bool advance(const Interaction& hands);

    /// Says, once, what stopped one of them since the last call, and that the recording is full.
    void say_trouble();

 private:
    bool replay_frame();

    const gl::Context& context_;
    Message& message_;
    std::unique_ptr<Import> import_;
    std::unique_ptr<Experiment> experiment_, beside_;
    Compared compared_;               // what beside_ was made for
    std::string said_, said_beside_;  // of their trouble
    bool said_full_ = false;
    std::optional<Recording> replay_, coming_;  // what is replayed; what import_ is for
};

/// The simulation on all cores: the motion is the same, and drawing waits for it.
Change all_cores();

}  // namespace palpate
