#include "palpate/render/ambient_occlusion.h"

#include "palpate/render/view.h"

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

constexpr int lights = 64;
constexpr int map_size = 512;
constexpr int occlusion_group = 256;  // as in ambient_occlusion.comp

const char* ambient_occlusion_comp =
#include "embedded/ambient_occlusion.comp.h"
    ;

// A direction. They are spread evenly over the sphere: a Fibonacci spiral, by the golden angle.
vec3 spread(int i) {
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    const double z = 1 - (2 * i + 1.0) / lights;
    const double r = std::sqrt(1 - z * z);
    return vec3(r * std::cos(golden * i), r * std::sin(golden * i), z);
}

std::vector<vec3> normals_of(const Mesh& mesh) {
    if (!mesh.normals.empty()) return mesh.normals;
    std::vector<vec3> normals;
    compute_normals(mesh.positions, mesh.triangles, normals);
    return normals;
}

}  // namespace

AmbientOcclusion::AmbientOcclusion()
    : map_(map_size), gather_({{GL_COMPUTE_SHADER, "ambient_occlusion.comp", ambient_occlusion_comp}}) {}

gl::Buffer AmbientOcclusion::measure(const Mesh& mesh, const gl::Program& depth) const {
    const std::vector<float> none(mesh.positions.size(), 0.0f);
    gl::Buffer ambient_occlusion(none);
    const gl::Buffer positions(mesh.positions);
    const gl::Buffer normals(normals_of(mesh));
    const gl::Buffer triangles(mesh.triangles);
    const Extent extent = around(bounds_of(mesh.positions));

    gl::VertexArray corners;
    glEnableVertexArrayAttrib(corners.name(), 0);
    glVertexArrayAttribFormat(corners.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayVertexBuffer(corners.name(), 0, positions.name(), 0, sizeof(vec3));
    glVertexArrayElementBuffer(corners.name(), triangles.name());
    glBindVertexArray(corners.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, positions.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, normals.name());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 2, ambient_occlusion.name());
    map_.bind();

    gather_.set("lift", 3 * extent.radius / map_size);
    gather_.set("share", 4.0f / lights);  // a free surface faces half of the lights, at one half on average
    depth.set("centre", vec3(0));
    depth.set("size", 1.0f);
    for (int i = 0; i < lights; ++i) {
        const vec3 to_light = spread(i);
        const mat4 to_clip = light_projection(-to_light, extent);
        map_.begin();
        depth.use();
        depth.set("to_clip", to_clip);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * mesh.triangles.size()), GL_UNSIGNED_INT,
                       nullptr);

        gather_.use();
        gather_.set("to_shadow", to_texture(to_clip));
        gather_.set("to_light", to_light);
        glDispatchCompute(
            static_cast<GLuint>((mesh.positions.size() + occlusion_group - 1) / occlusion_group), 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
    }
    return ambient_occlusion;
}

}  // namespace palpate
