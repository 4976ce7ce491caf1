#include "forecast/files/time_order.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <numeric>

namespace nepho::forecast {
namespace {

std::string count_text(std::size_t count, const char* one, const char* several) {
  return std::to_string(count) + (count == 1 ? one : several);
}

std::string step_text(std::int64_t ns) {
  const double s = double(ns) * 1e-9;
  char text[40];
  if (s >= 86400)
    std::snprintf(text, sizeof text, "%.6g days", s / 86400);
  else if (s >= 3600)
    std::snprintf(text, sizeof text, "%.6g h", s / 3600);
  else if (s >= 60)
    std::snprintf(text, sizeof text, "%.6g min", s / 60);
  else
    std::snprintf(text, sizeof text, "%.6g s", s);
  return text;
}

// Steps are equal that differ by less than 1 %: times as float days have some seconds.
std::string gaps(const std::vector<std::int64_t>& times) {
  constexpr std::size_t kListed = 3;
  std::map<std::int64_t, std::size_t> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    const std::int64_t step = times[i] - times[i - 1];
    const auto near = std::ranges::find_if(
        steps, [&](const auto& s) { return std::abs(s.first - step) * 100 < s.first; });
    ++(near == steps.end() ? steps[step] : near->second);
  }
  if (steps.size() < 2) return "";
  const std::int64_t usual =
      std::ranges::max_element(steps, {}, [](const auto& s) { return s.second; })->first;
  std::size_t found = 0;
  std::string text;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if ((times[i] - times[i - 1]) * 100 <= usual * 101) continue;
    if (++found <= kListed)
      text += (found > 1 ? ", " : "") + time_text(times[i - 1]) + " to " + time_text(times[i]);
  }
  if (found == 0) return "Times are not evenly spaced.";
  return "Times are " + step_text(usual) + " apart, with " +
         count_text(found, " gap: ", " gaps: ") + text + (found > kListed ? ", ..." : "") + ".";
}

}  // namespace

std::string time_text(std::int64_t utc_ns) {
  using namespace std::chrono;
  const sys_seconds at = floor<seconds>(sys_time<nanoseconds>(nanoseconds(utc_ns)));
  const year_month_day date(floor<days>(at));
  const hh_mm_ss<seconds> time(at - floor<days>(at));
  char text[48];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02dZ", int(date.year()),
                unsigned(date.month()), unsigned(date.day()), int(time.hours().count()),
                int(time.minutes().count()), int(time.seconds().count()));
  return text;
}

TimeOrder order_times(std::span<const std::int64_t> utc_ns) {
  TimeOrder order;
  std::vector<std::size_t> all(utc_ns.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  const auto ns = [&](std::size_t i) { return utc_ns[i]; };
  if (!std::ranges::is_sorted(all, {}, ns))
    order.facts.push_back("The times are not in order: they are sorted.");
  std::ranges::stable_sort(all, {}, ns);
  std::size_t twice = 0;
  for (const std::size_t i : all) {
    if (!order.state.empty() && ns(order.state.back()) == ns(i)) {
      order.state.pop_back();
      ++twice;
    }
    order.state.push_back(i);
  }
  if (twice > 0)
    order.facts.push_back(count_text(twice, " time occurs twice: the later state of it is used.",
                                     " times occur twice: the later state of each is used."));
  std::vector<std::int64_t> times;
  for (const std::size_t i : order.state) times.push_back(ns(i));
  if (std::string text = gaps(times); !text.empty()) order.facts.push_back(std::move(text));
#ifdef NEPHO_MUTANT_TIME_SHIFT
  if (!order.state.empty()) std::ranges::rotate(order.state, order.state.begin() + 1);
#endif
  return order;
}

}  // namespace nepho::forecast
