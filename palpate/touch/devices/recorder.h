#pragma once
#include "palpate/touch/devices/decorator.h"
#include "palpate/touch/log.h"

#include <cstddef>

namespace palpate {

/// Records everything that is read from a device and written to it. A tick without an answer is not recorded.
class Recorder final : public Decorator {
 public:
    /// Allocates room for `seconds` at `rate` Hz; nothing is allocated later. Throws Error if these are not
    /// positive and finite.
    Recorder(std::unique_ptr<Device> inner, double seconds, double rate = 1000);

    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench& wrench) noexcept override;

    // Only while no loop runs:
    const Log& log() const { return log_; }
    std::size_t missed() const { return missed_; }  // ticks that found no room

 private:
    Log log_;
    std::size_t most_ = 0, missed_ = 0;
    bool noted_ = false;  // whether the present tick is recorded
};

}  // namespace palpate
