// Any text as a scene: an Error of one line, or a scene with a body or a surface.
#include "palpate/scene/scene.h"

#include "palpate/base/error.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const palpate::Scene scene = palpate::parse_scene(text, "fuzz.toml", "/nowhere");
        if (scene.bodies.empty() && scene.surfaces.empty()) std::abort();
    } catch (const palpate::Error& error) {
        if (std::string_view(error.what()).find_first_of("\n\r") != std::string_view::npos) std::abort();
    }
    return 0;
}
