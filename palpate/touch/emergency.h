#pragma once

namespace palpate {

class Touch;

/// From now on no device of this process goes on pushing when it ends, crashes or is paused: all hands are
/// let go of before (base/halt.h says when that is, and what it can do nothing about). A library does not
/// take signals unasked, so this is for whoever owns the process: the command and the viewer call it; call it
/// once in a program of yours, after your own handlers of signals are installed, which are called as before.
void let_go_at_halt();

/// Lets go of all hands of this process, and returns when no tick that was under way can push any more, or
/// after 20 ms. For handlers of signals of your own: it is async-signal-safe, as Device::stop() is.
void let_go_of_all() noexcept;

// ---- for Touch ----

/// Throws Error if there are more hands than any desk has.
void add_touch(Touch& touch);
/// When this returns, nobody holds on to it.
void remove_touch(Touch& touch) noexcept;

}  // namespace palpate
