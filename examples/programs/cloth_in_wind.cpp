// A flag hangs from its pole, the wind rises, and the flag flies.
// Writes flag.pc2, a mesh cache for Blender, and flag.obj, the mesh that it moves.
#include <palpate/palpate.h>

#include <cstdio>

using namespace palpate;

int main() try {
    // 600 x 400 mm of cloth, held at its left edge.
    Body flag = cloth(ivec2(31, 21), 0.02f, {.density = 0.12f, .damping = 0.2f, .link_damping = 1e-4f});
    pin(flag, nodes_in(flag, {.low = {-0.001f, -1, -1}, .high = {0.001f, 1, 1}}));
    // With one node per vertex the surface needs no mapping: its positions are the nodes'.
    const Mesh surface = face_mesh(flag);

    auto solver = make_solver(flag, {.air = 1.2f});
    const auto film = make_sequence(surface, "flag.pc2", 151);
    film->add(0, surface.positions, {});
    for (int frame = 1; frame <= 300; ++frame) {
        const float time = float(frame) / 60;
        const vec3 wind = vec3(8, 0, 1.5f) * glm::smoothstep(1.0f, 2.0f, time);
        const Stats stats = solver->step(1.0 / 60, {.wind = wind});
        if (stats.diverged) throw Error("the motion blew up", "the flag", "use stiffer springs");
        const auto nodes = solver->nodes().positions;
        if (frame % 2 == 0) film->add(time, nodes, {});
        if (frame % 30 == 0)
            std::printf("%3.1f s   wind %3.1f m/s   the free corner is at %5.0f mm, %5.0f mm\n", time,
                        glm::length(wind), 1000 * nodes[30].x, 1000 * nodes[30].y);
    }
    film->finish();
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
