#pragma once
#include "palpate/run/play.h"
#include "palpate/run/recording.h"
#include "palpate/run/report.h"
#include "palpate/scene/build.h"
#include "palpate/solver/forces.h"

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

/// A scene that was built, and what of: made on any thread, because it may take long.
struct Prepared {
    SceneText source;
    std::vector<Change> changes;
    Scene scene;
    Models models;
};

/// Throws Error.
Prepared prepare(SceneText source, std::vector<Change> changes, const Progress& progress = {});

/// How strong a hand is that reaches into a body: as strong as the springs of its heaviest nodes, so that it
/// moves what it takes hold of, and weaker with light ones, so that the step need not be much shorter.
struct Strength {
    float pull = 0;      // N/m, of a drag of one node, for each kg of it
    float pressure = 0;  // Pa/m, of a tip
};
Strength strength_for(const Body& body);

/// A scene that somebody plays with: it goes on frame by frame, whatever is changed meanwhile. Nothing in it
/// depends on a clock, a window or a thread, so the same inputs at the same frames lead to the same state, to
/// the bit. A step above the stability bound is accepted here: what it does can be looked at and undone.
class Experiment {
 public:
    /// On a GPU, in that context. Throws Error.
    explicit Experiment(Prepared prepared, const gl::Context* context = nullptr);
    Experiment(Experiment&&) = default;
    Experiment& operator=(Experiment&&) = delete;

    /// One frame of 1/60 s. False if the motion blew up, now or before: then all is as it was before that
    /// frame, and trouble() says so.
    bool advance(const Hands& hands = {});

    /// Another one with some more changes, that goes on from where this one is; hands may take hold of both.
    std::unique_ptr<Experiment> beside(const std::vector<Change>& more) const;

    /// Whether bodies can take that beside the scene's own tools: nodes that are there, and
    /// forces that are not out of all proportion to what they are made of.
    bool takes(const Hands& hands) const;

    /// Why it does not go on, in one line; empty while it does.
    const std::string& trouble() const { return trouble_; }

    // ---- changes: all of them keep where things are, as far as the same nodes are still there ----

    /// Replaces what was changed of the same keys before. Throws Error, and then all is as it was.
    /// `again`: it goes with the change before, as one movement of a slider does, and is undone with it.
    void change(const std::vector<Change>& changes, bool again = false);

    bool can_undo() const { return at_ > 0; }
    std::size_t changes_made() const { return at_; }  // that undo() could take back
    bool can_redo() const { return at_ + 1 < history_.size(); }
    void undo();
    void redo();

    /// Everything back to rest, at time 0; what was changed stays changed.
    void restart();

    /// Where things were about two seconds ago, or before trouble; what was changed since is changed back.
    bool can_return() const { return !good_.empty(); }
    void return_to_good();

    /// Holds a node fast where it is, or lets go of it.
    void pin(std::size_t body, const std::vector<int>& nodes, bool fast);
    bool is_pinned(std::size_t body, int node) const;

    // ---- what there is ----

    const SceneText& source() const { return source_; }
    const std::vector<Change>& changes() const { return history_[at_]; }
    const Scene& scene() const { return *scene_; }
    const Models& models() const { return *models_; }
    const Play& play() const { return *play_; }
    const Report& report() const { return *report_; }
    double time() const;    // s
    Energy energy() const;  // of all bodies

    /// The longest step that keeps a body's small motions bounded, untouched, s.
    double stable_step(std::size_t body) const;

    /// Goes up whenever a surface, or how it hangs on its nodes, is another.
    int shapes() const { return shapes_; }

    // ---- its inputs ----

    /// All that has been done to it since it began, or was restarted; see replay(). Throws Error if that was
    /// too much to keep.
    Recording recording() const;

    /// Does what a recording did at the coming frame, and goes on by that frame. False after its last, or if
    /// the motion has blown up for good.
    bool replay(const Recording& recording);

    /// Of all positions and velocities, to the bit.
    std::string fingerprint() const;

 private:
    struct Good {
        long frame;
        std::vector<Change> changes;
        std::vector<State> states;
    };
    struct Made;
    Experiment(Prepared prepared, const gl::Context* context, const Experiment* other);
    Made make(const std::vector<Change>& changes) const;
    Made put_together(const std::vector<Change>& changes, Scene scene, Models models,
                      const Experiment* other) const;
    void add_to_history(const std::vector<Change>& changes);
    bool fits(const Made& made) const;
    void take(Made made);
    void carry_over(Made& made);
    void set(std::vector<Change> changes);
    void record(Input input);
    void remember();

    SceneText source_;
    const gl::Context* context_;
    std::vector<std::vector<Change>> history_;  // all changes that hold, after each change
    std::size_t at_ = 0;                        // in the history
    std::unique_ptr<Scene> scene_;
    std::unique_ptr<Models> models_;
    std::unique_ptr<Report> report_;
    std::unique_ptr<Play> play_;
    std::string trouble_;
    long frame_ = 0;         // since time 0
    std::deque<Good> good_;  // the latest last
    int shapes_;

    bool records_ = true;
    std::vector<Change> first_changes_;  // of the recording
    std::vector<Input> inputs_;
    long recorded_ = 0;         // frames of the recording so far
    std::size_t replayed_ = 0;  // inputs that were done again
};

}  // namespace palpate
