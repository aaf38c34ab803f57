// A soft body is pressed from above by a round tip:  first_touch [MESH in metres]
// Writes pressed.ply.
#include <palpate/palpate.h>

#include <cstdio>

using namespace palpate;

int main(int argc, char** argv) try {
    // Your own surface, or that of a block of 100 x 40 x 100 mm.
    Mesh mesh = argc > 1 ? read_mesh(argv[1], Units::metres) : hull_mesh(lattice({41, 17, 41}, 0.0025f, {}));

    // What moves: a lattice of springs that fills it. The lowest tenth of it is held.
    Body body =
        lattice(mesh, {.nodes = 4000, .material = {.youngs_modulus = 5000, .density = 1000, .damping = 10}});
    pin(body, nodes_below(body, 0.1f, {0, -1, 0}));
    // What is seen: the surface, each vertex of which follows the cell of the lattice that it lies in.
    const Embedding skin = embed(mesh, body);

    // The tip begins at the top, and in a second moves in by a quarter of the body's height.
    const Bounds box = bounds(mesh);
    const vec3 size = box.size(), top(box.centre().x, box.high.y, box.centre().z);
    Press tip{.velocity = {0, -0.25f * size.y, 0}, .radius = 0.2f * size.x, .stiffness = 400};
    tip.centre = top + vec3(0, tip.radius, 0);

    auto solver = make_solver(body, {.gravity = vec3(0)});
    for (int frame = 1; frame <= 60; ++frame) {
        const Stats stats = solver->step(1.0 / 60, {.presses = {&tip, 1}});
        tip.centre += tip.velocity / 60.0f;
        if (frame % 6 == 0)
            std::printf("%4.1f s   %5.1f mm deep   %6.3f N\n", frame / 60.0,
                        1000 * (top.y - (tip.centre.y - tip.radius)), 60 * glm::length(stats.reactions[0]));
    }
    deform(skin, solver->nodes(), mesh.positions, mesh.normals);
    write_mesh(mesh, "pressed.ply");
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
