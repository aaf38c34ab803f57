#pragma once
#include "palpate/base/error.h"
#include "palpate/gl/context.h"

#include <gtest/gtest.h>

#include <optional>

namespace palpate {

/// A test in a context of its own, which may not complain; skipped where there is none.
class WithContext : public ::testing::Test {
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
    const gl::Context* context() const { return &*context_; }

    std::optional<gl::Context> context_;
};

}  // namespace palpate
