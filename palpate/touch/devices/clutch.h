#pragma once
#include "palpate/touch/devices/decorator.h"

#include <atomic>

namespace palpate {

/// Lets a person move the real hand elsewhere while the one in the scene waits, as one lifts a mouse. Let go
/// of by hold() or while a button is pressed: then the position stays and no force reaches the device. From
/// there it goes on when it is taken up again, `placed` anew.
class Clutch final : public Decorator {
 public:
    /// `buttons`: any of these bits lets go; they stay among the hand's.
    explicit Clutch(std::unique_ptr<Device> inner, unsigned buttons = 0);

    /// From any thread.
    void hold(bool held) noexcept { held_ = held; }

    void open() override;
    bool read(double now, Hand& hand) noexcept override;
    bool write(vec3 force) noexcept override;

 private:
    unsigned buttons_;
    std::atomic<bool> held_ = false;
    bool known_ = false;     // whether there is a position yet
    bool let_go_ = false;    // at the last read
    vec3 at_ = vec3(0);      // m, in the scene
    vec3 offset_ = vec3(0);  // from the real hand to it
    unsigned placed_ = 0;
};

}  // namespace palpate
