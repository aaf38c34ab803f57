#pragma once
#include <atomic>

namespace palpate {

/// A triple buffer: passes the newest value from one writer to one reader, neither of which ever waits. Of
/// its three places one is written, one is read, and one holds the newest value in between.
template <class T>
class TripleBuffer {
 public:
    /// For the writer: its own place, which still holds the value of two or three writes ago; fill it, then
    /// publish() it.
    T& draft() { return places_[draft_]; }
    void publish() { draft_ = middle_.exchange(draft_ | fresh, std::memory_order_acq_rel) & place; }

    /// For the reader: takes the newest value into shown(). False if there is none since the last call.
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
