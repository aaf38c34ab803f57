#pragma once
#include "palpate/viewer/gui.h"
#include "palpate/viewer/viewer.h"

#include <memory>

namespace palpate {

/// The viewer in a window of the desktop.
class Window {
 public:
    /// Throws Error if there is no display, or no OpenGL 4.5 on it.
    explicit Window(ivec2 size = ivec2(1280, 800));
    ~Window();
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    Viewer& viewer();
    Gui& gui();

    /// One round: what a person did, what moved meanwhile, a picture of it. False once it is to close.
    bool round();

    /// Round by round, until it is closed.
    void run();

 private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace palpate
