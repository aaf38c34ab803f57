#pragma once
#include "palpate/viewer/gui.h"
#include "palpate/viewer/viewer.h"

#include <memory>

namespace palpate {

/// The viewer in a desktop window.
class Window {
 public:
    /// Throws Error if there is no display, or no OpenGL 4.5 on it.
    explicit Window(ivec2 size = ivec2(1280, 800));
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    Viewer& viewer();
    Gui& gui();

    /// One round of the event loop: handles input, advances, draws. False once the window shall close.
    bool round();

    /// Runs the event loop until the window is closed.
    void run();

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
