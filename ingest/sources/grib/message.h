#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace nepho::grib {

// One message with one field, in memory, through ecCodes. Not thread-safe: ecCodes keeps caches of
// its own, and all calls must run under the host's I/O lock. ecCodes prints nothing, and where it
// would end the process (a failed assertion on damaged bytes) an Error is thrown.
class Message {
 public:
  // `where` names it in errors. Throws Error where ecCodes does not understand it.
  Message(std::vector<unsigned char> bytes, std::string where);
  ~Message();
  Message(const Message&) = delete;
  Message& operator=(const Message&) = delete;

  const std::string& where() const { return where_; }
  // Nothing where the key is not there, or its value is GRIB's missing.
  std::optional<long> integer(const char* key) const;
  std::optional<double> number(const char* key) const;
  std::string text(const char* key) const;             // "" likewise
  std::vector<double> numbers(const char* key) const;  // none likewise
  // As above, but Error where there is nothing.
  long need_integer(const char* key) const;
  double need_number(const char* key) const;

  // Unpacked, in the message's own order; NaN where a value is missing. Throws Error on damage, and
  // on packings that this build of ecCodes cannot read.
  std::vector<double> values() const;
  // Of all points, as ecCodes works them out, for grids that no map of ours tells: in the message's
  // order where that runs along rows, east and north. Empty where it cannot.
  struct Places {
    std::vector<double> latitude_deg, longitude_deg;
  };
  Places places() const;

 private:
  struct Handle;
  std::vector<unsigned char> bytes_;
  std::string where_;
  std::unique_ptr<Handle> handle_;
};

// Latitudes of a Gaussian grid from north to south; `count` parallels between pole and equator.
std::vector<double> gaussian_latitudes_deg(long count);

}  // namespace nepho::grib
