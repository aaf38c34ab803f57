#include "palpate/touch/make_device.h"

#include "palpate/base/error.h"
#include "palpate/touch/devices/playback.h"
#include "palpate/touch/devices/script.h"

#include <fmt/format.h>

namespace palpate {

std::unique_ptr<Device> make_device(DeviceKind kind, const DeviceSettings& settings) {
    switch (kind) {
        case DeviceKind::hand:
            return std::make_unique<VirtualHand>(settings.path, settings.hand);
        case DeviceKind::script:
            return std::make_unique<Script>(settings.path);
        case DeviceKind::mouse:
            return std::make_unique<Mouse>(settings.mouse, settings.replay);
        case DeviceKind::playback:
            return std::make_unique<Playback>(read_log(settings.log));
    }
    return nullptr;
}

std::unique_ptr<Device> make_device(std::string_view name, const DeviceSettings& settings) {
    const auto kind = value_of<DeviceKind>(name);
    if (!kind)
        throw Error(fmt::format("no device \"{}\"", name), "the list of devices",
                    fmt::format("did you mean \"{}\"? There are {}", nearest_name<DeviceKind>(name),
                                all_names<DeviceKind>()));
    return make_device(*kind, settings);
}

}  // namespace palpate
