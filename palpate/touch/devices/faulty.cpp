#include "palpate/touch/devices/faulty.h"

#include <limits>

namespace palpate {

Faulty::Faulty(std::unique_ptr<Device> inner, std::vector<Fault> faults, std::function<void(double)> sleep)
    : Decorator(std::move(inner)), faults_(std::move(faults)), sleep_(std::move(sleep)) {
    for (const Fault& fault : faults_)
        if (!(fault.from <= fault.to))
            throw Error("a fault that ends before it begins", spec().name, "give it increasing times");
    if (!sleep_) throw Error("no sleep function for stalls", spec().name, "hand one in");
}

void Faulty::open() {
    start_.reset();
    last_.reset();
    Decorator::open();
}

const Fault* Faulty::due(FaultKind kind) const {
    for (const Fault& fault : faults_)
        if (fault.kind == kind && time_ >= fault.from && time_ < fault.to) return &fault;
    return nullptr;
}

bool Faulty::read(double now, DeviceState& state) noexcept {
    if (!start_) start_ = now;
    time_ = now - *start_;
    if (const Fault* stall = due(FaultKind::stall)) sleep_(stall->to - time_);
    if (due(FaultKind::vanish)) {
        Decorator::stop();
        return false;
    }
    if (due(FaultKind::freeze) && last_) {
        state = *last_;
        return true;
    }
    DeviceState read;
    if (!Decorator::read(now, read)) return false;
    last_ = state = read;
    if (due(FaultKind::not_a_number)) state.pose.place = dvec3(std::numeric_limits<double>::quiet_NaN());
    if (const Fault* fault = due(FaultKind::jump)) state.pose.place += dvec3(fault->jump);
    return true;
}

bool Faulty::write(const Wrench& wrench) noexcept {
    if (due(FaultKind::vanish) || due(FaultKind::refuse)) return false;
    return Decorator::write(wrench);
}

}  // namespace palpate
