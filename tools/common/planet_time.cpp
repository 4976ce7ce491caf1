#include <cmath>
#include <cstdlib>

#include "common/planet_scene.h"
#include "core/error.h"
#include "scene/utc.h"

namespace nepho {

std::int64_t utc_of(const VolumeInfo& info, double time_s) {
  return info.time_origin_ns + std::int64_t(std::llround(time_s * 1e9));
}

double time_at(const VolumeInfo& info, std::int64_t utc_ns, const std::string& where) {
  constexpr std::int64_t kHalfMillisecond_ns = 500'000;  // times as float seconds or days
  std::string listed;
  int count = 0;
  for (const double t : info.times_s) {
    const std::int64_t own_ns = utc_of(info, t);
    if (std::abs(own_ns - utc_ns) <= kHalfMillisecond_ns) return t;
    if (++count <= 12) listed += (count > 1 ? ", " : "") + utc_text(own_ns);
  }
  if (count > 12) listed += ", ... (" + std::to_string(count) + ")";
  const bool no_date = info.time_origin_ns == 0;
  throw Error({"no such time", where,
               no_date ? "a time in seconds: its data have no date" : "one of " + listed,
               utc_text(utc_ns), ""});
}

}  // namespace nepho
