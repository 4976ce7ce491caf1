#pragma once

#include <cstddef>
#include <cstdint>

namespace nepho {

// C entry of nepho_nc_writer.so, which is loaded by whoever writes a NetCDF file; no program links
// it. A file is described first; its values are then handed over slab by slab in any order, so that
// only one slab is in memory. A slab spans the last two dimensions of a variable (all of it where
// it has fewer); slab n stands at index n of the other dimensions, last one fastest.

enum class NcFormat : std::int32_t { kClassic, kOffset64, kNetcdf4 };
enum class NcValue : std::int32_t { kChar, kByte, kShort, kInt, kFloat, kDouble };

struct NcAttribute {
  const char* name;
  const char* text;  // null: numbers
  NcValue value;
  const double* numbers;
  std::size_t count;
};

struct NcDimension {
  const char* name;
  std::size_t length;
  bool unlimited;
};

struct NcVariable {
  const char* name;
  NcValue value;
  const std::int32_t* dimensions;  // places in the file's list
  std::size_t rank;
  const NcAttribute* attributes;  // `_FillValue` among them where there is one
  std::size_t attribute_count;
};

struct NcFileSpec {
  const char* path;  // written beside it, then renamed over it
  NcFormat format;
  const NcDimension* dimensions;
  std::size_t dimension_count;
  const NcVariable* variables;
  std::size_t variable_count;
  const NcAttribute* attributes;
  std::size_t attribute_count;
  std::int32_t deflate;  // level of variables of two dimensions and more, with shuffle; 0: none
};

struct NcOpenFile;

// All return 0, or 1 with a zero-terminated text in `error`.
using nc_create_fn = int(const NcFileSpec* spec, NcOpenFile** file, char* error, std::size_t size);
// `values`: as many as the slab has, in the file's units; characters as their codes.
using nc_put_fn = int(NcOpenFile* file, std::size_t variable, std::size_t slab,
                      const double* values, char* error, std::size_t size);
// The file is gone after it in any case; `keep` false: nothing is left on disk.
using nc_close_fn = int(NcOpenFile* file, bool keep, char* error, std::size_t size);

}  // namespace nepho

extern "C" {
int nepho_nc_create(const nepho::NcFileSpec* spec, nepho::NcOpenFile** file, char* error,
                    std::size_t size);
int nepho_nc_put(nepho::NcOpenFile* file, std::size_t variable, std::size_t slab,
                 const double* values, char* error, std::size_t size);
int nepho_nc_close(nepho::NcOpenFile* file, bool keep, char* error, std::size_t size);
}
