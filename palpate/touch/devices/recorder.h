#pragma once
#include "palpate/touch/devices/decorator.h"
#include "palpate/touch/log.h"

#include <cstddef>

namespace palpate {

/// Writes down all that a device says and is told. A tick in which it is gone has no line.
class Recorder final : public Decorator {
 public:
    /// Room for all of `seconds` at `rate` Hz is made here; nothing is allocated later. Throws Error if that
    /// is no length.
    Recorder(std::unique_ptr<Device> inner, double seconds, double rate = 1000);

    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench& wrench) noexcept override;

    // While no loop runs:
    const Log& log() const { return log_; }
    std::size_t missed() const { return missed_; }  // ticks that found no more room

 private:
    Log log_;
    std::size_t most_ = 0, missed_ = 0;
    bool noted_ = false;  // whether the tick that now is has a line
};

}  // namespace palpate
