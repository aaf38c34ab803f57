// A body in the viewer's window, to be pulled, pressed, dented and pinned until the window is closed.
#include <palpate/palpate.h>
#include <palpate/viewer/show.h>

#include <cstdio>

using namespace palpate;

int main() try {
    // A beam of jelly, 200 mm long, pinned at its left end.
    Body jelly = lattice({21, 5, 5}, 0.01f, {.youngs_modulus = 20'000, .density = 1000, .damping = 2});
    pin(jelly, nodes_below(jelly, 0.01f, {-1, 0, 0}));
    show(jelly, hull_mesh(jelly));
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
