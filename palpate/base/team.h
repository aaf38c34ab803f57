#pragma once
#include <atomic>
#include <functional>
#include <thread>
#include <vector>

namespace palpate {

/// Threads that work on one thing together, again and again, and meet in between: what takes a few
/// microseconds of each. Waiting members spin for a moment, then sleep.
class Team {
 public:
    /// `members`: at least one. The caller of run() is member 0; the others have threads of their own.
    explicit Team(int members);
    ~Team();
    Team(const Team&) = delete;
    Team& operator=(const Team&) = delete;

    int members() const { return int(threads_.size()) + 1; }

    /// Calls work(member) once for each member, all at the same time; returns when all have. It does not
    /// throw.
    void run(const std::function<void(int)>& work);

    /// In run(): waits until all members are here. What each wrote before, all see after.
    void meet();

 private:
    void stand_by(int member);

    std::vector<std::thread> threads_;
    const std::function<void(int)>* work_ = nullptr;  // null: go home
    std::atomic<unsigned> calls_ = 0;                 // of run()
    std::atomic<unsigned> arrived_ = 0, meetings_ = 0;
};

}  // namespace palpate
