#pragma once

#include <cstdint>

#include "bricks/brick_source.h"

namespace nepho {

// What bricks promise of their source: the optical depth of the whole within 0.2 %, of columns
// within 0.5 % rms, against the source's own field under the same kernel (lattice.md 2): means over
// a column's hat, or the field on its line where samples are the field's values.
struct BrickCheck {
  static constexpr double kTotal = 2e-3, kColumns = 5e-3;  // relative

  // Of all that the bricks hold, over what the source says that its data hold, less 1; where it
  // does not say, of the sampled columns.
  double total_difference = 0;
  double total_doubt = 0;  // a standard error of it; 0: not sampled
  // Of the depths of sampled columns: rms of the difference over the rms of the source's own.
  double column_rms = 0;
  double column_rms_least = 0;  // two standard errors below it
  int columns = 0;
  // Beyond what the sample can be blamed for: two standard errors.
  bool total_kept() const;
  bool columns_kept() const { return column_rms_least <= kColumns; }
  bool kept() const { return total_kept() && columns_kept(); }
};

// Finest bricks against the source, on up to some hundred columns that are drawn over all cloudy
// places alike. Throws Error where the source has no field of its own, or no cloud at this time.
BrickCheck check_bricks(const BrickSource& source, double time_s, std::uint64_t seed = 1);

}  // namespace nepho
