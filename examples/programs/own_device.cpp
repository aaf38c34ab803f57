// A device of your own feels a table; the impulses that it gives to the table could drive a simulation.
#include "pen.h"
#include <palpate/palpate.h>

#include <cstdio>

using namespace palpate;

int main() try {
    let_go_at_halt();  // however this program ends, no motor goes on pushing
    const std::vector<vec3> corners = {{-0.1f, 0, 0.1f}, {0.1f, 0, 0.1f}, {0, 0, -0.1f}};
    const std::vector<uvec3> triangles = {{0, 1, 2}};
    const Touchable table[] = {{corners, triangles}};

    Touch touch(std::make_unique<Pen>(), {.radius = 0.003, .feels = {{.stiffness = 300}}});
    touch.feel(Patch(table));
    const TouchLoop loop({&touch});
    double impulse = 0;  // N·s, downward
    for (int i = 0; i < 6; ++i) {
        sleep_until(now() + 0.5);
        for (Push push; touch.next(push);) impulse -= push.impulse.y;
        const Felt felt = touch.felt();
        std::printf("%5.1f mm above the table, pushed up with %.2f N; impulse on the table so far %.2f N s\n",
                    1000 * felt.pose.place.y, double(felt.force.y), impulse);
    }
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
