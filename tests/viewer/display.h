#pragma once
#include "palpate/base/vectors.h"

#include <X11/Xatom.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <X11/extensions/XTest.h>
#include <X11/keysym.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

namespace palpate {

// A display that nobody sees, for as long as it lives.
class Xvfb {
 public:
    Xvfb() {
        if (pipe(ends_) != 0) return;
        child_ = fork();
        if (child_ == 0) {
            close(ends_[0]);
            const std::string to = std::to_string(ends_[1]);
            freopen("/dev/null", "w", stderr);
            execlp("Xvfb", "Xvfb", "-displayfd", to.c_str(), "-screen", "0", "1280x1024x24", "-nolisten",
                   "tcp", "-noreset", static_cast<char*>(nullptr));
            _exit(127);
        }
        close(ends_[1]);
        char number[16] = {};
        const ssize_t length = ::read(ends_[0], number, sizeof number - 1);
        if (length > 0) name_ = fmt::format(":{}", std::atoi(number));
        while (!name_.empty() && !answers()) {
            usleep(20'000);
            if (waitpid(child_, nullptr, WNOHANG) != 0) child_ = -1, name_.clear();  // it has ended
        }
    }
    ~Xvfb() {
        if (child_ <= 0) return;
        kill(child_, SIGTERM);
        waitpid(child_, nullptr, 0);
        ::close(ends_[0]);  // not before, because it may yet write there
    }
    const std::string& name() const { return name_; }  // empty where there is no such program

 private:
    bool answers() const {
        Display* display = XOpenDisplay(name_.c_str());
        if (display) XCloseDisplay(display);
        return display;
    }

    pid_t child_ = -1;
    int ends_[2] = {-1, -1};  // of a pipe by which it tells its number
    std::string name_;
};

// The people's side of the display: their hands and eyes.
class Person {
 public:
    explicit Person(const std::string& display) : display_(XOpenDisplay(display.c_str())) {}
    ~Person() { XCloseDisplay(display_); }

    void move(vec2 to) {
        XTestFakeMotionEvent(display_, -1, int(to.x), int(to.y), 0);
        XSync(display_, False);
    }
    void button(unsigned number, bool down) {
        XTestFakeButtonEvent(display_, number, down, 0);
        XSync(display_, False);
    }
    void key(KeySym symbol, bool control = false) {
        if (control) hold(XK_Control_L, true);
        hold(symbol, true);
        hold(symbol, false);
        if (control) hold(XK_Control_L, false);
    }
    void hold(KeySym symbol, bool down) {
        XTestFakeKeyEvent(display_, XKeysymToKeycode(display_, symbol), down, 0);
        XSync(display_, False);
    }
    void resize(unsigned width, unsigned height) {
        XResizeWindow(display_, window(), width, height);
        XSync(display_, False);
    }
    void close() {
        const Atom protocols = XInternAtom(display_, "WM_PROTOCOLS", False);
        send(window(), protocols,
             {long(XInternAtom(display_, "WM_DELETE_WINDOW", False)), CurrentTime, 0, 0, 0});
    }

    bool sees_window() { return window() != 0; }

    // What is on the screen, of a window's size.
    std::vector<std::uint8_t> look() {
        XWindowAttributes at;
        XGetWindowAttributes(display_, window(), &at);
        XImage* image =
            XGetImage(display_, window(), 0, 0, unsigned(at.width), unsigned(at.height), AllPlanes, ZPixmap);
        std::vector<std::uint8_t> pixels;
        for (int y = 0; y < at.height; ++y)
            for (int x = 0; x < at.width; ++x) {
                const unsigned long pixel = XGetPixel(image, x, y);
                for (int shift : {16, 8, 0}) pixels.push_back(std::uint8_t(pixel >> shift));
            }
        XDestroyImage(image);
        return pixels;
    }

    // Drops a file, as a file manager does (the XDND protocol, version 5). `round`: lets the window go on.
    void drop(const std::string& file, const std::function<void()>& round) {
        const XID target = window();
        const XID source = XCreateSimpleWindow(display_, DefaultRootWindow(display_), 0, 0, 1, 1, 0, 0, 0);
        const Atom list = atom("text/uri-list"), selection = atom("XdndSelection");
        XSetSelectionOwner(display_, selection, source, CurrentTime);
        send(target, atom("XdndEnter"), {long(source), 5l << 24, long(list), 0, 0});
        send(target, atom("XdndPosition"),
             {long(source), 0, 640l << 16 | 400, CurrentTime, long(atom("XdndActionCopy"))});
        round();
        send(target, atom("XdndDrop"), {long(source), 0, CurrentTime, 0, 0});
        const std::string text = "file://" + file + "\r\n";
        for (bool served = false; !served;) {
            // The window may wait for the answer within a round: so it is given from here, between two.
            while (XPending(display_)) {
                XEvent event;
                XNextEvent(display_, &event);
                if (event.type != SelectionRequest) continue;
                const XSelectionRequestEvent& asked = event.xselectionrequest;
                XChangeProperty(display_, asked.requestor, asked.property, asked.target, 8, PropModeReplace,
                                reinterpret_cast<const unsigned char*>(text.data()), int(text.size()));
                XEvent answer = {};
                answer.xselection = {SelectionNotify,
                                     0,
                                     True,
                                     display_,
                                     asked.requestor,
                                     asked.selection,
                                     asked.target,
                                     asked.property,
                                     asked.time};
                XSendEvent(display_, asked.requestor, False, 0, &answer);
                XSync(display_, False);
                served = true;
            }
            round();
        }
        round();
        XDestroyWindow(display_, source);
        XSync(display_, False);
    }

 private:
    Atom atom(const char* name) { return XInternAtom(display_, name, False); }

    // The one that is shown.
    XID window() {
        XID root, parent, *children = nullptr, found = 0;
        unsigned count = 0;
        XQueryTree(display_, DefaultRootWindow(display_), &root, &parent, &children, &count);
        for (unsigned i = 0; i < count; ++i) {
            XWindowAttributes at;
            XGetWindowAttributes(display_, children[i], &at);
            if (at.map_state == IsViewable && at.c_class == InputOutput) found = children[i];
        }
        XFree(children);
        return found;
    }

    void send(XID to, Atom type, std::array<long, 5> data) {
        XEvent event = {};
        event.xclient.type = ClientMessage;
        event.xclient.window = to;
        event.xclient.message_type = type;
        event.xclient.format = 32;
        std::copy(data.begin(), data.end(), event.xclient.data.l);
        XSendEvent(display_, to, False, NoEventMask, &event);
        XSync(display_, False);
    }

    Display* display_;
};

}  // namespace palpate
