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

/// A built scene with its source. It may be made on any thread, because it may take long.
struct Prepared {
    SceneText source;  // without a text if a program made the models
    std::vector<Change> changes;
    Scene scene;
    Models models;
};

/// Throws Error.
Prepared prepare(SceneText source, std::vector<Change> changes, const Progress& progress = {});

/// From models that a program made. The scene has default values; colours, tools and paths may be added to
/// it.
Prepared prepare(Models models);
/// From a body and a surface that follows it.
Prepared prepare(Body body, Mesh surface);

/// The usual stiffness of a hand on a body: like the springs of its heaviest nodes, so that it moves what
/// it holds, and less for light nodes, so that the step need not be much shorter.
struct Strength {
    float pull = 0;      // N/m per kg of a node that is dragged
    float pressure = 0;  // Pa/m, of a tip
};
Strength strength_for(const Body& body);

/// An interactive scene: it advances frame by frame, and can be changed in between. Nothing in it depends on
/// a clock, a window or a thread, so the same inputs at the same frames lead to the same state, to the bit. A
/// step above the stability limit is accepted here: its effect can be watched and undone.
///
/// An experiment without a scene text can be pinned, undone and restarted as well. But change(), beside(),
/// recording() and replay() need a text, and throw Error without one.
class Experiment {
 public:
    /// `context`: for a backend on the GPU. Throws Error.
    explicit Experiment(Prepared prepared, const gl::Context* context = nullptr);
    Experiment(Experiment&&) = default;
    Experiment& operator=(Experiment&&) = delete;

    /// Advances by one frame of 1/60 s, or by fewer slices: for hands that answer more often. False if the
    /// motion has diverged, now or before: then the state is that before, and trouble() says so.
    bool advance(const Interaction& hands = {}, int slices = slices_per_frame);

    /// A copy with more changes, which continues from the present state; an interaction may act on both.
    std::unique_ptr<Experiment> beside(const std::vector<Change>& more) const;

    /// Whether bodies can take that interaction besides the scene's own tools: its nodes exist, and its
    /// forces are in proportion to their material.
    bool takes(const Interaction& hands) const;

    /// Why it does not advance, in one line; empty while it does.
    const std::string& trouble() const { return trouble_; }

    // ---- changes: all of them keep the state, as far as the same nodes still exist ----

    /// Changes keys, replacing earlier changes of the same keys. Throws Error; then nothing has changed.
    /// `again`: it belongs to the change before, as in one movement of a slider, and is undone with it.
    void change(const std::vector<Change>& changes, bool again = false);

    bool can_undo() const { return at_ > 0; }
    std::size_t changes_made() const { return at_; }  // that undo() can take back
    bool can_redo() const { return at_ + 1 < history_.size(); }
    void undo();
    void redo();

    /// Resets everything to rest, at time 0; changes are kept.
    void restart();

    /// Returns to the state of about two seconds ago, or before trouble, and takes back later changes.
    bool can_return() const { return !good_.empty(); }
    void return_to_good();

    /// Pins nodes where they are, or releases them.
    void pin(std::size_t body, const std::vector<int>& nodes, bool fast);
    bool is_pinned(std::size_t body, int node) const;

    // ---- contents ----

    const SceneText& source() const { return done_.scene; }
    bool has_text() const { return !source().text.empty(); }
    void require_text() const;  // throws Error if there is none
    const std::vector<Change>& changes() const { return history_[at_].changes; }
    const Scene& scene() const { return *made_.scene; }
    const Models& models() const { return *made_.models; }
    const Play& play() const { return *made_.play; }
    const Report& report() const { return *made_.report; }
    double time() const;    // s
    Energy energy() const;  // of all bodies

    /// The stability limit of the step for a body that nothing touches, s.
    double stable_step(std::size_t body) const;

    /// The identity of all surfaces and embeddings: a new one whenever one of them changes. Each experiment
    /// has its own.
    using Shapes = std::shared_ptr<const char>;
    const Shapes& shapes() const { return shapes_; }

    // ---- its inputs ----

    /// All inputs since it began or was restarted; see replay(). Throws Error if there were too many to keep.
    Recording recording() const;
    bool recording_is_full() const;

    /// Applies a recording's next inputs, and advances by at least a frame. False after the last input, or if
    /// the motion has diverged for good.
    bool replay(const Recording& recording);

    /// A hash of all positions and velocities, to the bit.
    std::string fingerprint() const;

 private:
    // What was changed: keys of the text; or without a text, the pinned nodes, one list for each body.
    struct Setting {
        std::vector<Change> changes;
        std::vector<std::vector<int>> pinned;
        bool operator==(const Setting&) const = default;
    };
    struct Good {
        long slice;  // since time 0
        Setting setting;
        std::vector<State> states;
    };
    struct Made {
        std::unique_ptr<Scene> scene;
        std::unique_ptr<Models> models;
        std::unique_ptr<Report> report;
        std::unique_ptr<Play> play;  // is destroyed before what it refers to
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
    int replay_one(const Recording& recording);
    void remember();

    const gl::Context* context_;
    std::vector<Setting> history_;  // the setting after each change
    std::size_t at_ = 0;            // in the history
    Made made_;
    std::vector<std::vector<float>> free_;  // inverse masses without pins, one list for each body, if there
                                            // is no text
    std::string trouble_;
    long slice_ = 0;         // since time 0
    std::deque<Good> good_;  // in order of time
    Shapes shapes_ = std::make_shared<char>();

    bool records_;
    Recording done_;            // what was done to it so far
    std::size_t replayed_ = 0;  // how many inputs were replayed
};

}  // namespace palpate
