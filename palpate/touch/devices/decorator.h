#pragma once
#include "palpate/touch/device.h"

#include <memory>
#include <utility>

namespace palpate {

/// A device around another, which it owns: by itself it changes nothing. Those that do change what they say
/// of the five. A decorator that read() has failed in leaves `hand` as it was, as any device does.
class Decorator : public Device {
 public:
    explicit Decorator(std::unique_ptr<Device> inner) : inner_(std::move(inner)) {}

    DeviceSpec spec() const override { return inner_->spec(); }
    void open() override { inner_->open(); }
    bool read(double now, Hand& hand) noexcept override { return inner_->read(now, hand); }
    bool write(vec3 force) noexcept override { return inner_->write(force); }
    void stop() noexcept override { inner_->stop(); }

 private:
    std::unique_ptr<Device> inner_;
};

}  // namespace palpate
