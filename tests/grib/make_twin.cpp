// make_grib_twin FILE: the twin of grib_twin.h as a file, for tests of the module.

#include <cstdio>

#include "grib_twin.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  nepho::grib::test::GribTwin twin;
  twin.hours = {0, 3, 6, 9};
  twin.latitude.clear();
  twin.longitude.clear();
  for (int n = 0; n < 21; ++n) twin.latitude.push_back(-30 + 4 * n);
  for (int n = 0; n < 26; ++n) twin.longitude.push_back(100 + 4 * n);
  std::string bytes;
  for (const long hour : twin.hours) bytes += twin.all(hour);
  std::ofstream(arguments[1], std::ios::binary) << bytes;
  std::printf("%s: %zu bytes\n", arguments[1], bytes.size());
  return 0;
}
