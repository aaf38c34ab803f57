#pragma once
#include "palpate/base/sequence_lock.h"
#include "palpate/touch/devices/decorator.h"

namespace palpate {

/// How much farther a tip goes in the scene than at its device, and how hard the scene's forces are there; it
/// turns as much in both. Both are from 1e-6 to 1e6.
struct Scale {
    vec3 about = vec3(0);  // the point, m, that is the same in both
    float motion = 1;
    float forces = 0;  // N at the device for each N in the scene; 0: 1 / motion, by which a wall is as stiff
                       // in N/m at the device as in the scene
};

/// Any device in another scale. Its limits stay the device's own, whatever the scale becomes: each sample
/// says what a newton and a metre are there now (DeviceState::forces, motion), and Touch reckons with that.
class Scaled final : public Decorator {
 public:
    Scaled(std::unique_ptr<Device> inner, const Scale& scale);

    /// From the next read on; the device is `placed` anew. From one thread at a time, any but the loop's too.
    /// Throws Error if it is out of bounds, and then all is as it was.
    void set(const Scale& scale);

    /// In the scene's newtons and metres, by the scale that it was made with.
    DeviceSpec spec() const override;
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    /// No more than the device's peak force and torque, whatever the scale has become.
    bool write(const Wrench& wrench) noexcept override;

 private:
    struct Set {
        Scale scale;
        unsigned times = 0;  // that it was set anew
    };

    Scale first_;
    float peak_force_ = 0, peak_torque_ = 0;  // N and N·m, at the device
    Set setting_;                             // of the thread that sets
    SequenceLock<Set> shared_;
    Set used_;
};

}  // namespace palpate
