#include "sources/grib/field_header.h"

#include <chrono>

namespace nepho::grib {
namespace {

// GRIB2 table 4.4 and edition 1's table 4. Months and years have no length.
std::optional<std::int64_t> unit_s(long code, long edition) {
  switch (code) {
    case 0:
      return 60;
    case 1:
      return 3600;
    case 2:
      return 86400;
    case 10:
      return 3 * 3600;
    case 11:
      return 6 * 3600;
    case 12:
      return 12 * 3600;
    case 13:
      return edition == 1 ? 15 * 60 : 1;
    case 14:
      if (edition == 1) return 30 * 60;
      return {};
    case 254:
      if (edition == 1) return 1;
      return {};
    default:
      return {};
  }
}

// Edition 1, table 5: ranges that are of one moment.
bool is_moment1(long range) {
  return range == 0 || range == 1 || range == 10;
}

}  // namespace

std::optional<std::int64_t> valid_time_ns(const Message& message) {
  const long edition = message.need_integer("editionNumber");
  const long date = message.need_integer("dataDate");  // yyyymmdd
  const auto day = std::chrono::sys_days(std::chrono::year(int(date / 10000)) /
                                         std::chrono::month(unsigned(date / 100 % 100)) /
                                         std::chrono::day(unsigned(date % 100)));
  std::int64_t seconds = std::int64_t(day.time_since_epoch().count()) * 86400;
  seconds +=
      message.integer("hour").value_or(0) * 3600 + message.integer("minute").value_or(0) * 60;
  if (edition == 2) seconds += message.integer("second").value_or(0);
  long step = 0;
  if (edition == 2) {
    step = message.integer("forecastTime").value_or(0);
  } else {
    const long range = message.need_integer("timeRangeIndicator");
    if (!is_moment1(range)) return {};
    const long p1 = message.integer("P1").value_or(0), p2 = message.integer("P2").value_or(0);
    step = range == 1 ? 0 : range == 10 ? p1 * 256 + p2 : p1;
  }
  const char* const unit = edition == 2 ? "indicatorOfUnitOfTimeRange" : "unitOfTimeRange";
  const auto step_s = unit_s(message.integer(unit).value_or(1), edition);
  if (!step_s && step != 0) return {};
#ifdef NEPHO_MUTANT_STEP_UNIT
  return (seconds + step * 3600) * 1'000'000'000;
#endif
  seconds += step * step_s.value_or(0);
  constexpr std::int64_t kFurthest_s = 9'200'000'000;  // of int64 ns
  if (seconds > kFurthest_s || seconds < -kFurthest_s) return {};
  return seconds * 1'000'000'000;
}

FieldHeader header_of(const Message& message, const forecast::UserNames& names) {
  FieldHeader header;
  header.level = level_of(message);
  header.parameter = parameter_of(message, header.level, names);
  header.valid_ns = valid_time_ns(message);
  // Edition 2: a range of time is part of the templates that have one, whatever is done over it.
  header.instant = message.need_integer("editionNumber") == 2
                       ? !message.integer("numberOfTimeRange")
                       : header.valid_ns.has_value();
  header.member = message.integer("perturbationNumber").value_or(0);
  return header;
}

}  // namespace nepho::grib
