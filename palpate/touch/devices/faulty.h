#pragma once
#include "palpate/touch/devices/decorator.h"

#include <functional>
#include <optional>
#include <vector>

namespace palpate {

enum class FaultKind {
    no_number,  // the place is NaN
    jump,       // the place is off by `jump`
    vanish,     // the device is gone, and its motors have no current
    stall,      // read() does not return before it is over
    freeze,     // the last sample again and again
    refuse,     // write() fails, and the device keeps what it pushed with
};

struct Fault {
    FaultKind kind = FaultKind::vanish;
    double from = 0, to = 0;        // s since the first read: from this on, until before that
    vec3 jump = vec3(0.05f, 0, 0);  // m
};

/// Any device that fails on schedule, to see what a loop makes of it.
class Faulty final : public Decorator {
 public:
    /// `sleep`: how a stall passes so many seconds, on the clock that the test has. Throws Error if there is
    /// none, or if a fault ends before it begins.
    Faulty(std::unique_ptr<Device> inner, std::vector<Fault> faults,
           std::function<void(double seconds)> sleep);

    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench& wrench) noexcept override;

 private:
    // The fault of a kind that is due, or null.
    const Fault* due(FaultKind kind) const;

    std::vector<Fault> faults_;
    std::function<void(double)> sleep_;
    std::optional<double> start_;      // of the loop's clock
    double time_ = 0;                  // s since then, at the last read
    std::optional<DeviceState> last_;  // before any fault
};

}  // namespace palpate
