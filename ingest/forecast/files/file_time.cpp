#include "forecast/files/file_time.h"

#include <cctype>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "units/parse_unit.h"

namespace nepho::forecast {
namespace {

constexpr double kNsPerSecond = 1e9;
constexpr double kSecondsPerDay = 86400;
constexpr double kDateLimit_s = 9.2e9;  // of int64 ns: years 1678 to 2261

// CF 4.4.1. The first three are of real days; years of the others have 360, 365 or 366.
enum class Calendar { kStandard, kProleptic, kJulian, k360Day, kNoLeap, kAllLeap };
struct CalendarName {
  const char* name;
  Calendar calendar;
};
constexpr CalendarName kCalendars[] = {{"standard", Calendar::kStandard},
                                       {"gregorian", Calendar::kStandard},
                                       {"proleptic_gregorian", Calendar::kProleptic},
                                       {"julian", Calendar::kJulian},
                                       {"360_day", Calendar::k360Day},
                                       {"360", Calendar::k360Day},
                                       {"noleap", Calendar::kNoLeap},
                                       {"no_leap", Calendar::kNoLeap},
                                       {"365_day", Calendar::kNoLeap},
                                       {"all_leap", Calendar::kAllLeap},
                                       {"366_day", Calendar::kAllLeap}};

bool is_real(Calendar calendar) {
  return calendar == Calendar::kStandard || calendar == Calendar::kProleptic ||
         calendar == Calendar::kJulian;
}

bool is_leap(std::int64_t year, bool julian) {
  return year % 4 == 0 && (julian || year % 100 != 0 || year % 400 == 0);
}

int month_days(Calendar calendar, std::int64_t year, int month) {
  constexpr int kDays[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  if (calendar == Calendar::k360Day) return 30;
  if (month != 2) return kDays[month - 1];
  const bool julian =
      calendar == Calendar::kJulian || (calendar == Calendar::kStandard && year <= 1582);
  const bool leap = calendar == Calendar::kAllLeap || (is_real(calendar) && is_leap(year, julian));
  return leap ? 29 : 28;
}

struct Date {
  int year = 0, month = 1, day = 1;
  double second_of_day = 0;  // UTC: less the zone's offset, so that it may lie outside the day
};

// Dates without a calendar are read as standard ones; 31 is a day until the calendar is known.
bool is_date(const Date& date, Calendar calendar) {
  return date.month >= 1 && date.month <= 12 && date.day >= 1 &&
         date.day <= month_days(calendar, date.year, date.month);
}

std::string lower(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

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
  if (std::sscanf(text.c_str(), " %d-%d-%d%n", &date.year, &date.month, &date.day, &used) != 3 &&
      std::sscanf(text.c_str(), " %4d%2d%2d%n", &date.year, &date.month, &date.day, &used) != 3)
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

// Days to a model's calendar and from it: years of 360, 365 or 366 days.
struct YearMonthDay {
  std::int64_t year;
  int month, day;
};
std::int64_t day_of_calendar(const Date& date, Calendar calendar) {
  if (calendar == Calendar::k360Day)
    return 360ll * date.year + 30 * (date.month - 1) + date.day - 1;
  std::int64_t days = (calendar == Calendar::kNoLeap ? 365ll : 366ll) * date.year + date.day - 1;
  for (int m = 1; m < date.month; ++m) days += month_days(calendar, 1, m);
  return days;
}
YearMonthDay date_of_day(std::int64_t days, Calendar calendar) {
  const std::int64_t length = calendar == Calendar::kNoLeap ? 365 : 366;
  const std::int64_t year = (days >= 0 ? days : days - length + 1) / length;
  int of_year = int(days - year * length), month = 1;
  while (of_year >= month_days(calendar, 1, month)) of_year -= month_days(calendar, 1, month++);
  return {year, month, of_year + 1};
}

// The day of ours, since 1970, that a day of a model's calendar is drawn as; `moved` where it has
// another name there.
std::int64_t drawn_day(std::int64_t days, Calendar calendar, bool& moved) {
  if (calendar == Calendar::k360Day) {
    // The same part of the year: our years are longer, so that no two days become one.
    const std::int64_t year = (days >= 0 ? days : days - 359) / 360, of_year = days - year * 360;
    const std::int64_t first = gregorian_days(year, 1, 1);
    const std::int64_t length = gregorian_days(year + 1, 1, 1) - first;
    moved = true;
    return first + of_year * length / 360;
  }
  const YearMonthDay date = date_of_day(days, calendar);
  const bool missing = date.month == 2 && date.day == 29 && !is_leap(date.year, false);
  moved = moved || missing;
  return missing ? gregorian_days(date.year, 3, 1)
                 : gregorian_days(date.year, date.month, date.day);
}

// A date plus seconds by the calendar's own count of days.
std::optional<std::int64_t> after_ns(const Date& date, double seconds, Calendar calendar,
                                     bool& moved) {
  const double total = date.second_of_day + seconds;
  if (!(std::abs(total) < 1e12)) return {};
  if (is_real(calendar)) {
    const bool julian = calendar == Calendar::kJulian ||
                        (calendar == Calendar::kStandard &&
                         (date.year < 1582 || (date.year == 1582 && date.month < 11 &&
                                               (date.month < 10 || date.day < 15))));
    return join_ns(julian ? julian_days(date.year, date.month, date.day)
                          : gregorian_days(date.year, date.month, date.day),
                   total);
  }
  const std::int64_t later = std::int64_t(std::floor(total / kSecondsPerDay));
  const double rest = total - double(later) * kSecondsPerDay;
  const std::int64_t days = day_of_calendar(date, calendar) + later;
  if (std::abs(days) > 1'000'000) return {};
  return join_ns(drawn_day(days, calendar, moved), rest);
}

Calendar calendar_of(const DataFile& file, const FileVariable& axis) {
  const std::string name = lower(axis.text("calendar"));
  if (name.empty()) return Calendar::kStandard;
  std::string known;
  for (const CalendarName& row : kCalendars) {
    if (name == row.name) return row.calendar;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
  }
  throw Error({"the calendar is not known", file.where(axis), known, "\"" + name + "\"",
               name == "none" ? "a perpetual date puts the sun nowhere: write one of these" : ""});
}

// Seconds of a unit that is a time; nothing else is accepted. Months and years are as long as the
// calendar's where it has such, else UDUNITS's: a tropical year of 365.242198781 days, and a
// twelfth.
std::optional<double> unit_seconds(std::string word, Calendar calendar,
                                   std::vector<std::string>& assumptions) {
  word = lower(word);
  while (word.ends_with(' ')) word.pop_back();
  const bool month = word == "month" || word == "months" || word == "mon";
  const bool common = word == "common_year" || word == "common_years";
  const bool year = word == "year" || word == "years" || word == "yr" || word == "yrs";
  if (common) return 365 * kSecondsPerDay;
  if (month || year) {
    const double year_days = calendar == Calendar::k360Day    ? 360
                             : calendar == Calendar::kNoLeap  ? 365
                             : calendar == Calendar::kAllLeap ? 366
                                                              : 365.242198781;
    const double days = month && calendar != Calendar::k360Day ? year_days / 12
                        : month                                ? 30
                                                               : year_days;
    char text[160];
    std::snprintf(
        text, sizeof text,
        "Times count %s of %.10g days each, as UDUNITS does: these are not the calendar's.",
        month ? "months" : "years", days);
    if (calendar != Calendar::k360Day && (month || is_real(calendar))) assumptions.push_back(text);
    return days * kSecondsPerDay;
  }
  if (word == "secs") word = "s";
  if (word == "mins") word = "min";
  if (word == "hrs") word = "h";
  if (word == "msec" || word == "msecs") word = "ms";
  try {
    return to_si(1, word, kTime);
  } catch (const Error&) {
    return {};
  }
}

// 20130502.569444: the day's fraction has about 1e-9 left in a double, rounded to the second.
std::optional<std::int64_t> absolute_ns(double value, Calendar calendar, bool& moved) {
  if (!(std::abs(value) < 1e9)) return {};
  const double day = std::floor(value);
  const int number = int(day);
  const Date date{number / 10000, number / 100 % 100, number % 100, 0};
  if (!is_date(date, calendar)) return {};
  return after_ns(date, std::round((value - day) * kSecondsPerDay), calendar, moved);
}

// What the dates of a calendar that is not ours became.
void say_calendar(Calendar calendar, bool moved, std::vector<std::string>& assumptions) {
  if (calendar == Calendar::k360Day)
    assumptions.push_back(
        "Calendar 360_day: each day is drawn as the day of ours at the same part of the year, at "
        "the "
        "same hour (30 February as 1 March, 1 July as 2 July).");
  if (calendar == Calendar::kJulian)
    assumptions.push_back("Calendar julian: times are shown by the Gregorian calendar.");
  if (calendar == Calendar::kAllLeap && moved)
    assumptions.push_back(
        "Calendar 366_day: 29 February of years that have none is drawn as 1 March.");
}

// Where the word stands that parts a unit from its origin, and how long it is.
struct Since {
  std::size_t at, length;
};
std::optional<Since> since_of(const std::string& unit) {
  const std::string text = lower(unit);
  for (const char* word : {" since ", " after ", " from ", " ref "})
    if (const std::size_t at = text.find(word); at != std::string::npos)
      return Since{at, std::string(word).size()};
  return {};
}

}  // namespace

std::optional<std::int64_t> parse_date_ns(const std::string& text) {
  const auto date = parse_date(text);
  bool moved = false;
  if (!date || !is_date(*date, Calendar::kStandard)) return {};
  return after_ns(*date, 0, Calendar::kStandard, moved);
}

bool is_time_unit(const std::string& unit) {
  return since_of(unit).has_value() || unit.starts_with("day as ");
}

FileTimes read_times(const DataFile& file, const FileVariable& axis) {
  const std::string unit = axis.text("units");
  const auto bad_unit = [&](const char* hint) {
    return Error({"the unit of the time axis is not known", file.where(axis),
                  "such as \"hours since 2000-01-01 00:00:00\", or \"day as %Y%m%d.%f\"",
                  "\"" + unit + "\"", hint});
  };
  const Calendar calendar = calendar_of(file, axis);
  FileTimes result;
  std::optional<Date> origin;
  double unit_s = 0;
  const bool absolute = unit == "day as %Y%m%d.%f";
  if (const auto since = since_of(unit)) {
    origin = parse_date(unit.substr(since->at + since->length));
    if (origin && !is_date(*origin, calendar)) throw bad_unit("the calendar has no such date");
    const auto seconds = unit_seconds(unit.substr(0, since->at), calendar, result.assumptions);
    if (!seconds)
      throw bad_unit("known are seconds, minutes, hours, days, weeks, months and years");
    unit_s = *seconds;
  }
  if (!origin && !absolute) throw bad_unit("");
  bool moved = false;
  for (const double value : file.read_all(axis)) {
    const auto ns = absolute ? absolute_ns(value, calendar, moved)
                             : after_ns(*origin, value * unit_s, calendar, moved);
    if (!std::isfinite(value) || !ns)
      throw Error({"a time is missing or out of range", file.where(axis), "years 1678 to 2261",
                   "time " + std::to_string(result.utc_ns.size()) + ": " + std::to_string(value) +
                       " " + unit,
                   ""});
    result.utc_ns.push_back(*ns);
  }
  say_calendar(calendar, moved, result.assumptions);
  return result;
}

}  // namespace nepho::forecast
