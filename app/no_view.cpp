#include "app/view.h"
#include "palpate/base/error.h"

void view(const std::string&, const std::vector<palpate::Change>&, palpate::ivec2, bool) { check_view(); }

void check_view() {
    throw palpate::Error(
        "no viewer", "this build",
        "install libglfw3-dev and libimgui-dev and build again; or run a scene off screen, with "
        "--headless");
}
