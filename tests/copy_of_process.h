#pragma once
// What becomes of a process, seen from outside: a copy of this one lives and ends, and writes into memory
// that both share.
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <functional>
#include <new>

namespace palpate {

/// Something that this process and its copies share.
template <class T>
class WithCopies {
 public:
    WithCopies() {
        void* room = mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
        if (room == MAP_FAILED) throw std::bad_alloc();
        shared_ = new (room) T;
    }
    ~WithCopies() { munmap(shared_, sizeof(T)); }
    WithCopies(const WithCopies&) = delete;
    WithCopies& operator=(const WithCopies&) = delete;

    T& operator*() const { return *shared_; }
    T* operator->() const { return shared_; }

 private:
    T* shared_;
};

/// What a copy exits with that comes to the end of its life.
constexpr int lived = 7;

/// Starts a copy that lives so. It is silent, and gone after half a minute whatever happens.
inline pid_t start_copy(const std::function<void()>& life) {
    const pid_t copy = fork();
    if (copy != 0) return copy;
    alarm(30);
    if (!std::freopen("/dev/null", "w", stderr)) _exit(9);
    life();
    _exit(lived);
}

/// The status of a copy when it has ended, or has been stopped if options say so.
inline int wait_for(pid_t copy, int options = 0) {
    int status = 0;
    waitpid(copy, &status, options);
    return status;
}

/// Until something is so, or 20 s have gone by.
inline void wait_until(const std::function<bool()>& is_so) {
    for (int ms = 0; ms < 20'000 && !is_so(); ++ms) usleep(1000);
}

}  // namespace palpate
