#include "palpate/gl/context.h"

#include "palpate/base/error.h"
#include "palpate/gl/visit.h"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

namespace palpate::gl {
namespace {

constexpr const char* where = "OpenGL";
constexpr const char* remedy =
    "install libegl1, libopengl0 and libgl1-mesa-dri, or the graphics card's driver";

bool can_load(const char* library) {
    void* handle = dlopen(library, RTLD_LAZY);
    if (handle) dlclose(handle);
    return handle != nullptr;
}

// epoxy ends the program if a library is missing, so check first.
void require_libraries() {
    if (!can_load("libEGL.so.1")) throw Error("libEGL.so.1 is missing", where, remedy);
    if (!can_load("libOpenGL.so.0") && !can_load("libGL.so.1"))
        throw Error("libOpenGL.so.0 is missing", where, remedy);
}

constexpr int oldest = 45;  // direct state access; a card with 4.3's compute shaders has a driver with it

// Whether a context is current, of EGL or of another system, whose library is then loaded.
bool has_current_context() {
    if (eglGetCurrentContext() != EGL_NO_CONTEXT) return true;
    using Current = void* (*)();
    void* glx = dlopen("libGLX.so.0", RTLD_LAZY | RTLD_NOLOAD);
    if (!glx) return false;
    const auto current = reinterpret_cast<Current>(dlsym(glx, "glXGetCurrentContext"));
    dlclose(glx);
    return current && current() != nullptr;
}

std::string in_words(int version) { return fmt::format("{}.{}", version / 10, version % 10); }

bool is_software(EGLDeviceEXT device) {
    const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
    return extensions &&
           std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos;
}

// The displays to try, the best first. Mesa's surfaceless display does not see cards of other vendors'
// drivers, so the cards come before it; a software device comes last, for a Mesa without the surfaceless
// platform.
std::vector<EGLDisplay> displays() {
    std::vector<EGLDisplay> cards, rest;
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_MESA_platform_surfaceless"))
        rest.push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
    if (epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_platform_device")) {
        std::array<EGLDeviceEXT, 16> devices{};
        EGLint count = 0;
        eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count);
        for (int i = 0; i < count; ++i)
            (is_software(devices[i]) ? rest : cards)
                .push_back(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    }
    cards.insert(cards.end(), rest.begin(), rest.end());
    return cards;
}

// The newest version of core OpenGL that a display offers; 0 if it has none.
int newest(EGLDisplay display) {
    eglBindAPI(EGL_OPENGL_API);
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 2, EGL_NONE};
    EGLContext context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    if (context == EGL_NO_CONTEXT) return 0;
    const bool usable = eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context);
    const int version = usable ? epoxy_gl_version() : 0;
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
    return version;
}

// A debug context, because only that is guaranteed to report errors; we make few calls, so it costs little. A
// robust context reports when the card has lost it; not every driver offers that.
EGLContext create(EGLDisplay display, bool robust) {
    eglBindAPI(EGL_OPENGL_API);
    const EGLint attributes[][2] = {
        {EGL_CONTEXT_MAJOR_VERSION, 4},
        {EGL_CONTEXT_MINOR_VERSION, 5},
        {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT},
        {EGL_CONTEXT_OPENGL_DEBUG, EGL_TRUE},
        {robust ? EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY : EGL_NONE, EGL_LOSE_CONTEXT_ON_RESET},
        {EGL_NONE, EGL_NONE}};
    // No config, because there is no surface that it could describe.
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes[0]);
}

// The context owns both objects, which are deleted with it.
void bind_one_pixel() {
    GLuint pixel = 0, framebuffer = 0;
    glCreateRenderbuffers(1, &pixel);
    glNamedRenderbufferStorage(pixel, GL_RGBA8, 1, 1);
    glCreateFramebuffers(1, &framebuffer);
    glNamedFramebufferRenderbuffer(framebuffer, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, pixel);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

std::string text(GLenum what) {
    const GLubyte* bytes = glGetString(what);
    return bytes ? reinterpret_cast<const char*>(bytes) : "unknown";
}

template <class Number = int>
Number number(GLenum what) {
    GLint64 value = 0;
    glGetInteger64v(what, &value);
    return static_cast<Number>(value);
}

// How many float textures can be attached and drawn into at once.
int float_targets() {
    GLint can = GL_FALSE;
    glGetInternalformativ(GL_TEXTURE_2D, GL_RGBA32F, GL_FRAMEBUFFER_RENDERABLE, 1, &can);
    if (can == GL_NONE) return 0;
    return std::min(number(GL_MAX_DRAW_BUFFERS), number(GL_MAX_COLOR_ATTACHMENTS));
}

}  // namespace

// On the heap, at a fixed address for the driver's debug callback, wherever the Context moves.
struct Context::Parts {
    bool adopted = false;
    // Never terminated: all contexts of the process share a display, and eglTerminate would end them all.
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::string renderer, version, vendor, egl, first_error;
    int errors = 0;
    long reads = 0;

    static std::unique_ptr<Parts> make();
    static std::unique_ptr<Parts> adopt();
    Parts() = default;
    ~Parts();
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;

    void find();
    bool open(EGLDisplay candidate);
    void name();
    void listen();
};

std::unique_ptr<Context::Parts> Context::Parts::adopt() {
    auto parts = std::make_unique<Parts>();
    parts->adopted = true;
    // epoxy ends the program if it is called without a context.
    if (!can_load("libEGL.so.1") || !has_current_context())
        throw Error("no context is current on this thread", where, "make the window's context current first");
    parts->name();
    if (const int version = epoxy_gl_version(); version < oldest)
        throw Error(fmt::format("this context has version {}, but {} core is needed", in_words(version),
                                in_words(oldest)),
                    where, "ask the window for a newer one, or update the graphics card's driver");
    return parts;
}

std::unique_ptr<Context::Parts> Context::Parts::make() {
    auto parts = std::make_unique<Parts>();
    parts->find();
    parts->name();
    parts->egl = fmt::format("{}, {}", eglQueryString(parts->display, EGL_VERSION),
                             eglQueryString(parts->display, EGL_VENDOR));
    parts->listen();
    bind_one_pixel();
    return parts;
}

void Context::Parts::name() {
    renderer = text(GL_RENDERER);
    version = text(GL_VERSION);
    vendor = text(GL_VENDOR);
}

void Context::Parts::find() {
    require_libraries();
    std::vector<EGLDisplay> usable;
    for (EGLDisplay candidate : displays())
        if (eglInitialize(candidate, nullptr, nullptr)) usable.push_back(candidate);
    for (EGLDisplay candidate : usable)
        if (open(candidate)) return;
    if (usable.empty()) throw Error("no display for drawing without a window", where, remedy);
    int found = 0;
    for (EGLDisplay candidate : usable) found = std::max(found, newest(candidate));
    if (found == 0)
        throw Error(fmt::format("no driver has version {} core", in_words(oldest)), where, remedy);
    throw Error(
        fmt::format("the driver has version {}, but {} core is needed", in_words(found), in_words(oldest)),
        where, "update the graphics card's driver, or install libgl1-mesa-dri of 2020 or later");
}

Context::Parts::~Parts() {
    if (adopted || context == EGL_NO_CONTEXT) return;
    if (eglGetCurrentContext() == context)
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, context);
}

bool Context::Parts::open(EGLDisplay candidate) {
    EGLContext created = create(candidate, true);
    if (created == EGL_NO_CONTEXT) created = create(candidate, false);
    if (created == EGL_NO_CONTEXT) return false;
    if (!eglMakeCurrent(candidate, EGL_NO_SURFACE, EGL_NO_SURFACE, created)) {
        eglDestroyContext(candidate, created);
        return false;
    }
    display = candidate;
    context = created;
    return true;
}

void Context::Parts::listen() {
    glDebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    glDebugMessageControl(GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);  // so an error is counted before its call returns
    auto count = [](GLenum, GLenum, GLuint, GLenum, GLsizei, const GLchar* message, const void* to) {
        auto& parts = *static_cast<Parts*>(const_cast<void*>(to));
        if (parts.errors++ == 0) parts.first_error = message;
    };
    glDebugMessageCallback(count, this);
}

Context::Context() : parts_(Parts::make()) {}
Context::Context(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Context Context::adopt() { return Context(Parts::adopt()); }
Context::~Context() = default;
Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;

void Context::make_current() const {
    if (!parts_->adopted) {
        eglBindAPI(EGL_OPENGL_API);
        if (!eglMakeCurrent(parts_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, parts_->context))
            throw Error("the context cannot be used from this thread", where,
                        "end the thread that used it before, or draw on that thread");
    }
    if (glGetGraphicsResetStatus() != GL_NO_ERROR)
        throw Error("the graphics card has lost the context and everything in it", where,
                    "start again; if it happens again, use smaller bodies or pictures, or update the driver");
}

void Context::make_current_or_not() const noexcept {
    try {
        make_current();
    } catch (const Error&) {}
}

void Context::read(unsigned buffer, std::span<std::byte> to) const {
    ++parts_->reads;
    glGetNamedBufferSubData(buffer, 0, static_cast<GLsizeiptr>(to.size()), to.data());
}

void Context::read_texture(unsigned texture, unsigned format, unsigned type, std::span<std::byte> to) const {
    ++parts_->reads;
    const Visit visit;
    glGetTextureImage(texture, 0, format, type, static_cast<GLsizei>(to.size()), to.data());
}

void Context::finish() const { glFinish(); }

long Context::reads() const { return parts_->reads; }

const std::string& Context::renderer() const { return parts_->renderer; }
const std::string& Context::version() const { return parts_->version; }
const std::string& Context::vendor() const { return parts_->vendor; }
const std::string& Context::egl() const { return parts_->egl; }

bool Context::software() const {
    for (const char* name : {"llvmpipe", "softpipe", "lavapipe", "SwiftShader", "Software Rasterizer"})
        if (parts_->renderer.find(name) != std::string::npos) return true;
    return false;
}

Limits Context::limits() const {
    make_current();
    return {.buffer_texels = number<long>(GL_MAX_TEXTURE_BUFFER_SIZE),
            .storage_bytes = number<long>(GL_MAX_SHADER_STORAGE_BLOCK_SIZE),
            .vertex_storage_buffers = number(GL_MAX_VERTEX_SHADER_STORAGE_BLOCKS),
            .compute_storage_buffers = number(GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS),
            .vertex_textures = number(GL_MAX_VERTEX_TEXTURE_IMAGE_UNITS),
            .fragment_textures = number(GL_MAX_TEXTURE_IMAGE_UNITS),
            .compute_textures = number(GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS),
            .captured_buffers = number(GL_MAX_TRANSFORM_FEEDBACK_SEPARATE_ATTRIBS),
            .float_targets = float_targets(),
            .texture_side = number(GL_MAX_TEXTURE_SIZE),
            .group = number(GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS),
            .shared_bytes = number(GL_MAX_COMPUTE_SHARED_MEMORY_SIZE)};
}

int Context::errors() const { return parts_->errors; }
const std::string& Context::first_error() const { return parts_->first_error; }

}  // namespace palpate::gl
