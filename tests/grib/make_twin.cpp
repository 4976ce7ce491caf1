// make_grib_twin FILE: the twin of grib_twin.h as a file, for tests of the module.

#include <cstdio>

#include "grib_twin.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  nepho::grib::test::GribTwin twin;
  twin.hours = {0, 3, 6, 9};
  std::string bytes;
  for (const long hour : twin.hours) bytes += twin.all(hour);
  std::ofstream(arguments[1], std::ios::binary) << bytes;
  std::printf("%s: %zu bytes\n", arguments[1], bytes.size());
  return 0;
}
