#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "api/source_module.h"
#include "forecast/files/data_file.h"

namespace nepho::netcdf {

// One netCDF file, read only, through netCDF-C (netCDF-3 and -4, all groups as one: groups.h). All
// calls into the library run under the host's I/O lock, with HDF5's own error printing off; what is
// known of dimensions, variables and attributes is read once, so that asking for it takes no lock.

using forecast::FileAttribute;
using forecast::FileVariable;

class NcFile final : public forecast::DataFile {
 public:
  // Throws Error: no such file, empty, no netCDF, cut short, damaged.
  NcFile(std::string path, IoLock io_lock);
  ~NcFile() override;

  // Missing values (_FillValue, missing_value, valid_range, valid_min, valid_max, the library's
  // default fill) are told by the packed number, before scale_factor and add_offset. _Unsigned is
  // obeyed.
  std::vector<float> read_floats(const FileVariable& variable,
                                 const std::vector<std::size_t>& start,
                                 const std::vector<std::size_t>& count) const override;
  std::vector<double> read_doubles(const FileVariable& variable,
                                   const std::vector<std::size_t>& start,
                                   const std::vector<std::size_t>& count) const override;
  std::vector<std::string> read_texts(const FileVariable& variable) const override;
  forecast::VariableBytes bytes_read(const FileVariable& variable) const override;

 private:
  template <class Action>
  auto locked(Action&& action) const;
  struct Contents;
  void inquire();
  void inquire_group(int group, const std::string& path, Contents& contents);
  FileVariable inquire_variable(int group, int id);
  template <class T>
  std::vector<T> read(const FileVariable& variable, const std::vector<std::size_t>& start,
                      const std::vector<std::size_t>& count) const;

  IoLock io_lock_;
  int id_ = -1;
  struct Handle {
    int group = 0, variable = 0;  // netCDF's
    int type = 0;                 // nc_type
  };
  std::vector<Handle> handles_;                            // by variable
  mutable std::vector<std::atomic<std::uint64_t>> bytes_;  // asked for, by variable
};

// What a packed value means (CF 1.11, 2.5.1 and 8.1; netCDF Users Guide, appendix A).
struct Packing {
  double scale = 1, offset = 0;
  std::vector<double> fills;  // packed values that are missing
  double lowest, highest;     // packed; missing outside
  double wrap = 0;            // added to negative packed values: 256 or 65536 where _Unsigned
  // `packed` and `values` may be the same.
  template <class From, class To>
  void unpack(const From* packed, std::size_t count, To* values) const;
};
Packing packing_of(const FileVariable& variable, int nc_type);

}  // namespace nepho::netcdf
