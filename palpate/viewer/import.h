#pragma once
#include "palpate/run/experiment.h"

#include <atomic>
#include <future>
#include <mutex>
#include <optional>
#include <string>

namespace palpate {

/// Builds a scene on a thread of its own. Destroying it cancels, and waits until the work has noticed, which
/// it does between two of its parts.
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
    /// Once it is done. Throws Error if it could not be built.
    Prepared take() { return work_.get(); }

 private:
    const std::string name_;
    mutable std::mutex mutex_;
    State state_;
    std::atomic<bool> cancelled_ = false;
    std::future<Prepared> work_;
};

}  // namespace palpate
