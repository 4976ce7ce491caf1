// Files that are no GRIB, or damaged: one message that names the file, soon, and nothing on the
// streams.

#include <gtest/gtest.h>

#include <chrono>
#include <random>

#include "grib_twin.h"
#include "refused.h"

namespace nepho::grib::test {
namespace {

// What opening and reading all says; "" where both succeed.
std::string complaint(const std::string& path) {
  try {
    const auto forecast = open({path});
    for (std::size_t time = 0; time < forecast->times_s().size(); ++time) forecast->columns(time);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

std::string refused(const std::string& path, const std::vector<std::string>& says) {
  const auto start = std::chrono::steady_clock::now();
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  const std::string text = complaint(path);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(), 5);
  EXPECT_FALSE(text.empty());
  for (const std::string& part : says)
    EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' in: " << text;
  EXPECT_NE(text.find(path), std::string::npos) << text;
  return text;
}

std::string whole() {
  GribTwin twin;
  return twin.all(0);
}

TEST(GribMalformed, NoGrib) {
  refused(write_bytes("text.grib", "This is a letter, not a forecast.\n"), {"not a GRIB file"});
  refused(write_bytes("empty.grib", ""), {"is empty", "0 bytes"});
  refused(write_bytes("name.grib", "GRIB"), {"message 1 at byte 0", "the end of the file"});
  refused(write_bytes("edition.grib", std::string("GRIB\0\0\0\3", 8) + std::string(100, ' ')),
          {"known edition", "edition 3"});
  refused(folder() / "nothing.grib", {"no such file"});
  refused(std::filesystem::temp_directory_path().string(), {"folder"});
  refused(write_bytes("large.grib", std::string(std::size_t(3) << 20, 'G')), {"not a GRIB file"});
}

TEST(GribMalformed, CutShort) {
  for (const int edition : {1, 2}) {
    GribTwin twin;
    twin.edition = edition;
    const std::string all = twin.all(0);
    EXPECT_EQ(complaint(write_bytes("all.grib", all)), "");
    int cuts = 0;
    for (std::size_t at = 5; at < all.size(); at += 37) {
      // Between two messages, the rest is a file of its own.
      if (all.compare(at - 4, 4, "7777") == 0) continue;
      const std::string text = refused(write_bytes("cut.grib", all.substr(0, at)), {"message"});
      EXPECT_TRUE(text.find("cut short") != std::string::npos) << text;
      ++cuts;
    }
    EXPECT_GT(cuts, 20);
  }
}

TEST(GribMalformed, DamagedInTheMiddle) {
  std::string bytes = whole();
  const std::size_t second = bytes.find("GRIB", 4);
  bytes.replace(second - 4, 4, "7707");
  refused(write_bytes("end.grib2", bytes), {"message 1 at byte 0", "other bytes at its end"});
  bytes = whole();
  bytes[second + 16] = char(0x40);  // the first section as long as the file
  refused(write_bytes("section.grib2", bytes),
          {"message 2 at byte " + std::to_string(second), "section 1"});
}

// Packed numbers of a later time: what came before is read, and that time refused in one message.
TEST(GribMalformed, DamagedInTheMiddleOfARun) {
  GribTwin twin;
  twin.packing = "grid_jpeg";
  const std::string first = twin.all(0);
  std::string bytes = first + twin.all(6);
  // The data of the last message: its end stays.
  const std::size_t last = bytes.rfind("GRIB"), length = bytes.size() - last;
  std::fill(bytes.begin() + std::ptrdiff_t(bytes.size() - length / 4), bytes.end() - 4, '\xff');
  const std::string path = write_bytes("later.grib2", bytes);
  const auto forecast = open({path});
  ASSERT_EQ(forecast->times_s().size(), 2u);
  EXPECT_EQ(forecast->columns(0).extinction_per_m,
            open({write_bytes("first.grib2", first)})->columns(0).extinction_per_m);
  nepho::test::expect_quiet_refusal([&] { forecast->columns(1); },
                                    {path, "byte " + std::to_string(last), "clwmr"});
}

TEST(GribMalformed, ShorterWhileItIsRead) {
  const std::string path = write_bytes("shrinks.grib2", whole());
  const GribFile file({path}, {});
  std::filesystem::resize_file(path, 700);
  try {
    all_of(file, "clwmr");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("shorter while it was read"), std::string::npos);
  }
}

TEST(GribMalformed, WhatIsMissingIsNamed) {
  GribTwin twin;
  std::string air;
  for (const double hPa : twin.pressure_hPa)
    air += twin.message("t", hPa, 0, [](double, double) { return 250.0; });
  refused(write_bytes("no_water.grib2", air),
          {"no cloud water on levels", "t(time 1, isobaric 4, lat 5, lon 6)"});
  std::string high;
  for (const double hPa : twin.pressure_hPa)
    high += twin.message("clwmr", hPa, 0, [](double, double) { return 0.5; });
  refused(write_bytes("thick.grib2", high), {"[clwmr]", "more water than any cloud"});
}

// Any bytes changed: read or refused, never the end of this process, and nothing on its streams.
TEST(GribMalformed, FlippedBytes) {
  std::mt19937 random(20);
  int read = 0, refusals = 0;
  for (const int edition : {1, 2})
    for (const char* packing : {"grid_simple", "grid_ccsds", "grid_jpeg", "grid_second_order"}) {
      const bool second_order = std::string(packing) == "grid_second_order";
      if ((edition == 1) != second_order && std::string(packing) != "grid_simple") continue;
      GribTwin twin;
      twin.edition = edition;
      twin.packing = packing;
      const std::string all = twin.all(0);
      for (int n = 0; n < 250; ++n) {
        std::string bytes = all;
        for (auto flips = 1 + random() % 6; flips > 0; --flips)
          bytes[random() % bytes.size()] = char(random());
        const std::string path = write_bytes("flipped.grib", bytes);
        testing::internal::CaptureStderr();
        testing::internal::CaptureStdout();
        const auto start = std::chrono::steady_clock::now();
        (complaint(path).empty() ? read : refusals) += 1;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
        EXPECT_LT(took.count(), 5) << edition << " " << packing << " " << n;
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
      }
    }
  std::printf("measured: %d read, %d refused\n", read, refusals);
  EXPECT_GT(read, 100);
  EXPECT_GT(refusals, 200);
}

}  // namespace
}  // namespace nepho::grib::test
