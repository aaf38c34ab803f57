// A picture without a window: a soft cube has fallen on a table, and its lattice shows through.
// Writes picture.png.
#include <palpate/palpate.h>

#include <cstdio>

using namespace palpate;

int main() try {
    // A cube of jelly, 80 mm wide, 30 mm above the table and free to fall.
    Body jelly = lattice({9, 9, 9}, 0.01f, {.youngs_modulus = 3000, .density = 1000, .damping = 1});
    for (vec3& p : jelly.positions) p += vec3(-0.04f, 0.03f, -0.04f);
    Mesh surface = hull_mesh(jelly);
    const Embedding skin = embed(surface, jelly);

    Collider table{.shape = Plane{}, .friction = 0.5f};
    auto solver = make_solver(jelly, {.colliders = {table}});
    solver->step(0.11);
    deform(skin, solver->nodes(), surface.positions, surface.normals);

    Renderer renderer(Offscreen{640, 420});
    const std::vector<uvec2> springs = spring_ends(jelly);
    Picture picture;
    picture.camera = {.eye = {0.13f, 0.12f, 0.2f}, .look_at = {0, 0.03f, 0}};
    picture.surfaces.push_back(
        {renderer.add(surface), surface.positions, surface.normals, {{0.8f, 0.3f, 0.1f}}});
    picture.wires.push_back({solver->nodes().positions, springs});
    picture.grounds.push_back({});
    renderer.draw(picture);
    write_png(renderer.image(), "picture.png");
    std::printf("the cube is %.1f mm high; see picture.png\n", 1000 * bounds(surface).size().y);
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
