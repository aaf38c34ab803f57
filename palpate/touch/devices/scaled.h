#pragma once
#include "palpate/base/shared.h"
#include "palpate/touch/devices/decorator.h"

namespace palpate {

/// How much farther a hand goes in the scene than at its device, and how hard the scene's forces are there.
struct Scale {
    vec3 about = vec3(0);  // the point, m, that is the same in both
    float motion = 1;      // above 0
    float forces = 0;  // N at the device for each N in the scene; 0: 1 / motion, by which a wall is as stiff
                       // in N/m at the device as in the scene
};

/// Any device in another scale.
class Scaled final : public Decorator {
 public:
    Scaled(std::unique_ptr<Device> inner, const Scale& scale);

    /// From the next read on; the hand is `placed` anew. From one thread at a time, any but the loop's too.
    void set(const Scale& scale) noexcept;

    /// In the scene's newtons and metres, by the scale that it was made with.
    DeviceSpec spec() const override;
    void open() override;
    bool read(double now, Hand& hand) noexcept override;
    /// No more than the device's peak force, whatever the scale has become.
    bool write(vec3 force) noexcept override;

 private:
    struct Set {
        Scale scale;
        unsigned times = 0;  // that it was set anew
    };

    Scale first_;
    float peak_force_ = 0;  // N, at the device
    Set setting_;           // of the thread that sets
    Shared<Set> shared_;
    Set used_;
};

}  // namespace palpate
