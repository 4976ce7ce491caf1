// The same rows as C++ float and as GLSL: both within the bounds of the table.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>

#include "accuracy_report.h"
#include "cases.h"
#include "common/gl_context.h"
#include "compute.h"

namespace nepho::test {

void PrintTo(const Case& which, std::ostream* out) {
  *out << which.name;
}

namespace {

class Shader : public testing::TestWithParam<Case> {
 protected:
  static void SetUpTestSuite() {
    static const std::unique_ptr<GlContext> context = make_egl_context();
    std::printf("on %s\n", context->description().c_str());
  }
};

TEST_P(Shader, AgreesWithTheTableAndWithFloat) {
  const Case& tested = GetParam();
  const std::vector<Row> rows = tested.rows();
  const std::vector<Outputs> on_gpu = evaluate_on_gpu(tested.which, rows);
  double worst = 0, apart = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double error = error_of(rows[i], on_gpu[i]);
    ASSERT_FALSE(std::isnan(error)) << "row " << i;
    worst = std::max(worst, error);
    Row as_float = rows[i];
    as_float.truth = evaluate_f32(tested.which, rows[i]);
    apart = std::max(apart, error_of(as_float, on_gpu[i]));
  }
  report_accuracy("equations in GLSL", tested.name, worst, tested.bound_gpu, "1");
  report_accuracy("equations, GLSL from C++ float", tested.name, apart,
                  tested.bound_gpu + tested.bound_f32, "1");
  EXPECT_LE(worst, tested.bound_gpu);
  EXPECT_LE(apart, tested.bound_gpu + tested.bound_f32);
}

INSTANTIATE_TEST_SUITE_P(Table, Shader, testing::ValuesIn(cases()),
                         [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace nepho::test
