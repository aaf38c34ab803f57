// The scenes that come with Palpate: each is built once, looked at, and set in motion.
#include "palpate/files/write.h"
#include "palpate/run/experiment.h"
#include "palpate/run/play.h"
#include "palpate/run/run.h"
#include "tests/scratch.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

std::vector<std::string> shipped_names() {
    std::vector<std::string> names;
    for (const ShippedScene& scene : shipped_scenes()) names.push_back(scene.name);
    return names;
}
class Shipped : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Every, Shipped, ::testing::ValuesIn(shipped_names()),
                         [](const auto& each) { return each.param; });

// The first file that a scene wants and this machine lacks, or nothing.
std::string missing_file(const Scene& scene) {
    std::vector<BodyRecipe> all = scene.bodies;
    all.insert(all.end(), scene.surfaces.begin(), scene.surfaces.end());
    for (const BodyRecipe& body : all) {
        std::vector<std::string> files = body.stand_ins;
        files.insert(files.begin(), body.volume.empty() ? body.surface : body.volume);
        const bool found = std::any_of(files.begin(), files.end(), [&](const std::string& file) {
            return file.empty() || is_found(file, scene.folder);
        });
        if (!found) return files[0];
        for (const std::string& map : {body.colour_map, body.normal_map})
            if (!map.empty() && !is_found(map, scene.folder)) return map;
    }
    return "";
}

// Bodies are as the scene says.
void expect_as_it_says(const Scene& scene, const Models& made) {
    std::size_t held = 0;
    for (std::size_t m = 0; m < made.models.size(); ++m) {
        const BodyRecipe& recipe = scene.bodies[m];
        const Body& body = made.models[m].body;
        if (!recipe.dims && !recipe.cloth && !recipe.cage)
            EXPECT_LE(std::abs(double(body.count()) / recipe.nodes - 1), 0.05);
        EXPECT_GT(made.models[m].surface.triangles.size(), 0u);
        for (float inverse : body.inverse_mass) held += inverse == 0;
        if (!recipe.cage) EXPECT_LT(held, body.count() / 2);
    }
    for (const StaticSurface& still : made.static_surfaces) EXPECT_GT(still.surface.triangles.size(), 0u);
    if (scene.bodies.empty()) return;
    if (scene.colliders.empty()) EXPECT_GT(held, 0u);  // else it may stand on one
    // The heart's vessels end openly, and the dragon may stand in for itself; notes say so.
    if (scene.bodies[0].stand_ins.empty()) EXPECT_TRUE(made.notes.empty()) << made.notes[0];
}

// All that it does in its first third of a second goes well.
TEST_P(Shipped, IsBuiltAsItSaysAndStarts) {
    if (const std::string file = missing_file(read_scene(GetParam())); !file.empty())
        GTEST_SKIP() << file << " is not available";
    const Prepared prepared = prepare(find_scene(GetParam()), {});
    expect_as_it_says(prepared.scene, prepared.models);
    Report report;
    Play play(prepared.scene, prepared.models, report);
    for (int frame = 0; frame < 20; ++frame) ASSERT_TRUE(play.advance(frame * frame_seconds, frame_seconds));
    for (const Report::Body& body : report.bodies) EXPECT_EQ(body.inverted_cells, 0u);
    for (const Skin& skin : play.skins())
        for (vec3 p : skin.positions) ASSERT_TRUE(std::isfinite(p.x + p.y + p.z));
}

// 10,000 steps of the automatic length, and five seconds: nothing blows up, and what is damped comes to rest.
class Tissue : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Shipped, Tissue, ::testing::Values("brain", "box"),
                         [](const auto& each) { return each.param; });

TEST_P(Tissue, IsStableAtTheAutomaticStep) {
    if (const std::string file = missing_file(read_scene(GetParam())); !file.empty())
        GTEST_SKIP() << file << " is not available";
    std::vector<Change> coarse;  // the motion of a few nodes is no calmer than that of many
    if (GetParam() == "brain") coarse = {"body.brain.nodes=2000", "body.brain.faces=8000"};
    const Models made = build(read_scene(GetParam(), coarse));
    for (const Model& model : made.models)
        for (Integrator integrator : {Integrator::verlet, Integrator::semi_implicit_euler}) {
            Simulation simulation = made.simulation;
            simulation.integrator = integrator;
            auto solver = make_solver(model.body, simulation);
            Stats stats;
            double seconds = 0;
            for (int steps = 0; steps < 10'000 || seconds < 5; steps += stats.steps) {
                stats = solver->step(0.1);
                seconds += 0.1;
                ASSERT_FALSE(stats.diverged) << name_of(integrator) << " after " << steps;
            }
            EXPECT_LE(stats.largest_speed, 0.02) << name_of(integrator);
        }
}

// What somebody just drops in, from 1 mm to 2 m long and with nothing said of it, is tissue that holds
// itself: it comes to rest, and no cell turns inside out meanwhile.
TEST(Dropped, ClosedMeshesComeToRest) {
    Scratch scratch;
    Mesh dumbbell = both(ellipsoid(vec3(0.03f), 9), ellipsoid({0.1f, 0.012f, 0.012f}, 9));
    for (vec3& p : dumbbell.positions) p += 0.002f * vec3(std::sin(90 * p.y), std::sin(110 * p.z), 0);
    Mesh leaning = ellipsoid({0.03f, 0.3f, 0.03f}, 12);
    for (vec3& p : leaning.positions) p.x += 0.4f * p.y + p.y * p.y;
    const std::pair<const char*, Mesh> meshes[] = {{"ball", ellipsoid(vec3(0.5f), 12)},
                                                   {"egg", ellipsoid({1, 0.4f, 0.6f}, 14)},
                                                   {"plate", block(vec3(0), {0.001f, 0.00007f, 0.0008f})},
                                                   {"rod", block(vec3(0), {0.02f, 0.3f, 0.02f})},
                                                   {"leaning rod", leaning},
                                                   {"dumbbell", dumbbell}};
    for (const auto& [name, mesh] : meshes) {
        SCOPED_TRACE(name);
        const std::filesystem::path file = scratch / (std::string(name) + ".ply");
        write_mesh(mesh, file);
        const Prepared prepared = prepare(find_scene(file.string()), {"body.it.nodes=1500"});
        Report report;
        Play play(prepared.scene, prepared.models, report);
        std::vector<vec3> earlier;
        for (int frame = 0; frame < 600; ++frame) {
            ASSERT_TRUE(play.advance(frame * frame_seconds, frame_seconds));
            if (frame == 594)
                earlier.assign(play.skins()[0].positions.begin(), play.skins()[0].positions.end());
        }
        EXPECT_EQ(report.bodies[0].inverted_cells, 0u);
        EXPECT_GT(report.bodies[0].cells, 0u);
        float way = 0;
        for (std::size_t i = 0; i < earlier.size(); ++i)
            way = std::max(way, glm::distance(earlier[i], play.skins()[0].positions[i]));
        EXPECT_LE(way,
                  2e-4f);  // m in a twelfth of a second; the rod, which its weight bends over, swings longest
    }
}

// However small it is made and however slender it is, a frame takes 500 steps at most.
TEST(Dropped, AFrameTakesFiveHundredStepsAtMost) {
    Scratch scratch;
    write_mesh(block(vec3(0), {0.02f, 0.3f, 0.02f}), scratch / "rod.ply");
    const Prepared prepared =
        prepare(find_scene((scratch / "rod.ply").string()), {"body.it.nodes=1500", "body.it.size=0.001"});
    Report report;
    Play play(prepared.scene, prepared.models, report);
    ASSERT_TRUE(play.advance(0, frame_seconds));
    EXPECT_LE(report.bodies[0].steps, 505);  // its modulus has two digits
    EXPECT_GE(report.bodies[0].steps, 300);
}

}  // namespace
}  // namespace palpate
