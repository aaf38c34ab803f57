// What is done to a surface is done to the nodes: the same force, moment and work.
#include "palpate/body/scatter.h"

#include "palpate/body/cloth.h"
#include "palpate/body/lattice.h"
#include "tests/refusal.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <random>

namespace palpate {
namespace {

struct Hung {
    std::string name;
    Body body;
    Embedding skin;
    std::size_t vertices;
};

std::vector<Hung> hung_surfaces() {
    const Mesh organ = ellipsoid({0.05f, 0.03f, 0.04f}, 16);
    const Body lattice_body =
        lattice(organ, {.nodes = 700, .material = {.youngs_modulus = 2000, .density = 1000}});
    const Mesh bowl = ellipsoid({0.04f, 0.04f, 0.02f}, 7);
    const Body sheet = cloth(bowl, {.density = 0.3f});
    const Mesh quilt = ellipsoid({0.041f, 0.041f, 0.021f}, 20);
    std::vector<Hung> all;
    for (const auto& named : names(Mapping{})) {
        if (named.value == Mapping::automatic) continue;
        const std::string name(named.name);
        all.push_back({"organ, " + name, lattice_body, embed(organ, lattice_body, named.value),
                       organ.positions.size()});
        if (named.value != Mapping::trilinear)
            all.push_back(
                {"quilt, " + name, sheet, embed(quilt, sheet, named.value), quilt.positions.size()});
    }
    return all;
}

// Nodes that were stretched and turned somehow.
std::vector<vec3> deformed(const Body& body, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> part(-0.15f, 0.15f);
    std::vector<vec3> places;
    for (vec3 p : body.positions)
        places.push_back(vec3(1.1f * p.x - 0.4f * p.y, 0.4f * p.x + 0.9f * p.y, p.z + p.x) +
                         body.spacing * vec3(part(random), part(random), part(random)));
    return places;
}

TEST(Scatter, KeepsForceMomentAndWork) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> part(-1, 1);
    auto any = [&] { return vec3(part(random), part(random), part(random)); };
    for (const auto& [name, body, skin, vertices] : hung_surfaces()) {
        SCOPED_TRACE(name);
        const std::vector<vec3> at = deformed(body, 5), normals = approximate_normals(body, at);
        std::vector<vec3> places, unused;
        deform(skin, {at, normals}, places, unused);
        // Of the others the normals would turn too.
        const bool turns = name.find("constant") != name.npos || name.find("trilinear") != name.npos ||
                           name.find("frames") != name.npos;
        for (int i = 0; i < 20; ++i) {
            const SurfacePush push{.vertex = random() % vertices, .force = any()};
            const std::vector<NodePush> pushes = scatter(skin, {at, normals}, {&push, 1});
            dvec3 force(0), moment(0);
            for (const NodePush& p : pushes) {
                force += dvec3(p.force);
                moment += glm::cross(dvec3(at[std::size_t(p.node)]), dvec3(p.force));
                EXPECT_EQ(p.stiffness, 0);
            }
            EXPECT_LE(glm::distance(force, dvec3(push.force)), 1e-5);
            if (turns)
                EXPECT_LE(glm::distance(moment, glm::cross(dvec3(places[push.vertex]), dvec3(push.force))),
                          2e-6);
            // Work: what deform() makes of any small motion of the nodes.
            std::vector<vec3> way(at.size()), there(at), back(at), ahead, behind;
            double work = 0;
            for (std::size_t n = 0; n < at.size(); ++n)
                way[n] = 0.01f * body.spacing * any(), there[n] += way[n], back[n] -= way[n];
            for (const NodePush& p : pushes)
                work += glm::dot(dvec3(p.force),
                                 dvec3(there[std::size_t(p.node)]) - dvec3(back[std::size_t(p.node)]));
            deform(skin, {there, normals}, ahead, unused);
            deform(skin, {back, normals}, behind, unused);
            const double done =
                glm::dot(dvec3(push.force), dvec3(ahead[push.vertex]) - dvec3(behind[push.vertex]));
            EXPECT_LE(std::abs(work - done),
                      0.02 * 0.02 * double(body.spacing) * double(glm::length(push.force)));
        }
    }
}

// A spring on the surface: as stiff, and it draws as strongly.
TEST(Scatter, ASpringIsAsStiffOnTheNodes) {
    for (const auto& [name, body, skin, vertices] : hung_surfaces()) {
        SCOPED_TRACE(name);
        const std::vector<vec3> at = deformed(body, 6), normals = approximate_normals(body, at);
        std::vector<vec3> places, unused;
        deform(skin, {at, normals}, places, unused);
        const SurfacePush push{.vertex = vertices / 3,
                               .to = places[vertices / 3] + vec3(0.01f, -0.02f, 0.03f),
                               .velocity = vec3(1, 2, 3),
                               .stiffness = 40};
        double stiffness = 0;
        dvec3 force(0);
        for (const NodePush& p : scatter(skin, {at, normals}, {&push, 1})) {
            EXPECT_GE(p.stiffness, 0);
            EXPECT_EQ(p.velocity, push.velocity);
            stiffness += p.stiffness;
            force += dvec3(p.stiffness * (p.to - at[std::size_t(p.node)]));
        }
        EXPECT_NEAR(stiffness, 40, 1e-4);
        EXPECT_LE(glm::distance(force, dvec3(0.4, -0.8, 1.2)), 1e-4);
    }
}

// As whoever pushes on a surface wants them.
TEST(Scatter, PositionsAloneAreThoseWithNormals) {
    for (const auto& [name, body, skin, vertices] : hung_surfaces()) {
        SCOPED_TRACE(name);
        const std::vector<vec3> at = deformed(body, 7), normals = approximate_normals(body, at);
        std::vector<vec3> places, unused, alone;
        deform(skin, {at, normals}, places, unused);
        deform(skin, {at, normals}, alone);
        EXPECT_EQ(alone.size(), vertices);
        EXPECT_TRUE(alone == places);
    }
}

TEST(Scatter, RefusesWhatThereIsNot) {
    const Hung organ = hung_surfaces()[0];
    const SurfacePush beyond{.vertex = organ.vertices}, fine{};
    const std::vector<vec3> normals(organ.body.count());
    EXPECT_NE(refusal([&] {
                  scatter(organ.skin, {organ.body.positions, normals}, {&beyond, 1});
              }).find("vertex"),
              std::string::npos);
    EXPECT_NE(refusal([&] { scatter(organ.skin, {}, {&fine, 1}); }), "");
    for (const Hung& one : hung_surfaces())
        if (one.name.find("interpolated") != one.name.npos)
            EXPECT_NE(refusal([&] { scatter(one.skin, {one.body.positions, {}}, {&fine, 1}); }), "");
}

}  // namespace
}  // namespace palpate
