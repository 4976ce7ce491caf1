#include "forecast/files/file_time.h"

#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "units/parse_unit.h"

namespace nepho::forecast {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kSecondsPerDay = 86400;
constexpr double kDateLimit_s = 9.2e9;  // of int64 ns: years 1678 to 2261
constexpr int kMonthDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};

struct Date {
  int year = 0, month = 1, day = 1;
  double second_of_day = 0;  // UTC: less the zone's offset, so that it may lie outside the day
};

// Days from 0000-03-01 to a date of the Gregorian or Julian calendar.
std::int64_t days_from_march_0(std::int64_t year, int month, int day, bool gregorian) {
  year -= month <= 2;
  const auto floor_by = [&](std::int64_t n) { return (year >= 0 ? year : year - n + 1) / n; };
  const std::int64_t of_year = (153 * (month + (month > 2 ? -3 : 9)) + 2) / 5 + day - 1;
  return year * 365 + floor_by(4) - (gregorian ? floor_by(100) - floor_by(400) : 0) + of_year;
}

// Days since 1970-01-01.
std::int64_t gregorian_days(std::int64_t year, int month, int day) {
  return days_from_march_0(year, month, day, true) - 719468;
}
std::int64_t julian_days(std::int64_t year, int month, int day) {
  return days_from_march_0(year, month, day, false) - 719470;
}

std::optional<Date> parse_date(const std::string& text) {
  Date date;
  int used = 0, hour = 0, minute = 0;
  double second = 0;
  if (std::sscanf(text.c_str(), " %d-%d-%d%n", &date.year, &date.month, &date.day, &used) != 3)
    return {};
  const char* at = text.c_str() + used;
  if (*at == 'T' || *at == '_' || *at == ' ') {
    ++at;
    if (std::sscanf(at, "%d%n", &hour, &used) == 1 && hour >= 0 && *at != '+') {
      at += used;
      if (std::sscanf(at, ":%d%n", &minute, &used) == 1) at += used;
      if (std::sscanf(at, ":%lf%n", &second, &used) == 1) at += used;
    }
  }
  while (*at == ' ') ++at;
  double zone_s = 0;
  if (*at == 'Z' || std::string(at).starts_with("UTC") || std::string(at).starts_with("GMT")) {
    at += *at == 'Z' ? 1 : 3;
  } else if (*at == '+' || *at == '-') {
    int zone_hour = 0, zone_minute = 0;
    if (std::sscanf(at + 1, "%2d:%2d%n", &zone_hour, &zone_minute, &used) != 2 &&
        std::sscanf(at + 1, "%2d%2d%n", &zone_hour, &zone_minute, &used) != 2 &&
        std::sscanf(at + 1, "%2d%n", &zone_hour, &used) != 1)
      return {};
    zone_s = (*at == '-' ? -1 : 1) * (zone_hour * 3600.0 + zone_minute * 60.0);
    at += 1 + used;
  }
  while (*at == ' ') ++at;
  const bool in_range = date.month >= 1 && date.month <= 12 && date.day >= 1 && date.day <= 31 &&
                        hour >= 0 && hour <= 24 && minute >= 0 && minute < 60 && second >= 0 &&
                        second < 61;
  if (*at != '\0' || !in_range) return {};
  date.second_of_day = hour * 3600.0 + minute * 60.0 + second - zone_s;
  return date;
}

// Whole days apart from the rest: a double of seconds since 0001 has 8 us.
std::optional<std::int64_t> join_ns(std::int64_t days, double second) {
  const double whole_days = std::floor(second / kSecondsPerDay);
  const double total_s = (double(days) + whole_days) * kSecondsPerDay;
  if (!(std::abs(total_s) < kDateLimit_s)) return {};
  return (days + std::int64_t(whole_days)) * std::int64_t(kSecondsPerDay * kNsPerSecond) +
         std::llround((second - whole_days * kSecondsPerDay) * kNsPerSecond);
}

enum class Calendar { kStandard, kProleptic, kNoLeap };

// A date plus seconds by the calendar's own count of days.
std::optional<std::int64_t> after_ns(const Date& date, double seconds, Calendar calendar) {
  const double total = date.second_of_day + seconds;
  if (!(std::abs(total) < 1e12)) return {};
  if (calendar != Calendar::kNoLeap) {
    const bool julian = calendar == Calendar::kStandard &&
                        (date.year < 1582 || (date.year == 1582 && date.month < 11 &&
                                              (date.month < 10 || date.day < 15)));
    return join_ns(julian ? julian_days(date.year, date.month, date.day)
                          : gregorian_days(date.year, date.month, date.day),
                   total);
  }
  // Every date of this calendar is a date of ours: count in years of 365 days, then name the day.
  std::int64_t days = std::int64_t(std::floor(total / kSecondsPerDay));
  const double rest = total - double(days) * kSecondsPerDay;
  for (int m = 1; m < date.month; ++m) days += kMonthDays[m - 1];
  days += date.day - 1 + std::int64_t{365} * date.year;
  const std::int64_t year = (days >= 0 ? days : days - 364) / 365;
  int of_year = int(days - year * 365), month = 1;
  while (of_year >= kMonthDays[month - 1]) of_year -= kMonthDays[month++ - 1];
  return join_ns(gregorian_days(year, month, of_year + 1), rest);
}

Calendar calendar_of(const DataFile& file, const FileVariable& axis) {
  const std::string name = axis.text("calendar");
  if (name.empty() || name == "standard" || name == "gregorian") return Calendar::kStandard;
  if (name == "proleptic_gregorian") return Calendar::kProleptic;
  if (name == "noleap" || name == "365_day") return Calendar::kNoLeap;
  throw Error({"this calendar has days that are not of ours", file.where(axis),
               "standard, gregorian, proleptic_gregorian, noleap or 365_day", name,
               "convert the times, for example with cdo setcalendar,standard"});
}

// 20130502.569444: the day's fraction has about 1e-9 left in a double, rounded to the second.
std::optional<std::int64_t> absolute_ns(double value) {
  if (!(std::abs(value) < 1e9)) return {};
  const double day = std::floor(value);
  const int number = int(day);
  return after_ns({number / 10000, number / 100 % 100, number % 100, 0},
                  std::round((value - day) * kSecondsPerDay), Calendar::kProleptic);
}

}  // namespace

std::optional<std::int64_t> parse_date_ns(const std::string& text) {
  const auto date = parse_date(text);
  return date ? after_ns(*date, 0, Calendar::kStandard) : std::nullopt;
}

bool is_time_unit(const std::string& unit) {
  return unit.find(" since ") != std::string::npos || unit.starts_with("day as ");
}

std::vector<std::int64_t> read_times_ns(const DataFile& file, const FileVariable& axis) {
  const std::string unit = axis.text("units");
  const auto bad_unit = [&] {
    return Error({"the unit of the time axis is not known", file.where(axis),
                  "such as \"hours since 2000-01-01 00:00:00\"", "\"" + unit + "\"", ""});
  };
  const Calendar calendar = calendar_of(file, axis);
  const std::size_t since = unit.find(" since ");
  std::optional<Date> origin;
  double unit_s = 0;
  const bool absolute = unit == "day as %Y%m%d.%f";
  if (since != std::string::npos) {
    origin = parse_date(unit.substr(since + 7));
    std::string word = unit.substr(0, since);
    if (word == "secs") word = "s";
    if (word == "hrs") word = "h";
    if (word == "msec" || word == "msecs") word = "ms";
    try {
      unit_s = to_si(1, word, kTime);
    } catch (const Error&) {
      throw bad_unit();  // months and years among them: they have no length
    }
  }
  if (!origin && !absolute) throw bad_unit();
  std::vector<std::int64_t> times;
  for (const double value : file.read_all(axis)) {
    const auto ns = absolute ? absolute_ns(value) : after_ns(*origin, value * unit_s, calendar);
    if (!std::isfinite(value) || !ns)
      throw Error({"a time is missing or out of range", file.where(axis), "years 1678 to 2261",
                   std::to_string(value) + " " + unit, ""});
    times.push_back(*ns);
  }
  return times;
}

}  // namespace nepho::forecast
