// Dents in pictures: as the same mesh looks that was dented on the host.
#include "bench/deformations.h"
#include "palpate/base/files.h"
#include "palpate/gl/program.h"
#include "palpate/render/gpu_dents.h"
#include "palpate/render/renderer.h"
#include "tests/gl/with_context.h"
#include "tests/render/gpu.h"
#include "tests/render/pictures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <regex>
#include <sstream>
#include <string>

namespace palpate {
namespace {

// Places and normals, dented by a vertex shader and fetched by transform feedback.
Moved dented_by_shader(const Moved& from, std::span<const Dent> dents, GLuint binding) {
    const std::string text = "#version 450 core\n" + GpuDents::shader(binding) + R"(
        layout(location = 0) in vec3 place;
        layout(location = 1) in vec3 normal;
        layout(xfb_buffer = 0, xfb_stride = 24) out;
        layout(xfb_offset = 0) out vec3 to_place;
        layout(xfb_offset = 12) out vec3 to_normal;
        void main() {
            to_place = dented(place, normal);
            to_normal = dented_normal(place, normal);
        })";
    const gl::Program program({{GL_VERTEX_SHADER, "feedback", text}});
    const gl::Buffer places(from.positions), normals(from.normals),
        out = gl::Buffer::room(24 * from.positions.size());
    gl::VertexArray corners;
    for (GLuint k : {0u, 1u}) {
        glEnableVertexArrayAttrib(corners.name(), k);
        glVertexArrayAttribFormat(corners.name(), k, 3, GL_FLOAT, GL_FALSE, 0);
        glVertexArrayAttribBinding(corners.name(), k, k);
        glVertexArrayVertexBuffer(corners.name(), k, (k == 0 ? places : normals).name(), 0, sizeof(vec3));
    }
    GpuDents on_gpu;
    on_gpu.set(dents);
    on_gpu.bind(binding);
    program.use();
    glBindVertexArray(corners.name());
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, out.name());
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, GLsizei(from.positions.size()));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    std::vector<vec3> vectors(2 * from.positions.size());
    glGetNamedBufferSubData(out.name(), 0, GLsizeiptr(12 * vectors.size()), vectors.data());
    Moved moved;
    for (std::size_t i = 0; i < vectors.size(); i += 2) {
        moved.positions.push_back(vectors[i]);
        moved.normals.push_back(vectors[i + 1]);
    }
    return moved;
}

Moved dented_on_the_host(Moved moved, std::span<const Dent> dents) {
    for (std::size_t i = 0; i < moved.positions.size(); ++i) {
        const vec3 place = moved.positions[i], normal = moved.normals[i];
        moved.positions[i] = dented(dents, place, normal);
        moved.normals[i] = dented_normal(dents, place, normal);
    }
    return moved;
}

TEST_F(WithContext, DentsInAShaderAreThoseOfTheHost) {
    std::mt19937 random(3);
    auto any = [&](float from, float to) { return std::uniform_real_distribution<float>(from, to)(random); };
    auto any_vector = [&](float size) { return vec3(any(-size, size), any(-size, size), any(-size, size)); };
    for (int count : {0, 1, 2, 7, 63, 64, 65, 100}) {
        std::vector<Dent> dents;
        for (int i = 0; i < count; ++i)
            dents.push_back({any_vector(0.1f), any(-0.01f, 0.01f), any(0.005f, 0.03f)});
        if (count >= 7 && count < 64) {  // these are none
            dents[2].depth = std::nanf("");
            dents[3].width = 0;
            dents[5].centre.y = INFINITY;
        }
        Moved at;
        for (int i = 0; i < 999; ++i) {
            at.positions.push_back(any_vector(0.12f));
            at.normals.push_back(glm::normalize(any_vector(1) + vec3(1e-3f)));
        }
        const std::span<const Dent> shown = std::span(dents).first(std::size_t(std::min(count, most_dents)));
        const Moved is = dented_by_shader(at, dents, GLuint(count % 5)),
                    should = dented_on_the_host(at, shown);
        for (std::size_t i = 0; i < at.positions.size(); ++i) {
            EXPECT_LE(glm::distance(is.positions[i], should.positions[i]), 1e-6f) << count;
            EXPECT_LE(glm::distance(is.normals[i], should.normals[i]), 1e-4f) << count;
            if (count == 0) EXPECT_TRUE(is.positions[i] == at.positions[i] && is.normals[i] == at.normals[i]);
        }
    }
}

// The lines that an application adds or changes are as many as its own words and the docs say.
TEST(DentInAnApplication, TakesAsManyLinesAsIsSaid) {
    const std::string source = PALPATE_SOURCE_DIR, program = "dent_in_an_application";
    const std::string text = read_text(source + "/examples/programs/" + program + ".cpp"),
                      docs = read_text(source + "/docs/library.md");
    const std::regex marked(R"(^\s*[^\s/].*\s// \+( was: .+)?$)");
    int lines = 0;
    std::istringstream all(text);
    for (std::string line; std::getline(all, line);) lines += std::regex_match(line, marked);
    EXPECT_GT(lines, 0);
    const std::string said = std::to_string(lines) + " lines";
    EXPECT_LT(text.find(" " + said), text.find("#include"));
    EXPECT_NE(docs.find("| `" + program + "` | " + said), std::string::npos) << said;
    EXPECT_NE(docs.find(said + ", as `examples/programs/" + program + ".cpp`"), std::string::npos) << said;
}

class DentPictures : public WithContext {
 protected:
    void SetUp() override {
        WithContext::SetUp();
        if (!context_) return;
        renderer_.emplace(Offscreen{320, 240}, context());
        plate_ = renderer_->add(plate_mesh_);
    }
    void TearDown() override {
        renderer_.reset();
        WithContext::TearDown();
    }

    Image image(const Picture& picture) {
        renderer_->draw(picture);
        return renderer_->image();
    }

    // A white plate 0.6 m wide at this height, which shows shadows and makes the extent of pictures the same.
    Surface plate(float height) {
        plate_places_.clear();
        for (vec3 p : plate_mesh_.positions) plate_places_.push_back({p.x, height, -p.y});
        return {.mesh = plate_, .positions = plate_places_, .normals = up_, .look = {.colour = vec3(0.8f)}};
    }

    const Mesh plate_mesh_ = relief({0.6f, 0.6f}, {1, 1}, [](vec2) { return 0.0f; });
    const std::vector<vec3> up_ = std::vector<vec3>(4, vec3(0, 1, 0));
    std::vector<vec3> plate_places_;
    int plate_ = 0;
    std::optional<Renderer> renderer_;
};

// A sheet in the plane y = 0, fine or of two triangles.
Mesh sheet(int parts) {
    Mesh mesh = relief({0.3f, 0.3f}, {parts, parts}, [](vec2) { return 0.0f; });
    for (vec3& p : mesh.positions) p = {p.x, p.z, -p.y};
    for (vec3& n : mesh.normals) n = {0, 1, 0};
    compute_tangents(mesh);
    return mesh;
}

const std::vector<Dent> three_dents = {{{-0.06f, 0, 0.02f}, 0.02f, 0.02f},
                                       {{0.05f, 0, -0.03f}, 0.015f, 0.012f},
                                       {{0.03f, 0, 0.08f}, -0.01f, 0.02f}};

void expect_as(const Image& is, const Image& should, const std::string& where) {
    const Difference off = difference(is, should);
    EXPECT_LE(off.mean, 0.1) << where;
    EXPECT_LE(off.share, 0.001) << where;
}

// From above, from aside and from below, where the backs show; also as colours of the normals.
TEST_F(DentPictures, ASheetLooksAsTheOneDentedOnTheHost) {
    const Mesh mesh = sheet(160);
    const int number = renderer_->add(mesh);
    const Moved moved = dented_on_the_host({mesh.positions, mesh.normals, {}}, three_dents);
    for (vec3 eye : {vec3(0.1f, 0.5f, 0.1f), vec3(0.5f, 0.2f, 0.3f), vec3(0.1f, -0.4f, 0.3f)})
        for (bool shows_normals : {false, true})
            for (bool coarse : {false, true}) {
                const Look look{.shows_normals = shows_normals, .coarse_dents = coarse};
                Picture picture{.camera = {.eye = eye}, .light = {.direction = {1, -0.7f, 0.3f}}};
                picture.surfaces = {plate(-0.1f), {number, moved.positions, moved.normals, look}};
                if (eye.y < 0) picture.surfaces.erase(picture.surfaces.begin());
                const Image host = image(picture);
                picture.surfaces.back() = {number, mesh.positions, mesh.normals, look};
                const Image undented = image(picture);
                EXPECT_GE(difference(undented, host).mean, 0.4);  // it shows
                picture.surfaces.back().dents = three_dents;
                expect_as(image(picture), host, std::to_string(eye.x) + (coarse ? ", coarse" : ""));
            }
}

// In cells, on triangles and on frames; the nodes moved, on the host and on the GPU.
TEST_F(DentPictures, AMappedSurfaceLooksAsTheOneDentedOnTheHost) {
    const Carrier c = organ_on_a_lattice();
    for (Mapping mapping : {Mapping::trilinear, Mapping::constant, Mapping::frames}) {
        const Embedding skin = embed(c.surface, c.body, mapping);
        const int number = renderer_->add(c.surface, skin);
        const std::vector<vec3> nodes = c.bent(c.body.positions),
                                normals = approximate_normals(c.body, nodes);
        const NodeBuffers buffers(nodes, normals);
        const NodeTextures textures(nodes, normals, 29);
        const Moved moved = follow(skin, c.body, nodes);
        std::vector<Dent> dents;
        for (std::size_t i : {moved.positions.size() / 3, moved.positions.size() / 2})
            dents.push_back({moved.positions[i], 0.012f, 0.012f});
        const Moved dented = dented_on_the_host(moved, dents);
        const Bounds box = bounds_of(moved.positions);
        for (const Dent& dent : dents) {
            const vec3 outwards = glm::normalize(dent.centre - box.centre());
            Picture picture{.camera = {.eye = box.centre() + 0.35f * outwards + vec3(0, 0.1f, 0),
                                       .look_at = box.centre()}};
            picture.surfaces = {plate(box.low.y), {number, dented.positions, dented.normals}};
            const Image host = image(picture);
            picture.surfaces.back() = {.mesh = number, .gpu_nodes = buffers.nodes};
            EXPECT_GE(difference(image(picture), host).mean, 0.5) << name_of(mapping);
            for (const Surface& surface :
                 {Surface{.mesh = number, .nodes = {nodes, normals}, .dents = dents},
                  Surface{.mesh = number, .gpu_nodes = buffers.nodes, .dents = dents},
                  Surface{.mesh = number, .gpu_nodes = textures.nodes, .dents = dents}}) {
                picture.surfaces.back() = surface;
                expect_as(image(picture), host, std::string(name_of(mapping)));
            }
        }
    }
}

// Figure 6 of 2007: seen from above, two triangles whose corners are far from any dent look like a fine
// sheet. That needs normals that are turned in each pixel.
TEST_F(DentPictures, LargeTrianglesShowDentsByTheirNormalsAlone) {
    const Mesh fine = sheet(200), large = sheet(1);
    const int fine_number = renderer_->add(fine), large_number = renderer_->add(large);
    const std::vector<Dent> dents = {{{-0.04f, 0, 0.02f}, 0.012f, 0.03f},
                                     {{0.04f, 0, -0.01f}, 0.008f, 0.025f}};
    Picture picture{.camera = {.eye = {0, 0.4f, 0}, .up = {0, 0, -1}, .angle = 25, .orthographic = true},
                    .light = {.direction = {1, -1, 0.3f}}};
    Look look{.colour = vec3(0.7f), .shine = 0.2f};
    for (bool shows_normals : {false, true}) {
        look.shows_normals = shows_normals;
        picture.surfaces = {{.mesh = fine_number,
                             .positions = fine.positions,
                             .normals = fine.normals,
                             .look = look,
                             .dents = dents}};
        const Image should = image(picture);
        picture.surfaces = {{.mesh = large_number,
                             .positions = large.positions,
                             .normals = large.normals,
                             .look = look,
                             .dents = dents}};
        expect_as(image(picture), should, "large triangles");
        picture.surfaces.back().look.coarse_dents = true;
        const Image coarse = image(picture);
        picture.surfaces.back().dents = {};
        const Image flat = image(picture);
        EXPECT_GE(difference(should, flat).mean, 1);
        EXPECT_LE(difference(coarse, flat).mean, 0.1);
    }
}

TEST_F(DentPictures, WithoutDentsThatActNoPixelChanges) {
    const Mesh mesh = sheet(20);
    const int number = renderer_->add(mesh),
              hung = renderer_->add(mesh, embed(mesh, cloth({9, 9}, 0.04f, {.density = 0.2f})));
    const std::vector<vec3> nodes = cloth({9, 9}, 0.04f, {.density = 0.2f}).positions;
    const std::vector<Dent> none = {{vec3(0), 0, 0.01f}, {vec3(0), 0.01f, 0}, {vec3(NAN), 0.01f, 0.01f}};
    for (Surface surface :
         {Surface{number, mesh.positions, mesh.normals}, Surface{.mesh = hung, .nodes = {nodes, nodes}}}) {
        Picture picture{.camera = {.eye = {0.1f, 0.5f, 0.1f}}, .surfaces = {surface}};
        const Image before = image(picture);
        picture.surfaces[0].dents = none;
        EXPECT_TRUE(image(picture).pixels == before.pixels);
        picture.surfaces[0].dents = three_dents;
        EXPECT_FALSE(image(picture).pixels == before.pixels);
        picture.surfaces[0].dents = {};
        EXPECT_TRUE(image(picture).pixels == before.pixels);
    }
}

// A bump, or a dent as deep as the body, may lie where its cluster does not.
TEST_F(DentPictures, AreTheSameToTheBitCulledOrNot) {
    std::mt19937 random(5);
    auto any = [&](float from, float to) { return std::uniform_real_distribution<float>(from, to)(random); };
    const Carrier c = organ_on_a_lattice();
    double left_out = 0;
    for (Mapping mapping : {Mapping::trilinear, Mapping::constant, Mapping::frames}) {
        const int number = renderer_->add(c.surface, embed(c.surface, c.body, mapping));
        for (int trial = 0; trial < 12; ++trial) {
            const std::vector<vec3> nodes = trial % 2 ? c.twisted(c.body.positions) : c.body.positions,
                                    normals = approximate_normals(c.body, nodes);
            std::vector<Dent> dents;
            for (int i = 0; i <= trial % 3; ++i)
                dents.push_back({vec3(any(-0.05f, 0.05f), any(-0.04f, 0.04f), any(-0.06f, 0.06f)),
                                 any(-0.04f, 0.04f), any(0.005f, 0.03f)});
            const vec3 target(any(-0.08f, 0.08f), any(-0.08f, 0.08f), any(-0.08f, 0.08f));
            Picture picture{
                .camera = {.eye = target + any(0.05f, 0.3f) * glm::normalize(target + vec3(0.01f)),
                           .look_at = target,
                           .angle = any(10, 60),
                           .orthographic = trial % 4 == 0},
                .surfaces = {{.mesh = number, .nodes = {nodes, normals}, .dents = dents}},
                .grounds = {{.offset = -0.1f}}};
            const Image culled = image(picture);
            const Culled count = renderer_->culled(number);
            left_out = std::max(left_out, 1 - double(count.vertices_drawn) / double(count.vertices));
            picture.culls = false;
            EXPECT_TRUE(image(picture).pixels == culled.pixels) << name_of(mapping) << ", " << trial;
        }
    }
    EXPECT_GE(left_out, 0.1);  // there was something to get wrong
}

// Where the plate is seen, and only its light can have changed, a bump's shadow is the host's.
TEST_F(DentPictures, ShadowsFollow) {
    const Mesh mesh = ellipsoid({0.05f, 0.05f, 0.05f}, 60);
    const int number = renderer_->add(mesh);
    const std::vector<Dent> bump = {{{-0.05f, 0, 0}, -0.04f, 0.015f}};
    const Moved moved = dented_on_the_host({mesh.positions, mesh.normals, {}}, bump);
    Picture picture{.camera = {.eye = {0.2f, 0.5f, 0.4f}}, .light = {.direction = {0.2f, -0.5f, 1}}};
    picture.surfaces = {plate(-0.06f), {}};
    auto drawn = [&](const Surface& surface, vec3 colour) {
        picture.surfaces[1] = surface;
        picture.surfaces[1].look.colour = colour;
        return image(picture);
    };
    const Surface plain{number, mesh.positions, mesh.normals}, host{number, moved.positions, moved.normals};
    Surface ours = plain;
    ours.dents = bump;
    const vec3 red(0.9f, 0, 0), green(0, 0.9f, 0);
    const Image before = drawn(plain, red), should = drawn(host, red), is = drawn(ours, red);
    const Image others[] = {drawn(plain, green), drawn(host, green), drawn(ours, green)};
    int changed = 0, off = 0;
    for (std::size_t i = 0; i < is.pixels.size(); i += 4) {
        auto same = [&](const Image& a, const Image& b) {
            return std::equal(&a.pixels[i], &a.pixels[i + 4], &b.pixels[i]);
        };
        if (!same(before, others[0]) || !same(should, others[1]) || !same(is, others[2])) continue;
        changed += std::abs(before.pixels[i] - should.pixels[i]) > 16;
        off += std::abs(is.pixels[i] - should.pixels[i]) > 16;
    }
    EXPECT_GE(changed, 300);
    EXPECT_LE(off, changed / 50);
}

// A normal map lies about the dented normal.
TEST_F(DentPictures, NormalMapsLieOverDents) {
    const Mesh mesh = sheet(100);
    Body body = cloth({17, 17}, 0.02f, {.density = 0.2f});
    for (vec3& p : body.positions) p = {p.x - 0.16f, p.z, 0.16f - p.y};
    const std::vector<vec3> normals(body.count(), vec3(0, 1, 0));
    auto all = [&](std::uint8_t red, std::uint8_t blue) {
        Image map{4, 4, {}};
        for (int i = 0; i < 16; ++i) map.pixels.insert(map.pixels.end(), {red, 128, blue, 255});
        return renderer_->add(map, Texels::normals);
    };
    const int flat = all(128, 255), tilted = all(200, 233);
    Surface surface{.mesh = renderer_->add(mesh, embed(mesh, body, Mapping::frames)),
                    .nodes = {body.positions, normals},
                    .dents = three_dents};
    const Picture around{.camera = {.eye = {0.1f, 0.5f, 0.2f}}, .light = {.direction = {1, -1, 0.3f}}};
    auto drawn = [&](int map) {
        Picture picture = around;
        surface.look.normal_map = map;
        picture.surfaces = {surface};
        return image(picture);
    };
    const Image without = drawn(-1), with_flat = drawn(flat);
    EXPECT_LE(difference(with_flat, without).mean, 0.2);
    EXPECT_EQ(difference(with_flat, without).share, 0);
    const Image with_tilted = drawn(tilted);
    EXPECT_GE(difference(with_tilted, without).mean, 2);
    surface.dents = {};
    EXPECT_GE(difference(drawn(tilted), with_tilted).mean, 1);
}

TEST_F(DentPictures, OddDentsAreDrawnAsWellAsTheyCanBe) {
    const Mesh mesh = sheet(20);
    const int number = renderer_->add(mesh);
    const float odd[] = {NAN, INFINITY, -3e38f, 0, 1e-30f, 9e8f};
    std::vector<Dent> dents;
    for (float a : odd)
        for (float b : odd) dents.push_back({vec3(a, 0, b), a, b});
    for (int i = 0; i < 100; ++i) dents.push_back(three_dents[std::size_t(i % 3)]);
    renderer_->draw(
        {.surfaces = {
             {.mesh = number, .positions = mesh.positions, .normals = mesh.normals, .dents = dents}}});
}

}  // namespace
}  // namespace palpate
