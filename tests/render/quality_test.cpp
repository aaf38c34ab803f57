// What a window asks of a renderer beside pictures: other sizes, faster and better pictures, other things to
// show, and pictures put into a framebuffer of the window's own.
#include "palpate/base/error.h"
#include "palpate/body/lattice.h"
#include "palpate/gl/context.h"
#include "palpate/render/renderer.h"
#include "palpate/voxels/thinned.h"
#include "tests/gl/hostile.h"
#include "tests/gl/with_context.h"
#include "tests/refusal.h"
#include "tests/render/gpu.h"
#include "tests/render/pictures.h"
#include "tests/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace palpate {
namespace {

constexpr Offscreen size{320, 240};
const std::array<std::uint8_t, 4> paper{1, 2, 3, 4};

// A framebuffer as a window has one, bound for drawing, with paper in it.
class Window {
 public:
    Window(Offscreen wanted, GLenum format) : pixels_(format, wanted.width, wanted.height) {
        glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, pixels_.name(), 0);
        glClearTexImage(pixels_.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, paper.data());
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
    }

    // The bytes that it holds, in rows from the top.
    Image image() const {
        const int width = pixels_.width(), height = pixels_.height();
        std::vector<std::uint8_t> up(4u * width * height);
        glGetTextureImage(pixels_.name(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(up.size()), up.data());
        Image image{width, height, {}};
        for (int row = height; row-- > 0;)
            image.pixels.insert(image.pixels.end(), up.begin() + 4 * row * width,
                                up.begin() + 4 * (row + 1) * width);
        return image;
    }

    GLuint name() const { return framebuffer_.name(); }

 private:
    gl::Texture pixels_;
    gl::Framebuffer framebuffer_;
};

// A byte of a pixel; beyond the rim that of the nearest one.
int byte(const Image& image, int x, int y, int k) {
    x = std::clamp(x, 0, image.width - 1);
    y = std::clamp(y, 0, image.height - 1);
    return image.pixels[4 * (std::size_t(y) * image.width + x) + k];
}

// Made as large as that, each byte in between its neighbours.
Image stretched(const Image& image, int width, int height) {
    Image large{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float u = (x + 0.5f) * image.width / width - 0.5f;
            const float v = (y + 0.5f) * image.height / height - 0.5f;
            const int i = int(std::floor(u)), j = int(std::floor(v));
            for (int k = 0; k < 4; ++k) {
                const float above =
                    glm::mix(float(byte(image, i, j, k)), float(byte(image, i + 1, j, k)), u - i);
                const float below =
                    glm::mix(float(byte(image, i, j + 1, k)), float(byte(image, i + 1, j + 1, k)), u - i);
                large.pixels.push_back(std::uint8_t(std::lround(glm::mix(above, below, v - j))));
            }
        }
    return large;
}

int largest_difference(const Image& a, const Image& b) {
    EXPECT_EQ(a.pixels.size(), b.pixels.size());
    int most = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
        most = std::max(most, std::abs(a.pixels[i] - b.pixels[i]));
    return most;
}

class Qualities : public WithContext {
 protected:
    void SetUp() override {
        WithContext::SetUp();
        if (IsSkipped()) return;
        renderer_.emplace(size, context());
        picture_ = seen_by(*renderer_);
    }

    // A thing of each kind, with shadows, grooves and edges.
    Picture seen_by(Renderer& renderer) const {
        return {.camera = {.eye = vec3(0.1f, 0.25f, 0.5f), .look_at = vec3(0)},
                .light = {.direction = vec3(0.5f, -1, -0.3f)},
                .surfaces = {{renderer.add(thing_), thing_.positions, thing_.normals, {}}},
                .wires = {{wire_points_, wire_lines_}},
                .balls = {{vec3(-0.05f, 0.11f, 0.05f), 0.02f}},
                .grounds = {{vec3(0, 1, 0), -0.1f}}};
    }

    Image image(const Picture& picture) {
        renderer_->draw(picture);
        return renderer_->image();
    }

    // The picture as a window has it.
    Image shown(const Picture& picture, Offscreen as = size) {
        const Window window(as, GL_RGBA8);
        renderer_->draw(picture);
        renderer_->show({0, 0});
        return window.image();
    }

    Mesh thing_ = ellipsoid(vec3(0.1f, 0.08f, 0.06f), 100);
    std::vector<vec3> wire_points_{{-0.2f, 0.05f, 0}, {0.2f, 0.05f, 0.1f}};
    std::vector<uvec2> wire_lines_{{0, 1}};
    std::optional<Renderer> renderer_;
    Picture picture_;
};

TEST_F(Qualities, ResizedItDrawsAsOneThatWasMadeInThatSize) {
    for (Offscreen other : {Offscreen{640, 480}, Offscreen{101, 67}, Offscreen{1, 1}, Offscreen{3, 200}}) {
        renderer_->resize(other);
        const Image before = renderer_->image();
        EXPECT_EQ(before.width, other.width);
        EXPECT_EQ(before.height, other.height);
        EXPECT_EQ(before.pixels[0], 0);
        Renderer made(other);
        made.draw(seen_by(made));
        EXPECT_EQ(image(picture_).pixels, made.image().pixels) << other.width << " x " << other.height;
    }
}

TEST_F(Qualities, ShowsTheBytesOfItsImage) {
    const ivec2 corner(7, 5);
    for (GLenum format : {GL_RGBA8, GL_SRGB8_ALPHA8})
        for (int samples : {4, 1}) {
            renderer_->set({.samples = samples});
            const Image drawn = image(picture_);
            const Window window({size.width + 20, size.height + 20}, format);
            glEnable(GL_FRAMEBUFFER_SRGB);
            renderer_->show(corner);
            EXPECT_TRUE(glIsEnabled(GL_FRAMEBUFFER_SRGB));
            glDisable(GL_FRAMEBUFFER_SRGB);
            const Image all = window.image();
            for (int y = 0; y < all.height; ++y)
                for (int x = 0; x < all.width; ++x)
                    for (int k = 0; k < 4; ++k) {
                        const ivec2 from(x - corner.x, y - (20 - corner.y));
                        const bool within =
                            from.x >= 0 && from.x < size.width && from.y >= 0 && from.y < size.height;
                        ASSERT_EQ(byte(all, x, y, k), within ? byte(drawn, from.x, from.y, k) : paper[k])
                            << x << ", " << y;
                    }
        }
}

TEST_F(Qualities, OfFewerPixelsItShowsWhatLiesBetween) {
    for (Offscreen odd : {size, Offscreen{101, 67}, Offscreen{1, 3}})
        for (float scale : {0.25f, 0.5f, 0.7f}) {
            renderer_->resize(odd);
            renderer_->set({.scale = scale});
            const Image all = shown(picture_, odd), drawn = renderer_->image();
            EXPECT_EQ(drawn.width, std::max(1, int(std::lround(scale * odd.width))));
            EXPECT_EQ(drawn.height, std::max(1, int(std::lround(scale * odd.height))));
            EXPECT_LE(largest_difference(all, stretched(drawn, odd.width, odd.height)), 2)
                << odd.width << " x " << odd.height << ", " << scale;
        }
}

TEST_F(Qualities, FewerPixelsAreOfTheSamePicture) {
    renderer_->resize({101, 67});
    const Image full = image(picture_);
    for (float scale : {0.25f, 0.5f, 0.7f}) {
        renderer_->set({.scale = scale});
        EXPECT_LE(difference(shown(picture_, {101, 67}), full).mean, 6) << scale;
    }
}

TEST_F(Qualities, ADraftIsNearlyThePicture) {
    const Image full = image(picture_);
    renderer_->set(draft_quality);
    EXPECT_LE(difference(shown(picture_), full).mean, 5);
    // Of which the most is due to shadows.
    renderer_->set({.shadows = false});
    const Image unshadowed = image(picture_);
    renderer_->set(draft_quality);
    EXPECT_LE(difference(shown(picture_), unshadowed).mean, 2);
}

TEST_F(Qualities, AfterADraftComesTheSamePictureAsBefore) {
    const Image full = image(picture_);
    renderer_->set(draft_quality);
    const Image draft = image(picture_);
    renderer_->set({});
    EXPECT_EQ(image(picture_).pixels, full.pixels);
    renderer_->set(draft_quality);
    EXPECT_EQ(image(picture_).pixels, draft.pixels);
}

TEST_F(Qualities, OneSampleAPixelMakesHardEdges) {
    const Mesh ball = ellipsoid(vec3(0.1f), 32);
    Picture picture{.camera = {.eye = vec3(0, 0, 0.5f), .look_at = vec3(0)}};
    const Surface black{renderer_->add(ball), ball.positions, ball.normals, {vec3(0), 0}};
    for (int samples : {1, 2, 4, 8}) {
        renderer_->set({.samples = samples});
        picture.surfaces.clear();
        const Image without = image(picture);
        picture.surfaces = {black};
        const Image with = image(picture);
        int partly = 0;
        for (std::size_t i = 0; i < with.pixels.size(); i += 4)
            partly += with.pixels[i] > 10 && with.pixels[i] + 10 < without.pixels[i];
        if (samples == 1)
            EXPECT_EQ(partly, 0);
        else
            EXPECT_GT(partly, 100) << samples;
    }
}

TEST_F(Qualities, WithoutShadowsLightGetsEverywhere) {
    Picture picture{.camera = {.eye = vec3(0, 0.4f, 0.6f), .look_at = vec3(0)},
                    .light = {.direction = vec3(1, -1, 0)},
                    .grounds = {{}}};
    const Ball high{vec3(-0.1f, 0.1f, 0), 0.01f};  // its shadow falls on the origin
    auto at_origin = [&](bool shadows, bool with) {
        renderer_->set({.shadows = shadows});
        picture.balls = {{vec3(0.3f, 0.01f, 0), 0.01f}};
        if (with) picture.balls.push_back(high);
        return byte(image(picture), size.width / 2, size.height / 2, 1);
    };
    EXPECT_LT(at_origin(true, true), at_origin(true, false) - 20);
    EXPECT_NEAR(at_origin(false, true), at_origin(false, false), 4);  // the ball still hides sky
}

TEST_F(Qualities, ADraftFollowsNodesToo) {
    const Body body = lattice({5, 5, 5}, 0.06f, Material{});
    std::vector<vec3> nodes;
    for (vec3 p : body.positions)
        nodes.push_back(vec3(p.x - 0.12f + 0.3f * (p.y - 0.12f), p.y - 0.12f, p.z - 0.12f));
    Mesh surface = thing_;
    for (vec3& p : surface.positions) p += 0.12f;
    const Embedding skin = embed(surface, body);
    const std::vector<vec3> normals = approximate_normals(body, nodes);
    const NodeBuffers buffers(nodes, normals);
    picture_.surfaces = {{.mesh = renderer_->add(surface, skin), .gpu_nodes = buffers.nodes}};
    const Image full = image(picture_);
    renderer_->set({.every_triangle = false});
    const Difference off = difference(image(picture_), full);
    EXPECT_LE(off.mean, 0.5);
    EXPECT_GT(off.mean, 0);
}

TEST_F(Qualities, ClearedItBeginsAnew) {
    const Image full = image(picture_);
    const Image dot{1, 1, {255, 0, 0, 255}};
    EXPECT_EQ(renderer_->add(dot), 0);
    const Mesh ball = ellipsoid(vec3(0.05f), 16);
    EXPECT_EQ(renderer_->add(ball), 1);
    renderer_->clear();
    EXPECT_EQ(renderer_->add(dot), 0);
    EXPECT_EQ(renderer_->add(ball), 0);
    const Image empty = image({});
    renderer_->clear();
    EXPECT_EQ(image({}).pixels, empty.pixels);
    EXPECT_EQ(image(seen_by(*renderer_)).pixels, full.pixels);
}

TEST_F(Qualities, QualitiesThatCannotBeAreErrors) {
    const Image full = image(picture_);
    for (const Quality& odd :
         {Quality{.samples = 0}, Quality{.samples = 3}, Quality{.samples = 16}, Quality{.samples = -4},
          Quality{.scale = 0}, Quality{.scale = 0.24f}, Quality{.scale = 1.01f},
          Quality{.scale = std::numeric_limits<float>::quiet_NaN()}}) {
        SCOPED_TRACE(odd.samples);
        SCOPED_TRACE(odd.scale);
        expect_refused("choose", [&] { renderer_->set(odd); });
    }
    EXPECT_THROW(renderer_->resize({0, 10}), Error);
    EXPECT_THROW(renderer_->resize({10, 1 << 24}), Error);
    EXPECT_EQ(image(picture_).pixels, full.pixels);
}

// Whoever else draws in the context: whatever has been set there, it is as it was afterwards, and the
// pictures are the same to the bit.
TEST_F(Qualities, AGuestLeavesTheContextAsItFindsIt) {
    const Mesh sphere = ellipsoid(vec3(0.1f, 0.08f, 0.06f), 20);
    const Body body = lattice({9, 9, 9}, 0.03f, {.youngs_modulus = 5000, .density = 1000});
    std::vector<vec3> nodes;
    for (vec3 p : body.positions) nodes.push_back(p - vec3(0.12f));
    Image dots{4, 4, std::vector<std::uint8_t>(64, 200)};
    for (std::size_t i = 0; i < dots.pixels.size(); i += 12) dots.pixels[i] = 30;
    // All that a renderer does, in a new one each time.
    const auto pictures = [&](auto visited) {
        std::vector<Image> images;
        const NodeBuffers on_gpu(nodes, nodes);
        const Window window(size, GL_RGBA8);
        visited([&] {
            Renderer renderer(size, context());
            Mesh textured = sphere;
            for (vec3 p : sphere.positions) textured.uvs.push_back(4.0f * vec2(p));
            compute_tangents(textured);
            Body lying = body;
            lying.positions = nodes;
            Picture picture = seen_by(renderer);
            picture.surfaces.push_back({.mesh = renderer.add(textured, embed(textured, lying)),
                                        .look = {.colour_map = renderer.add(dots)},
                                        .gpu_nodes = on_gpu.nodes});
            const Dent dent{vec3(0, 0, 0.06f), 0.01f, 0.01f};
            picture.surfaces.push_back(
                {.mesh = renderer.add(textured, embed(textured, lying, Mapping::frames)),
                 .nodes = {nodes, nodes},
                 .dents = {&dent, 1}});
            renderer.draw(picture);
            images.push_back(renderer.image());
            glBindFramebuffer(GL_DRAW_FRAMEBUFFER, window.name());
            renderer.show({0, 0});
            renderer.set(draft_quality);
            renderer.resize({100, 80});
            images.push_back(renderer.image());
            renderer.draw(picture);
            images.push_back(renderer.image());
            renderer.clear();
        });
        images.push_back(window.image());
        return images;
    };
    const std::vector<Image> alone = pictures([](auto draw) { draw(); });
    const std::vector<Image> visited = pictures([](auto draw) {
        const Hostile application;
        const auto before = state_of_context();
        draw();
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, application.framebuffer());
        expect_untouched(before, "after a Renderer");
    });
    for (std::size_t i = 0; i < alone.size(); ++i) EXPECT_EQ(visited[i].pixels, alone[i].pixels) << i;
    EXPECT_NE(alone.front().pixels[0], alone.back().pixels[100]);  // they show something
}

TEST_F(Qualities, APictureOfWhatIsNotThereIsRefused) {
    const Image full = image(picture_);
    const auto refused = [&](const std::string& word, auto spoil) {
        Picture odd = picture_;
        spoil(odd);
        expect_refused(word, [&] { renderer_->draw(odd); });
    };
    refused("a mesh that was not added", [](Picture& p) { p.surfaces[0].mesh = -1; });
    refused("a mesh that was not added", [](Picture& p) { p.surfaces[0].mesh = 100; });
    refused("a map that was not added", [](Picture& p) { p.surfaces[0].look.colour_map = 3; });
    refused("a map that was not added", [](Picture& p) { p.surfaces[0].look.normal_map = 3; });
    refused("number of its mesh's vertices", [](Picture& p) { p.surfaces[0].positions = {}; });
    refused("number of its mesh's vertices",
            [](Picture& p) { p.surfaces[0].normals = p.surfaces[0].normals.first(7); });
    const std::vector<vec2> too_few(7, vec2(0));
    refused("texture coordinates", [&](Picture& p) { p.surfaces[0].uvs = too_few; });
    refused("a missing point", [](Picture& p) { p.wires[0].points = p.wires[0].points.first(1); });

    const Body body = lattice(thing_, {.spacing = 0.03f, .material = {.youngs_modulus = 1e4f, .density = 1}});
    const int hung = renderer_->add(thing_, embed(thing_, body, Mapping::interpolated));
    const std::span<const vec3> nodes(body.positions);
    for (const Nodes& few : {Nodes{}, Nodes{nodes.first(9), nodes}, Nodes{nodes, nodes.first(9)}})
        refused("nodes", [&](Picture& p) { p.surfaces[0] = {.mesh = hung, .nodes = few}; });
    EXPECT_THROW(renderer_->culled(100), Error);
    EXPECT_THROW(renderer_->add(Image{2, 2, {1, 2, 3}}), Error);
    Mesh broken = thing_;
    broken.triangles[0].x = unsigned(thing_.positions.size());
    EXPECT_THROW(renderer_->add(broken), Error);
    EXPECT_EQ(image(picture_).pixels, full.pixels);
}

TEST(Thinned, FewerTrianglesKeepTheShape) {
    const Mesh mesh = ellipsoid(vec3(0.1f, 0.08f, 0.06f), 100);
    Mesh few = mesh;
    few.triangles = thinned(mesh, 5000);
    EXPECT_LE(few.triangles.size(), 5000u);
    EXPECT_GT(few.triangles.size(), 4500u);
    EXPECT_NEAR(volume(few) / volume(mesh), 1, 0.005);
}

TEST(Thinned, FewTrianglesStayAsTheyAre) {
    const Mesh mesh = ellipsoid(vec3(0.1f), 10);
    EXPECT_EQ(thinned(mesh, mesh.triangles.size()), mesh.triangles);
    EXPECT_TRUE(thinned(Mesh{}, 10).empty());
}

}  // namespace
}  // namespace palpate
