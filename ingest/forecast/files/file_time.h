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

// The times of a CF time axis, in the file's order, and what was taken for granted.
struct FileTimes {
  std::vector<std::int64_t> utc_ns;
  std::vector<std::string> assumptions;
};
// "hours since 2000-01-01 00:00" or "day as %Y%m%d.%f", by CF's calendars (4.4.1): standard
// (gregorian), proleptic_gregorian and julian are of real days; noleap (365_day) and all_leap
// (366_day) keep their dates, 360_day the part of the year, as the day and hour that the sun stands
// at. Months and years are UDUNITS's. Throws Error on other calendars and units, on an origin that
// the calendar does not have, and on times that are missing or out of range.
FileTimes read_times(const DataFile& file, const FileVariable& axis);
// Is this the unit of a time axis?
bool is_time_unit(const std::string& unit);

}  // namespace nepho::forecast
