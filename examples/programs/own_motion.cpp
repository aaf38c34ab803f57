// A surface follows nodes that something else moves, such as an animation or another engine:
//     own_motion [MESH in metres]
// Writes twist.glb, which any viewer of glTF plays.
#include <palpate/palpate.h>

#include <cmath>
#include <cstdio>

using namespace palpate;

int main(int argc, char** argv) try {
    Mesh mesh = argc > 1 ? read_mesh(argv[1], Units::metres) : hull_mesh(lattice({11, 41, 11}, 0.005f, {}));
    if (mesh.normals.empty()) compute_normals(mesh);

    // A cage of 3 x 5 x 3 nodes around the surface. Only their positions matter; no mass is used.
    const Bounds box = bounds(mesh);
    Body cage = lattice(ivec3(3, 5, 3), 1, {});
    for (vec3& p : cage.positions) p = box.low + box.size() * p / vec3(2, 4, 2);
    const Embedding skin = embed(mesh, cage);

    const int pictures = 60;
    const auto film = make_sequence(mesh, "twist.glb", pictures);
    std::vector<vec3> moved = cage.positions, positions, normals;
    for (int i = 0; i < pictures; ++i) {
        // Your own motion: a twist, in which each node turns by an angle proportional to its height.
        for (std::size_t n = 0; n < moved.size(); ++n) {
            const vec3 rest = cage.positions[n] - box.centre();
            const float turn = std::sin(6.2832f * i / pictures) * 1.5f * rest.y / box.size().y;
            const float c = std::cos(turn), s = std::sin(turn);
            moved[n] = box.centre() + vec3(c * rest.x + s * rest.z, rest.y, c * rest.z - s * rest.x);
        }
        deform(skin, {.positions = moved, .normals = {}}, positions, normals);
        film->add(i / 30.0, positions, normals);
    }
    film->finish();
    std::printf("%zu vertices on %zu nodes, %d pictures\n", mesh.positions.size(), cage.count(), pictures);
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
