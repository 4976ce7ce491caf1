#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

#include "api/source_module.h"
#include "forecast/files/data_file.h"
#include "sources/grib/cf_dataset.h"
#include "sources/grib/field_table.h"

namespace nepho::grib {

// GRIB files as one CF dataset: fields of the same parameter and kind of level become a variable
// over (time, level, y, x), absent ones NaN. Coordinates, grid_mapping and formula_terms are as CF
// 1.11 has them; axes of place rise. Headers are read once, values when they are asked for, one
// message at a time; all calls into ecCodes run under the host's I/O lock.
class GribFile final : public forecast::DataFile {
 public:
  // Times of one forecast, or its fields, spread over files in any way. Throws Error: as
  // scan_fields(), table_of() and usable_fields().
  GribFile(const std::vector<std::string>& paths, IoLock io_lock,
           const forecast::UserNames& names = {});

  // Throws Error on damage, naming the message.
  std::vector<float> read_floats(const forecast::FileVariable& variable,
                                 const std::vector<std::size_t>& start,
                                 const std::vector<std::size_t>& count) const override;
  std::vector<double> read_doubles(const forecast::FileVariable& variable,
                                   const std::vector<std::size_t>& start,
                                   const std::vector<std::size_t>& count) const override;
  std::vector<std::string> read_texts(const forecast::FileVariable& variable) const override;
  // Of the messages, packed as they are.
  forecast::VariableBytes bytes_read(const forecast::FileVariable& variable) const override;

 private:
  template <class T>
  std::vector<T> read(const forecast::FileVariable& variable, const std::vector<std::size_t>& start,
                      const std::vector<std::size_t>& count) const;
  // One field on the grid's axes, changed to the variable's units.
  std::vector<float> plane(const forecast::FileVariable& variable, int field) const;

  IoLock io_lock_;
  FieldTable table_;
  std::vector<VariableValues> values_;                     // by variable
  mutable std::vector<std::atomic<std::uint64_t>> bytes_;  // asked for, by variable
};

}  // namespace nepho::grib
