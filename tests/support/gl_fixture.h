#pragma once

#include <gtest/gtest.h>

#include <memory>

#include "common/gl_context.h"

namespace nepho::test {

// One context for a test program: making it is cheap, compiling shaders in it is not.
class GlFixture : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    static const std::unique_ptr<GlContext> context = make_egl_context();
    ASSERT_NE(context, nullptr);
  }
};

}  // namespace nepho::test
