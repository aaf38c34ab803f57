#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>

namespace palpate {

/// Calls piece(i) once for each i below `count`, on as many processors as there are; returns when all are
/// done. What an i writes should depend on it alone: then it does not depend on who took it. A piece may call
/// this again: no more threads work than there are processors, and whoever has pieces left takes those that
/// come free. If pieces throw, those not yet begun are left out, and what the first of them threw is thrown.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& piece);

/// Calls work(i) once for each i below `count`, in pieces of `at_once`: as many as take some 100 µs, more
/// than it takes to start a thread. The rest is as in_parallel() has it.
template <class Work>
void parallel_for(std::size_t count, std::size_t at_once, const Work& work) {
    in_parallel((count + at_once - 1) / at_once, [&](std::size_t piece) {
        const std::size_t end = std::min(count, (piece + 1) * at_once);
        for (std::size_t i = piece * at_once; i < end; ++i) work(i);
    });
}

/// Calls each of these once.
template <class... Works>
void parallel_invoke(const Works&... works) {
    const std::function<void()> all[] = {std::cref(works)...};
    in_parallel(sizeof...(works), [&](std::size_t i) { all[i](); });
}

/// While it lives, what this thread does in parallel is done by at most so many threads, itself among them.
class Processors {
 public:
    explicit Processors(int most);
    ~Processors();
    Processors(const Processors&) = delete;
    Processors& operator=(const Processors&) = delete;

    struct Free;  // how many more threads may work

 private:
    const std::unique_ptr<Free> free_;
    Free* const before_;
};

}  // namespace palpate
