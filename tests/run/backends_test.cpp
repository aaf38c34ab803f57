// A run looks the same and reports the same on every backend.
#include "palpate/base/error.h"
#include "palpate/files/image_file.h"
#include "palpate/gl/context.h"
#include "palpate/run/run.h"
#include "tests/scratch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace palpate {
namespace {

// A soft block, held at its foot and pressed from above, beside a cloth that falls on a ball.
const std::string scene_text = R"(
[simulation]
duration = 0.5
[camera]
eye = [0.2, 0.16, 0.28]
look_at = [0.06, 0.02, 0.05]
[[body]]
name = "block"
dims = [9, 6, 9]
spacing = 0.01
youngs_modulus = 8000
density = 1000
damping = 10
pin = { below = 0 }
[[body]]
name = "cloth"
cloth = [12, 12]
spacing = 0.01
density = 0.3
damping = 4
move = [0.13, 0.06, 0.05]
[[collider]]
sphere = { centre = [0.16, 0.01, 0.05], radius = 0.03 }
[[tool]]
name = "finger"
radius = 0.012
stiffness = 600
from = [0.04, 0.3, 0.04]
along = [0, -1, 0]
path = [[0.1, 0, 0.002, 0], [0.3, 0, -0.01, 0], [0.6, 0, -0.01, 0]]
)";

struct Seen {
    Image image;
    Report report;
};

Seen seen(Backend backend, const std::string& mapping, const Scratch& scratch) {
    const std::string name = std::string(name_of(backend)) + "-" + mapping;
    const std::vector<Change> changes = {"simulation.backend=\"" + std::string(name_of(backend)) + "\"",
                                         "body.block.mapping=\"" + mapping + "\""};
    Scene scene = parse_scene(scene_text, "scene.toml", ".", changes);
    scene.name = name;
    RunSettings settings;
    settings.images = scratch / name;
    settings.image_every = 0.5;
    settings.width = 400;
    settings.height = 225;
    Report report = run(scene, settings);
    return {read_image(settings.images / (name + "-00.50s.png")), std::move(report)};
}

// Of 255: in the mean, and the share of the pixels that differ by more than 16.
void expect_alike(const Image& a, const Image& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    ASSERT_FALSE(a.pixels.empty());
    double sum = 0, far = 0;
    for (std::size_t p = 0; p < a.pixels.size(); p += 4) {
        int most = 0;
        for (std::size_t k = p; k < p + 3; ++k) {
            const int d = std::abs(int(a.pixels[k]) - int(b.pixels[k]));
            sum += d;
            most = std::max(most, d);
        }
        far += most > 16;
    }
    const double pixels = double(a.pixels.size() / 4);
    EXPECT_LE(sum / (3 * pixels), 2);
    EXPECT_LE(far / pixels, 0.01);
}

bool there_is_opengl() {
    try {
        gl::Context context;
        return true;
    } catch (const Error&) {
        return false;
    }
}

TEST(Backends, LookAndReportTheSame) {
    if (!there_is_opengl()) GTEST_SKIP() << "OpenGL is not available";
    const Scratch scratch;
    const Seen truth = seen(Backend::reference, "trilinear", scratch);
    ASSERT_FALSE(truth.report.diverged);
    EXPECT_GT(truth.report.tools[0].largest_force, 0.1);
    for (const auto& [backend, name] : names(Backend{})) {
        SCOPED_TRACE(std::string(name));
        const Seen one = seen(backend, "trilinear", scratch);
        EXPECT_FALSE(one.report.diverged);
        expect_alike(one.image, truth.image);
        const Report::Tool &finger = one.report.tools[0], &expected = truth.report.tools[0];
        EXPECT_LE(std::abs(finger.largest_force - expected.largest_force), 1e-3 * expected.largest_force);
        EXPECT_LE(std::abs(finger.deepest_indentation - expected.deepest_indentation), 1e-5);
        ASSERT_EQ(finger.force.size(), expected.force.size());
        EXPECT_EQ(one.report.bodies[0].steps, truth.report.bodies[0].steps);
    }
}

TEST(Backends, LookTheSameWithEveryMapping) {
    if (!there_is_opengl()) GTEST_SKIP() << "OpenGL is not available";
    const Scratch scratch;
    for (const char* mapping : {"one-to-one", "constant", "interpolated", "normal-offset", "frames"}) {
        SCOPED_TRACE(mapping);
        expect_alike(seen(Backend::feedback, mapping, scratch).image,
                     seen(Backend::reference, mapping, scratch).image);
    }
}

}  // namespace
}  // namespace palpate
