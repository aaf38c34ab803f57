#include "bench/speed/speed.h"
#include "palpate/base/clock.h"
#include "palpate/base/error.h"
#include "palpate/base/team.h"
#include "palpate/body/embedding.h"
#include "palpate/body/lattice.h"
#include "palpate/body/select.h"
#include "palpate/scene/build.h"
#include "tests/shapes.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <random>

namespace palpate::speed {
namespace {

const Material of_springs{
    .youngs_modulus = 10'000, .density = 1040, .damping = 5, .model = MaterialModel::springs};
const Material of_tissue{.youngs_modulus = 10'000, .density = 1040, .damping = 5};

Simulation with(Backend backend, int threads = 1, Integrator integrator = Integrator::verlet) {
    return {.backend = backend, .threads = threads, .integrator = integrator};
}

// The same surface with its vertices in random order.
Mesh shuffled(const Mesh& mesh) {
    std::vector<unsigned> place(mesh.positions.size());
    std::iota(place.begin(), place.end(), 0u);
    std::shuffle(place.begin(), place.end(), std::mt19937(1));
    Mesh to;
    to.positions.resize(place.size());
    for (std::size_t i = 0; i < place.size(); ++i) to.positions[place[i]] = mesh.positions[i];
    for (uvec3 t : mesh.triangles) to.triangles.push_back({place[t.x], place[t.y], place[t.z]});
    return to;
}

// Every link at its full share, as in 2005; one edge pinned.
Body whole_box(int nodes) {
    Body box = lattice(ivec3(nodes), 0.01f, of_springs);
    GridSprings& stencil = *box.grid();
    for (std::size_t i = 0; i < box.count(); ++i)
        for (std::size_t l = 0; l < stencil.links.size(); ++l)
            if (stencil.quarters(i, l) > 0) {
                stencil.shares[i] &= ~(std::uint64_t(7) << 3 * l);
                stencil.shares[i] |= std::uint64_t(4) << 3 * l;
            }
    for (int i = 0; i < nodes; ++i) box.inverse_mass[std::size_t(i)] = 0;
    return box;
}

// Maps a surface onto nodes that do not move, which costs the same.
Case mapping_of(std::string name, const Mesh& surface, const Body& body, Mapping mapping, int threads,
                double bytes, bool normals = true) {
    struct Mapped {
        Embedding skin;
        std::vector<vec3> nodes, node_normals, positions, normals;
        Team team;
        explicit Mapped(int members) : team(members) {}
    };
    auto all = std::make_shared<Mapped>(threads);
    all->skin = embed(surface, body, mapping);
    all->nodes = body.positions;
    all->node_normals = approximate_normals(body, body.positions);
    const double vertices = double(surface.positions.size());
    return {std::move(name),
            [=] {
                const double start = palpate::now();
                Team* const team = threads > 1 ? &all->team : nullptr;
                const Nodes nodes{all->nodes, all->node_normals};
                for (int i = 0; i < 10; ++i)
                    if (normals)
                        deform(all->skin, nodes, all->positions, all->normals, nullptr, team);
                    else
                        deform(all->skin, nodes, all->positions, team);
                return Work{palpate::now() - start, 10 * vertices};
            },
            0,
            bytes,
            0,
            threads};
}

}  // namespace

std::vector<Case> lattice_cases() {
    const Body box = lattice(ivec3(27), 0.01f, of_springs), large = lattice(ivec3(64), 0.01f, of_springs);
    std::vector<Case> cases;
    auto add = [&](const std::string& name, const Body& body, const Simulation& how) {
        cases.push_back(stepping(name, body, how));
    };
    add("27³, whole links", whole_box(27), with(Backend::cpu));
    const Body small = lattice(ivec3(10), 0.01f, of_springs);
    add("10³", small, with(Backend::cpu));
    cases.push_back(stepping("10³, a call for each step", small, with(Backend::cpu), nullptr, 1));
    add("27³, shares", box, with(Backend::cpu));
    add("27³, shares, 2 threads", box, with(Backend::cpu, 2));
    add("64³, shares", large, with(Backend::cpu));
    add("64³, shares, 2 threads", large, with(Backend::cpu, 2));
    add("ball of 20,000 nodes", lattice(ellipsoid(vec3(0.1f), 60), {.nodes = 20'000, .material = of_springs}),
        with(Backend::cpu));
    add("27³, cells of tissue", lattice(ivec3(27), 0.01f, of_tissue), with(Backend::cpu));
    add("27³, cells of tissue, 2 threads", lattice(ivec3(27), 0.01f, of_tissue), with(Backend::cpu, 2));
    add("64³, cells of tissue", lattice(ivec3(64), 0.01f, of_tissue), with(Backend::cpu));
    add("ball of 20,000 nodes, cells of tissue",
        lattice(ellipsoid(vec3(0.1f), 60), {.nodes = 20'000, .material = of_tissue}), with(Backend::cpu));
    try {
        const Scene scene = read_scene("brain");
        add("brain of 20,000 nodes", build(scene).models.front().body, with(Backend::cpu));
    } catch (const Error& error) {
        fmt::print(stderr, "brain: not available: {}\n", error.what());
    }
    Body hard = box;
    strengthen(hard, std::vector<float>(box.count(), 1.5f));
    add("27³, a stiffness for each node", hard, with(Backend::cpu));
    add("27³, 32 links (2012)",
        lattice(ivec3(27), 0.01f, SpringKinds{100, 50, 10}, {.mass = 1, .damping = 5}), with(Backend::cpu));
    add("27³, springs in a table", without_grid(box), with(Backend::cpu));
    add("64³, springs in a table", without_grid(large), with(Backend::cpu));
    for (const auto& [integrator, name] : names(Integrator{}))
        if (integrator != Integrator::verlet)
            add(fmt::format("27³, {}", name), box, with(Backend::cpu, 1, integrator));
    add("27³, the scalar reference", box, with(Backend::reference));
    add("27³, cells of tissue, the scalar reference", lattice(ivec3(27), 0.01f, of_tissue),
        with(Backend::reference));
    for (Case& of : bullet(box)) cases.push_back(std::move(of));
    return cases;
}

std::vector<Case> cloth_cases() {
    std::vector<Case> cases;
    for (int size : {128, 512})
        for (int threads : {1, 2})
            cases.push_back(stepping(fmt::format("{}², {} thread{}", size, threads, threads > 1 ? "s" : ""),
                                     cloth(ivec2(size), 0.01f, linen), with(Backend::cpu, threads)));
    ClothSettings damped = linen;
    damped.link_damping = 1e-4f;
    cases.push_back(
        stepping("128², damping along the springs", cloth(ivec2(128), 0.01f, damped), with(Backend::cpu)));
    const Body sheet = cloth(ivec2(128), 0.01f, linen);
    const Mesh triangles = face_mesh(sheet);
    cases.push_back(stepping("128² of triangles", cloth(triangles, linen), with(Backend::cpu)));
    cases.push_back(
        stepping("128² of triangles, shuffled", cloth(shuffled(triangles), linen), with(Backend::cpu)));
    ClothSettings stiff = linen;
    stiff.bending = 1e-5f;
    stiff.stiffness.flexion = 0;
    cases.push_back(
        stepping("128² of triangles that resist bending", cloth(triangles, stiff), with(Backend::cpu)));
    cases.push_back(stepping("128², the scalar reference", sheet, with(Backend::reference)));
    return cases;
}

std::vector<Case> embed_cases() {
    const Mesh surface = ellipsoid(vec3(0.1f), 283);  // 159,614 vertices
    const Body body = lattice(surface, {.nodes = 20'000, .material = of_springs});
    constexpr double written = 2 * sizeof(vec3);
    std::vector<Case> cases;
    for (int threads : {1, 2}) {
        const std::string on = threads > 1 ? ", 2 threads" : "";
        cases.push_back(mapping_of("trilinear" + on, surface, body, Mapping::trilinear, threads,
                                   sizeof(InCell) + written));
        cases.push_back(
            mapping_of("frames" + on, surface, body, Mapping::frames, threads, sizeof(OnFrames) + written));
        cases.push_back(mapping_of("trilinear, positions alone" + on, surface, body, Mapping::trilinear,
                                   threads, sizeof(InCell) + sizeof(vec3), false));
        cases.push_back(mapping_of("interpolated" + on, surface, body, Mapping::interpolated, threads,
                                   sizeof(OnTriangle) + written));
        cases.push_back(mapping_of("constant" + on, surface, body, Mapping::constant, threads,
                                   sizeof(OnTriangle) + written));
    }
    return cases;
}

}  // namespace palpate::speed
