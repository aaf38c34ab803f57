#pragma once
#include "palpate/touch/device.h"
#include "palpate/touch/log.h"

#include <cstddef>
#include <optional>

namespace palpate {

/// Plays back a log from its first tick, beginning with the first read, and stands still after its last. At
/// the ticks of the log it returns exactly what the recorded device returned, to the bit if the loop's clock
/// starts as it did then. Between two ticks the pose is interpolated linearly, or stays at the earlier one
/// across a change of `placed`.
class Playback final : public Device {
 public:
    explicit Playback(Log log);

    DeviceSpec spec() const override { return {.name = "playback of " + log_.device, .turns = true}; }
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench&) noexcept override { return true; }
    void stop() noexcept override {}

 private:
    Log log_;
    std::optional<double> later_;  // s, from the recorded time to the present time
    std::size_t at_ = 0;           // the last tick that is past
};

}  // namespace palpate
