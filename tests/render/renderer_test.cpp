#include "palpate/render/renderer.h"

#include "palpate/base/error.h"
#include "palpate/gl/context.h"
#include "palpate/render/view.h"
#include "tests/refusal.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

namespace palpate {
namespace {

constexpr int width = 320, height = 240;
constexpr float pi = std::numbers::pi_v<float>;
constexpr float nan = std::numeric_limits<float>::quiet_NaN();
const Look black{vec3(0), 0};
const Look chalk{vec3(0.7f), 0};

// Linear light, as the renderer had it before it was stored as sRGB.
float linear(std::uint8_t stored) {
    const float s = stored / 255.0f;
    return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

vec3 at(const Image& image, int x, int y) {
    const std::uint8_t* pixel = &image.pixels.at(4 * (static_cast<std::size_t>(y) * image.width + x));
    return vec3(linear(pixel[0]), linear(pixel[1]), linear(pixel[2]));
}

vec3 centre(const Image& image) { return at(image, image.width / 2, image.height / 2); }

// What the picture shows of a place in the world.
vec3 at(const Image& image, const Camera& camera, vec3 place) {
    const vec4 clip = view(camera, float(image.width) / image.height, Extent{}).to_clip * vec4(place, 1);
    const vec2 part = 0.5f + 0.5f * vec2(clip.x, -clip.y) / clip.w;
    return at(image, int(part.x * image.width), int(part.y * image.height));
}

// The area that black things cover, in pixels, with the partly covered ones in part.
double covered(const Image& image, const Image& without) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += 1 - at(image, x, y).g / at(without, x, y).g;
    return sum;
}

// The sum of all differences.
double difference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) sum += std::abs(a.pixels[i] - b.pixels[i]);
    return sum;
}

Camera from(vec3 eye) { return {.eye = eye, .look_at = vec3(0)}; }

// A square of two triangles across z, which faces z.
Mesh square(float half) {
    Mesh mesh;
    mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.normals.assign(4, vec3(0, 0, 1));
    return mesh;
}

class Rendering : public ::testing::Test {
 protected:
    void SetUp() override {
        try {
            renderer_.emplace(Offscreen{width, height});
        } catch (const Error& error) {
            GTEST_SKIP() << "OpenGL is not available: " << error.what();
        }
    }
    void TearDown() override {
        if (renderer_) EXPECT_EQ(renderer_->context().errors(), 0) << renderer_->context().first_error();
    }

    Image image(const Picture& picture) {
        renderer_->draw(picture);
        return renderer_->image();
    }

    Surface add(const Mesh& mesh, Look look) {
        return {renderer_->add(mesh), mesh.positions, mesh.normals, look};
    }

    std::optional<Renderer> renderer_;
};

TEST_F(Rendering, ImageIsBlackBeforeTheFirstFrame) {
    const Image image = renderer_->image();
    EXPECT_EQ(image.width, width);
    EXPECT_EQ(image.height, height);
    EXPECT_EQ(centre(image), vec3(0));
    EXPECT_EQ(image.pixels[3], 255);
}

TEST_F(Rendering, ABallCoversTheAreaThatPerspectiveSays) {
    const Mesh ball = ellipsoid(vec3(0.1f), 64);
    const float distance = 0.5f;
    Picture picture{.camera = from({0, 0, distance})};
    const Image without = image(picture);
    picture.surfaces = {add(ball, black)};
    const float slope = 0.1f / std::sqrt(distance * distance - 0.1f * 0.1f);
    const float radius = 0.5f * height * slope / std::tan(0.5f * glm::radians(picture.camera.angle));
    EXPECT_NEAR(covered(image(picture), without) / (pi * radius * radius), 1, 0.003);
}

TEST_F(Rendering, ABallCoversTheAreaThatParallelSightLinesSay) {
    const Mesh ball = ellipsoid(vec3(0.1f), 64);
    Picture picture{.camera = from({0.3f, 0.4f, 0})};
    picture.camera.orthographic = true;
    const Image without = image(picture);
    picture.surfaces = {add(ball, black)};
    const float shown =
        2 * 0.5f * std::tan(0.5f * glm::radians(picture.camera.angle));  // m from bottom to top
    const float radius = 0.1f * height / shown;
    EXPECT_NEAR(covered(image(picture), without) / (pi * radius * radius), 1, 0.003);
}

TEST_F(Rendering, TheNearHidesTheFar) {
    const Ball near{vec3(0, 0, 0.1f), 0.05f, vec3(0.8f, 0, 0)},
        far{vec3(0, 0, -0.1f), 0.05f, vec3(0, 0.8f, 0)};
    for (const auto& balls : {std::vector{near, far}, std::vector{far, near}}) {
        const vec3 ahead = centre(image({.camera = from({0, 0, 0.5f}), .balls = balls}));
        const vec3 behind = centre(image({.camera = from({0, 0, -0.5f}), .balls = balls}));
        EXPECT_GT(ahead.r, 2 * ahead.g);
        EXPECT_GT(behind.g, 2 * behind.r);
    }
}

TEST_F(Rendering, TheSideTowardsTheLightIsBrighter) {
    const Mesh ball = ellipsoid(vec3(0.1f), 32);
    Picture picture{.camera = from({0, 0, 0.5f}), .surfaces = {add(ball, chalk)}};
    for (float side : {-1.0f, 1.0f}) {
        picture.light.direction = vec3(-side, 0, -0.3f);
        const Image lit = image(picture);
        const vec3 bright = at(lit, picture.camera, vec3(0.07f * side, 0, 0.07f));
        const vec3 dark = at(lit, picture.camera, vec3(-0.07f * side, 0, 0.07f));
        EXPECT_GT(bright.g, 1.5f * dark.g);
    }
}

TEST_F(Rendering, TheSkyIsAboveAlsoForACameraThatLooksDown) {
    Picture picture{.camera = from({0, 0.5f, 0.001f}), .light = {.colour = vec3(0)}};
    const Mesh above = block(vec3(-0.05f), vec3(0.05f));
    picture.surfaces = {add(above, chalk)};
    const vec3 top = centre(image(picture));
    picture.camera = from({0, -0.5f, 0.001f});
    const vec3 bottom = centre(image(picture));
    EXPECT_GT(top.g, 1.5f * bottom.g);
}

TEST_F(Rendering, AShadowFallsWhereTheLightSays) {
    const float high = 0.2f, radius = 0.05f;
    Picture picture{.camera = from({0, 0.8f, 0.4f}),
                    .light = {.direction = vec3(1, -2, 0)},
                    .balls = {{vec3(0, high, 0), radius}},
                    .grounds = {{}}};
    const Image image = this->image(picture);
    const vec3 below(0.5f * high, 0, 0);
    const float lit = at(image, picture.camera, -below).g;
    EXPECT_LT(at(image, picture.camera, below).g, 0.7f * lit);
    EXPECT_GT(at(image, picture.camera, below + vec3(0, 0, 2 * radius)).g, 0.9f * lit);
    EXPECT_GT(at(image, picture.camera, below - vec3(0, 0, 2 * radius)).g, 0.9f * lit);
    EXPECT_GT(at(image, picture.camera, below + vec3(2.5f * radius, 0, 0)).g, 0.9f * lit);
}

TEST_F(Rendering, AThingShadowsAnother) {
    const Mesh table = square(0.2f);
    Picture picture{.camera = from({0, 0.2f, 0.6f}), .light = {.direction = vec3(1, 0, -1)}};
    picture.surfaces = {add(table, chalk)};
    const vec3 place(0.1f, 0, 0);
    const float lit = at(image(picture), picture.camera, place).g;
    picture.balls = {{vec3(0, 0, 0.1f), 0.03f}};
    EXPECT_LT(at(image(picture), picture.camera, place).g, 0.7f * lit);
}

TEST_F(Rendering, AFlatThingDoesNotShadowItself) {
    const Mesh table = square(0.5f);
    Picture picture{.camera = from({0, 0, 0.5f}), .surfaces = {add(table, chalk)}};
    picture.camera.orthographic = true;
    for (float slope : {0.2f, 1.0f, 4.0f}) {
        picture.light.direction = vec3(slope, 0.3f * slope, -1);
        const Image image = this->image(picture);
        int darkest = 255, brightest = 0;
        for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
            darkest = std::min<int>(darkest, image.pixels[i]);
            brightest = std::max<int>(brightest, image.pixels[i]);
        }
        EXPECT_LE(brightest - darkest, 2) << "slope " << slope;  // the grain
    }
}

TEST_F(Rendering, AGrooveIsDarkerThanARidge) {
    // Waves 20 mm long and as deep, seen and lit from above; flat places only, so that the slope does not
    // matter.
    Mesh waves;
    const int n = 128;
    auto wave = [](float x) { return 0.01f * std::cos(2 * pi * x / 0.02f); };
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const float x = 0.1f * i / n - 0.05f;
            waves.positions.push_back({x, 0.1f * j / n - 0.05f, wave(x)});
        }
    for (unsigned j = 0; j < n; ++j)
        for (unsigned i = 0; i < n; ++i) {
            const unsigned a = j * (n + 1) + i, b = a + n + 1;
            waves.triangles.insert(waves.triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
        }
    compute_normals(waves);
    Picture picture{.camera = from({0, 0, 0.2f}), .light = {.colour = vec3(0)}};
    picture.camera.orthographic = true;
    picture.surfaces = {add(waves, chalk)};
    const Image image = this->image(picture);
    EXPECT_LT(at(image, picture.camera, vec3(0.01f, 0, 0)).g, 0.7f * centre(image).g);
}

TEST_F(Rendering, AnOpenSheetIsSeenFromBothSides) {
    const Mesh sheet = square(0.05f);
    for (float side : {-1.0f, 1.0f}) {
        Picture picture{.camera = from({0, 0, 0.5f * side})};
        const Image without = image(picture);
        picture.surfaces = {add(sheet, black)};
        EXPECT_GT(covered(image(picture), without), 100);
    }
}

TEST_F(Rendering, AGroundIsSeenFromItsFrontOnly) {
    const Ball ball{vec3(0, 0.1f, 0), 0.05f};
    for (float side : {-1.0f, 1.0f}) {
        Picture picture{.camera = from({0, 0.4f * side, 0.6f}), .balls = {ball}};
        const Image without = image(picture);
        picture.grounds = {{}};
        const double change = difference(image(picture), without);
        if (side > 0)
            EXPECT_GT(change, 1000);
        else
            EXPECT_EQ(change, 0);
    }
}

TEST_F(Rendering, WiresCoverTheirLengthAndShineThroughSurfaces) {
    const std::vector<vec3> points{{-0.05f, 0, 0}, {0.05f, 0, 0}};
    const std::vector<uvec2> lines{{0, 1}};
    Picture picture{.camera = from({0, 0, 0.5f})};
    const Image empty = image(picture);
    picture.wires = {{points, lines, vec3(0)}};
    const float per_metre = 0.5f * height / std::tan(0.5f * glm::radians(picture.camera.angle)) / 0.5f;
    const double area = covered(image(picture), empty);
    EXPECT_GT(area, 0.7 * 0.1 * per_metre);
    EXPECT_LT(area, 1.5 * 0.1 * per_metre);

    const Mesh sheet = square(0.2f);
    picture.wires.clear();
    picture.surfaces = {add(sheet, chalk)};
    const Image bare = image(picture);
    auto change = [&](float z) {
        const std::vector<vec3> moved{{-0.05f, 0, z}, {0.05f, 0, z}};
        picture.wires = {{moved, lines, vec3(0)}};
        return difference(image(picture), bare);
    };
    const double before = change(0.01f), on = change(0), behind = change(-0.01f);
    EXPECT_GT(on, 0.9 * before);
    EXPECT_GT(behind, 0);
    EXPECT_LT(behind, 0.7 * before);
}

TEST_F(Rendering, TheSamePictureGivesTheSameBytes) {
    const Mesh ball = ellipsoid(vec3(0.1f, 0.08f, 0.06f), 32);
    const std::vector<uvec2> lines{{0, 20}, {10, 300}};
    Picture picture{.surfaces = {add(ball, {})},
                    .wires = {{ball.positions, lines}},
                    .balls = {{vec3(0, 0.1f, 0), 0.02f}},
                    .grounds = {{vec3(0, 1, 0), -0.08f}}};
    const Image first = image(picture);
    EXPECT_EQ(image(picture).pixels, first.pixels);
    image({});
    EXPECT_EQ(image(picture).pixels, first.pixels);

    Renderer other({width, height});
    picture.surfaces[0].mesh = other.add(ball);
    other.draw(picture);
    EXPECT_EQ(other.image().pixels, first.pixels);
}

TEST_F(Rendering, TwoSurfacesOfOneMeshStayApart) {
    const Mesh ball = ellipsoid(vec3(0.05f), 16);
    std::vector<vec3> aside = ball.positions;
    for (vec3& p : aside) p.x += 0.12f;
    Picture picture{.camera = from({0.06f, 0, 0.6f})};
    picture.camera.look_at = vec3(0.06f, 0, 0);
    const Image without = image(picture);
    picture.surfaces = {add(ball, black)};
    const double one = covered(image(picture), without);
    picture.surfaces.push_back({picture.surfaces[0].mesh, aside, ball.normals, black});
    EXPECT_NEAR(covered(image(picture), without) / one, 2, 0.02);
}

TEST_F(Rendering, ManyBallsAreAllDrawn) {
    Picture picture{.camera = from({0, 0, 1})};
    for (int i = 0; i < 20; ++i)
        picture.balls.push_back({vec3(0.02f * i - 0.19f, 0, 0), 0.008f, vec3(1, 0, 0)});
    const Image image = this->image(picture);
    for (const Ball& ball : picture.balls) {
        const vec3 seen = at(image, picture.camera, ball.centre);
        EXPECT_GT(seen.r, 2 * seen.g);
    }
}

TEST_F(Rendering, NothingIsAPictureToo) {
    const Image empty = image({});
    EXPECT_GT(centre(empty).g, 0.1f);
    const Mesh none;
    const Picture picture{.surfaces = {add(none, {})},
                          .wires = {{}},
                          .balls = {{vec3(0), 0}},
                          .grounds = {{vec3(0, -1, 0), 1}}};
    EXPECT_EQ(image(picture).pixels, empty.pixels);
    EXPECT_GT(centre(image({.grounds = {{}}})).g, 0.1f);
}

TEST_F(Rendering, OddCamerasStillSee) {
    const vec3 ahead(0, 0, -0.3f);
    const Camera odd[] = {
        {.eye = vec3(0), .look_at = vec3(0)},
        {.eye = vec3(0), .look_at = ahead, .up = ahead},
        {.eye = vec3(0), .look_at = ahead, .up = vec3(0)},
        {.eye = vec3(0), .look_at = ahead, .up = vec3(nan)},
        {.eye = vec3(0), .look_at = ahead, .angle = 0},
        {.eye = vec3(0), .look_at = ahead, .angle = 500},
        {.eye = vec3(0), .look_at = ahead, .angle = nan},
    };
    Picture picture{.balls = {{ahead, 0.1f, vec3(0.8f, 0, 0)}}};
    for (bool orthographic : {false, true})
        for (Camera camera : odd) {
            camera.orthographic = orthographic;
            picture.camera = camera;
            const vec3 seen = centre(image(picture));
            EXPECT_GT(seen.r, 2 * seen.g)
                << "camera " << &camera - odd << (orthographic ? " orthographic" : "");
        }
    picture.camera = {.eye = vec3(nan)};
    image(picture);
    picture.camera = {.eye = ahead, .look_at = vec3(0)};  // within the ball
    image(picture);
}

TEST_F(Rendering, PointsThatAreNotFiniteTakeNothingElseAlong) {
    const Mesh ball = ellipsoid(vec3(0.1f), 32);
    Picture picture{.camera = from({0, 0, 0.5f})};
    const Image without = image(picture);
    picture.surfaces = {add(ball, black)};
    const double whole = covered(image(picture), without);
    Mesh torn = ball;
    torn.positions[100] = vec3(nan);
    torn.positions[500] = vec3(0, std::numeric_limits<float>::infinity(), 0);
    torn.positions[900] = vec3(1e30f);
    torn.normals[300] = vec3(nan);
    picture.surfaces[0].positions = torn.positions;
    picture.surfaces[0].normals = torn.normals;
    const double rest = covered(image(picture), without);
    EXPECT_TRUE(std::abs(rest / whole - 1) <= 0.1) << rest << " of " << whole;
    picture.balls = {{vec3(nan), 0.1f}, {vec3(0), nan}};
    picture.light.direction = vec3(nan);
    picture.grounds = {{vec3(nan), 0}, {vec3(0), -0.2f}};
    EXPECT_GT(at(image(picture), 5, 5).g, 0.05f);
}

TEST_F(Rendering, RenderersMoveAndStayApart) {
    Renderer other({8, 8});
    Renderer moved = std::move(other);
    const Image before = image({.balls = {{vec3(0), 0.1f}}});
    moved.draw({});
    EXPECT_EQ(moved.image().width, 8);
    moved = Renderer({16, 4});
    moved.draw({});
    EXPECT_EQ(moved.image().width, 16);
    EXPECT_EQ(renderer_->image().pixels, before.pixels);
}

TEST_F(Rendering, SizesThatCannotBeAreErrors) {
    for (Offscreen size : {Offscreen{0, 10}, Offscreen{10, -1}, Offscreen{1 << 24, 10}}) {
        SCOPED_TRACE(size.width);
        expect_refused("choose 1 to", [&] { Renderer renderer(size); });
    }
}

}  // namespace
}  // namespace palpate
