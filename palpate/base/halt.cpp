#include "palpate/base/halt.h"

#include "palpate/base/error.h"

#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <span>

namespace palpate {
namespace {

// All signals that end a process unless they are handled, but for SIGTRAP, which belongs to debuggers.
constexpr int ending[] = {SIGINT, SIGTERM, SIGHUP,  SIGQUIT, SIGABRT, SIGSEGV, SIGBUS,  SIGFPE,    SIGILL,
                          SIGSYS, SIGPIPE, SIGALRM, SIGUSR1, SIGUSR2, SIGXCPU, SIGXFSZ, SIGVTALRM, SIGPROF};
constexpr int pausing[] = {SIGTSTP, SIGTTIN, SIGTTOU};
constexpr int crashing[] = {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGSYS};
constexpr std::size_t alternate_stack = 1 << 16;  // bytes, for the handler where the stack itself overflowed

// Data of the signal handler, so it is at fixed places.
std::array<std::atomic<void (*)(Halt) noexcept>, 8> acts{};
std::array<struct sigaction, NSIG> before{};  // the former handler of each signal
std::atomic<pid_t> process = 0;               // the process that asked for this
std::atomic<pid_t> acting = 0;                // the thread that is calling the acts

pid_t this_thread() { return pid_t(syscall(SYS_gettid)); }

void wait_a_moment() { poll(nullptr, 0, 1); }

// One thread at a time calls them: others wait, so that none ends the process meanwhile. A thread whose act
// crashed does not call them again.
void call_acts(Halt halt) {
    if (getpid() != process) return;
    pid_t expected = 0;
    if (!acting.compare_exchange_strong(expected, this_thread())) {
        if (expected == this_thread()) return;
        for (int ms = 0; ms < 1000 && acting != 0; ++ms) wait_a_moment();
        return;
    }
    for (auto& act : acts)
        if (auto* call = act.load()) call(halt);
    acting = 0;
}

// Takes the default action: ends the process; or pauses it, and returns when it continues.
void do_as_usual(int signal) {
    struct sigaction usual {
    }, ours{};
    usual.sa_handler = SIG_DFL;
    sigaction(signal, &usual, &ours);
    sigset_t now, masked;
    sigemptyset(&now);
    sigaddset(&now, signal);
    raise(signal);
    pthread_sigmask(SIG_UNBLOCK, &now, &masked);
    pthread_sigmask(SIG_SETMASK, &masked, nullptr);
    sigaction(signal, &ours, nullptr);
}

void pass_on(int signal, siginfo_t* about, void* context) {
    struct sigaction& earlier = before[std::size_t(signal)];
    const struct sigaction it = earlier;
    if (!(it.sa_flags & SA_SIGINFO) && it.sa_handler == SIG_DFL) return do_as_usual(signal);
    if (it.sa_flags & SA_RESETHAND) {
        earlier.sa_flags = 0;
        earlier.sa_handler = SIG_DFL;
    }
    if (it.sa_flags & SA_SIGINFO)
        it.sa_sigaction(signal, about, context);
    else
        it.sa_handler(signal);
}

bool is_one_of(std::span<const int> signals, int signal) {
    return std::ranges::find(signals, signal) != signals.end();
}

void halt(int signal, siginfo_t* about, void* context) {
    const int error = errno;
    call_acts(is_one_of(pausing, signal) ? Halt::paused : Halt::ended);
    pass_on(signal, about, context);
    errno = error;
}

void listen(int signal) {
    struct sigaction& earlier = before[std::size_t(signal)];
    if (sigaction(signal, nullptr, &earlier) != 0) return;
    const bool is_ignored = !(earlier.sa_flags & SA_SIGINFO) && earlier.sa_handler == SIG_IGN;
    if (is_ignored) return;
    const bool is_usual = !(earlier.sa_flags & SA_SIGINFO) && earlier.sa_handler == SIG_DFL;
    struct sigaction ours = earlier;  // keeps the application's other settings
    ours.sa_sigaction = halt;
    ours.sa_flags = (earlier.sa_flags & ~int(SA_RESETHAND)) | SA_SIGINFO | SA_ONSTACK;
    if (is_usual) ours.sa_flags |= SA_RESTART;
    // A second signal waits until the first has been handled; only a crash cannot wait.
    for (int other : ending)
        if (!is_one_of(crashing, other)) sigaddset(&ours.sa_mask, other);
    for (int other : pausing) sigaddset(&ours.sa_mask, other);
    sigaction(signal, &ours, nullptr);
}

void make_alternate_stack() {
    alignas(16) static char room[alternate_stack];
    stack_t has{}, made{};
    if (sigaltstack(nullptr, &has) != 0 || !(has.ss_flags & SS_DISABLE)) return;
    made.ss_sp = room;
    made.ss_size = sizeof room;
    sigaltstack(&made, nullptr);
}

void listen_to_all() {
    make_alternate_stack();
    for (int signal : ending) listen(signal);
    for (int signal : pausing) listen(signal);
    std::atexit([] { call_acts(Halt::ended); });
    std::at_quick_exit([] { call_acts(Halt::ended); });
}

}  // namespace

void on_halt(void (*act)(Halt) noexcept) {
    static std::once_flag once;
    std::call_once(once, listen_to_all);
    process = getpid();
    for (auto& place : acts) {
        void (*there)(Halt) noexcept = nullptr;
        if (place.compare_exchange_strong(there, act) || there == act) return;
    }
    throw Error("too many functions to call before a halt", "this program", "combine some of them");
}

}  // namespace palpate
