#pragma once
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace palpate {

/// A thread pool for short parallel work, of a few microseconds, that is repeated often, with barriers in
/// between. Waiting members spin for a moment, then sleep.
class Team {
 public:
    /// `members`: at least one. The caller of run() is member 0; the others have threads of their own.
    explicit Team(int members);
    ~Team();
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    int members() const { return int(threads_.size()) + 1; }

    /// Calls work(member) once for each member, all at the same time; returns when all calls have returned.
    /// `work` must not throw.
    void run(const std::function<void(int)>& work);

    /// A barrier, to be called in run(): waits until all members have reached it. What each wrote before it,
    /// all see after it.
    void meet();

 private:
    void stand_by(int member);

    std::vector<std::thread> threads_;
    const std::function<void(int)>* work_ = nullptr;  // null: the threads end
    std::atomic<unsigned> calls_ = 0;                 // of run()
    std::atomic<unsigned> arrived_ = 0, meetings_ = 0;
};

}  // namespace palpate
