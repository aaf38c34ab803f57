#include "palpate/gl/context.h"

#include "palpate/base/error.h"
#include "palpate/gl/buffer.h"
#include "palpate/gl/program.h"
#include "palpate/gl/texture.h"
#include "tests/gl/with_context.h"
#include "tests/refusal.h"

#include <epoxy/egl.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace palpate::gl {
namespace {

// What doubles its numbers.
constexpr const char* doubling = R"(#version 450 core
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Numbers { float numbers[]; };
uniform float factor;
void main() { numbers[gl_GlobalInvocationID.x] *= factor; }
)";

using Gl = WithContext;

std::string refusal(std::initializer_list<Shader> shaders) {
    return palpate::refusal([&] { Program program(shaders); });
}

std::vector<float> contents(const Buffer& buffer, std::size_t count) {
    std::vector<float> values(count);
    glGetNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(count * sizeof(float)), values.data());
    return values;
}

TEST_F(Gl, NamesItsDriver) {
    EXPECT_FALSE(context_->renderer().empty());
    EXPECT_GE(context_->version(), "4.5");
}

TEST_F(Gl, HasAFramebufferFromTheStart) {
    EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
}

TEST_F(Gl, CountsErrorsAndKeepsTheFirst) {
    Context other;
    glEnable(0xffff);
    const std::string first = other.first_error();
    glBindBuffer(0xffff, 0);
    EXPECT_EQ(other.errors(), 2);
    EXPECT_FALSE(first.empty());
    EXPECT_EQ(other.first_error(), first);
}

TEST_F(Gl, ReportsErrorsWhereverItMoves) {
    Context first;
    Context second = std::move(first);
    glEnable(0xffff);
    EXPECT_EQ(second.errors(), 1);
}

TEST_F(Gl, ContextsAreApartAndOutliveEachOther) {
    Buffer ours(std::array{1.0f, 2.0f});
    {
        Context other;
        EXPECT_FALSE(glIsBuffer(ours.name()));
        context_->make_current();
    }
    EXPECT_TRUE(glIsBuffer(ours.name()));
    EXPECT_EQ(contents(ours, 2), (std::vector{1.0f, 2.0f}));
}

TEST_F(Gl, BuffersHoldWhatTheyWereGiven) {
    const std::vector values{1.0f, -2.5f, 3e9f};
    Buffer fixed(values);
    EXPECT_EQ(contents(fixed, 3), values);

    Buffer changing;
    changing.upload(values);
    EXPECT_EQ(contents(changing, 3), values);
    changing.upload(std::vector{7.0f});
    EXPECT_EQ(contents(changing, 1), std::vector{7.0f});
    changing.upload(std::vector<float>{});
    Buffer nothing(std::vector<float>{});
}

TEST_F(Gl, HandlesMoveAndDelete) {
    static_assert(!std::is_copy_constructible_v<Buffer> && std::is_nothrow_move_constructible_v<Buffer>);
    GLuint name = 0;
    {
        Buffer first(std::array{1.0f});
        name = first.name();
        Buffer second = std::move(first);
        EXPECT_EQ(first.name(), 0u);
        EXPECT_EQ(second.name(), name);
        Buffer third;
        third = std::move(second);
        EXPECT_EQ(third.name(), name);
        EXPECT_TRUE(glIsBuffer(name));
    }
    EXPECT_FALSE(glIsBuffer(name));
}

TEST_F(Gl, ProgramsRunAndTakeUniforms) {
    Program program({{GL_COMPUTE_SHADER, "doubling.comp", doubling}});
    Buffer numbers(std::array{1.0f, 2.0f, 4.0f});
    program.set("factor", 2.0f);
    program.set("unknown", vec3(1));  // ignored
    program.use();
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, numbers.name());
    glDispatchCompute(3, 1, 1);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    EXPECT_EQ(contents(numbers, 3), (std::vector{2.0f, 4.0f, 8.0f}));
}

TEST_F(Gl, AProgramThatCannotCompileNamesItsFileInOneLine) {
    const std::string what =
        refusal({{GL_VERTEX_SHADER, "odd.vert", "#version 450 core\nvoid main() { oops; }\n"}});
    EXPECT_NE(what.find("odd.vert"), std::string::npos) << what;
    EXPECT_NE(what.find("oops"), std::string::npos) << what;
}

TEST_F(Gl, AProgramThatCannotLinkNamesItsFilesInOneLine) {
    const char* calls = "#version 450 core\nvoid missing();\nvoid main() { missing(); }\n";
    const std::string what = refusal({{GL_VERTEX_SHADER, "calls.vert", calls}});
    EXPECT_NE(what.find("calls.vert"), std::string::npos) << what;
    EXPECT_NE(what.find("missing"), std::string::npos) << what;
}

TEST_F(Gl, ShadersOfOneStageAreLinkedTogether) {
    const char* calls = "#version 450 core\nvec4 there();\nvoid main() { gl_Position = there(); }\n";
    const char* defines = "#version 450 core\nvec4 there() { return vec4(1); }\n";
    EXPECT_EQ(refusal({{GL_VERTEX_SHADER, "calls.vert", calls}, {GL_VERTEX_SHADER, "defines.vert", defines}}),
              "");
}

TEST_F(Gl, TexturesCanBeDrawnInto) {
    for (int samples : {1, 4}) {
        Texture texture(GL_RGBA8, 16, 8, samples);
        Framebuffer framebuffer;
        glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
        EXPECT_EQ(glCheckNamedFramebufferStatus(framebuffer.name(), GL_FRAMEBUFFER),
                  static_cast<GLenum>(GL_FRAMEBUFFER_COMPLETE));
    }
}

TEST_F(Gl, SaysWhatItCanTake) {
    const Limits limits = context_->limits();
    // What OpenGL 4.5 promises.
    EXPECT_GE(limits.buffer_texels, 65536);
    EXPECT_GE(limits.storage_bytes, 1 << 24);
    EXPECT_GE(limits.vertex_storage_buffers, 0);
    EXPECT_GE(limits.compute_storage_buffers, 8);
    EXPECT_GE(limits.vertex_textures, 16);
    EXPECT_GE(limits.fragment_textures, 16);
    EXPECT_GE(limits.compute_textures, 16);
    EXPECT_GE(limits.captured_buffers, 4);
    EXPECT_GE(limits.float_targets, 8);
    EXPECT_GE(limits.texture_side, 16384);
    EXPECT_GE(limits.group, 1024);
    EXPECT_GE(limits.shared_bytes, 32768);
    EXPECT_FALSE(context_->vendor().empty());
    EXPECT_TRUE(context_->egl().starts_with("1.")) << context_->egl();
    EXPECT_EQ(context_->software(), context_->renderer().find("llvmpipe") != std::string::npos);
}

TEST_F(Gl, ReadsAreCounted) {
    const std::array values{1.0f, 2.0f, 3.0f, 4.0f};
    Buffer buffer(values);
    Texture texture(GL_RGBA32F, 1, 1);
    glTextureSubImage2D(texture.name(), 0, 0, 0, 1, 1, GL_RGBA, GL_FLOAT, values.data());
    const long before = context_->reads();
    std::array<float, 2> first{};
    context_->read(buffer.name(), std::as_writable_bytes(std::span(first)));
    EXPECT_EQ(first, (std::array{1.0f, 2.0f}));
    std::array<float, 4> texel{};
    context_->read_texture(texture.name(), GL_RGBA, GL_FLOAT, std::as_writable_bytes(std::span(texel)));
    EXPECT_EQ(texel, values);
    EXPECT_EQ(context_->reads(), before + 2);
}

void expect_one_line(const std::string& what, std::initializer_list<const char*> words) {
    for (const char* word : words) EXPECT_NE(what.find(word), std::string::npos) << word << ": " << what;
    EXPECT_NE(what.find("in OpenGL; "), std::string::npos) << what;  // and a remedy
}

// A context that somebody else has made, current for as long as it lives.
class Foreign {
 public:
    explicit Foreign(int version, EGLDisplay display = eglGetCurrentDisplay()) : display_(display) {
        const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                     version / 10,
                                     EGL_CONTEXT_MINOR_VERSION,
                                     version % 10,
                                     EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                     EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                     EGL_NONE};
        eglBindAPI(EGL_OPENGL_API);
        context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        current_ = eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
    }
    ~Foreign() {
        leave();
        eglDestroyContext(display_, context_);
    }
    void leave() const { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
    bool current() const { return current_ && eglGetCurrentContext() == context_; }

 private:
    EGLDisplay display_;
    EGLContext context_ = EGL_NO_CONTEXT;
    bool current_ = false;
};

TEST_F(Gl, AForeignContextIsAdoptedAndStaysItsOwners) {
    {
        Foreign foreign(45);
        ASSERT_TRUE(foreign.current());
        {
            Context adopted = Context::adopt();
            EXPECT_EQ(adopted.renderer(), context_->renderer());
            EXPECT_EQ(adopted.egl(), "");
            adopted.make_current();
            Buffer buffer(std::array{5.0f});
            std::array<float, 1> back{};
            adopted.read(buffer.name(), std::as_writable_bytes(std::span(back)));
            EXPECT_EQ(back[0], 5.0f);
            EXPECT_EQ(adopted.reads(), 1);
            EXPECT_EQ(context_->reads(), 0);
        }
        EXPECT_TRUE(foreign.current());
        Buffer works(std::array{6.0f});
        EXPECT_EQ(contents(works, 1), std::vector{6.0f});
    }
    context_->make_current();
}

TEST_F(Gl, WhereNoContextIsCurrentNoneIsAdopted) {
    Foreign(45).leave();
    expect_one_line(palpate::refusal([] { Context::adopt(); }),
                    {"no context is current", "make the window's"});
    context_->make_current();
}

TEST_F(Gl, ALostContextIsSaidInOneLine) {
    const auto sound = epoxy_glGetGraphicsResetStatus;
    epoxy_glGetGraphicsResetStatus = []() -> GLenum { return GL_UNKNOWN_CONTEXT_RESET; };
    const std::string what = palpate::refusal([&] { context_->make_current(); });
    epoxy_glGetGraphicsResetStatus = sound;
    expect_one_line(what, {"lost the context", "everything in it", "start again"});
    EXPECT_EQ(palpate::refusal([&] { context_->make_current(); }), "");
}

// Sets up the process as a machine that lacks something, runs, and ends with 1 and what an Error says.
template <class Do>
[[noreturn]] void end_with_error(const char* variable, const char* value, const Do& act) {
    setenv(variable, value, 1);
    std::fputs(palpate::refusal(act).c_str(), stderr);
    std::exit(1);
}

// These in processes of their own, because EGL looks for its drivers once.
TEST(GlDeathTest, WithoutADriverTheErrorSaysWhatToInstall) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const char* wanted = "in OpenGL; install libegl1.*libgl1-mesa-dri";
    EXPECT_EXIT(end_with_error("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json", [] { Context(); }),
                ::testing::ExitedWithCode(1), wanted);
    EXPECT_EXIT(end_with_error("LIBGL_DRIVERS_PATH", "/nowhere", [] { Context(); }),
                ::testing::ExitedWithCode(1), wanted);
}

// Mesa pretends to be older where it is told to; so these ask for Mesa.
const char* mesa = "/usr/share/glvnd/egl_vendor.d/50_mesa.json";

template <class Do>
[[noreturn]] void end_with_error_of_version_3_3(const Do& act) {
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", mesa, 1);
    end_with_error("MESA_GL_VERSION_OVERRIDE", "3.3", act);
}

TEST(GlDeathTest, AnOlderOneIsRefusedWithBothVersions) {
    if (!std::filesystem::exists(mesa)) GTEST_SKIP() << "Mesa is not available";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(end_with_error_of_version_3_3([] { Context(); }), ::testing::ExitedWithCode(1),
                "version 3.3, but 4.5 core is needed in OpenGL; update the graphics card's driver");
}

TEST(GlDeathTest, AnOlderForeignContextIsRefusedWithBothVersions) {
    if (!std::filesystem::exists(mesa)) GTEST_SKIP() << "Mesa is not available";
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto adopt = [] {
        EGLDisplay display =
            eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        eglInitialize(display, nullptr, nullptr);
        const Foreign foreign(33, display);
        Context::adopt();
    };
    EXPECT_EXIT(end_with_error_of_version_3_3(adopt), ::testing::ExitedWithCode(1),
                "version 3.3, but 4.5 core is needed in OpenGL; ask the window for a newer one");
}

}  // namespace
}  // namespace palpate::gl
