#pragma once
#include "palpate/base/error.h"
#include "palpate/touch/device.h"

#include <memory>
#include <utility>

namespace palpate {

/// A device around another, which it owns. By itself it changes nothing: what derives from it overrides those
/// of the five methods in which it does.
class Decorator : public Device {
 public:
    /// Throws Error if there is none inside.
    explicit Decorator(std::unique_ptr<Device> inner) : inner_(std::move(inner)) {
        if (!inner_) throw Error("no device", "what goes around one", "make it before");
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
