#pragma once
#include "palpate/touch/devices/mouse.h"
#include "palpate/touch/devices/virtual_hand.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// The settings of all devices; each takes what it needs.
struct DeviceSettings {
    Path path{};  // that a simulated hand or a script follows
    VirtualHandSettings hand{};
    MouseSettings mouse{};
    std::vector<PointerEvent> replay{};  // events for a mouse
    std::filesystem::path log{};         // to play back
};

/// What a device needs from those who choose it by name.
enum class DeviceNeeds {
    pointer,  // a window that passes on pointer events
    path,     // DeviceSettings::path
    log,      // DeviceSettings::log
};

/// A kind of device that comes with Palpate. A program's own device needs no entry here: the program hands it
/// to a Touch.
struct Driver {
    std::string_view name, about;
    DeviceNeeds needs;
    /// Makes a device, not yet open. Throws Error, for example if a log cannot be read.
    std::unique_ptr<Device> (*make)(const DeviceSettings& settings);
};

std::span<const Driver> drivers();

/// The driver of that name. If there is none, throws an Error that lists the names.
const Driver& driver(std::string_view name);

/// The names of all drivers, or of those with that need, for a message: "a, b, c".
std::string names_of_drivers(std::optional<DeviceNeeds> needs = {});

}  // namespace palpate
