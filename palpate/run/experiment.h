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
    SceneText source;  // without a text where a program made the models
    std::vector<Change> changes;
    Scene scene;
    Models models;
};

/// Throws Error.
Prepared prepare(SceneText source, std::vector<Change> changes, const Progress& progress = {});

/// What a program made. Its scene is what goes without saying: colours, tools and paths may be put into it.
Prepared prepare(Models models);
/// A body and the surface that is hung on it.
Prepared prepare(Body body, Mesh surface);

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
///
/// What was made without a text can be pinned, undone and restarted as well. But change(), beside(),
/// recording() and replay() speak of a text, and throw Error where there is none.
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

    const SceneText& source() const { return done_.scene; }
    bool has_text() const { return !source().text.empty(); }
    void require_text() const;  // throws Error where there is none
    const std::vector<Change>& changes() const { return history_[at_].changes; }
    const Scene& scene() const { return *made_.scene; }
    const Models& models() const { return *made_.models; }
    const Play& play() const { return *made_.play; }
    const Report& report() const { return *made_.report; }
    double time() const;    // s
    Energy energy() const;  // of all bodies

    /// The longest step that keeps a body's small motions bounded, untouched, s.
    double stable_step(std::size_t body) const;

    /// Another one whenever a surface, or how it hangs on its nodes, is another. Experiments share none.
    using Shapes = std::shared_ptr<const char>;
    const Shapes& shapes() const { return shapes_; }

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
    // What was changed: of the text; or without one, the nodes that are pinned, a list a body.
    struct Setting {
        std::vector<Change> changes;
        std::vector<std::vector<int>> pinned;
        bool operator==(const Setting&) const = default;
    };
    struct Good {
        long frame;
        Setting setting;
        std::vector<State> states;
    };
    struct Made {
        std::unique_ptr<Scene> scene;
        std::unique_ptr<Models> models;
        std::unique_ptr<Report> report;
        std::unique_ptr<Play> play;  // goes before what it refers to
    };
    Experiment(Prepared prepared, const gl::Context* context, const Experiment* other);
    Made make(const Setting& setting) const;
    Made put_together(Scene scene, Models models, const Experiment* other) const;
    void add_to_history(Setting setting);
    bool fits(const Made& made) const;
    void take(Made made);
    void carry_over(Made& made);
    void set(const Setting& setting);
    void record(Input input);
    void remember();

    const gl::Context* context_;
    std::vector<Setting> history_;  // what holds after each change
    std::size_t at_ = 0;            // in the history
    Made made_;
    std::vector<std::vector<float>> free_;  // inverse masses without pins, a list a body, where no text is
    std::string trouble_;
    long frame_ = 0;         // since time 0
    std::deque<Good> good_;  // the latest last
    Shapes shapes_ = std::make_shared<char>();

    bool records_;
    Recording done_;            // to it so far
    std::size_t replayed_ = 0;  // inputs that were done again
};

}  // namespace palpate
