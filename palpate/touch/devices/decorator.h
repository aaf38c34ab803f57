#pragma once
#include "palpate/base/error.h"
#include "palpate/touch/device.h"

#include <memory>
#include <utility>

namespace palpate {

/// A device around another, which it owns (the decorator pattern). It passes all five methods on; derived
/// classes override those that they change.
class Decorator : public Device {
 public:
    /// Throws Error if `inner` is null.
    explicit Decorator(std::unique_ptr<Device> inner) : inner_(std::move(inner)) {
        if (!inner_) throw Error("no device", "a decorator", "make the inner device first");
    }

    DeviceSpec spec() const override { return inner_->spec(); }
    void open() override { inner_->open(); }
    bool read(double now, DeviceState& state) noexcept override { return inner_->read(now, state); }
    bool write(const Wrench& wrench) noexcept override { return inner_->write(wrench); }
    void stop() noexcept override { inner_->stop(); }

 private:
    std::unique_ptr<Device> inner_;
};

}  // namespace palpate
