#pragma once

namespace palpate {

/// How a process comes to a halt.
enum class Halt {
    paused,  // it is stopped from its terminal (Ctrl+Z) and may continue later
    ended,   // it is asked to end, crashes, or calls exit()
};

/// From now on `act` is called before the process halts: at a signal that would end it (SIGINT, SIGTERM,
/// SIGHUP and the like), at one that would pause it, at a crash (SIGSEGV, abort(), an uncaught exception), at
/// exit() and at quick_exit(). Afterwards the signal does what it would have done otherwise: it ends the
/// process, or a handler that the application had installed before is called. So the application may also
/// continue after `act`. Signals that were ignored stay ignored.
///
/// It is called in a signal handler, on any thread, at any time: it must be async-signal-safe (POSIX), so it
/// must not allocate, lock or print. A process made by fork() has to call this again, as a daemon should. It
/// is not called at SIGKILL, SIGSTOP, _exit() or a loss of power, nor if the stack overflows on another
/// thread than the one that called this first.
///
/// There may be up to 8 different functions; a second call with the same one has no effect. Throws Error if
/// there are more.
void on_halt(void (*act)(Halt) noexcept);

}  // namespace palpate
