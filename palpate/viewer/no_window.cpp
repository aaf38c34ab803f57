// Takes the place of all the other files where GLFW or Dear ImGui is missing.
#include "palpate/base/error.h"
#include "palpate/viewer/show.h"

namespace palpate {

void show(const Body&, const Mesh&, const ShowSettings&) { check_window(); }
void show(Prepared, const ShowSettings&) { check_window(); }
void show(const std::string&, const std::vector<Change>&, const ShowSettings&) { check_window(); }

void check_window() {
    throw Error(
        "no viewer", "this build",
        "install libglfw3-dev and libimgui-dev and build Palpate again; or run a scene off screen, by "
        "palpate run SCENE --headless");
}

}  // namespace palpate
