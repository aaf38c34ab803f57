#pragma once
#include "palpate/base/sequence_lock.h"
#include "palpate/touch/devices/decorator.h"

namespace palpate {

/// The scale between a device and the scene, of motion and of forces, each from 1e-6 to 1e6; orientations are
/// the same in both.
struct Scale {
    vec3 about = vec3(0);  // m, the fixed point of the scaling
    float motion = 1;      // m in the scene for each m at the device
    float forces = 0;  // N at the device for each N in the scene; 0: 1 / motion, which keeps stiffness in N/m
};

/// Any device in another scale. The limits of the device hold in its own units, whatever the scale: each
/// sample carries the present scale (DeviceState::forces, motion), and Touch takes it into account.
class Scaled final : public Decorator {
 public:
    Scaled(std::unique_ptr<Device> inner, const Scale& scale);

    /// Sets a new scale from the next read on, with a new `placed`. May be called by one thread at a time,
    /// not only by the loop's. Throws Error if it is out of range; then nothing has changed.
    void set(const Scale& scale);

    /// In the scene's newtons and metres, by the scale of the constructor.
    DeviceSpec spec() const override;
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    /// Writes no more than the device's peak force and torque, whatever the scale.
    bool write(const Wrench& wrench) noexcept override;

 private:
    struct Set {
        Scale scale;
        unsigned times = 0;  // how often it was set
    };

    Scale first_;
    float peak_force_ = 0, peak_torque_ = 0;  // N and N·m, at the device
    Set setting_;                             // of the thread that calls set()
    SequenceLock<Set> shared_;
    Set used_;
};

}  // namespace palpate
