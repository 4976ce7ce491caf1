#pragma once

#include <string>

namespace nepho::netcdf {

// netCDF-C 4.9 reads what lies beyond the end of a classic file (CDF-1, -2, -5) as zeros, without a
// word: a copy that was cut short would be a clear sky. This compares the length with what the
// header claims. Throws Error where the file is shorter, or the header itself is cut; other kinds
// of files pass.
void check_classic_size(const std::string& path);

}  // namespace nepho::netcdf
