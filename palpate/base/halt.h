#pragma once

namespace palpate {

/// How a process comes to a halt.
enum class Halt {
    paused,  // it is stopped from its terminal (Ctrl+Z) and may go on later
    ended,   // it is told to end, crashes, or calls exit()
};

/// From now on `act` is called before the process halts: at a signal that would end it (SIGINT, SIGTERM,
/// SIGHUP and the like), at one that would pause it, at a crash (SIGSEGV, abort(), an exception that nobody
/// catches), at exit() and at quick_exit(). Then goes on what would have happened otherwise: the signal ends
/// the process as it would have, or a handler that the application had installed before is called. Signals
/// that were ignored stay ignored. So `act` may also be called where the application then goes on after all.
///
/// It is called in a handler of signals, on any thread, in the middle of anything: it may do only what POSIX
/// calls async-signal-safe, so it allocates, locks and prints nothing. In a copy of the process that fork()
/// made it is called only if that copy asks again, as a daemon should. SIGKILL, SIGSTOP, _exit() and the loss
/// of power give nobody a last word; nor does a stack that overflows on another thread than the one that
/// called this first.
///
/// Up to 8 different ones; the same one twice counts once. Throws Error if there are more.
void on_halt(void (*act)(Halt) noexcept);

}  // namespace palpate
