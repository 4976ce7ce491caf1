// Times of forecasts: calendars, order, gaps, and files in any order.

#include <algorithm>

#include "cf_twin.h"
#include "forecast/files/file_time.h"
#include "forecast/files/time_order.h"
#include "sources/netcdf/nc_file.h"

namespace nepho::forecast::test {
namespace {

FileTimes times_of(const std::string& units, const std::string& calendar,
                   const std::vector<double>& values) {
  const std::string path = folder() / "axis.nc";
  {
    NcWriter nc(path);
    nc.dimension("time", values.size());
    Attributes attributes = {{"units", units}};
    if (!calendar.empty()) attributes["calendar"] = calendar;
    nc.variable("time", NC_DOUBLE, {"time"}, values, attributes);
  }
  const netcdf::NcFile file(path, {});
  return read_times(file, *file.find("time"));
}

bool says(const std::vector<std::string>& all, const std::string& part) {
  return std::ranges::any_of(
      all, [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

// Dates counted by hand. 360_day: day n of a year is day floor(n L / 360) of ours, which has L.
TEST(Times, CalendarsAgainstDates) {
  const struct {
    const char *units, *calendar;
    double value;
    const char* date;
  } cases[] = {
      {"days since 2001-01-01", "360_day", 180, "2001-07-02"},
      {"days since 2001-02-28", "360_day", 2.25, "2001-03-01 06:00:00"},  // 30 February
      {"days since 2000-02-28", "360_day", 2, "2000-02-29"},
      {"days since 2001-02-30 12:00", "360_day", 0, "2001-03-01 12:00:00"},
      {"days since 2001-01-01", "360_day", 359.5, "2001-12-30 12:00:00"},
      {"days since 2001-01-01", "360_day", 360, "2002-01-01"},
      {"months since 2000-01-01", "360_day", 14, "2001-03-02"},
      {"days since 2000-01-01", "julian", 0, "2000-01-14"},
      {"days since 1900-02-29", "julian", 1, "1900-03-14"},
      {"days since 2000-02-28", "all_leap", 1, "2000-02-29"},
      {"days since 2001-02-28", "366_day", 1, "2001-03-01"},  // 29 February
      {"days since 2001-01-01", "366_day", 366, "2002-01-01"},
      {"days since 2000-02-28", "365_day", 1, "2000-03-01"},
      {"years since 2000-01-01", "", 1, "2000-12-31 05:48:45.9746784"},
      {"Hours Since 2000-01-01", "Gregorian", 36, "2000-01-02 12:00:00"},
      {"minutes since 20000101", "", 90, "2000-01-01 01:30:00"},
  };
  for (const auto& c : cases) {
    const auto wanted = parse_date_ns(c.date);
    ASSERT_TRUE(wanted) << c.date;
    EXPECT_NEAR(double(times_of(c.units, c.calendar, {c.value}).utc_ns[0] - *wanted) * 1e-9, 0,
                1e-3)
        << c.units << " " << c.calendar << " " << c.value;
  }
}

// Whatever a year's length: no two days become one, and none is out of order.
TEST(Times, DaysOf360AreApart) {
  for (const int year : {1999, 2000}) {
    std::vector<double> days;
    for (int n = 0; n < 720; ++n) days.push_back(n);
    const FileTimes times =
        times_of("days since " + std::to_string(year) + "-01-01", "360_day", days);
    for (std::size_t n = 1; n < times.utc_ns.size(); ++n)
      EXPECT_GE(times.utc_ns[n] - times.utc_ns[n - 1], 86400'000'000'000) << n;
    EXPECT_TRUE(says(times.assumptions, "30 February as 1 March"));
  }
}

TEST(Times, WhatIsAssumedIsSaid) {
  EXPECT_TRUE(says(times_of("months since 2000-01-01", "", {1}).assumptions, "30.43684"));
  EXPECT_TRUE(times_of("months since 2000-01-01", "360_day", {1}).assumptions.size() == 1);
  EXPECT_TRUE(says(times_of("days since 2001-02-28", "all_leap", {1}).assumptions, "29 February"));
  EXPECT_TRUE(times_of("days since 2000-02-28", "all_leap", {1}).assumptions.empty());
  EXPECT_TRUE(times_of("days since 2000-02-28", "", {1}).assumptions.empty());
}

TEST(Times, OthersAreRefusedByName) {
  const auto refused = [](const char* units, const char* calendar, double value = 1) {
    try {
      times_of(units, calendar, {value});
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto expect = [](const std::string& text, const char* part) {
    EXPECT_NE(text.find(part), std::string::npos) << text;
  };
  expect(refused("days since 2000-01-01", "none"), "360_day");
  expect(refused("fortnights since 2000-01-01", ""), "hours");
  expect(refused("metres since 2000-01-01", ""), "hours");
  expect(refused("days since 2001-02-29", ""), "no such date");
  expect(refused("days since 2001-02-30", "noleap"), "no such date");
  expect(refused("month as %Y%m.%f", ""), "day as %Y%m%d.%f");
  expect(refused("day as %Y%m%d.%f", "", 20010229.5), "out of range");
  expect(refused("days since 2000-01-01", "", 1e9), "1678 to 2261");
}

TEST(Times, OrderDoublesAndGapsAreNamed) {
  const std::int64_t h = 3'600'000'000'000;
  const TimeOrder even = order_times(std::vector<std::int64_t>{0, 3 * h, 6 * h});
  EXPECT_EQ(even.state, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(even.facts.empty());
  const TimeOrder mixed =
      order_times(std::vector<std::int64_t>{6 * h, 0, 3 * h, 3 * h, 15 * h, 18 * h});
  EXPECT_EQ(mixed.state, (std::vector<std::size_t>{1, 3, 0, 4, 5}));
  EXPECT_TRUE(says(mixed.facts, "not in order"));
  EXPECT_TRUE(says(mixed.facts, "1 time occurs twice"));
  EXPECT_TRUE(
      says(mixed.facts, "3 h apart, with 1 gap: 1970-01-01T06:00:00Z to 1970-01-01T15:00:00Z."));
}

CfTwin twin_at(double hour) {
  CfTwin twin;
  twin.hours = {hour};
  return twin;
}

TEST(Times, FilesInAnyOrderAreOneForecast) {
  OpenRequest request;
  for (const double hour : {12.0, 0.0, 24.0, 6.0})
    request.files.push_back(twin_at(hour).write("hour" + std::to_string(int(hour))));
  const auto f = netcdf::open_netcdf(request);
  ASSERT_EQ(f->times_s(), (std::vector<double>{0, 6 * 3600., 12 * 3600., 24 * 3600.}));
  EXPECT_EQ(f->time_origin_ns(), *parse_date_ns("2020-03-01"));
  for (std::size_t t = 0; t < 4; ++t) {
    const std::string own =
        folder() / ("hour" + std::to_string(int(f->times_s()[t] / 3600)) + ".nc");
    EXPECT_EQ(f->columns(t).extinction_per_m, open(own)->columns(0).extinction_per_m) << t;
  }
  EXPECT_TRUE(says(f->facts(), "4 files are one forecast of 4 times"));
  EXPECT_TRUE(says(f->facts(), "1 gap: 2020-03-01T12:00:00Z to 2020-03-02T00:00:00Z"));
}

// Each time of one file is the state that stands there, whatever the order of its axis.
TEST(Times, TimesOfOneFileAreTheirStates) {
  CfTwin twin;
  twin.hours = {12, 0, 6};
  const auto f = open(twin.write("shuffled"));
  EXPECT_TRUE(says(f->facts(), "not in order"));
  for (std::size_t t = 0; t < 3; ++t)
    EXPECT_EQ(f->columns(t).extinction_per_m,
              open(twin_at(6.0 * double(t)).write("alone"))->columns(0).extinction_per_m)
        << t;
}

TEST(Times, EmptyFilesAreNamedNotRefused) {
  CfTwin nothing = twin_at(0);
  nothing.water_scale = NAN;
  const std::string empty = nothing.write("empty"), full = twin_at(6).write("full");
  OpenRequest request;
  request.files = {full, empty};
  const auto f = netcdf::open_netcdf(request);
  ASSERT_EQ(f->times_s().size(), 2u);
  EXPECT_TRUE(says(f->facts(), "Fill values only, and clear: 2020-03-01T00:00:00Z."));
  for (const float value : f->columns(0).extinction_per_m) EXPECT_EQ(value, 0.0f);
  EXPECT_EQ(f->columns(1).extinction_per_m, open(full)->columns(0).extinction_per_m);
  EXPECT_NE(refusal(empty).find("all values of the cloud water are missing"), std::string::npos);
  request.files = {empty, empty};
  EXPECT_THROW(netcdf::open_netcdf(request), Error);
}

}  // namespace
}  // namespace nepho::forecast::test
