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

/// What devices are made of; each takes its own.
struct DeviceSettings {
    Path path{};  // that a hand pulls itself along, or a script follows
    VirtualHandSettings hand{};
    MouseSettings mouse{};
    std::vector<PointerEvent> replay{};  // of a mouse
    std::filesystem::path log{};         // that is played back
};

/// What whoever chooses a device by its name has to bring.
enum class DeviceNeeds {
    pointer,  // a window that tells it of one
    path,     // DeviceSettings::path
    log,      // DeviceSettings::log
};

/// A kind of device that comes with Palpate. What a program brings itself needs none of this: it gives a
/// Touch its Device.
struct Driver {
    std::string_view name, about;
    DeviceNeeds needs;
    /// Still to be opened. Throws Error, as where a log cannot be read.
    std::unique_ptr<Device> (*make)(const DeviceSettings& settings);
};

std::span<const Driver> drivers();

/// The one of that name. Throws Error that lists the names where there is none.
const Driver& driver(std::string_view name);

/// The names of those that need such a thing, or of all, for a message: "a, b, c".
std::string names_of_drivers(std::optional<DeviceNeeds> needs = {});

}  // namespace palpate
