#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/source_module.h"
#include "forecast.h"

namespace nepho::netcdf {

// One netCDF file, read only, through netCDF-C (netCDF-3 and -4; the root group). All calls into
// the library run under the host's I/O lock, with HDF5's own error printing off; what is known of
// dimensions, variables and attributes is read once, so that asking for it takes no lock.

struct NcDimension {
  std::string name;
  std::size_t size = 0;
};

struct NcAttribute {
  std::string name, text;       // text of characters and strings, blanks at its ends removed
  std::vector<double> numbers;  // of numbers
};

struct NcVariable {
  std::string name;
  int id = 0, type = 0;         // type: nc_type
  std::size_t value_bytes = 0;  // of one value in the file, unpacked from compression
  std::vector<int> dimensions;  // in the file's order, slowest first
  std::vector<NcAttribute> attributes;

  const NcAttribute* attribute(const std::string& name) const;
  std::string text(const std::string& name) const;  // "" where there is none
  std::optional<double> number(const std::string& name) const;
  bool numeric() const;
};

class NcFile {
 public:
  // Throws Error: no such file, empty, no netCDF, cut short, damaged.
  NcFile(std::string path, IoLock io_lock);
  ~NcFile();
  NcFile(const NcFile&) = delete;
  NcFile& operator=(const NcFile&) = delete;

  const std::string& path() const { return path_; }
  const std::vector<NcDimension>& dimensions() const { return dimensions_; }
  const std::vector<NcVariable>& variables() const { return variables_; }
  const NcVariable* find(const std::string& name) const;
  // Global attributes.
  std::string text(const std::string& name) const { return global_.text(name); }
  std::optional<double> number(const std::string& name) const { return global_.number(name); }

  std::size_t size(int dimension) const { return dimensions_[std::size_t(dimension)].size; }
  const std::string& name(int dimension) const { return dimensions_[std::size_t(dimension)].name; }
  std::vector<std::size_t> shape(const NcVariable& variable) const;
  std::string shape_text(const NcVariable& variable) const;  // "name(time 4, lat 73, lon 144)"

  // A hyperslab in the file's own order, in the units of the file. Missing values (_FillValue,
  // missing_value, valid_range, valid_min, valid_max, the library's default fill) are told by the
  // packed number, before scale_factor and add_offset, and become NaN. _Unsigned is obeyed.
  // Throws Error on damage.
  std::vector<float> read_floats(const NcVariable& variable, const std::vector<std::size_t>& start,
                                 const std::vector<std::size_t>& count) const;
  std::vector<double> read_doubles(const NcVariable& variable,
                                   const std::vector<std::size_t>& start,
                                   const std::vector<std::size_t>& count) const;
  std::vector<double> read_all(const NcVariable& variable) const;
  // A variable of characters: one string per row of its last dimension; of strings: each.
  std::vector<std::string> read_texts(const NcVariable& variable) const;

  // Bytes of this variable's values that have been asked for, and of all its values.
  VariableBytes bytes_read(const NcVariable& variable) const;

  // "file [variable]", for errors.
  std::string where(const NcVariable& variable) const { return path_ + " [" + variable.name + "]"; }

 private:
  template <class Action>
  auto locked(Action&& action) const;
  void inquire();
  NcVariable inquire_variable(int id) const;
  std::size_t values_in(const NcVariable& variable) const;
  template <class T>
  std::vector<T> read(const NcVariable& variable, const std::vector<std::size_t>& start,
                      const std::vector<std::size_t>& count) const;

  std::string path_;
  IoLock io_lock_;
  int id_ = -1;
  std::vector<NcDimension> dimensions_;
  std::vector<NcVariable> variables_;
  NcVariable global_;                                      // its attributes only
  mutable std::vector<std::atomic<std::uint64_t>> bytes_;  // asked for, by variable
};

// What a packed value means (CF 1.11, 2.5.1 and 8.1; netCDF Users Guide, appendix A).
struct Packing {
  double scale = 1, offset = 0;
  std::vector<double> fills;  // packed values that are missing
  double lowest, highest;     // packed; missing outside
  double wrap = 0;            // added to negative packed values: 256 or 65536 where _Unsigned
  double value(double packed) const;
};
Packing packing_of(const NcVariable& variable);

}  // namespace nepho::netcdf
