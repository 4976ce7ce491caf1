#pragma once

#include <cstdint>
#include <string>

namespace nepho {

// Dates as ISO 8601 writes them, always UTC: "2005-08-28", "2005-08-28T15Z", "2005-08-28T15:00Z",
// "2005-08-28T15:00:00.25Z"; a blank or an underscore may stand for the T, and +hh:mm for the Z.
// Nanoseconds since 1970-01-01T00:00:00, without leap seconds. Years 1678 to 2261.

// Throws Error at `where`.
std::int64_t utc_ns_value(const std::string& text, const std::string& where);
// "2005-08-28T15:00:00Z", with as many decimals as there are.
std::string utc_text(std::int64_t utc_ns);

}  // namespace nepho
