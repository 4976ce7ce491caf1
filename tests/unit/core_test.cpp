// Checks, sums and moments of formats/core, and the physical constants.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "bricks/shell_chart.h"
#include "core/accumulator.h"
#include "core/check.h"
#include "core/error.h"
#include "random.h"
#include "units/parse_unit.h"

namespace nepho::test {
namespace {

TEST(Check, PassesWhatHolds) {
  int calls = 0;
  const auto next = [&] { return ++calls; };
  NEPHO_CHECK_EQ(next(), 1);
  EXPECT_EQ(calls, 1);     // once
  NEPHO_CHECK_LT(-1, 1u);  // by value: -1 < 1u is false in C++
  NEPHO_CHECK_GT(std::uint64_t(1) << 63, -1);
  NEPHO_CHECK_LE(1.0, 1.0);
  NEPHO_CHECK_GE(1.0f, 0.5);
  NEPHO_CHECK_NE(std::string("a"), "b");
}

TEST(CheckDeathTest, PrintsBothValuesAndAborts) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_DEATH(NEPHO_CHECK_LT(2.5, 0.1),
               "core_test.cpp.*2.5 < 0.1: 2.5 against 0.1000000000000000");
  EXPECT_DEATH(NEPHO_CHECK_EQ(std::string("fog"), "haze"), "fog against haze");
  EXPECT_DEATH(NEPHO_CHECK_GE(-1, 0u), "-1 against 0");
  EXPECT_DEATH(NEPHO_CHECK_LE(std::nan(""), 0.0), "nan against 0");
}

TEST(Error, SaysAllItsParts) {
  const Error error({.what = "a unit is missing",
                     .where = "scene.json:3:7",
                     .expected = "a length",
                     .found = "3",
                     .hint = "write 3 m"});
  EXPECT_STREQ(error.what(),
               "scene.json:3:7: a unit is missing: found 3, expected a length; write 3 m");
  EXPECT_EQ(error.parts().found, "3");
}

// 1 + n eps/2 - 1: the plain sum never leaves 1.
TEST(CompensatedSum, KeepsWhatAPlainSumLoses) {
  CompensatedSum sum;
  double plain = 1;
  sum.add(1);
  for (int n = 0; n < 1000000; ++n) sum.add(0x1p-54), plain += 0x1p-54;
  EXPECT_EQ(plain, 1);
  EXPECT_EQ(sum.value(), 1 + 1000000 * 0x1p-54);
  // Kahan's sum gives 0 here: the large term comes second.
  CompensatedSum neumaier;
  for (const double x : {1.0, 1e100, 1.0, -1e100}) neumaier.add(x);
  EXPECT_EQ(neumaier.value(), 2);
}

TEST(CompensatedSum, PartsMakeTheWhole) {
  Random random;
  CompensatedSum whole, left, right;
  long double exact = 0;
  double plain = 0, magnitude = 0;
  for (int n = 0; n < 200000; ++n) {
    const double x = random.uniform(-1, 1) * random.log_uniform(1e-8, 1e8);
    whole.add(x);
    (n % 3 ? left : right).add(x);
    exact += static_cast<long double>(x);
    plain += x;
    magnitude += std::abs(x);
  }
  left.add(right);
  const double bound = 1e-18 * magnitude;  // the long double sum's own error
  EXPECT_NEAR(whole.value(), double(exact), bound);
  EXPECT_NEAR(left.value(), double(exact), bound);
  EXPECT_GT(std::abs(plain - double(exact)), 10 * bound);  // the control
}

TEST(MeanVariance, OneToN) {
  MeanVariance moments;
  EXPECT_EQ(moments.mean(), 0);
  EXPECT_TRUE(std::isnan(moments.variance()));
  for (int n = 1; n <= 1000; ++n) moments.add(n);
  EXPECT_EQ(moments.count(), 1000u);
  EXPECT_NEAR(moments.mean(), 500.5, 1e-11);
  EXPECT_NEAR(moments.variance(), 1000 * 1001 / 12.0, 1e-8);  // n (n+1) / 12
  EXPECT_NEAR(moments.standard_error(), std::sqrt(1001 / 12.0), 1e-10);
}

TEST(MeanVariance, SurvivesALargeMeanAndMerging) {
  Random random;
  MeanVariance near_zero, far, parts[3], none;
  double squares = 0, sum = 0;
  for (int n = 0; n < 100000; ++n) {
    const double x = std::round(random.uniform(0, 1024));  // 1e9 + x is exact
    near_zero.add(x);
    far.add(1e9 + x);
    parts[n % 7 == 0 ? 0 : 1].add(1e9 + x);
    sum += 1e9 + x;
    squares += (1e9 + x) * (1e9 + x);
  }
  parts[2].add(parts[0]);
  parts[2].add(none);
  parts[2].add(parts[1]);
  EXPECT_NEAR(far.variance() / near_zero.variance(), 1, 1e-9);
  EXPECT_NEAR(parts[2].variance() / near_zero.variance(), 1, 1e-9);
  EXPECT_NEAR(parts[2].mean() - 1e9, near_zero.mean(), 1e-5);
  EXPECT_EQ(parts[2].count(), 100000u);
  const double naive = (squares - sum * sum / 1e5) / (1e5 - 1);  // the control
  EXPECT_GT(std::abs(naive / near_zero.variance() - 1), 1e-4);
}

// Those that follow from others do.
TEST(Constants, AreConsistent) {
  using namespace constants;
  EXPECT_NEAR(kWgs84Polar_m, 6356752.314245, 1e-6);
  EXPECT_NEAR(kSunAngularRadius_rad, std::asin(kSunRadius_m / kAstronomicalUnit_m), 1e-7);
  EXPECT_NEAR(kEarthMeanRadius_m,
              std::cbrt(kWgs84Equatorial_m * kWgs84Equatorial_m * kWgs84Polar_m), 0.1);
  EXPECT_NEAR(kDryAirGasConstant_J_per_kg_K, kGasConstant_J_per_mol_K / 0.0289644, 1e-4);
  EXPECT_NEAR(kVapourGasConstant_J_per_kg_K, kGasConstant_J_per_mol_K / 0.018015268, 1e-3);
  EXPECT_EQ(parse_unit("degC").offset, kZeroCelsius_K);
}

TEST(Units, WrongKindNamesBoth) {
  EXPECT_EQ(to_si(1, "km", kLength), 1000);
  try {
    to_si(1, "g/kg", kExtinction);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.parts().expected, "m-1");
    EXPECT_EQ(error.parts().found, "1");
  }
  EXPECT_THROW(to_si(1, "deg", kDimensionless), Error);
  EXPECT_THROW(parse_unit(""), Error);
  EXPECT_THROW(parse_unit("  "), Error);
  const Unit celsius = parse_unit("degC");
  EXPECT_NEAR(celsius.from_si(celsius.to_si(-40)), -40, 1e-13);
}

// Any bytes give a unit or an Error, nothing else: 200 000 strings of a unit's letters.
TEST(Units, AnyTextIsAUnitOrAnError) {
  Random random;
  const std::string letters = "mkgsKPadegNEWJ%1230.-^*/() \xc2\xb5\xb2\xe2\x81\xbb\x00_";
  int units = 0, errors = 0;
  for (int n = 0; n < 200000; ++n) {
    std::string text;
    for (int length = random.integer(0, 8); length > 0; --length)
      text += letters[std::size_t(random.integer(0, int(letters.size()) - 1))];
    try {
      const Unit unit = parse_unit(text);
      EXPECT_TRUE(unit.factor > 0 && std::isfinite(unit.factor)) << text;
      ++units;
    } catch (const Error&) {
      ++errors;
    }
  }
  EXPECT_GT(units, 1000);
  EXPECT_GT(errors, 1000);
}

}  // namespace
}  // namespace nepho::test
