// Palpate in another OpenGL application, which has its own context, its own shaders and its own motion of the
// nodes on the GPU. Palpate only maps the surface onto them. Writes foreign.png.
#include <palpate/gl/context.h>
#include <palpate/gl/texture.h>
#include <palpate/palpate.h>
#include <palpate/render/gpu_embedding.h>

#include <epoxy/egl.h>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cstdio>

using namespace palpate;

// The application: an OpenGL 4.5 context without a window.
void open_context() {
    EGLDisplay display = EGL_NO_DISPLAY;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    if (!eglInitialize(display, nullptr, nullptr) || !eglBindAPI(EGL_OPENGL_API) ||
        !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                        eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted)))
        throw Error("no context without a surface", "OpenGL", "install libegl1 and libgl1-mesa-dri");
}

// Its motion: a twist about the y axis, in which each node turns by an angle proportional to its height.
const char* turning = R"(#version 450 core
layout(local_size_x = 64) in;
layout(std430, binding = 6) readonly buffer Rest { vec4 rest[]; };
layout(std430, binding = 7) writeonly buffer Now { vec4 now[]; };
uniform float time;
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= rest.length()) return;
    vec4 p = rest[i];
    float angle = 20 * sin(time) * p.y, c = cos(angle), s = sin(angle);
    now[i] = vec4(c * p.x + s * p.z + 3 * p.y * p.y, p.y, c * p.z - s * p.x, 1);
})";

// Its vertex shader, which calls Palpate's map_vertex(), and its fragment shader.
const char* vertex = R"(
layout(location = 8) in vec3 at_rest;
uniform mat4 to_clip;
out vec3 facing, rest;
void main() {
    vec3 position;
    vec4 tangent;
    map_vertex(position, facing, tangent);
    rest = at_rest;
    gl_Position = to_clip * vec4(position, 1);
})";
const char* fragment = R"(#version 450 core
in vec3 facing, rest;
out vec4 colour;
void main() {
    float band = smoothstep(-0.2, 0.2, sin(250 * rest.y));
    float light = 0.25 + 0.75 * max(dot(normalize(facing), normalize(vec3(0.5, 0.8, 0.6))), 0);
    colour = vec4(light * mix(vec3(0.95, 0.55, 0.15), vec3(0.15, 0.45, 0.75), band), 1);
})";

// A sponge, 60 x 120 x 60 mm: where a sum of waves is positive.
Mesh sponge() {
    Volume waves;
    waves.dims = {62, 122, 62};
    waves.spacing = vec3(0.001f);
    waves.origin = vec3(-0.0305f, -0.0605f, -0.0305f);
    for (int z = 0; z < waves.dims.z; ++z)
        for (int y = 0; y < waves.dims.y; ++y)
            for (int x = 0; x < waves.dims.x; ++x) {
                const vec3 p = waves.origin + waves.spacing * vec3(x, y, z), w = 210.0f * p + 0.5f;
                const vec3 inside = vec3(0.03f, 0.06f, 0.03f) - abs(p);
                const float wave = glm::dot(sin(w), cos(vec3(w.y, w.z, w.x))) + 0.75f;
                waves.values.push_back(std::min({wave, 300 * inside.x, 300 * inside.y, 300 * inside.z}));
            }
    Mesh mesh = isosurface(waves, 0);
    compute_normals(mesh);
    return mesh;
}

int main() try {
    open_context();
    const gl::Context context = gl::Context::adopt();

    // The surface is embedded in a cage of 4 x 7 x 4 nodes, of which only the positions matter.
    const Mesh mesh = sponge();
    Body cage = lattice(ivec3(4, 7, 4), 0.02f, {});
    for (vec3& p : cage.positions) p -= vec3(0.03f, 0.06f, 0.03f);
    const GpuEmbedding skin(embed(mesh, cage));

    // What the application adds: the triangles, and an attribute of its own.
    const gl::Buffer triangles(mesh.triangles), at_rest(mesh.positions);
    const GLuint corners = skin.vertex_array(), own = GpuEmbedding::free_attribute;
    glVertexArrayElementBuffer(corners, triangles.name());
    glVertexArrayVertexBuffer(corners, own, at_rest.name(), 0, sizeof(vec3));
    glVertexArrayAttribFormat(corners, own, 3, GL_FLOAT, GL_FALSE, 0);
    glEnableVertexArrayAttrib(corners, own);

    std::vector<vec4> rest;
    for (vec3 p : cage.positions) rest.emplace_back(p, 1);
    const gl::Buffer rest_nodes(rest), nodes = gl::Buffer::room(rest.size() * sizeof(vec4));
    const gl::Program mover({{GL_COMPUTE_SHADER, "turning", turning}});
    const gl::Program drawer({{GL_VERTEX_SHADER, "vertex", "#version 450 core\n" + skin.shader() + vertex},
                              {GL_FRAGMENT_SHADER, "fragment", fragment}});

    const int width = 480, height = 640;
    const gl::Texture colours(GL_SRGB8_ALPHA8, width, height), depths(GL_DEPTH_COMPONENT24, width, height);
    const gl::Framebuffer picture;
    glNamedFramebufferTexture(picture.name(), GL_COLOR_ATTACHMENT0, colours.name(), 0);
    glNamedFramebufferTexture(picture.name(), GL_DEPTH_ATTACHMENT, depths.name(), 0);
    glBindFramebuffer(GL_FRAMEBUFFER, picture.name());
    glViewport(0, 0, width, height);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glEnable(GL_DEPTH_TEST);
    glClearColor(0.8f, 0.82f, 0.85f, 1);

    drawer.set("to_clip", glm::perspective(0.6f, float(width) / height, 0.1f, 1.0f) *
                              glm::lookAt(vec3(0.15f, 0.1f, 0.25f), vec3(0.02f, 0, 0), vec3(0, 1, 0)));
    for (int frame = 1; frame <= 30; ++frame) {
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, rest_nodes.name());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, nodes.name());
        mover.use();
        mover.set("time", frame / 30.0f);
        glDispatchCompute(GLuint(rest.size() + 63) / 64, 1, 1);

        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        skin.bind({.positions = nodes.name(), .count = rest.size()});
        drawer.use();
        glDrawElements(GL_TRIANGLES, GLsizei(3 * mesh.triangles.size()), GL_UNSIGNED_INT, nullptr);
    }

    Image shown{width, height, std::vector<std::uint8_t>(4 * width * height)};
    context.read_texture(colours.name(), GL_RGBA, GL_UNSIGNED_BYTE,
                         std::as_writable_bytes(std::span(shown.pixels)));
    for (int y = 0; y < height / 2; ++y)  // OpenGL's rows run bottom to top
        std::swap_ranges(&shown.pixels[4 * width * y], &shown.pixels[4 * width * (y + 1)],
                         &shown.pixels[4 * width * (height - 1 - y)]);
    write_png(shown, "foreign.png");
    std::printf("%zu vertices on %zu nodes, 30 frames on %s; see foreign.png\n", mesh.positions.size(),
                rest.size(), context.renderer().c_str());
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
