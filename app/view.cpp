#include "app/view.h"

#include "app/viewer/window.h"

void check_view() { palpate::check_window(); }

void view(const std::string& file, const std::vector<palpate::Change>& changes, palpate::ivec2 size,
          bool lattice) {
    using namespace palpate;
    // What is wrong with a scene is said here rather than in a window.
    const bool recorded = file.ends_with(".json"), named = !file.empty() && !recorded;
    const SceneText scene = named ? find_scene(file) : SceneText{};
    if (named) parse_scene(scene, changes);
    const Recording recording = recorded ? read_recording(file) : Recording{};
    Window window(size);
    window.viewer().options.look.springs = lattice;
    if (recorded) window.viewer().replay(recording);
    if (named) window.viewer().open(scene, changes);
    window.run();
}
