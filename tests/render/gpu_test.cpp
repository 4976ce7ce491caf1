// On hardware only (NEPHO_GPU_TESTS=ON): the context must be the hardware's, not Mesa's rasteriser.
// The renderer's own tests then run on it too, as everywhere the hardware comes first.
#include <gtest/gtest.h>

#include "common/gl_context.h"

namespace nepho::test {
namespace {

TEST(Gpu, HardwareComesBeforeSoftware) {
  const std::string device = make_egl_context()->description();
  std::printf("measured on: %s\n", device.c_str());
  EXPECT_EQ(device.find("software"), std::string::npos) << device;
  EXPECT_EQ(device.find("llvmpipe"), std::string::npos) << device;
}

}  // namespace
}  // namespace nepho::test
