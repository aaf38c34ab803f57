// Surfaces that are mapped where they are drawn: the same vertices and the same pictures as deform() makes on
// the host, and nothing read back.
#include "bench/deformations.h"
#include "palpate/base/error.h"
#include "palpate/gl/context.h"
#include "palpate/render/gpu_embedding.h"
#include "palpate/render/reach.h"
#include "palpate/render/renderer.h"
#include "tests/gl/with_context.h"
#include "tests/render/gpu.h"
#include "tests/render/pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <optional>
#include <random>
#include <string>

namespace palpate {
namespace {

constexpr Mapping every_mapping[] = {Mapping::one_to_one,    Mapping::constant,  Mapping::interpolated,
                                     Mapping::normal_offset, Mapping::trilinear, Mapping::frames};

bool can(const Body& body, Mapping mapping) { return mapping != Mapping::trilinear || !body.cells.empty(); }

// Any tangents, some of them left-handed.
Mesh with_tangents(Mesh mesh) {
    mesh.tangents.clear();
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
        const vec3 n = mesh.normals[i], aside = std::abs(n.x) < 0.6f ? vec3(1, 0, 0) : vec3(0, 1, 0);
        mesh.tangents.emplace_back(glm::normalize(glm::cross(n, aside)), i % 3 == 0 ? -1.0f : 1.0f);
    }
    return mesh;
}

// What a vertex shader makes of an embedding, fetched by transform feedback.
Moved mapped(const GpuEmbedding& skin, const GpuNodes& nodes, std::size_t vertices) {
    const std::string text = "#version 450 core\n" + skin.shader(nodes.width > 0) + R"(
        layout(xfb_buffer = 0, xfb_stride = 40) out;
        layout(xfb_offset = 0) out vec3 to_position;
        layout(xfb_offset = 12) out vec3 to_normal;
        layout(xfb_offset = 24) out vec4 to_tangent;
        void main() { map_vertex(to_position, to_normal, to_tangent); })";
    const gl::Program program({{GL_VERTEX_SHADER, "feedback", text}});
    const gl::Buffer out = gl::Buffer::room(vertices * 40);
    skin.bind(nodes);
    program.use();
    glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, out.name());
    glEnable(GL_RASTERIZER_DISCARD);
    glBeginTransformFeedback(GL_POINTS);
    glDrawArrays(GL_POINTS, 0, GLsizei(vertices));
    glEndTransformFeedback();
    glDisable(GL_RASTERIZER_DISCARD);
    std::vector<float> floats(10 * vertices);
    glGetNamedBufferSubData(out.name(), 0, GLsizeiptr(40 * vertices), floats.data());
    Moved moved;
    for (const float* f = floats.data(); f != floats.data() + floats.size(); f += 10) {
        moved.positions.emplace_back(f[0], f[1], f[2]);
        moved.normals.emplace_back(f[3], f[4], f[5]);
        moved.tangents.emplace_back(f[6], f[7], f[8], f[9]);
    }
    return moved;
}

// The largest distance between vectors of two lists; not a number if there is one among them.
template <class Vector>
float largest(const std::vector<Vector>& a, const std::vector<Vector>& b) {
    EXPECT_EQ(a.size(), b.size());
    float most = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (const float d = glm::distance(a[i], b[i]); !(d <= most)) most = d;
    return most;
}

// Takes out the tangents of vertices that have none to speak of: in their basis they run along the normal.
void drop_chance(const Embedding& skin, Moved& moved) {
    const auto* on_triangles = std::get_if<std::vector<OnTriangle>>(&skin.vertices);
    for (std::size_t i = 0; on_triangles && i < on_triangles->size(); ++i)
        if (glm::length(glm::cross(vec3(skin.tangents[i]), (*on_triangles)[i].normal)) < 0.02f)
            moved.tangents[i] = vec4(0);
}

void expect_same(const Moved& is, const Moved& should, float size, const std::string& where) {
    EXPECT_LE(largest(is.positions, should.positions), 1e-5f * size) << where;
    EXPECT_LE(largest(is.normals, should.normals), 2e-4f) << where;
    EXPECT_LE(largest(is.tangents, should.tangents), 2e-4f) << where;
}

class Mapped : public WithContext {
 protected:
    // By every mapping, from buffers and from textures.
    template <class Expect>
    void for_each_way(const Carrier& c, const std::vector<vec3>& nodes, const std::string& how,
                      Expect expect) {
        const std::vector<vec3> normals = approximate_normals(c.body, nodes);
        const Mesh surface = with_tangents(c.surface);
        const float size = glm::length(bounds(surface).size());
        for (Mapping mapping : every_mapping) {
            if (!can(c.body, mapping)) continue;
            const Embedding skin = embed(surface, c.body, mapping);
            const Moved should = follow(skin, c.body, nodes);
            const GpuEmbedding on_gpu(skin);
            auto compare = [&](const GpuNodes& on, const std::string& as) {
                expect(skin, mapped(on_gpu, on, surface.positions.size()), should, size, as);
            };
            const std::string where = c.name + ", " + std::string(name_of(mapping)) + ", " + how;
            const NodeBuffers buffers(nodes, normals);
            compare(buffers.nodes, where);
            for (int width : {1, 37, 4096}) {
                if (width == 1 && nodes.size() > 1000) continue;  // textures have a greatest height
                const NodeTextures textures(nodes, normals, width);
                compare(textures.nodes, where + ", texture");
            }
        }
    }

    void expect_as_on_the_host(const Carrier& c, const std::vector<vec3>& nodes, const std::string& how) {
        for_each_way(c, nodes, how,
                     [](const Embedding& skin, Moved is, Moved should, float size, const std::string& where) {
                         drop_chance(skin, is);
                         drop_chance(skin, should);
                         expect_same(is, should, size, where);
                     });
    }
};

TEST_F(Mapped, VerticesAreWhereTheHostPutsThem) {
    for (const Carrier& c : carriers())
        for (const Deformation* d : {&c.twisted, &c.bent})
            expect_as_on_the_host(c, (*d)(c.body.positions), d->name);
}

TEST_F(Mapped, AlsoWhereNodesAreInDisorder) {
    std::mt19937 random(3);
    for (const Carrier& c : carriers()) {
        std::uniform_real_distribution<float> off(-0.1f * c.body.spacing, 0.1f * c.body.spacing);
        std::vector<vec3> nodes = c.twisted(c.body.positions);
        for (vec3& p : nodes) p += vec3(off(random), off(random), off(random));
        expect_as_on_the_host(c, nodes, "disorder");
    }
}

// Where nodes lie in one point, some of them or all of them, a direction may be chance, but it is one.
TEST_F(Mapped, AlsoWhereTrianglesCollapse) {
    auto expect_sound = [](const Embedding&, const Moved& is, const Moved& should, float size,
                           const std::string& where) {
        EXPECT_LE(largest(is.positions, should.positions), 1e-5f * size) << where;
        for (std::size_t i = 0; i < is.normals.size(); ++i) {
            // At the least lengths that floats have, they are rough.
            ASSERT_NEAR(glm::length(is.normals[i]), 1, 0.1) << where;
            ASSERT_NEAR(glm::length(vec3(is.tangents[i])), 1, 0.1) << where;
            ASSERT_NEAR(glm::dot(vec3(is.tangents[i]), is.normals[i]), 0, 0.1) << where;
        }
    };
    for (const Carrier& c : carriers()) {
        std::vector<vec3> nodes = c.body.positions;
        for (std::size_t i = 0; i + 1 < nodes.size(); i += 5) nodes[i + 1] = nodes[i];
        for_each_way(c, nodes, "pairs", expect_sound);
        nodes.assign(nodes.size(), vec3(0.1f, -0.2f, 0.3f));
        for_each_way(c, nodes, "one point", expect_sound);
    }
}

// Where Palpate's own text and that of an application are two shaders, or one.
TEST_F(Mapped, AnApplicationMayLinkItOrIncludeIt) {
    const Carrier c = quilt_on_a_cloth();
    const std::string version = "#version 450 core\n",
                      declared = "void map_vertex(out vec3 position, out vec3 normal, out vec4 tangent);\n",
                      own = R"(
        layout(location = 8) in vec3 colour;
        uniform mat4 to_clip;
        out vec3 shade;
        void main() {
            vec3 position, normal; vec4 tangent;
            map_vertex(position, normal, tangent);
            shade = colour * normal.z;
            gl_Position = to_clip * vec4(position, 1);
        })",
                      fragment = version + "in vec3 shade; out vec4 to; void main() { to = vec4(shade, 1); }";
    for (Mapping mapping : {Mapping::interpolated, Mapping::frames})
        for (bool in_textures : {false, true}) {
            const std::string text = GpuEmbedding(embed(c.surface, c.body, mapping)).shader(in_textures);
            EXPECT_NO_THROW(gl::Program({{GL_VERTEX_SHADER, "one", version + text + own},
                                         {GL_FRAGMENT_SHADER, "fragment", fragment}}));
            EXPECT_NO_THROW(gl::Program({{GL_VERTEX_SHADER, "own", version + declared + own},
                                         {GL_VERTEX_SHADER, "Palpate's", version + text},
                                         {GL_FRAGMENT_SHADER, "fragment", fragment}}));
        }
}

TEST_F(Mapped, ReachIsHowFarTheSurfaceIsFromItsNodes) {
    const Carrier over = quilt_on_a_cloth();
    EXPECT_NEAR(reach(over.surface, embed(over.surface, over.body, Mapping::frames)).beyond, 0.02f, 1e-4f);
    EXPECT_NEAR(reach(over.surface, embed(over.surface, over.body, Mapping::constant)).growth, 1, 0.01f);
    EXPECT_EQ(reach(over.surface, embed(over.surface, over.body, Mapping::one_to_one)).beyond, 0);
    // A ball round a box of cells, beyond which it bulges.
    const Mesh ball = ellipsoid(vec3(0.06f), 24);
    Body box = lattice({7, 7, 7}, 0.01f, {.youngs_modulus = 5000, .density = 1000});
    for (vec3& p : box.positions) p -= 0.03f;
    const Reach bulging = reach(ball, embed(ball, box, Mapping::trilinear));
    EXPECT_NEAR(bulging.beyond, 0.03f, 1e-4f);
    EXPECT_NEAR(bulging.growth, 2, 1e-3f);
    const Bounds around = bulging.around(bounds_of(box.positions));
    EXPECT_LE(glm::distance(around.low, vec3(-0.06f)) + glm::distance(around.high, vec3(0.06f)), 1e-4f);
}

// Counts every way by which OpenGL hands something back, by putting itself before them.
class ReadBacks {
 public:
    static inline int count = 0;

    ReadBacks() {
        count = 0;
        wrap<0>(epoxy_glReadPixels);
        wrap<1>(epoxy_glReadnPixels);
        wrap<2>(epoxy_glGetTexImage);
        wrap<3>(epoxy_glGetnTexImage);
        wrap<4>(epoxy_glGetTextureImage);
        wrap<5>(epoxy_glGetTextureSubImage);
        wrap<6>(epoxy_glGetBufferSubData);
        wrap<7>(epoxy_glGetNamedBufferSubData);
        wrap<8>(epoxy_glMapBuffer);
        wrap<9>(epoxy_glMapNamedBuffer);
        wrap<10>(epoxy_glMapBufferRange);
        wrap<11>(epoxy_glMapNamedBufferRange);
        wrap<12>(epoxy_glGetQueryObjectuiv);
        wrap<13>(epoxy_glGetQueryObjectui64v);
        wrap<14>(epoxy_glGetUniformfv);
        wrap<15>(epoxy_glFinish);
    }
    ~ReadBacks() {
        for (const auto& restore : restores_) restore();
    }

 private:
    template <int number, class Result, class... Arguments>
    void wrap(Result (*&entry)(Arguments...)) {
        static Result (*original)(Arguments...);
        original = entry;
        restores_.push_back([&entry] { entry = original; });
        entry = [](Arguments... arguments) -> Result {
            ++count;
            return original(arguments...);
        };
    }
    std::vector<std::function<void()>> restores_;
};

class MappedPictures : public Mapped {
 protected:
    void SetUp() override {
        Mapped::SetUp();
        if (context_) renderer_.emplace(Offscreen{320, 240}, &*context_);
    }
    void TearDown() override {
        renderer_.reset();
        Mapped::TearDown();
    }

    Image image(const Picture& picture) {
        renderer_->draw(picture);
        return renderer_->image();
    }

    // From aside and above.
    Picture around(const Bounds& box) const {
        const float size = glm::length(box.size());
        return {.camera = {.eye = box.centre() + size * vec3(0.4f, 0.5f, 1), .look_at = box.centre()}};
    }

    std::optional<Renderer> renderer_;
};

// Above a plate that shows the shadow, and makes the picture's extent the same.
TEST_F(MappedPictures, AreThoseOfTheHost) {
    const Mesh plate = relief({1, 1}, {1, 1}, [](vec2) { return 0.0f; });
    const int plate_number = renderer_->add(plate);
    // By turns twisted and bent: so each mapping is both, and the one carrier that has cells is both itself.
    bool is_turn_to_bend = false;
    for (const Carrier& c : carriers()) {
        is_turn_to_bend ^= true;
        for (Mapping mapping : every_mapping) {
            if (!can(c.body, mapping)) continue;
            const Embedding skin = embed(c.surface, c.body, mapping);
            const int number = renderer_->add(c.surface, skin);
            for (const Deformation* d : {&c.twisted, &c.bent}) {
                if (mapping != Mapping::trilinear && (d == &c.bent) != is_turn_to_bend) continue;
                const std::vector<vec3> nodes = (*d)(c.body.positions),
                                        normals = approximate_normals(c.body, nodes);
                const NodeBuffers buffers(nodes, normals);
                const NodeTextures textures(nodes, normals, 29);
                const Moved moved = follow(skin, c.body, nodes);
                const Bounds box = bounds_of(moved.positions);
                const float size = glm::length(box.size());
                std::vector<vec3> under;
                for (vec3 p : plate.positions)
                    under.push_back(vec3(box.centre().x, box.low.y, box.centre().z) +
                                    2 * size * vec3(p.x, 0, -p.y));
                const std::vector<vec3> up(under.size(), vec3(0, 1, 0));

                Picture picture = around(box);
                picture.surfaces = {{plate_number, under, up}};
                const Image empty = image(picture);
                picture.surfaces.push_back({number, moved.positions, moved.normals});
                const Image host = image(picture);
                EXPECT_GE(difference(host, empty).mean, 5);  // there is something to see
                for (const Surface& surface : {Surface{.mesh = number, .nodes = {nodes, normals}},
                                               Surface{.mesh = number, .gpu_nodes = buffers.nodes},
                                               Surface{.mesh = number, .gpu_nodes = textures.nodes}}) {
                    picture.surfaces.back() = surface;
                    const Difference off = difference(image(picture), host);
                    const std::string where = c.name + ", " + std::string(name_of(mapping)) + ", " + d->name;
                    EXPECT_LE(off.mean, 0.5) << where;
                    EXPECT_LE(off.share, 0.005) << where;
                }
            }
        }
    }
}

// Alone on the ground, whose looks go with the extent of the things: that is then reckoned from the nodes.
TEST_F(MappedPictures, AreNearlyThoseOfTheHostWhereOnlyNodesTellTheExtent) {
    for (const Carrier& c : carriers()) {
        const Embedding skin = embed(c.surface, c.body);
        const int number = renderer_->add(c.surface, skin);
        for (const Deformation* d : {&c.twisted, &c.bent}) {
            const std::vector<vec3> nodes = (*d)(c.body.positions),
                                    normals = approximate_normals(c.body, nodes);
            const NodeBuffers buffers(nodes, normals);
            const Moved moved = follow(skin, c.body, nodes);
            Picture picture = around(bounds_of(moved.positions));
            picture.grounds = {{.offset = bounds_of(moved.positions).low.y}};
            picture.surfaces = {{number, moved.positions, moved.normals}};
            const Image host = image(picture);
            picture.surfaces = {{.mesh = number, .gpu_nodes = buffers.nodes}};
            const Difference off = difference(image(picture), host);
            EXPECT_LE(off.mean, 2) << c.name << ", " << d->name;
            EXPECT_LE(off.share, 0.02) << c.name << ", " << d->name;
        }
    }
}

// Nodes that a shader moves are drawn without the host seeing any.
TEST_F(MappedPictures, NothingIsReadBackToDraw) {
    const Carrier c = organ_on_a_lattice();
    const gl::Program mover({{GL_COMPUTE_SHADER, "mover", R"(#version 450 core
        layout(local_size_x = 64) in;
        layout(std430, binding = 0) buffer Nodes { vec4 nodes[]; };
        void main() {
            uint i = gl_GlobalInvocationID.x;
            if (i < nodes.length()) nodes[i].x += nodes[i].z * nodes[i].z;
        })"}});
    for (Mapping mapping : every_mapping) {
        const int mesh = renderer_->add(c.surface, embed(c.surface, c.body, mapping));
        const std::vector<vec3> normals = approximate_normals(c.body, c.body.positions);
        const NodeBuffers nodes(c.body.positions, normals);
        Picture picture = around(bounds(c.surface));
        picture.surfaces = {{.mesh = mesh, .gpu_nodes = nodes.nodes}};
        const Image before = image(picture);
        const long reads = context_->reads();
        {
            ReadBacks read_backs;
            for (int frame = 0; frame < 5; ++frame) {
                glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, nodes.positions.name());
                mover.use();
                glDispatchCompute(GLuint(c.body.count() / 64 + 1), 1, 1);
                renderer_->draw(picture);
            }
            EXPECT_EQ(ReadBacks::count, 0) << name_of(mapping);
            EXPECT_EQ(context_->reads(), reads) << name_of(mapping);
            const Image after = renderer_->image();
            EXPECT_GE(ReadBacks::count, 1);  // that they are counted
            EXPECT_GE(difference(after, before).mean, 0.5);
        }
        EXPECT_EQ(context_->reads(), reads + 1);
    }
}

}  // namespace
}  // namespace palpate
