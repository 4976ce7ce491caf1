#pragma once

#include <eccodes.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/error.h"
#include "sources/grib/grib_file.h"
#include "sources/grib/open_grib.h"
#include "test_folder.h"

namespace nepho::grib::test {

inline const nepho::test::TestFolder& folder() {
  static const nepho::test::TestFolder folder("grib");
  return folder;
}

// Keys of ecCodes in the order of their setting.
struct Key {
  Key(const char* key, double value) : name(key), number(value) {}
  Key(const char* key, int value) : name(key), number(value), whole(true) {}
  Key(const char* key, long value) : name(key), number(double(value)), whole(true) {}
  Key(const char* key, const char* value) : name(key), text(value) {}
  std::string name;
  double number = 0;
  bool whole = false;
  std::string text;
};
using Keys = std::vector<Key>;

// One message, from ecCodes's own sample of the edition.
class Made {
 public:
  explicit Made(int edition, const Keys& keys = {})
      : codes_(codes_grib_handle_new_from_samples(nullptr, edition == 1 ? "GRIB1" : "GRIB2")) {
    if (!codes_) throw std::runtime_error("no samples of ecCodes");
    set(keys);
  }
  ~Made() { codes_handle_delete(codes_); }
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;

  Made& set(const Keys& keys) {
    for (const Key& key : keys) {
      int status = 0;
      if (!key.text.empty()) {
        std::size_t length = key.text.size();
        status = codes_set_string(codes_, key.name.c_str(), key.text.c_str(), &length);
      } else if (key.whole) {
        status = codes_set_long(codes_, key.name.c_str(), long(key.number));
      } else {
        status = codes_set_double(codes_, key.name.c_str(), key.number);
      }
      if (status) throw std::runtime_error(key.name + ": " + codes_get_error_message(status));
    }
    return *this;
  }
  Made& set(const char* name, const std::vector<double>& list) {
    if (const int status = codes_set_double_array(codes_, name, list.data(), list.size()))
      throw std::runtime_error(std::string(name) + ": " + codes_get_error_message(status));
    return *this;
  }
  Made& set(const char* name, const std::vector<long>& list) {
    if (const int status = codes_set_long_array(codes_, name, list.data(), list.size()))
      throw std::runtime_error(std::string(name) + ": " + codes_get_error_message(status));
    return *this;
  }
  // NaN is missing.
  Made& values(std::vector<double> list) {
    constexpr double kNone = -9.99e33;
    bool missing = false;
    for (double& value : list)
      if (std::isnan(value)) {
        value = kNone;
        missing = true;
      }
    if (missing) set({{"bitmapPresent", 1}, {"missingValue", kNone}});
    return set("values", list);
  }
  std::string bytes() const {
    const void* data = nullptr;
    std::size_t size = 0;
    codes_get_message(codes_, &data, &size);
    return {static_cast<const char*>(data), size};
  }
  long number(const char* key) const {
    long value = 0;
    codes_get_long(codes_, key, &value);
    return value;
  }
  // ecCodes's own places of all points, with their values.
  struct Place {
    double latitude, longitude, value;
  };
  std::vector<Place> places() const {
    const std::size_t count = std::size_t(number("numberOfPoints"));
    std::vector<double> lat(count), lon(count), value(count);
    if (const int status = codes_grib_get_data(codes_, lat.data(), lon.data(), value.data()))
      throw std::runtime_error(std::string("places: ") + codes_get_error_message(status));
    std::vector<Place> places;
    for (std::size_t n = 0; n < count; ++n) places.push_back({lat[n], lon[n], value[n]});
    return places;
  }

 private:
  codes_handle* codes_;
};

inline std::string write_bytes(const std::string& name, const std::string& bytes) {
  const std::string path = folder() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// The same number of either edition: parameter, level, date and step.
inline Keys parameter(int edition, const std::string& name) {
  struct Codes {
    int discipline, category, number, table, number1;
  };
  static const std::map<std::string, Codes> codes = {
      {"t", {0, 0, 0, 2, 11}},      {"gh", {0, 3, 5, 2, 7}},  {"clwmr", {0, 1, 22, 2, 153}},
      {"icmr", {0, 1, 23, 2, 178}}, {"q", {0, 1, 0, 2, 51}},  {"r", {0, 1, 1, 2, 52}},
      {"pres", {0, 3, 0, 2, 1}},    {"hhl", {0, 3, 6, 2, 8}}, {"z", {0, 3, 4, 2, 6}},
      {"lsm", {2, 0, 0, 2, 81}},    {"u", {0, 2, 2, 2, 33}}};
  const Codes& c = codes.at(name);
  if (edition == 1)
    return {{"centre", 7}, {"table2Version", c.table}, {"indicatorOfParameter", c.number1}};
  return {{"discipline", c.discipline},
          {"parameterCategory", c.category},
          {"parameterNumber", c.number}};
}

inline Keys isobaric(int edition, double hPa) {
  if (edition == 1) return {{"indicatorOfTypeOfLevel", 100}, {"level", long(std::lround(hPa))}};
  return {{"typeOfFirstFixedSurface", 100},
          {"scaleFactorOfFirstFixedSurface", 0},
          {"scaledValueOfFirstFixedSurface", long(std::lround(hPa * 100))},
          {"typeOfSecondFixedSurface", 255}};
}

inline Keys level(int edition, int code2, int code1, long value) {
  if (edition == 1) return {{"indicatorOfTypeOfLevel", code1}, {"level", value}};
  return {{"typeOfFirstFixedSurface", code2},
          {"scaleFactorOfFirstFixedSurface", 0},
          {"scaledValueOfFirstFixedSurface", value},
          {"typeOfSecondFixedSurface", 255}};
}

inline Keys at_hour(int edition, long hour) {
  Keys keys = {{"dataDate", 20200301l}, {"dataTime", 0l}};
  if (edition == 1)
    keys.insert(keys.end(),
                {{"unitOfTimeRange", 1}, {"P1", hour}, {"P2", 0}, {"timeRangeIndicator", 0}});
  else
    keys.insert(keys.end(), {{"indicatorOfUnitOfTimeRange", 1}, {"forecastTime", hour}});
  return keys;
}

inline std::unique_ptr<forecast::Forecast> open(const std::vector<std::string>& paths,
                                                std::optional<forecast::Region> region = {}) {
  forecast::OpenRequest request;
  request.files = paths;
  request.region = region;
  return open_grib(request);
}

// What opening says; "" where it succeeds.
inline std::string refusal(const std::string& path) {
  try {
    open({path});
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

inline bool says(const std::vector<std::string>& texts, const std::string& part) {
  return std::ranges::any_of(
      texts, [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace nepho::grib::test
