#include "palpate/viewer/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace palpate {
namespace {

std::vector<Change> changes_for(const Compared& compared, const Scene& scene) {
    std::vector<Change> changes;
    if (compared.with == Compared::With::backend)
        changes.push_back(fmt::format("simulation.backend=\"{}\"", name_of(compared.backend)));
    if (compared.with == Compared::With::mapping)
        for (std::size_t b = 0; b < scene.bodies.size(); ++b)
            changes.push_back(fmt::format("body.{}.mapping=\"{}\"", b + 1, name_of(compared.mapping)));
    return changes;
}

}  // namespace

Change all_cores() {
    return fmt::format("simulation.threads={}", std::clamp(std::thread::hardware_concurrency(), 1u, 8u));
}

void Session::open(SceneText source, std::vector<Change> changes) {
    coming_.reset();
    const bool given = std::ranges::any_of(
        changes, [](const Change& change) { return change.starts_with("simulation.threads="); });
    if (!given) changes.push_back(all_cores());
    import_ = std::make_unique<Import>(std::move(source), std::move(changes));
}

void Session::replay(Recording recording) {
    import_ = std::make_unique<Import>(recording.scene, recording.changes);
    coming_ = std::move(recording);
}

void Session::cancel_import() {
    if (!import_) return;
    import_->cancel();
    message_.say("stopped opening " + import_->name() + " as soon as it notices");
}

std::optional<Prepared> Session::take_import() {
    std::optional<Prepared> prepared;
    if (!import_ || !import_->done()) return prepared;
    const std::unique_ptr<Import> done = std::move(import_);
    if (done->cancelled())
        message_.say("stopped opening " + done->name());
    else
        message_.attempt([&] { prepared = done->take(); });
    return prepared;
}

void Session::begin(Prepared prepared) {
    auto experiment = std::make_unique<Experiment>(std::move(prepared), &context_);
    beside_.reset();
    compared_ = {};
    replay_.reset();
    if (!import_) std::swap(replay_, coming_);
    experiment_ = std::move(experiment);
}

bool Session::compare(Compared& asked) {
    if (replay_) asked = {};
    if (asked == compared_ || !experiment_) return false;
    compared_ = asked;
    beside_.reset();
    message_.attempt([&] {
        const std::vector<Change> changes = changes_for(compared_, experiment_->scene());
        if (!changes.empty()) beside_ = experiment_->beside(changes);
    });
    if (!beside_) asked = compared_ = {};
    return true;
}

bool Session::advance(const Interaction& hands) {
    if (replay_) return replay_frame();
    experiment_->advance(hands);
    if (beside_) beside_->advance(hands);
    return true;
}

void Session::say_trouble() {
    auto say = [&](const std::string& trouble, std::string& said, const char* before, const char* after) {
        if (!trouble.empty() && trouble != said) message_.say(before + trouble + after, true);
        said = trouble;
    };
    say(experiment_->trouble(), said_, "", "; it is held where it was last sound");
    say(beside_ ? beside_->trouble() : "", said_beside_, "on the right, ", "");
    const bool is_full = experiment_->recording_is_full();
    if (is_full && !said_full_) message_.say("the recording is full; restart to begin a new one");
    said_full_ = is_full;
}

bool Session::replay_frame() {
    if (experiment_->replay(*replay_)) return true;
    const bool same = experiment_->fingerprint() == replay_->fingerprint;
    message_.say(same ? "replayed to the end, the same to the bit"
                      : "replayed to the end, but the state is another: another backend, other files, or "
                        "another version?",
                 !same);
    stop_replaying();
    return false;
}

}  // namespace palpate
