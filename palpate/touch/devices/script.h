#pragma once
#include "palpate/scene/path.h"
#include "palpate/touch/device.h"

#include <optional>

namespace palpate {

/// A hand that follows a path, whatever forces act on it. The path's time counts from the first read.
class Script final : public Device {
 public:
    explicit Script(Path path);

    DeviceSpec spec() const override { return {.name = "script", .turns = true}; }
    void open() override;
    bool read(double now, DeviceState& state) noexcept override;
    bool write(const Wrench&) noexcept override { return true; }
    void stop() noexcept override {}

 private:
    Path path_;
    std::optional<double> start_;  // on the loop's clock
};

}  // namespace palpate
