// Draws the viewer's window as docs/viewer.md and the README show it, on a virtual display.
//   viewer_pictures FOLDER
#include "palpate/base/files.h"
#include "palpate/files/image_file.h"
#include "palpate/viewer/window.h"
#include "tests/viewer/display.h"

#include <cstdio>
#include <filesystem>

namespace palpate {
namespace {

class Photographer {
 public:
    Photographer(Window& window, Person& person, std::filesystem::path folder)
        : window_(window), person_(person), folder_(std::move(folder)) {}

    void open(const char* scene) {
        viewer().open(find_scene(scene));
        while (viewer().importing()) window_.round();
    }
    // In the scene's time.
    void wait(double seconds) {
        const double until = viewer().experiment()->time() + seconds;
        while (viewer().experiment()->time() < until) window_.round();
    }
    // With Shift it pulls.
    void drag(vec2 from, vec2 to, bool pulls = true) {
        person_.move(from);
        rounds(2);
        if (pulls) person_.hold(XK_Shift_L, true);
        person_.button(1, true);
        rounds(1);
        if (pulls) person_.hold(XK_Shift_L, false);
        for (int i = 1; i <= 10; ++i) {
            person_.move(glm::mix(from, to, float(i) / 10));
            rounds(1);
        }
    }
    void let_go() {
        person_.button(1, false);
        rounds(2);
    }
    void rounds(int count) {
        for (int i = 0; i < count; ++i) window_.round();
    }
    Viewer& viewer() { return window_.viewer(); }

    void take(const char* name) {
        viewer().options.paused = true;
        viewer().options.care = Care::full;
        rounds(4);
        const std::vector<std::uint8_t> seen = person_.look();
        Image image{1280, 720, {}};
        for (std::size_t i = 0; i < seen.size(); i += 3)
            image.pixels.insert(image.pixels.end(), {seen[i], seen[i + 1], seen[i + 2], 255});
        write_png(image, folder_ / name);
        std::puts(name);
        viewer().options.paused = false;
        viewer().options.care = Care::automatic;
    }

 private:
    Window& window_;
    Person& person_;
    std::filesystem::path folder_;
};

void take_all(const std::filesystem::path& folder) {
    const Xvfb xvfb;
    setenv("DISPLAY", xvfb.name().c_str(), 1);
    Window window(ivec2(1280, 720));
    Person person(xvfb.name());
    Photographer photographer(window, person, folder);

    photographer.open("brain");
    photographer.wait(0.3);
    photographer.drag({820, 300}, {1010, 130});
    photographer.wait(0.7);
    photographer.take("viewer-pull.png");
    photographer.let_go();

    photographer.viewer().restart();
    photographer.wait(0.3);
    photographer.drag({800, 260}, {900, 330}, false);
    for (int i = 0; i < 3; ++i) person.button(4, true), person.button(4, false), photographer.rounds(2);
    photographer.wait(1);
    photographer.take("viewer-press.png");
    photographer.let_go();

    photographer.open("catheter");
    photographer.viewer().options.tip = 0.008f;
    photographer.wait(0.1);
    photographer.drag({470, 400}, {475, 395}, false);
    for (int i = 0; i < 8; ++i) person.button(4, true), person.button(4, false), photographer.rounds(2);
    photographer.wait(1.5);
    photographer.take("viewer-dent.png");
    photographer.let_go();

    photographer.open("box");
    photographer.viewer().options.compared = {.with = Compared::With::mapping, .mapping = Mapping::constant};
    photographer.viewer().options.look.springs = true;
    photographer.drag({640, 430}, {640, 200});
    photographer.wait(0.6);
    photographer.take("viewer-beside.png");
}

}  // namespace
}  // namespace palpate

int main(int argc, char** argv) {
    try {
        palpate::take_all(argc > 1 ? argv[1] : ".");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
