#pragma once
#include <atomic>

namespace palpate {

/// Passes values from one thread to another, of which the reader wants the newest. Neither ever waits,
/// whatever the other does: there are three places, one that is written, one that is read, and the newest
/// between.
template <class T>
class TripleBuffer {
 public:
    /// The writer's own place, with what it held two or three values ago; fill it, then publish() it.
    T& draft() { return places_[draft_]; }
    void publish() { draft_ = middle_.exchange(draft_ | fresh, std::memory_order_acq_rel) & place; }

    /// The reader's: takes the newest, if there is one that it has not had; then shown() is that.
    bool fetch() {
        if (!(middle_.load(std::memory_order_relaxed) & fresh)) return false;
        shown_ = middle_.exchange(shown_, std::memory_order_acq_rel) & place;
        return true;
    }
    const T& shown() const { return places_[shown_]; }

 private:
    static constexpr unsigned place = 3, fresh = 4;

    T places_[3] = {};
    unsigned draft_ = 0, shown_ = 1;
    std::atomic<unsigned> middle_ = 2;
};

}  // namespace palpate
