#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nepho::forecast {

// States of a forecast by their times, whatever the order in which files hold them.
struct TimeOrder {
  // Of the states, ascending in time; of two states of one time the later in the order given.
  std::vector<std::size_t> state;
  // One sentence each: out of order, twice, gaps. Gaps are steps longer than the most frequent one.
  std::vector<std::string> facts;
};
TimeOrder order_times(std::span<const std::int64_t> utc_ns);

// "2005-08-28T12:00:00Z", to the second.
std::string time_text(std::int64_t utc_ns);

}  // namespace nepho::forecast
