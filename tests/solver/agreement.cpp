#include "tests/solver/agreement.h"

#include "palpate/body/select.h"
#include "palpate/solver/stability.h"
#include "tests/shapes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace palpate {
namespace {

// A body with many odd things: nodes pinned and of other masses, and a scattering of holes in its links.
Body battered(Body body, unsigned seed) {
    std::mt19937 random(seed);
    auto chance = [&](double p) { return std::bernoulli_distribution(p)(random); };
    for (float& inverse : body.inverse_mass) inverse *= chance(0.1) ? 0.0f : chance(0.3) ? 0.5f : 1.0f;
    if (GridSprings* stencil = body.grid()) {
        const Table springs = table(body);
        for (std::size_t i = 0; i < body.count(); ++i)
            for (std::size_t l = 0; l < stencil->links.size(); ++l)
                if (const int to = springs.of(i)[l].to; to > int(i) && chance(0.05)) {
                    const std::size_t width = stencil->in_quarters() ? 3 : 1;
                    const std::uint64_t link = width == 3 ? 7 : 1;
                    for (std::size_t k = 0; k < stencil->links.size(); ++k) {  // the link back
                        if (stencil->links[k].offset != -stencil->links[l].offset) continue;
                        stencil->shares[i] &= ~(link << width * l);
                        stencil->shares[std::size_t(to)] &= ~(link << width * k);
                    }
                }
    }
    return body;
}

Body with_strength(Body body, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> factors(body.count());
    for (float& f : factors) f = std::uniform_real_distribution<float>(0.3f, 4.0f)(random);
    strengthen(body, factors);
    return body;
}

Body with_whole_links(Body body) {
    GridSprings& stencil = *body.grid();
    for (std::size_t i = 0; i < body.count(); ++i)
        for (std::size_t l = 0; l < stencil.links.size(); ++l)
            if (stencil.quarters(i, l) > 0) {
                stencil.shares[i] &= ~(std::uint64_t(7) << 3 * l);
                stencil.shares[i] |= std::uint64_t(4) << 3 * l;
            }
    return body;
}

// Two of its corners tied together, and a rope along an edge that two springs share.
Body stitched(Body body) {
    const int last = int(body.count()) - 1;
    body.terms.push_back(
        ListedSprings{{{0, last, 0.4f, 0.05f}, {1, 2, 2, 0.01f}, {2, 3, 3, 0.012f}, {1, 2, 1, 0.01f}}});
    return body;
}

// Hinges between most of its faces, one of them softer and one that rests bent.
Body hinged(Body body, float rigidity) {
    Bending hinges = bending(body, rigidity);
    hinges.hinges.resize(hinges.hinges.size() * 4 / 5);
    hinges.hinges.front().stiffness *= 0.3f;
    hinges.hinges.back().rest = -0.4f;
    body.terms.push_back(std::move(hinges));
    return body;
}

Body turned(Body body) {
    const mat3 turn = mat3(glm::rotate(mat4(1), 0.7f, glm::normalize(vec3(1, 2, 3))));
    for (vec3& p : body.positions) p = turn * p + vec3(0.02f, 0.05f, -0.03f);
    return body;
}

Body mirrored(Body body) {
    for (vec3& p : body.positions) p.x = -p.x;
    return body;
}

}  // namespace

std::vector<NamedBody> odd_bodies() {
    const Body organ = lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 700, .material = of_springs});
    std::vector<vec3> corners = {
        {0, 0, 0}, {0.03f, 0, 0}, {0, 0.03f, 0}, {0, 0, 0.03f}, {0.02f, 0.02f, 0.02f}};
    std::vector<Spring> edges;
    for (int a = 0; a < 5; ++a)
        for (int b = 0; b < a; ++b) edges.push_back({a, b, 20});
    Body net_body = net(corners, std::vector<float>{0.01f, 0.01f, 0.01f, 0.02f, 0.0f}, edges);
    net_body.damping = 20;
    Mesh bowl = ellipsoid({0.04f, 0.04f, 0.02f}, 7);
    ClothSettings stiff_linen = linen;
    stiff_linen.bending = 2e-4f;
    stiff_linen.stiffness.flexion = 0;
    const Body bending_bowl = cloth(bowl, stiff_linen);
    const Body solid_organ =
        lattice(ellipsoid({0.05f, 0.03f, 0.04f}, 12), {.nodes = 150, .material = of_tissue});
    return {
        {"box", lattice({9, 7, 8}, 0.01f, of_springs)},
        {"box with whole links", with_whole_links(lattice({8, 9, 5}, 0.01f, of_springs))},
        {"battered box", battered(lattice({10, 6, 7}, 0.01f, of_springs), 1)},
        {"box with strength", with_strength(lattice({7, 6, 5}, 0.01f, of_springs), 2)},
        {"stitched box", stitched(lattice({5, 6, 4}, 0.01f, of_springs))},
        {"organ", organ},
        {"battered organ", battered(organ, 3)},
        {"organ with strength", with_strength(organ, 4)},
        {"turned box", turned(lattice({6, 5, 4}, 0.01f, of_springs))},
        {"turned organ with strength", turned(with_strength(organ, 7))},
        {"battered box, mirrored", mirrored(battered(lattice({5, 6, 7}, 0.01f, of_springs), 8))},
        {"turned volume, mirrored",
         mirrored(turned(lattice({6, 5, 4}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20})))},
        {"volume of 2012", lattice({7, 5, 6}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20})},
        {"volume with strength",
         with_strength(lattice({5, 5, 6}, 0.01f, SpringKinds{20, 10, 5}, {.mass = 0.1f, .damping = 20}), 5)},
        {"cloth", cloth({17, 9}, 0.01f, linen)},
        {"turned cloth", turned(cloth({12, 11}, 0.01f, linen))},
        {"battered cloth", battered(cloth({11, 13}, 0.01f, linen), 6)},
        {"cloth of triangles", cloth(bowl, linen)},
        {"net", net_body},
        {"sheet that bends", bending_bowl},
        {"battered sheet that bends", battered(bending_bowl, 9)},
        {"solid box", lattice({6, 4, 5}, 0.01f, of_tissue)},
        {"battered solid organ with strength", battered(with_strength(solid_organ, 12), 11)},
        {"turned solid organ", turned(solid_organ)},
        {"stitched solid", stitched(lattice({5, 6, 4}, 0.01f, of_tissue))},
        {"cloth with hinges", hinged(cloth({12, 7}, 0.01f, linen), 2e-4f)}};
}

Acting everything(const Body& body) {
    Acting on;
    vec3 low(1e9f), high(-1e9f);
    for (vec3 p : body.positions) low = glm::min(low, p), high = glm::max(high, p);
    const vec3 middle = 0.5f * (low + high), off = middle + vec3(0.0017f, 0.0029f, 0.0023f);
    // No node lies where the way out is left to rounding: in the middle of something, or half way between two
    // faces.
    on.colliders = {
        {Plane{{0, 1, 0}, low.y - 0.001f}, 0.4f},
        {Sphere{{high.x + 0.001f, low.y, middle.z + 0.003f}, 0.012f}, 0.3f},
        {Box{vec3(low.x, middle.y, high.z) + vec3(0.0013f, 0.0007f, 0.0009f), {0.006f, 0.005f, 0.004f}}, 0.2f,
         0.001f},
        {Capsule{off - vec3(0, 0.05f, 0), off - vec3(0.03f, 0.05f, 0), 0.01f}}};
    on.motions.assign(on.colliders.size(), Motion{});
    on.motions[1].velocity = {-0.05f, 0.02f, 0};
    on.motions[1].spin = {0, 1, 0};
    on.presses = {{middle + vec3(0, 0, high.z - middle.z + 0.006f), {0, 0, -0.1f}, 0.011f, 30}};
    on.pushes = {{int(body.count() / 2), middle + vec3(0.01f, 0.02f, 0), {0.1f, 0, 0}, 3}};
    for (std::size_t i = 0; i < body.count(); i += 3)
        if (body.inverse_mass[i] == 0) {
            on.moved.push_back(int(i));
            on.places.push_back(body.positions[i] + vec3(0, 0.002f, 0.001f));
        }
    on.moves = {{on.moved, on.places}};
    on.wind = {0.5f, -0.2f, 1};
    on.air = 1.2f;
    return on;
}

Acting rubbing(const Body& body) {
    Acting on = everything(body);
    on.presses[0].friction = {0.4, 0.4};
    on.presses[0].velocity += vec3(0.1f, 0.05f, 0);
    on.presses.push_back(on.presses[0]);
    on.presses[1].centre += vec3(0.004f, 0.001f, 0);
    on.presses[1].velocity = {0.02f, -0.1f, 0.05f};
    on.presses[1].damping = 0.05f;
    return on;
}

Acting many_tools(const Body& body) {
    std::mt19937 random(9);
    auto any = [&](float most) { return std::uniform_real_distribution<float>(-most, most)(random); };
    auto vector = [&](float most) { return vec3(any(most), any(most), any(most)); };
    Acting on;
    for (int i = 0; i < 300; ++i) {
        const int node = int(random() % body.count());
        on.pushes.push_back({node, body.positions[std::size_t(node)] + vector(0.01f), vector(0.1f),
                             i % 3 == 0 ? 0 : 0.5f + any(0.5f), i % 2 == 0 ? vec3(0) : vector(0.01f)});
    }
    for (int i = 0; i < 20; ++i)
        on.presses.push_back({body.positions[random() % body.count()] + vec3(0, 0, 0.007f) + vector(0.001f),
                              vector(0.05f), 0.008f, 3});
    return on;
}

Simulation simulation(const Body& body, const Acting& on, Integrator integrator, Backend backend,
                      int threads) {
    float contact = 0, pull = 0;
    for (const Press& press : on.presses) contact += pressure_per_metre(press);
    for (const NodePush& drag : on.pushes) pull += drag.stiffness;
    const double touched = touched_frequency(body, highest_frequency(body), contact, pull);
    double step = automatic_step(integrator, touched, body.damping, body.link_damping);
    if (!(step > 0 && step < 1e-3)) step = 1e-3;
    return {.backend = backend,
            .threads = threads,
            .integrator = integrator,
            .step = step,
            .force = true,
            .shortest_step = 0,
            .air = on.air,
            .colliders = on.colliders};
}

void expect_same_bits(const State& a, const State& b) {
    EXPECT_TRUE(a.positions == b.positions);
    EXPECT_TRUE(a.velocities == b.velocities);
    EXPECT_EQ(a.lag, b.lag);
}

double furthest_apart(const std::vector<dvec3>& a, const std::vector<dvec3>& b) {
    EXPECT_EQ(a.size(), b.size());
    double most = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (const double d = glm::distance(a[i], b[i]); !(d <= most)) most = d;
    return most;
}

void expect_same(const Body& body, const Acting& on, Integrator integrator, Backend backend, int steps,
                 double bound, const gl::Context* context) {
    const Simulation how = simulation(body, on, integrator, backend);
    expect_same(*make_solver(body, how, context), body, on, how, steps, bound);
}

void expect_same(Solver& solver, const Body& body, const Acting& on, const Simulation& fast, int steps,
                 double bound) {
    Simulation slow = fast;
    slow.backend = Backend::reference;
    Solver* const a = &solver;
    const double seconds = steps * fast.step;
    auto b = make_solver(body, slow);
    auto exact = make_exact_solver(body, slow, highest_frequency(body));
    const Stats of_a = a->step(seconds, on.influences()), of_b = b->step(seconds, on.influences()),
                of_exact = exact->step(seconds, on.influences());
    ASSERT_FALSE(of_a.diverged || of_b.diverged || of_exact.diverged);
    ASSERT_EQ(of_a.steps, of_b.steps);
    const State ends_a = a->state(), ends_b = b->state(), truth = exact->state();
    const double place = bound + 10 * furthest_apart(ends_b.positions, truth.positions),
                 speed = bound / fast.step / 4 + 10 * furthest_apart(ends_b.velocities, truth.velocities);
    EXPECT_LE(furthest_apart(ends_a.positions, truth.positions), place);
    EXPECT_LE(furthest_apart(ends_a.velocities, truth.velocities), speed);
    const Nodes seen = a->nodes(), seen_b = b->nodes();
    ASSERT_EQ(seen.positions.size(), body.count());
    for (std::size_t i = 0; i < body.count(); ++i) {
        ASSERT_LE(glm::distance(dvec3(seen.positions[i]), ends_a.positions[i]), 1e-7) << i;
        ASSERT_LE(glm::distance(seen.normals[i], seen_b.normals[i]), 1e-2 + 10 * place / body.spacing) << i;
    }
    EXPECT_LE(std::abs(of_a.largest_speed - of_exact.largest_speed), speed);
    EXPECT_LE(std::abs(of_a.largest_move - of_exact.largest_move), place);
    const double a_little = 1e-4 * seconds;  // of a tenth of a newton
    EXPECT_LE(furthest_apart(of_a.reactions, of_exact.reactions),
              a_little + 10 * furthest_apart(of_b.reactions, of_exact.reactions));
    EXPECT_LE(furthest_apart(of_a.pushes, of_exact.pushes),
              a_little + 10 * furthest_apart(of_b.pushes, of_exact.pushes));
}

}  // namespace palpate
