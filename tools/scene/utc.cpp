#include "scene/utc.h"

#include <chrono>
#include <cstdio>

#include "core/error.h"

namespace nepho {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000, kDay_ns = 86400 * kSecond_ns;

// Reads digits from the front of a text; every step says whether it fitted.
class Scanner {
 public:
  explicit Scanner(const std::string& text) : text_(text) {}
  bool end() const { return at_ == text_.size(); }
  char peek() const { return end() ? '\0' : text_[at_]; }
  bool take(const char* any_of) {
    const bool fits = !end() && std::string(any_of).find(peek()) != std::string::npos;
    at_ += fits;
    return fits;
  }
  bool number(int digits, int low, int high, int& value) {
    value = 0;
    for (int n = 0; n < digits; ++n) {
      if (peek() < '0' || peek() > '9') return false;
      value = 10 * value + (text_[at_++] - '0');
    }
    return value >= low && value <= high;
  }
  bool fraction_ns(std::int64_t& ns) {
    std::int64_t unit = kSecond_ns / 10;
    bool any = false;
    for (; peek() >= '0' && peek() <= '9'; ++at_, unit /= 10, any = true)
      ns += unit * (peek() - '0');
    return any;
  }

 private:
  const std::string& text_;
  std::size_t at_ = 0;
};

bool scan_time(Scanner& in, std::int64_t& ns) {
  int hour = 0, minute = 0, second = 0;
  if (!in.number(2, 0, 24, hour)) return false;
  if (in.take(":")) {
    if (!in.number(2, 0, 59, minute)) return false;
    if (in.take(":") && !in.number(2, 0, 59, second)) return false;
    if (in.take(".") && !in.fraction_ns(ns)) return false;
  }
  ns += (3600ll * hour + 60 * minute + second) * kSecond_ns;
  return ns <= kDay_ns;
}

bool scan_zone(Scanner& in, std::int64_t& ns) {
  if (in.end() || in.take("Zz")) return in.end();
  const bool east = in.peek() == '+';
  int hour = 0, minute = 0;
  if (!in.take("+-") || !in.number(2, 0, 14, hour)) return false;
  in.take(":");
  if (!in.end() && !in.number(2, 0, 59, minute)) return false;
  ns += (east ? -1 : 1) * (3600ll * hour + 60 * minute) * kSecond_ns;
  return in.end();
}

bool scan(const std::string& text, std::int64_t& result) {
  Scanner in(text);
  int year = 0, month = 0, day = 0;
  if (!in.number(4, 1678, 2261, year) || !in.take("-") || !in.number(2, 1, 12, month) ||
      !in.take("-") || !in.number(2, 1, 31, day))
    return false;
  const std::chrono::year_month_day date{std::chrono::year(year),
                                         std::chrono::month(unsigned(month)),
                                         std::chrono::day(unsigned(day))};
  if (!date.ok()) return false;
  std::int64_t ns = 0;
  if (in.take("Tt _") && !scan_time(in, ns)) return false;
  if (!scan_zone(in, ns)) return false;
  result = std::chrono::sys_days(date).time_since_epoch().count() * kDay_ns + ns;
  return true;
}

}  // namespace

std::int64_t utc_ns_value(const std::string& text, const std::string& where) {
  std::int64_t ns = 0;
  if (!scan(text, ns))
    throw Error({"not a date", where, "a date such as 2005-08-28T15:00:00Z, years 1678 to 2261",
                 "'" + text.substr(0, 40) + "'", ""});
  return ns;
}

std::string utc_text(std::int64_t utc_ns) {
  const std::int64_t days = utc_ns >= 0 ? utc_ns / kDay_ns : -((-utc_ns + kDay_ns - 1) / kDay_ns);
  const std::int64_t in_day_ns = utc_ns - days * kDay_ns, seconds = in_day_ns / kSecond_ns;
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(days))};
  char text[40];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02d", int(date.year()),
                unsigned(date.month()), unsigned(date.day()), int(seconds / 3600),
                int(seconds / 60 % 60), int(seconds % 60));
  std::string result = text;
  if (const std::int64_t rest = in_day_ns % kSecond_ns) {
    std::snprintf(text, sizeof text, ".%09lld", static_cast<long long>(rest));
    result += text;
    result.erase(result.find_last_not_of('0') + 1);
  }
  return result + "Z";
}

}  // namespace nepho
