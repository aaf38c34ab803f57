// node.inl and pass.inl are also GLSL: compute and transform-feedback shaders around the same text compile.
#include "palpate/base/error.h"
#include "palpate/base/files.h"
#include "palpate/gl/context.h"
#include "palpate/gl/program.h"

#include <gtest/gtest.h>

#include <optional>

namespace palpate {
namespace {

const std::string folder = PALPATE_SOURCE_DIR "/palpate/solver/";

std::string physics() {
    return "#define FN\n#define ASIDE\n#define UNROLL\n#define LINKS pass.links\n#define Real float\n#define "
           "Real3 "
           "vec3\n"
           "#define select(c, a, b) ((c) ? (a) : (b))\n#define any_node(c) (c)\n" +
           read_text(folder + "pass.inl") + "layout(std140, binding = 0) uniform Uniforms { Pass pass; };\n";
}

// What a backend tells the physics of a node, besides its neighbours; and the physics.
std::string eyes() {
    return R"(
        layout(binding = 2) uniform samplerBuffer corners;
        layout(binding = 3) uniform sampler3D distances;
        float share(int l) { return 1.0; }
        float stiffness(int l) { return pass.spring[l].stiffness; }
        float tension(int l) { return pass.spring[l].tension; }
        float longest(int l) { return pass.spring[l].longest; }
        float neighbour(int l) { return 1.0; }
        vec3 origin() { return vec3(0); }
        float area() { return 1.0; }
        float cover() { return 0.0; }
        float held(int i) { return 0.0; }
        vec3 corner(int i) { return texelFetch(corners, i).xyz; }
        float distance_at(int i, vec3 p) { return texture(distances, p).w; }
        vec3 uphill_at(int i, vec3 p) { return texture(distances, p).xyz; }
    )" + read_text(folder + "node.inl") +
           read_text(folder + "obstacles.inl");
}

std::string compute_shader() {
    return "#version 430 core\nlayout(local_size_x = 64) in;\n" + physics() + R"(
        struct Stored { vec4 position, velocity; };
        layout(std430, binding = 0) readonly buffer Now { Stored now[]; };
        layout(std430, binding = 1) writeonly buffer Next { Stored next[]; };
        int id;
        vec3 toward(vec3 p, int l) { return now[id + l + 1].position.xyz - p; }
        vec3 passing(vec3 v, int l) { return now[id + l + 1].velocity.xyz - v; })" +
           eyes() + R"(
        void main() {
            id = int(gl_GlobalInvocationID.x);
            Node node = Node(now[id].position.xyz, now[id].velocity.xyz, now[id].position.w);
            node = collide(integrate(node, node, acceleration(node)), node.position);
            next[id] = Stored(vec4(node.position, node.inverse_mass), vec4(node.velocity, 0));
        })";
}

std::string feedback_shader() {
    return "#version 430 core\n" + physics() + R"(
        layout(location = 0) in vec4 position;
        layout(location = 1) in vec3 velocity;
        layout(binding = 0) uniform samplerBuffer positions;
        out vec3 next_position, next_velocity;
        layout(binding = 1) uniform samplerBuffer velocities;
        vec3 toward(vec3 p, int l) { return texelFetch(positions, gl_VertexID + l + 1).xyz - p; }
        vec3 passing(vec3 v, int l) { return texelFetch(velocities, gl_VertexID + l + 1).xyz - v; })" +
           eyes() + R"(
        void main() {
            Node node = Node(position.xyz, velocity, position.w);
            node = collide(integrate(node, node, acceleration(node)), node.position);
            next_position = node.position;
            next_velocity = node.velocity;
        })";
}

std::optional<gl::Context> context() {
    try {
        return gl::Context();
    } catch (const Error& error) {
        return std::nullopt;
    }
}

TEST(Shader, ThePhysicsCompilesAsCompute) {
    const auto gl = context();
    if (!gl) GTEST_SKIP() << "OpenGL is not available";
    EXPECT_NO_THROW(gl::Program({{GL_COMPUTE_SHADER, "compute", compute_shader()}}));
}

TEST(Shader, ThePhysicsCompilesAsTransformFeedback) {
    const auto gl = context();
    if (!gl) GTEST_SKIP() << "OpenGL is not available";
    EXPECT_NO_THROW(gl::Program({{GL_VERTEX_SHADER, "feedback", feedback_shader()}}));
}

// The mappings' text is GLSL as well.
TEST(Shader, TheMappingsCompileAsCompute) {
    const auto gl = context();
    if (!gl) GTEST_SKIP() << "OpenGL is not available";
    const std::string source =
        "#version 430 core\nlayout(local_size_x = 64) in;\n#define FN\n#define Real float\n#define Real3 "
        "vec3\n"
        "#define select(c, a, b) ((c) ? (a) : (b))\n#define x_of(v) (v).x\n" +
        read_text(PALPATE_SOURCE_DIR "/palpate/body/mapping.inl") + R"(
        layout(std430, binding = 0) buffer Places { vec4 place[]; };
        void main() {
            vec3 corner[8];
            for (int k = 0; k < 8; ++k) corner[k] = place[k].xyz;
            Followed f = in_cell(corner, 0.1, 0.2, 0.3);
            vec3 normal = normal_by_cofactors(f, 0, 1, 0, vec3(0, 1, 0));
            Followed t = on_triangle(corner[0], corner[1], corner[2], clear_direction(corner[3]), 0.5);
            place[9].xyz = f.position + upright(expand(t, 1, 0, 0), normal);
        })";
    EXPECT_NO_THROW(gl::Program({{GL_COMPUTE_SHADER, "mapping", source}}));
}

TEST(Shader, AMistakeInItIsFound) {
    const auto gl = context();
    if (!gl) GTEST_SKIP() << "OpenGL is not available";
    EXPECT_THROW(gl::Program({{GL_COMPUTE_SHADER, "broken", compute_shader() + "float half;"}}), Error);
}

}  // namespace
}  // namespace palpate
