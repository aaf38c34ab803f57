#pragma once
#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>

namespace palpate {

/// Calls piece(i) once for each i below `count`, on all processors; returns when all calls are done. What
/// piece(i) writes should depend on i alone: then the result is the same on any number of threads. A piece
/// may call this again: there are never more working threads than processors, and a call with pieces left
/// takes threads that become free. If pieces throw, those not yet begun are skipped, and the exception of the
/// lowest i is thrown.
void in_parallel(std::size_t count, const std::function<void(std::size_t)>& piece);

/// Calls work(i) once for each i below `count`, in pieces of `at_once`. A piece should take some 100 µs,
/// longer than it takes to start a thread. Otherwise it is like in_parallel().
template <class Work>
void parallel_for(std::size_t count, std::size_t at_once, const Work& work) {
    in_parallel((count + at_once - 1) / at_once, [&](std::size_t piece) {
        const std::size_t end = std::min(count, (piece + 1) * at_once);
        for (std::size_t i = piece * at_once; i < end; ++i) work(i);
    });
}

/// Calls each of these functions once, in parallel.
template <class... Works>
void parallel_invoke(const Works&... works) {
    const std::function<void()> all[] = {std::cref(works)...};
    in_parallel(sizeof...(works), [&](std::size_t i) { all[i](); });
}

/// Limits, during its lifetime, how many threads do this thread's parallel work, this thread included.
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
