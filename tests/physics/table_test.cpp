#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "accuracy_report.h"
#include "cases.h"

namespace nepho::test {

void PrintTo(const Case& which, std::ostream* out) {
  *out << which.name;
}

namespace {

class Physics : public testing::TestWithParam<Case> {};

struct Worst {
  double f32 = 0, f64 = 0;
  std::size_t units_differ = 0;
};

TEST_P(Physics, IsWithinItsBound) {
  const Case& tested = GetParam();
  const std::vector<Row> rows = tested.rows();
  ASSERT_GE(rows.size(), 10000u);
  Worst worst;
  for (const Row& row : rows) {
    const Outputs in_double = evaluate_f64(tested.which, row);
    const double f32 = error_of(row, evaluate_f32(tested.which, row));
    const double f64 = error_of(row, in_double);
    ASSERT_FALSE(std::isnan(f32) || std::isnan(f64));
    worst.f32 = std::max(worst.f32, f32);
    worst.f64 = std::max(worst.f64, f64);
    worst.units_differ += evaluate_dim(tested.which, row) != in_double;
  }
  report_accuracy("equations in C++ float", tested.name, worst.f32, tested.bound_f32, "1");
  report_accuracy("equations in C++ double", tested.name, worst.f64, tested.bound_f64, "1");
  EXPECT_LE(worst.f32, tested.bound_f32);
  EXPECT_LE(worst.f64, tested.bound_f64);
  // The dimension-checked build computes the same bits, so what it checks is what runs.
  EXPECT_EQ(worst.units_differ, 0u);
}

INSTANTIATE_TEST_SUITE_P(Table, Physics, testing::ValuesIn(cases()),
                         [](const auto& row) { return row.param.name; });

}  // namespace
}  // namespace nepho::test
