#include "palpate/gl/context.h"

#include "palpate/base/error.h"
#include "palpate/gl/buffer.h"
#include "palpate/gl/program.h"
#include "palpate/gl/texture.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <optional>
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

class Gl : public ::testing::Test {
 protected:
    void SetUp() override {
        try {
            context_.emplace();
        } catch (const Error& error) {
            GTEST_SKIP() << "OpenGL is not available: " << error.what();
        }
    }
    void TearDown() override {
        if (context_) EXPECT_EQ(context_->errors(), 0) << context_->first_error();
    }

    std::optional<Context> context_;
};

// What Error says of these shaders; empty if they are sound.
std::string complaint(std::initializer_list<Shader> shaders) {
    try {
        Program program(shaders);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
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
        complaint({{GL_VERTEX_SHADER, "odd.vert", "#version 450 core\nvoid main() { oops; }\n"}});
    EXPECT_NE(what.find("odd.vert"), std::string::npos) << what;
    EXPECT_NE(what.find("oops"), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
}

TEST_F(Gl, AProgramThatCannotLinkNamesItsFilesInOneLine) {
    const char* calls = "#version 450 core\nvoid missing();\nvoid main() { missing(); }\n";
    const std::string what = complaint({{GL_VERTEX_SHADER, "calls.vert", calls}});
    EXPECT_NE(what.find("calls.vert"), std::string::npos) << what;
    EXPECT_NE(what.find("missing"), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
}

TEST_F(Gl, ShadersOfOneStageAreLinkedTogether) {
    const char* calls = "#version 450 core\nvec4 there();\nvoid main() { gl_Position = there(); }\n";
    const char* defines = "#version 450 core\nvec4 there() { return vec4(1); }\n";
    EXPECT_EQ(
        complaint({{GL_VERTEX_SHADER, "calls.vert", calls}, {GL_VERTEX_SHADER, "defines.vert", defines}}),
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

// In a process of its own, because EGL looks for its drivers once.
TEST(GlDeathTest, WithoutADriverTheErrorSaysWhatToInstall) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    auto open = [] {
        setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere.json", 1);
        try {
            Context context;
        } catch (const Error& error) {
            std::fputs(error.what(), stderr);
            std::exit(1);
        }
        std::exit(0);
    };
    EXPECT_EXIT(open(), ::testing::ExitedWithCode(1), "OpenGL; install libegl1.*libgl1-mesa-dri");
}

}  // namespace
}  // namespace palpate::gl
