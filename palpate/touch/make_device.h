#pragma once
#include "palpate/base/names.h"
#include "palpate/touch/devices/mouse.h"
#include "palpate/touch/devices/virtual_hand.h"

#include <filesystem>
#include <memory>
#include <string_view>
#include <vector>

namespace palpate {

/// The devices that come with Palpate.
enum class DeviceKind {
    hand,      // a simulated person, whom forces push
    script,    // a path, whatever pushes
    mouse,     // a pointer in a picture
    playback,  // a log
};

inline std::span<const Named<DeviceKind>> names(DeviceKind) {
    static constexpr Named<DeviceKind> all[] = {{DeviceKind::hand, "hand"},
                                                {DeviceKind::script, "script"},
                                                {DeviceKind::mouse, "mouse"},
                                                {DeviceKind::playback, "playback"}};
    return all;
}

/// What they need; each takes its own.
struct DeviceSettings {
    Path path{};  // that a hand pulls itself along, or a script follows
    VirtualHandSettings hand{};
    MouseSettings mouse{};
    std::vector<PointerEvent> replay{};  // of a mouse
    std::filesystem::path log{};         // that is played back
};

/// A device that is still to be opened. Throws Error if a log cannot be read.
std::unique_ptr<Device> make_device(DeviceKind kind, const DeviceSettings& settings = {});

/// The same by its name. Throws Error that lists the names where it is none.
std::unique_ptr<Device> make_device(std::string_view name, const DeviceSettings& settings = {});

}  // namespace palpate
