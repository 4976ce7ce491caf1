// What GRIB messages become: variables, whatever the edition, the scan and the packing.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "grib_twin.h"

namespace nepho::grib::test {
namespace {

// Every value of the file at its place against the formula.
void expect_formula(const std::string& path, const GribTwin& twin, double tolerance) {
  const GribFile file({path}, {});
  const std::vector<double> lat = all_of(file, "lat"), lon = all_of(file, "lon"),
                            level = all_of(file, "isobaric"), time = all_of(file, "time"),
                            water = all_of(file, "clwmr"), t = all_of(file, "t");
  ASSERT_EQ(file.shape(*file.find("clwmr")),
            (std::vector<std::size_t>{time.size(), level.size(), lat.size(), lon.size()}));
  ASSERT_EQ(lat.size(), twin.latitude.size());
  ASSERT_EQ(lon.size(), twin.longitude.size());
  ASSERT_EQ(level, (std::vector<double>{50000, 70000, 90000, 100000}));
  ASSERT_EQ(time.size(), twin.hours.size());
  std::size_t n = 0;
  double worst = 0, worst_t = 0;
  for (std::size_t h = 0; h < time.size(); ++h) {
    EXPECT_EQ(time[h], 1583020800.0 + 3600.0 * double(twin.hours[h]));
    for (const double p : level)
      for (const double y : lat)
        for (const double x : lon) {
          const double wanted = GribTwin::water(y, x, p / 100, double(twin.hours[h]));
          worst = std::max(worst, std::abs(water[n] - wanted));
          worst_t = std::max(worst_t, std::abs(t[n] - GribTwin::temperature_K(p / 100)));
          ++n;
        }
  }
  EXPECT_LE(worst, tolerance) << path;
  EXPECT_LE(worst_t, 1e-3) << path;
}

TEST(GribFields, ScanDoesNotMatter) {
  int ways = 0;
  for (const int edition : {1, 2})
    for (const bool west : {false, true})
      for (const bool north : {false, true})
        for (const bool columns : {false, true})
          for (const bool alternating : {false, true}) {
            if (alternating && edition == 1) continue;
            GribTwin twin;
            twin.edition = edition;
            twin.west = west;
            twin.north = north;
            twin.columns = columns;
            twin.alternating = alternating;
            SCOPED_TRACE("edition " + std::to_string(edition) + " flags " + std::to_string(west) +
                         std::to_string(north) + std::to_string(columns) +
                         std::to_string(alternating));
            expect_formula(twin.write("scan.grib"), twin, 1e-10);
            ++ways;
          }
  EXPECT_EQ(ways, 24);
}

TEST(GribFields, PackingDoesNotMatter) {
  // Complex packing and PNG, which ecCodes 2.28 does not write rightly, are real files' (the first
  // in real_test.cpp).
  for (const char* packing : {"grid_simple", "grid_ccsds", "grid_jpeg", "grid_ieee"}) {
    SCOPED_TRACE(packing);
    GribTwin twin;
    twin.packing = packing;
    twin.bits = 16;
    // 16 bits of a range of 4e-4; JPEG 2000 as ecCodes writes it is lossless.
    expect_formula(twin.write(std::string(packing) + ".grib2"), twin, 4e-9);
  }
  GribTwin twin;
  twin.edition = 1;
  twin.packing = "grid_second_order";
  expect_formula(twin.write("second_order.grib1"), twin, 1e-10);
}

TEST(GribFields, MissingValuesAreNaN) {
  for (const int edition : {1, 2}) {
    GribTwin twin;
    twin.edition = edition;
    twin.missing_at = 10;
    twin.missing_hPa = 700;
    const GribFile file({twin.write("missing.grib")}, {});
    const std::vector<double> water = all_of(file, "clwmr"), t = all_of(file, "t");
    ASSERT_EQ(water.size(), 2u * 4 * 5 * 6);
    std::size_t missing = 0;
    for (std::size_t n = 0; n < water.size(); ++n) {
      const std::size_t level = n / 30 % 4, row = n / 6 % 5;
      EXPECT_EQ(std::isnan(water[n]), level == 1 || row == 2) << n;  // 700 hPa; 10 N
      EXPECT_FALSE(std::isnan(t[n]));
      missing += std::isnan(water[n]);
    }
    EXPECT_EQ(missing, 2u * (30 + 3 * 6));
    EXPECT_TRUE(says(file.facts(), "clwmr is in the file for 6 of 8 times and levels"));
  }
}

// Fields of one message share its grid, and a bit map.
TEST(GribFields, SeveralFieldsInOneMessage) {
  GribTwin twin;
  twin.hours = {0};
  twin.missing_at = -30;
  std::string joined;
  std::size_t count = 0;
  for (const double hPa : twin.pressure_hPa)
    for (const char* name : {"clwmr", "t", "gh"}) {
      const std::string one = twin.message(name, hPa, 0, [&](double lat, double lon) {
        if (lat == twin.missing_at) return double(NAN);
        return name[0] == 'c'   ? GribTwin::water(lat, lon, hPa, 0)
               : name[0] == 't' ? GribTwin::temperature_K(hPa)
                                : GribTwin::geopotential_height_m(hPa);
      });
      // Sections in their order: 0 has 16 bytes, the others begin with their length.
      for (std::size_t at = 16; at + 4 < one.size();) {
        const auto byte = [&](std::size_t n) { return std::size_t((unsigned char)(one[at + n])); };
        const std::size_t bytes = byte(0) << 24 | byte(1) << 16 | byte(2) << 8 | byte(3);
        std::string section = one.substr(at, bytes);
        at += bytes;
        if (section[4] < 4 && count > 0) continue;  // grid and date are given once
        if (section[4] == 6 && count > 0) section = std::string("\0\0\0\6\6\376", 6);
        joined += section;
      }
      ++count;
    }
  joined = std::string("GRIB\xff\xff\0\2\0\0\0\0\0\0\0\0", 16) + joined + "7777";
  for (std::size_t n = 0, size = joined.size(); n < 8; ++n, size >>= 8)
    joined[15 - n] = char(size & 0xff);
  const std::string path = write_bytes("multi.grib2", "TTAA00 KWBC 010000\r\r\n" + joined + "\n\n");
  EXPECT_EQ(scan_fields(path, 0).size(), 12u);
  const GribFile file({path}, {});
  const std::vector<double> water = all_of(file, "clwmr"), t = all_of(file, "t");
  for (std::size_t n = 0; n < water.size(); ++n) {
    const double lat = twin.latitude[n / 6 % 5], lon = twin.longitude[n % 6];
    const double hPa = std::vector<double>{500, 700, 900, 1000}[n / 30];
    if (lat == -30) {
      EXPECT_TRUE(std::isnan(water[n]) && std::isnan(t[n]));
    } else {
      EXPECT_NEAR(water[n], GribTwin::water(lat, lon, hPa, 0), 1e-10);
      EXPECT_NEAR(t[n], GribTwin::temperature_K(hPa), 1e-3);
    }
  }
}

TEST(GribFields, HeadersAloneAreRead) {
  const GribFile file({GribTwin().write("bytes.grib2")}, {});
  std::uint64_t held = 0;
  for (const auto& v : file.variables()) {
    EXPECT_EQ(file.bytes_read(v).read, 0u) << v.name;
    held += file.bytes_read(v).held;
  }
  EXPECT_EQ(held, std::filesystem::file_size(file.path()));
  const forecast::FileVariable& water = *file.find("clwmr");
  const std::vector<float> some = file.read_floats(water, {1, 2, 1, 3}, {1, 1, 2, 2});
  ASSERT_EQ(some.size(), 4u);
  EXPECT_NEAR(double(some[0]), GribTwin::water(-10, 160, 900, 6), 1e-10);
  EXPECT_NEAR(double(some[3]), GribTwin::water(10, 180, 900, 6), 1e-10);
  EXPECT_EQ(file.bytes_read(water).read * 8, file.bytes_read(water).held);  // one of eight fields
}

TEST(GribFields, FilesOfOneForecast) {
  GribTwin twin;
  // One file a time, the later first; and the water in a file of its own.
  const std::string late = write_bytes("f006.grib2", twin.all(6));
  const std::string early = write_bytes("f000.grib2", twin.all(0));
  const auto whole = open({twin.write("whole.grib2")}), parts = open({late, early});
  EXPECT_EQ(parts->times_s(), (std::vector<double>{0, 21600}));
  EXPECT_EQ(parts->time_origin_ns(), 1583020800000000000);
  for (const std::size_t time : {0u, 1u})
    EXPECT_EQ(parts->columns(time).extinction_per_m, whole->columns(time).extinction_per_m);
  std::string water, air;
  for (const double hPa : twin.pressure_hPa) {
    water += twin.message(
        "clwmr", hPa, 0, [&](double lat, double lon) { return GribTwin::water(lat, lon, hPa, 0); });
    air += twin.message("t", hPa, 0, [&](double, double) { return GribTwin::temperature_K(hPa); });
    air += twin.message("gh", hPa, 0,
                        [&](double, double) { return GribTwin::geopotential_height_m(hPa); });
  }
  const auto apart = open({write_bytes("air.grib2", air), write_bytes("water.grib2", water)});
  EXPECT_EQ(apart->columns(0).extinction_per_m, whole->columns(0).extinction_per_m);
}

TEST(GribFields, DuplicatesMembersAndMeansAreSaid) {
  GribTwin twin;
  twin.hours = {0};
  const auto plain = [](double, double) { return 3e-4; };
  // The later of two stays; a mean over time is another quantity; members are not mixed.
  std::string bytes = twin.message("clwmr", 700, 0, [](double, double) { return 1e-5; });
  bytes += twin.all(0);
  Made mean(2, twin.grid());
  mean.set({{"productDefinitionTemplateNumber", 8}});
  mean.set(parameter(2, "clwmr")).set(isobaric(2, 700)).set(at_hour(2, 0));
  bytes += mean.values(twin.scanned(plain)).bytes();
  Made member(2, twin.grid());
  member.set({{"productDefinitionTemplateNumber", 1}, {"perturbationNumber", 7}});
  member.set(parameter(2, "clwmr")).set(isobaric(2, 700)).set(at_hour(2, 0));
  bytes += member.values(twin.scanned(plain)).bytes();
  const GribFile file({write_bytes("twice.grib2", bytes)}, {});
  const std::vector<double> water = all_of(file, "clwmr");
  ASSERT_EQ(water.size(), 120u);
  EXPECT_NEAR(water[30], GribTwin::water(-30, 100, 700, 0), 1e-10);
  EXPECT_TRUE(says(file.facts(), "1 field occur")) << "twice";
  EXPECT_TRUE(says(file.facts(), "1 field of the file are means"));
  EXPECT_TRUE(says(file.assumptions(), "Member 0 of an ensemble of 2"));
}

std::string with_time(int edition, const Keys& time) {
  GribTwin twin;
  twin.edition = edition;
  std::string bytes;
  for (const double hPa : {1000.0, 500.0})
    for (const char* name : {"clwmr", "t", "gh"}) {
      Made made(edition, twin.grid());
      made.set(parameter(edition, name)).set(isobaric(edition, hPa)).set(time);
      made.set({{"bitsPerValue", 24}});
      made.values(twin.scanned([&](double lat, double lon) {
        return name[0] == 'c'   ? GribTwin::water(lat, lon, hPa, 0)
               : name[0] == 't' ? GribTwin::temperature_K(hPa)
                                : GribTwin::geopotential_height_m(hPa);
      }));
      bytes += made.bytes();
    }
  return write_bytes("time.grib", bytes);
}

TEST(GribFields, StepsHaveTheirUnits) {
  const Keys date = {{"dataDate", 20200228l}, {"dataTime", 1830l}};
  constexpr std::int64_t kBase_s = 1582914600;  // 2020-02-28 18:30 UTC
  struct Case {
    int edition;
    long unit, step;
    std::int64_t seconds;
  };
  for (const Case& c : {Case{2, 1, 30, 108000},
                        {2, 0, 90, 5400},
                        {2, 13, 45, 45},
                        {2, 2, 3, 259200},
                        {2, 10, 5, 54000},
                        {2, 11, 2, 43200},
                        {2, 12, 2, 86400},
                        {1, 1, 30, 108000},
                        {1, 0, 90, 5400},
                        {1, 2, 3, 259200},
                        {1, 13, 3, 2700},
                        {1, 254, 45, 45}}) {
    Keys time = date;
    if (c.edition == 2)
      time.insert(time.end(), {{"indicatorOfUnitOfTimeRange", c.unit}, {"forecastTime", c.step}});
    else
      time.insert(
          time.end(),
          {{"unitOfTimeRange", c.unit}, {"P1", c.step}, {"P2", 0}, {"timeRangeIndicator", 0}});
    EXPECT_EQ(open({with_time(c.edition, time)})->time_origin_ns() / 1'000'000'000,
              kBase_s + c.seconds)
        << c.edition << " " << c.unit;
  }
  // P1 over two octets.
  Keys time = date;
  time.insert(time.end(),
              {{"unitOfTimeRange", 1}, {"timeRangeIndicator", 10}, {"P1", 1}, {"P2", 44}});
  EXPECT_EQ(open({with_time(1, time)})->time_origin_ns() / 1'000'000'000, kBase_s + 300 * 3600);
}

}  // namespace
}  // namespace nepho::grib::test
