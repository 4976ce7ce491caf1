#include "forecast/conventions/plain_times.h"

#include <algorithm>
#include <cmath>

#include "forecast/conventions/vertical.h"

namespace nepho::forecast {

std::optional<std::vector<std::int64_t>> plain_times_ns(const DataFile& file, int time) {
  const FileVariable* axis = file.find(file.name(time));
  if (!axis || !axis->numeric || axis->dimensions != std::vector<int>{time}) return {};
  const UnitOf unit = unit_of(*axis, kTime);
  if (!unit.fits) return {};
  constexpr double kFurthest_s = 9.2e9;  // of int64 ns
  std::vector<std::int64_t> times;
  for (const double value : file.read_all(*axis)) {
    const double seconds = value * unit.factor;
    if (!(std::abs(seconds) < kFurthest_s)) return {};
    times.push_back(std::int64_t(std::llround(seconds * 1e9)));
  }
  return times;
}

}  // namespace nepho::forecast
