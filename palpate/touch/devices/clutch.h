#pragma once
#include "palpate/touch/devices/decorator.h"

#include <atomic>

namespace palpate {

/// A clutch (indexing): lets a person move the device while its pose in the scene stays, as one lifts a
/// mouse. While hold(true) or a button holds it, the pose stays and no force reaches the device. Afterwards
/// it continues from that place, with the device's orientation and a new `placed`.
class Clutch final : public Decorator {
 public:
    /// `buttons`: each of these bits holds it while pressed; they are still reported.
    explicit Clutch(std::unique_ptr<Device> inner, unsigned buttons = 0);

    /// May be called from any thread.
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
    dvec3 offset_ = dvec3(0);  // m, from the device's place to that in the scene
    unsigned placed_ = 0;
};

}  // namespace palpate
