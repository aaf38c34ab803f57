#pragma once
#include "palpate/run/experiment.h"

#include <atomic>
#include <future>
#include <mutex>
#include <optional>
#include <string>

namespace palpate {

/// Builds a scene on a thread of its own. The destructor cancels and waits for the thread, which checks
/// between its stages.
class Import {
 public:
    Import(SceneText source, std::vector<Change> changes);
    ~Import();
    Import(const Import&) = delete;
    Import& operator=(const Import&) = delete;

    const std::string& name() const { return name_; }
    void cancel() { cancelled_ = true; }
    bool cancelled() const { return cancelled_; }

    struct State {
        std::string doing;
        double fraction = 0;
    };
    State state() const;

    bool done() const;
    /// To be called when it is done. Throws Error if the scene could not be built.
    Prepared take() { return work_.get(); }

 private:
    const std::string name_;
    mutable std::mutex mutex_;
    State state_;
    std::atomic<bool> cancelled_ = false;
    std::future<Prepared> work_;
};

}  // namespace palpate
