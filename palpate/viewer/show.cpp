#include "palpate/viewer/show.h"

#include "palpate/viewer/window.h"

namespace palpate {

void show(const Body& body, const Mesh& surface, const ShowSettings& settings) {
    show(prepare(body, surface), settings);
}

void show(Prepared prepared, const ShowSettings& settings) {
    Window window(settings.size);
    window.viewer().options.look.springs = settings.lattice;
    window.viewer().begin(std::move(prepared));
    window.run();
}

void show(const std::string& file, const std::vector<Change>& changes, const ShowSettings& settings) {
    // Errors of a scene are thrown here rather than shown in a window.
    const bool recorded = file.ends_with(".json"), named = !file.empty() && !recorded;
    const SceneText scene = named ? find_scene(file) : SceneText{};
    if (named) parse_scene(scene, changes);
    const Recording recording = recorded ? read_recording(file) : Recording{};
    Window window(settings.size);
    window.viewer().options.look.springs = settings.lattice;
    if (recorded) window.viewer().replay(recording);
    if (named) window.viewer().open(scene, changes);
    window.run();
}

}  // namespace palpate
