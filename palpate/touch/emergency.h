#pragma once

namespace palpate {

class Touch;

/// From now on all devices of this process are stopped when it ends, crashes or is paused (base/halt.h says
/// exactly when). A library should not install signal handlers unasked, so this is for the program: the
/// command and the viewer call it. Call it once in your own program, after installing your own signal
/// handlers, which are still called.
void let_go_at_halt();

/// Stops all devices of this process, and returns when no tick under way can push any more, or after 20 ms.
/// For your own signal handlers: it is async-signal-safe, as Device::stop() is.
void let_go_of_all() noexcept;

// ---- for Touch ----

/// Throws Error if there are too many.
void add_touch(Touch& touch);
/// When this returns, nothing uses the touch any more.
void remove_touch(Touch& touch) noexcept;

}  // namespace palpate
