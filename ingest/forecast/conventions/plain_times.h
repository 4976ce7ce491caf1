#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "forecast/files/data_file.h"

namespace nepho::forecast {

// Times of simulations that count from no date: a coordinate along the dimension `time` in s, min, h or
// d. Its values from 1970-01-01 00:00 UTC on; nothing where there is no such coordinate.
std::optional<std::vector<std::int64_t>> plain_times_ns(const DataFile& file, int time);

}  // namespace nepho::forecast
