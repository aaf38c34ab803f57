#pragma once
#include "palpate/touch/device.h"
#include "palpate/touch/log.h"

#include <cstddef>
#include <optional>

namespace palpate {

/// Plays a log back from its first tick on, beginning with the first read, and stands still after its last.
/// At the ticks of the log it says what the recorded device said, to the bit if the loop's clock begins as it
/// did then. Between two ticks the pose goes straight, or stays with the earlier where it was `placed` anew.
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
    std::optional<double> later_;  // s, than when it was recorded
    std::size_t at_ = 0;           // the last tick that has come
};

}  // namespace palpate
