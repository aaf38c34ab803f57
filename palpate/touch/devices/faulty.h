#pragma once
#include "palpate/touch/devices/decorator.h"

#include <functional>
#include <optional>
#include <vector>

namespace palpate {

enum class FaultKind {
    not_a_number,  // the position is NaN
    jump,          // the position is off by `jump`
    vanish,        // the device is gone, and its motors are off
    stall,         // read() blocks until the fault is over
    freeze,        // read() repeats the last sample
    refuse,        // write() fails, and the device keeps its last force
};

struct Fault {
    FaultKind kind = FaultKind::vanish;
    double from = 0, to = 0;        // s since the first read: from <= time < to
    vec3 jump = vec3(0.05f, 0, 0);  // m
};

/// Fault injection: a device that fails on schedule, for tests of how a loop copes.
class Faulty final : public Decorator {
 public:
    /// `sleep`: lets a stall last so many seconds, on the test's clock. Throws Error if it is empty, or if a
    /// fault ends before it begins.
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
    std::optional<double> start_;      // on the loop's clock
    double time_ = 0;                  // s since then, at the last read
    std::optional<DeviceState> last_;  // before the faults
};

}  // namespace palpate
