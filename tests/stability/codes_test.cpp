// Stiff cases of codes: each computes its naive form beside the project's.
#include <array>
#include <cmath>
#include <numeric>

#include "codes.h"
#include "expect_stable.h"
#include "random.h"

namespace nepho::test {
namespace {

// Columns of bricks whose extinction spans 8 decades between them.
TEST(Codes, ColumnsOverEightDecades) {
  Random random;
  double worst = 0, naive = 0;
  for (double top = 1; top > 1e-8; top *= 0.1)
    for (int trial = 0; trial < 300; ++trial) {
      std::array<double, 9> column{};
      for (double& value : column) value = top * random.uniform(0.01, 1);
      column[0] = top;
      const auto off = [&](const Codes& codes) {
        double decoded = 0;
        for (std::size_t k = 0; k < column.size(); ++k) decoded += double(codes.decode(k));
        return std::abs(decoded / std::accumulate(column.begin(), column.end(), 0.0) - 1);
      };
      worst = std::max(worst, off(code_values(column)));
      naive = std::max(naive, off(code_values(column, kTopCode16, 1 / 65535.0f)));
    }
  expect_stable("35", worst, 1e-3, naive, "of a column's optical depth");
}

// The edge of a cloud, four decades in one cell: a look-up between samples.
TEST(Codes, FilteredAcrossAnEdge) {
  double worst = 0, naive = 0;
  for (const double thin : {1e-4, 1e-3, 1e-2, 0.1}) {
    const Codes codes = code_values({0.0, thin, 1.0});
    // 16-bit logarithms over 8 decades; code 0 apart.
    const auto logarithm = [](double value) {
      return 1 + std::round(65534 * (1 + std::log10(value) / 8));
    };
    for (double f = 0; f <= 1; f += 0.125) {
      const double exact = thin + f * (1 - thin);
      const double low = double(codes.decode(1)), high = double(codes.decode(2));
      // A texture's filter sees codes; what it gives is then decoded.
      const double code = codes.code[1] + f * (codes.code[2] - codes.code[1]);
      const double filtered = double(codes.q.offset) + double(codes.q.scale) * code;
      worst =
          std::max({worst, std::abs(filtered - exact), std::abs(low + f * (high - low) - exact)});
      const double coded = logarithm(thin) + f * (logarithm(1) - logarithm(thin));
      naive = std::max(naive, std::abs(std::pow(10, 8 * ((coded - 1) / 65534 - 1)) - exact));
    }
  }
  expect_stable("36", worst, 1e-2, naive, "of the brick's maximum");
}

// Decoded samples above what the summary promises: a majorant must hold for what is read.
TEST(Codes, BoundsHoldForWhatIsDecoded) {
  Random random;
  int above = 0, naive = 0;
  for (int trial = 0; trial < 50000; ++trial) {
    const double top = random.log_uniform(1e-9, 1), low = top * random.uniform(0, 1);
    const float decoded = code_values({low, top}).decode(1);
    above += decoded > decoded_bound(top);
    naive += double(decoded) > top;
    EXPECT_LE(decoded_bound(top), top * (1 + 6e-7));  // and it is no idle bound
  }
  expect_stable("37", above / 50000.0, 0, naive / 50000.0, "of the bricks above their bound");
}

}  // namespace
}  // namespace nepho::test
