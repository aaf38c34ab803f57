// A volume, as from CT or MRI, becomes a clean surface:  import_volume [VOLUME ISO-VALUE]
// Writes surface.ply.
#include <palpate/palpate.h>

#include <cstdio>
#include <cstdlib>
#include <random>

using namespace palpate;

// A stand-in for a scan: a bright ball with a dent, 60 mm wide, in noise whose peaks look like tissue too.
Volume scan() {
    Volume volume;
    volume.dims = ivec3(72);
    volume.spacing = vec3(0.001f);
    std::mt19937 random(7);
    std::normal_distribution<float> noise(0, 40);
    for (int i = 0; i < 72 * 72 * 72; ++i) {
        const vec3 p(i % 72, i / 72 % 72, i / 72 / 72);  // x runs fastest
        const bool inside = glm::distance(p, vec3(36)) < 30 && glm::distance(p, vec3(36, 70, 36)) > 15;
        volume.values.push_back((inside ? 200.0f : 0.0f) + noise(random));
    }
    return volume;
}

int main(int argc, char** argv) try {
    const Volume volume = argc > 2 ? read_volume(argv[1]) : scan();
    Mesh mesh = isosurface(volume, argc > 2 ? std::strtof(argv[2], nullptr) : 100);
    std::printf("%zu faces in %zu parts\n", mesh.triangles.size(), soundness(mesh).parts);
    keep_largest(mesh);  // the rest is noise
    smooth(mesh, 10);
    decimate(mesh, 20'000);
    compute_normals(mesh);
    const Soundness sound = soundness(mesh);
    std::printf("%zu faces in %zu part, %zu open edges, %.1f ml\n", mesh.triangles.size(), sound.parts,
                sound.open_edges, 1e6 * palpate::volume(mesh));
    write_mesh(mesh, "surface.ply");
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
