#include "nc_writer.h"

#include <netcdf.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace nepho {

struct NcOpenFile {
  ~NcOpenFile();  // what was not closed is gone from the disk
  struct Variable {
    NcValue value;
    std::vector<std::size_t> shape;
  };
  std::string path, temporary;
  int id = -1;
  std::vector<Variable> variables;
};

NcOpenFile::~NcOpenFile() {
  if (id < 0) return;
  nc_abort(id);
  std::error_code ignored;
  std::filesystem::remove(temporary, ignored);
}

namespace {

void check(int code, const char* doing, const char* name) {
  if (code != NC_NOERR)
    throw std::runtime_error(std::string(doing) + " '" + name + "': " + nc_strerror(code));
}

int type_of(NcValue value) {
  switch (value) {
    case NcValue::kChar:
      return NC_CHAR;
    case NcValue::kByte:
      return NC_BYTE;
    case NcValue::kShort:
      return NC_SHORT;
    case NcValue::kInt:
      return NC_INT;
    case NcValue::kFloat:
      return NC_FLOAT;
    case NcValue::kDouble:
      return NC_DOUBLE;
  }
  throw std::invalid_argument("unknown kind of values");
}

void put_attributes(int file, int variable, const NcAttribute* list, std::size_t count) {
  for (std::size_t at = 0; at < count; ++at) {
    const NcAttribute& a = list[at];
    const int code =
        a.text ? nc_put_att_text(file, variable, a.name, std::string(a.text).size(), a.text)
               : nc_put_att_double(file, variable, a.name, type_of(a.value), a.count, a.numbers);
    check(code, "attribute", a.name);
  }
}

void define_variable(NcOpenFile& file, const NcFileSpec& spec, const NcVariable& v) {
  NcOpenFile::Variable kept{v.value, {}};
  std::vector<int> dimensions(v.dimensions, v.dimensions + v.rank);
  for (const int d : dimensions) kept.shape.push_back(spec.dimensions[d].length);
  int id = 0;
  check(nc_def_var(file.id, v.name, type_of(v.value), int(v.rank), dimensions.data(), &id),
        "variable", v.name);
  put_attributes(file.id, id, v.attributes, v.attribute_count);
  if (spec.format == NcFormat::kNetcdf4 && v.rank >= 2) {
    // One chunk per slab: what is put at once is packed at once.
    std::vector<std::size_t> chunk(v.rank, 1);
    for (std::size_t at = v.rank - 2; at < v.rank; ++at)
      chunk[at] = std::max<std::size_t>(kept.shape[at], 1);
    check(nc_def_var_chunking(file.id, id, NC_CHUNKED, chunk.data()), "chunks", v.name);
    // and no cache of many, which is 16 MiB for each variable
    check(nc_set_var_chunk_cache(file.id, id, 4096, 1, 1), "cache", v.name);
    if (spec.deflate > 0)
      check(nc_def_var_deflate(file.id, id, 1, 1, spec.deflate), "deflate", v.name);
  }
  file.variables.push_back(std::move(kept));
}

std::unique_ptr<NcOpenFile> create(const NcFileSpec& spec) {
  auto file = std::make_unique<NcOpenFile>();
  file->path = spec.path;
  file->temporary = file->path + ".part";
  const int mode = spec.format == NcFormat::kNetcdf4    ? NC_NETCDF4
                   : spec.format == NcFormat::kOffset64 ? NC_64BIT_OFFSET
                                                        : 0;
  check(nc_create(file->temporary.c_str(), NC_CLOBBER | mode, &file->id), "file", spec.path);
  for (std::size_t at = 0; at < spec.dimension_count; ++at) {
    const NcDimension& d = spec.dimensions[at];
    int id = 0;
    check(nc_def_dim(file->id, d.name, d.unlimited ? NC_UNLIMITED : d.length, &id), "dimension",
          d.name);
  }
  for (std::size_t at = 0; at < spec.variable_count; ++at)
    define_variable(*file, spec, spec.variables[at]);
  put_attributes(file->id, NC_GLOBAL, spec.attributes, spec.attribute_count);
  check(nc_enddef(file->id), "header", spec.path);
  return file;
}

void put(NcOpenFile& file, std::size_t variable, std::size_t slab, const double* values) {
  const NcOpenFile::Variable& v = file.variables.at(variable);
  const std::size_t rank = v.shape.size(), leading = rank > 2 ? rank - 2 : 0;
  std::vector<std::size_t> start(rank, 0), count(v.shape);
  for (std::size_t at = leading; at-- > 0; slab /= v.shape[at])
    start[at] = slab % v.shape[at], count[at] = 1;
  int code = 0;
  if (v.value == NcValue::kChar) {
    std::size_t size = 1;
    for (const std::size_t c : count) size *= c;
    std::string text(size, ' ');
    for (std::size_t at = 0; at < size; ++at) text[at] = char(values[at]);
    code = nc_put_vara_text(file.id, int(variable), start.data(), count.data(), text.data());
  } else {
    code = nc_put_vara_double(file.id, int(variable), start.data(), count.data(), values);
  }
  char name[NC_MAX_NAME + 1] = {};
  nc_inq_varname(file.id, int(variable), name);
  check(code, "values of", name);
}

void close(NcOpenFile& file) {
  check(nc_close(file.id), "closing", file.path.c_str());
  file.id = -1;
  std::filesystem::rename(file.temporary, file.path);
}

template <class Act>
int guarded(char* error, std::size_t size, Act&& act) {
  try {
    return act(), 0;
  } catch (const std::exception& e) {
    std::snprintf(error, size, "%s", e.what());
  } catch (...) {
    std::snprintf(error, size, "an unknown failure");
  }
  return 1;
}

}  // namespace
}  // namespace nepho

#define NEPHO_EXPORTED __attribute__((visibility("default")))

NEPHO_EXPORTED int nepho_nc_create(const nepho::NcFileSpec* spec, nepho::NcOpenFile** file,
                                   char* error, std::size_t size) {
  return nepho::guarded(error, size, [&] { *file = nepho::create(*spec).release(); });
}

NEPHO_EXPORTED int nepho_nc_put(nepho::NcOpenFile* file, std::size_t variable, std::size_t slab,
                                const double* values, char* error, std::size_t size) {
  return nepho::guarded(error, size, [&] { nepho::put(*file, variable, slab, values); });
}

NEPHO_EXPORTED int nepho_nc_close(nepho::NcOpenFile* file, bool keep, char* error,
                                  std::size_t size) {
  const std::unique_ptr<nepho::NcOpenFile> gone(file);
  return nepho::guarded(error, size, [&] {
    if (keep) nepho::close(*file);
  });
}
