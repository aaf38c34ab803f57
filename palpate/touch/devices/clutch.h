#pragma once
#include "palpate/touch/devices/decorator.h"

#include <atomic>

namespace palpate {

/// Lets a person move the device elsewhere while its pose in the scene waits, as one lifts a mouse. Let go of
/// by hold() or while a button is pressed: then the pose stays and no force reaches the device. Taken up
/// again it goes on from that place, turned as the device is, `placed` anew.
class Clutch final : public Decorator {
 public:
    /// `buttons`: any of these bits lets go; they stay among the device's.
    explicit Clutch(std::unique_ptr<Device> inner, unsigned buttons = 0);

    /// From any thread.
    void hold(bool held) noexcept { held_ = held; }

    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench& wrench) noexcept override;

 private:
    unsigned buttons_;
    std::atomic<bool> held_ = false;
    bool known_ = false;       // whether there is a pose yet
    bool let_go_ = false;      // at the last read
    Pose at_ = {};             // in the scene
    dvec3 offset_ = dvec3(0);  // m, from the device's place to it
    unsigned placed_ = 0;
};

}  // namespace palpate
