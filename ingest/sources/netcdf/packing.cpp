#include <netcdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "sources/netcdf/nc_file.h"

namespace nepho::netcdf {
namespace {

// The library's fill of a type where the variable names none; bytes have no default.
std::optional<double> default_fill(int type) {
  switch (type) {
    case NC_SHORT:
      return NC_FILL_SHORT;
    case NC_USHORT:
      return NC_FILL_USHORT;
    case NC_INT:
      return NC_FILL_INT;
    case NC_UINT:
      return NC_FILL_UINT;
    case NC_INT64:
      return double(NC_FILL_INT64);
    case NC_UINT64:
      return double(NC_FILL_UINT64);
    case NC_FLOAT:
      return double(NC_FILL_FLOAT);
    case NC_DOUBLE:
      return NC_FILL_DOUBLE;
    default:
      return {};
  }
}

// As a value of the packed type reads it: -1e20 written as double beside floats.
double in_type(double value, int type) {
  return type == NC_FLOAT ? double(float(value)) : value;
}

double signed_to_unsigned(double value, double wrap) {
  return value < 0 ? value + wrap : value;
}

}  // namespace

template <class From, class To>
void Packing::unpack(const From* packed, std::size_t count, To* values) const {
  const auto missing = std::numeric_limits<To>::quiet_NaN();
  const double first_fill = fills.empty() ? std::nan("") : fills.front();  // NaN is no number's
  const std::span<const double> more(fills.begin() + !fills.empty(), fills.end());
  for (std::size_t n = 0; n < count; ++n) {
    const double from = signed_to_unsigned(double(packed[n]), wrap);
    const bool there = from >= lowest && from <= highest && from != first_fill &&
                       (more.empty() || std::ranges::find(more, from) == more.end());
    values[n] = there ? To(from * scale + offset) : missing;
  }
}
template void Packing::unpack(const float*, std::size_t, float*) const;
template void Packing::unpack(const double*, std::size_t, float*) const;
template void Packing::unpack(const double*, std::size_t, double*) const;

Packing packing_of(const FileVariable& variable, int type) {
  Packing packing;
  packing.lowest = -std::numeric_limits<double>::infinity();
  packing.highest = std::numeric_limits<double>::infinity();
  packing.scale = variable.number("scale_factor").value_or(1);
  packing.offset = variable.number("add_offset").value_or(0);
  const std::string is_unsigned = variable.text("_Unsigned");
  if (is_unsigned == "true" || is_unsigned == "True") {
    if (type == NC_BYTE) packing.wrap = 256;
    if (type == NC_SHORT) packing.wrap = 65536;
    if (type == NC_INT) packing.wrap = 4294967296.0;
  }
  const auto packed = [&](double value) {
    return signed_to_unsigned(in_type(value, type), packing.wrap);
  };
  // FillValue without its line is what some writers leave behind; what it names is missing as well.
  for (const char* name : {"_FillValue", "missing_value", "FillValue"})
    if (const FileAttribute* attribute = variable.attribute(name))
      for (const double value : attribute->numbers) packing.fills.push_back(packed(value));
  if (!variable.attribute("_FillValue"))
    if (const auto fill = default_fill(type)) packing.fills.push_back(packed(*fill));
  if (const auto low = variable.number("valid_min")) packing.lowest = packed(*low);
  if (const auto high = variable.number("valid_max")) packing.highest = packed(*high);
  if (const FileAttribute* range = variable.attribute("valid_range"))
    if (range->numbers.size() == 2) {
      packing.lowest = packed(range->numbers[0]);
      packing.highest = packed(range->numbers[1]);
    }
  return packing;
}

}  // namespace nepho::netcdf
