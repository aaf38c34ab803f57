// Maps that are laid over a surface, and normals as colour.
#include "bench/deformations.h"
#include "palpate/base/error.h"
#include "palpate/gl/context.h"
#include "palpate/render/renderer.h"
#include "tests/render/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

namespace palpate {
namespace {

constexpr float pi = std::numbers::pi_v<float>;
constexpr float wide = 0.3f;  // m, of the plane

// Waves low enough that they hide nothing of the light and of the sky.
float height(vec2 p) {
    return 0.002f * std::sin(2 * pi * p.x / 0.05f) * std::cos(2 * pi * (p.x + p.y) / 0.06f);
}

vec2 slope(vec2 p) {
    const float d = 1e-3f;
    return vec2(height(p + vec2(d, 0)) - height(p - vec2(d, 0)),
                height(p + vec2(0, d)) - height(p - vec2(0, d))) /
           (2 * d);
}

// A normal for each pixel, of its place on the plane: u and v from 0 to 1 along x and y.
Image normal_map(int pixels, std::function<vec3(vec2)> normal) {
    Image image{pixels, pixels, {}};
    for (int row = 0; row < pixels; ++row)
        for (int column = 0; column < pixels; ++column) {
            const vec2 uv = (vec2(column, pixels - 1 - row) + 0.5f) / float(pixels);
            const vec3 n = normal(wide * (uv - 0.5f));
            for (int k = 0; k < 3; ++k) image.pixels.push_back(std::uint8_t(std::lround(128 + 127 * n[k])));
            image.pixels.push_back(255);
        }
    return image;
}

vec3 of_the_waves(vec2 p) { return glm::normalize(vec3(-slope(p), 1)); }

// A flat plane over a cloth. `mirrored`: u runs against x.
struct FlatQuilt {
    Mesh mesh = relief({wide, wide}, {30, 30}, [](vec2) { return 0.0f; });
    Body body = cloth({17, 17}, 0.02f, {.density = 0.2f});

    explicit FlatQuilt(bool mirrored = false) {
        for (vec3& p : body.positions) p -= vec3(0.16f, 0.16f, 0);
        for (vec2& uv : mesh.uvs)
            if (mirrored) uv.x = 1 - uv.x;
        compute_tangents(mesh);
    }
};

class Shading : public ::testing::Test {
 protected:
    void SetUp() override {
        try {
            renderer_.emplace(Offscreen{320, 240});
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

    // The plane, its nodes turned, with a look.
    Image drawn(const FlatQuilt& plane, Mapping mapping, const mat3& turn, const Look& look,
                const Picture& around) {
        std::vector<vec3> nodes;
        for (vec3 p : plane.body.positions) nodes.push_back(turn * p);
        const std::vector<vec3> normals = approximate_normals(plane.body, nodes);
        Picture picture = around;
        picture.surfaces = {{.mesh = renderer_->add(plane.mesh, embed(plane.mesh, plane.body, mapping)),
                             .look = look,
                             .nodes = {nodes, normals}}};
        return image(picture);
    }

    // The waves as triangles, turned.
    Image displaced(const mat3& turn, const Look& look, const Picture& around) {
        Mesh waves = relief({wide, wide}, {160, 160}, height);
        for (vec3& n : waves.normals) n = turn * n;
        for (vec3& p : waves.positions) p = turn * p;
        Picture picture = around;
        picture.surfaces = {{renderer_->add(waves), waves.positions, waves.normals, look}};
        return image(picture);
    }

    std::optional<Renderer> renderer_;
};

const mat3 unturned(1), quarter(0, 1, 0, -1, 0, 0, 0, 0, 1), aside(1, 0, 0, 0, 0, -1, 0, 1, 0);

Picture from(vec3 eye, vec3 light) {
    return {.camera = {.eye = eye, .angle = 30}, .light = {.direction = light}};
}

// Lit from aside, where every slope shows. The plane is turned by 90° within itself, and backwards; the
// texture may be mirrored on it.
TEST_F(Shading, ANormalMapLooksAsTheReliefItStandsFor) {
    const Look plain{vec3(0.6f), 0.3f};
    struct Case {
        mat3 turn;
        vec3 eye, light;
    };
    Mapping mapping = Mapping::constant;
    for (const auto& [turn, eye, light] : {Case{unturned, {0.1f, 0.1f, 0.5f}, {1, 0.3f, -0.5f}},
                                           Case{quarter, {0.1f, 0.1f, 0.5f}, {1, 0.3f, -0.5f}},
                                           Case{aside, {0.1f, 0.5f, 0.1f}, {1, -0.5f, 0.3f}}}) {
        const Picture around = from(eye, light);
        const Image relief = displaced(turn, plain, around);
        EXPECT_GE(difference(drawn(FlatQuilt(), mapping, turn, plain, around), relief).mean, 4);  // it shows
        for (bool mirrored : {false, true}) {
            const FlatQuilt plane(mirrored);
            Look bumpy = plain;
            auto normal = [&](vec2 p) {
                if (!mirrored) return of_the_waves(p);
                return of_the_waves({-p.x, p.y}) * vec3(-1, 1, 1);
            };
            bumpy.normal_map = renderer_->add(normal_map(512, normal), Texels::normals);
            const Difference off = difference(drawn(plane, mapping, turn, bumpy, around), relief);
            EXPECT_LE(off.mean, 1) << name_of(mapping) << (mirrored ? ", mirrored" : "");
            EXPECT_LE(off.share, 0.01) << name_of(mapping) << (mirrored ? ", mirrored" : "");
        }
        mapping = mapping == Mapping::constant ? Mapping::interpolated : Mapping::frames;
    }
}

TEST_F(Shading, AFlatNormalMapChangesNothing) {
    const FlatQuilt plane;
    const Picture around = from({0.1f, 0.1f, 0.5f}, {1, 0.3f, -1});
    Look look{vec3(0.6f), 0.3f};
    const Image without = drawn(plane, Mapping::frames, unturned, look, around);
    look.normal_map = renderer_->add(normal_map(4, [](vec2) { return vec3(0, 0, 1); }), Texels::normals);
    const Image with = drawn(plane, Mapping::frames, unturned, look, around);
    int most = 0;
    for (std::size_t i = 0; i < with.pixels.size(); ++i)
        most = std::max(most, std::abs(with.pixels[i] - without.pixels[i]));
    EXPECT_LE(most, 1);
}

// Red, green, blue and white in the quarters of an image: u to the right and v upwards.
TEST_F(Shading, AColourMapLiesAsItsCoordinatesSay) {
    Image quarters{64, 64, {}};
    for (int row = 0; row < 64; ++row)
        for (int column = 0; column < 64; ++column) {
            const bool right = column >= 32, high = row < 32;
            const std::uint8_t red = !right, green = right && !high, blue = right && high;
            if (!right && high)
                quarters.pixels.insert(quarters.pixels.end(), {255, 255, 255, 255});
            else
                quarters.pixels.insert(
                    quarters.pixels.end(),
                    {std::uint8_t(255 * red), std::uint8_t(255 * green), std::uint8_t(255 * blue), 255});
        }
    const FlatQuilt plane;
    const Look look{.colour = vec3(1), .shine = 0, .colour_map = renderer_->add(quarters)};
    const Picture around = from({0, 0, 0.6f}, {0, 0, -1});
    const Image nodes = drawn(plane, Mapping::frames, unturned, look, around);
    Picture host = around;
    host.surfaces = {{renderer_->add(plane.mesh), plane.mesh.positions, plane.mesh.normals, look}};
    for (const Image& image : {nodes, this->image(host)}) {
        auto at = [&](int x, int y) {
            const std::uint8_t* p = &image.pixels[4 * std::size_t(y * image.width + x)];
            return ivec3(p[0], p[1], p[2]);
        };
        const ivec3 low_left = at(130, 150), low_right = at(190, 150), high_left = at(130, 90),
                    high_right = at(190, 90);
        EXPECT_GT(low_left.r, 3 * low_left.g);
        EXPECT_GT(low_right.g, 3 * low_right.r);
        EXPECT_GT(high_right.b, 3 * high_right.r);
        EXPECT_GT(std::min({high_left.r, high_left.g, high_left.b}), 150);
    }
}

// Coordinates of the moment take the place of the mesh's own, which may have none.
TEST_F(Shading, AColourMapFollowsCoordinatesOfTheMoment) {
    Image left_red{64, 64, {}};
    for (int i = 0; i < 64 * 64; ++i)
        if (i % 64 < 32)
            left_red.pixels.insert(left_red.pixels.end(), {255, 0, 0, 255});
        else
            left_red.pixels.insert(left_red.pixels.end(), {0, 255, 0, 255});
    FlatQuilt plane;
    const Look look{.colour = vec3(1), .shine = 0, .colour_map = renderer_->add(left_red)};
    for (bool has_own : {true, false}) {
        if (!has_own) plane.mesh.uvs.clear();
        const int mesh = renderer_->add(plane.mesh);
        for (bool left : {true, false}) {
            const std::vector<vec2> now(plane.mesh.positions.size(), vec2(left ? 0.25f : 0.75f, 0.5f));
            Picture picture = from({0, 0, 0.6f}, {0, 0, -1});
            picture.surfaces = {{.mesh = mesh,
                                 .positions = plane.mesh.positions,
                                 .normals = plane.mesh.normals,
                                 .look = look,
                                 .uvs = now}};
            const Image image = this->image(picture);
            const std::uint8_t* middle =
                &image.pixels[4 * std::size_t(image.height / 2 * image.width + image.width / 2)];
            EXPECT_EQ(middle[0] > 3 * middle[1], left) << has_own;
            EXPECT_EQ(middle[1] > 3 * middle[0], !left) << has_own;
        }
    }
}

// Each face of a body shows where it looks now, and not where it looked at rest.
TEST_F(Shading, NormalsAsColourAreThoseOfTheMoment) {
    const FlatQuilt plane;
    Look look{.shine = 0};
    look.shows_normals = true;
    auto centre = [](const Image& image) {
        const std::uint8_t* p =
            &image.pixels[4 * std::size_t(image.height / 2 * image.width + image.width / 2)];
        return ivec3(p[0], p[1], p[2]);
    };
    const ivec3 front = centre(drawn(plane, Mapping::frames, unturned, look, from({0, 0, 0.6f}, {0, 0, -1})));
    EXPECT_GT(front.b, front.r + 40);
    EXPECT_GT(front.b, front.g + 40);
    const ivec3 top = centre(drawn(plane, Mapping::frames, aside, look, from({0, 0.6f, 0.01f}, {0, -1, 0})));
    EXPECT_GT(top.g, top.r + 40);
    EXPECT_GT(top.g, top.b + 40);
}

TEST_F(Shading, MapsOfNoSizeAreErrors) {
    EXPECT_THROW(renderer_->add(Image{}), Error);
    EXPECT_THROW(renderer_->add(Image{1 << 20, 1, {}}), Error);
}

}  // namespace
}  // namespace palpate
