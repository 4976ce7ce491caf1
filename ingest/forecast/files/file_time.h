#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"

namespace nepho::forecast {

// Nanoseconds since 1970-01-01T00:00:00 UTC, without leap seconds; 1678 to 2261.

// "2005-08-28_12:00:00", with T or a blank, short forms, fractions of a second, Z, +01:00.
std::optional<std::int64_t> parse_date_ns(const std::string& text);

// The times of a CF time axis: "hours since 2000-01-01 00:00", calendars standard, gregorian,
// proleptic_gregorian, noleap, 365_day; "day as %Y%m%d.%f". Throws Error on other calendars and
// units, and on times that are missing or out of range.
std::vector<std::int64_t> read_times_ns(const DataFile& file, const FileVariable& axis);
// Is this the unit of a time axis?
bool is_time_unit(const std::string& unit);

}  // namespace nepho::forecast
