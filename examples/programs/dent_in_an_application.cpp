// An OpenGL application in which a dent is felt but not seen, until Palpate shows it. All of it is the
// application's own, except 8 lines: those added end with "// +", those changed with "// + was:". (In place
// of a window, Palpate also writes its picture.) Writes dent.png.
#include <palpate/palpate.h>
#include <palpate/render/gpu_dents.h>  // +

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using glm::vec3;

const char* vertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
uniform mat4 to_clip;
out vec3 place, facing;
void main() {
    place = position;
    facing = normal;
    gl_Position = to_clip * vec4(dented(position, normal), 1);  // + was: vec4(position, 1);
})";
const char* fragment = R"(
in vec3 place, facing;
out vec4 colour;
uniform vec3 eye;
void main() {
    vec3 normal = dented_normal(place, normalize(facing));  // + was: normalize(facing);
    vec3 to_eye = normalize(eye - place), to_light = normalize(vec3(-0.7, 0.8, 0.3));
    float light = 0.15 + 0.85 * max(dot(normal, to_light), 0);
    float glint = pow(max(dot(normal, normalize(to_eye + to_light)), 0), 60);
    float stripe = smoothstep(-0.1, 0.1, sin(400 * place.x));
    colour = vec4(light * mix(vec3(0.7, 0.3, 0.25), vec3(0.85, 0.5, 0.4), stripe) + 0.3 * glint, 1);
})";

GLuint shader(GLenum stage, const char* main) {
    const std::string text = "#version 450 core\n" + palpate::GpuDents::shader() + main;  // + was: + main;
    const char* start = text.c_str();
    const GLuint made = glCreateShader(stage);
    glShaderSource(made, 1, &start, nullptr);
    glCompileShader(made);
    return made;
}

GLuint program() {
    const GLuint made = glCreateProgram();
    glAttachShader(made, shader(GL_VERTEX_SHADER, vertex));
    glAttachShader(made, shader(GL_FRAGMENT_SHADER, fragment));
    glLinkProgram(made);
    return made;
}

struct Corner {
    vec3 position, normal;
};

// A cushion: an ellipsoid with half-axes of 0.1, 0.06 and 0.08 m, in rings of vertices around the y axis.
const vec3 half_axes(0.1f, 0.06f, 0.08f);
Corner on_the_cushion(float across, float down) {
    const vec3 direction(std::sin(down) * std::sin(across), std::cos(down),
                         std::sin(down) * std::cos(across));
    return {half_axes * direction, glm::normalize(direction / half_axes)};
}

// A thumb and a finger as the application's haptic library reports them: where each first touched the
// cushion, and how deep it is now, m.
struct Touch {
    vec3 contact;
    float depth;
};
std::array<Touch, 2> touches(float time) {
    return {{{on_the_cushion(-0.25f, 1.1f).position, 0.018f * time},
             {on_the_cushion(0.55f, 0.8f).position, 0.012f * time}}};
}

bool open_context() {
    EGLDisplay display = EGL_NO_DISPLAY;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    const EGLint wanted[] = {EGL_CONTEXT_MAJOR_VERSION, 4, EGL_CONTEXT_MINOR_VERSION, 5, EGL_NONE};
    return eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API) &&
           eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE,
                          eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, wanted));
}

int main() {
    if (!open_context()) return std::fprintf(stderr, "no context without a surface in OpenGL\n"), 1;
    const int rings = 100, sides = 200;
    std::vector<Corner> corners;
    std::vector<unsigned> triangles;
    for (int i = 0; i <= rings; ++i)
        for (int j = 0; j <= sides; ++j) {
            corners.push_back(
                on_the_cushion(2 * glm::pi<float>() * float(j) / sides, glm::pi<float>() * float(i) / rings));
            const unsigned here = unsigned(corners.size() - 1), below = here + sides + 1;
            if (i < rings && j < sides)
                triangles.insert(triangles.end(), {here, below, below + 1, here, below + 1, here + 1});
        }
    GLuint buffers[2], arrays;
    glCreateBuffers(2, buffers);
    glNamedBufferStorage(buffers[0], GLsizeiptr(corners.size() * sizeof(Corner)), corners.data(), 0);
    glNamedBufferStorage(buffers[1], GLsizeiptr(triangles.size() * sizeof(unsigned)), triangles.data(), 0);
    glCreateVertexArrays(1, &arrays);
    glVertexArrayVertexBuffer(arrays, 0, buffers[0], 0, sizeof(Corner));
    glVertexArrayElementBuffer(arrays, buffers[1]);
    for (GLuint k : {0u, 1u}) {
        glEnableVertexArrayAttrib(arrays, k);
        glVertexArrayAttribFormat(arrays, k, 3, GL_FLOAT, GL_FALSE, k * sizeof(vec3));
        glVertexArrayAttribBinding(arrays, k, 0);
    }

    const int width = 640, height = 480;
    GLuint picture, targets[2];
    glCreateFramebuffers(1, &picture);
    glCreateRenderbuffers(2, targets);
    glNamedRenderbufferStorage(targets[0], GL_SRGB8_ALPHA8, width, height);
    glNamedRenderbufferStorage(targets[1], GL_DEPTH_COMPONENT24, width, height);
    glNamedFramebufferRenderbuffer(picture, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, targets[0]);
    glNamedFramebufferRenderbuffer(picture, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, targets[1]);
    glBindFramebuffer(GL_FRAMEBUFFER, picture);
    glViewport(0, 0, width, height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glClearColor(0.8f, 0.82f, 0.85f, 1);

    const vec3 eye(0.05f, 0.16f, 0.26f);
    const glm::mat4 to_clip =
        glm::perspective(0.65f, float(width) / height, 0.1f, 1.0f) * glm::lookAt(eye, vec3(0), vec3(0, 1, 0));
    const GLuint drawer = program();
    palpate::GpuDents dents;  // +
    glUseProgram(drawer);
    glUniformMatrix4fv(glGetUniformLocation(drawer, "to_clip"), 1, GL_FALSE, glm::value_ptr(to_clip));
    glUniform3fv(glGetUniformLocation(drawer, "eye"), 1, glm::value_ptr(eye));
    glBindVertexArray(arrays);
    for (int frame = 1; frame <= 30; ++frame) {
        const auto [thumb, finger] = touches(frame / 30.0f);
        const palpate::Dent now[] = {{thumb.contact, thumb.depth}, {finger.contact, finger.depth}};  // +
        dents.set(now);                                                                              // +
        dents.bind();                                                                                // +
        glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
        glDrawElements(GL_TRIANGLES, GLsizei(triangles.size()), GL_UNSIGNED_INT, nullptr);
    }

    palpate::Image shown{width, height, std::vector<std::uint8_t>(4 * width * height)};
    for (int y = 0; y < height; ++y)  // OpenGL's rows run bottom to top
        glReadPixels(0, height - 1 - y, width, 1, GL_RGBA, GL_UNSIGNED_BYTE,
                     &shown.pixels[std::size_t(4 * width * y)]);
    palpate::write_png(shown, "dent.png");
    std::printf("%zu triangles with two dents, 30 frames; see dent.png\n", triangles.size() / 3);
}
