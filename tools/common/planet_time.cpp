#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "common/brick_columns.h"
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

namespace {

// The sum of extinction times volume: by the data, else by the bricks of the roots, which have the
// same.
double cloud_amount(const BrickSource& source, double time_s) {
  DataFacts facts;
  if (source.data_facts(time_s, facts) == Status::kOk && std::isfinite(facts.extinction_m2))
    return facts.extinction_m2;
  const VolumeInfo& info = source.info();
  double sum = 0;
  for (int root = 0; root < info.chart->roots(); ++root) {
    const NodeKey key(root, 0, 0u, 0u, 0u);
    sum += brick_sum(info, key, brick_values(source, key, time_s));
  }
  return sum;
}

double cloudiest_time(const BrickSource& source) {
  const std::vector<double>& times_s = source.info().times_s;
  return *std::ranges::max_element(times_s, {}, [&](double t) { return cloud_amount(source, t); });
}

}  // namespace

std::optional<double> named_time(const VolumeSpec& volume, const BrickSource& source) {
  const VolumeInfo& info = source.info();
  if (volume.utc_ns) return time_at(info, *volume.utc_ns, "volume '" + info.name + "'");
  if (volume.time_s) return time_of(volume, info);
  const std::string& choice = volume.time_choice;
  if (choice.empty()) return std::nullopt;
  if (info.times_s.empty()) return time_of(volume, info);
  if (choice == "first") return info.times_s.front();
  if (choice == "last") return info.times_s.back();
  if (choice == "cloudiest") return cloudiest_time(source);
  std::size_t index = 0;
  const auto [stop, failure] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  const std::string where = volume.where.empty() ? "volume '" + info.name + "'" : volume.where;
  if (failure != std::errc{} || stop != choice.data() + choice.size())
    throw Error({"not a time", where,
                 "a date such as 2005-08-28T15:00:00Z, an index from 0, first, last, cloudiest, or "
                 "seconds such as 3600s",
                 "'" + choice.substr(0, 40) + "'", ""});
  if (index >= info.times_s.size())
    throw Error({"no such time", where,
                 "an index from 0 to " + std::to_string(info.times_s.size() - 1) +
                     " (seconds are written 3600s)",
                 choice, ""});
  return info.times_s[index];
}

}  // namespace nepho
