#include "sources/netcdf/nc_file.h"

#include <hdf5.h>
#include <netcdf.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <numeric>

#include "api/module_support.h"
#include "core/error.h"
#include "forecast/files/survives.h"
#include "sources/netcdf/classic_size.h"
#include "sources/netcdf/groups.h"

namespace nepho::netcdf {
namespace {

constexpr std::size_t kBlockValues = std::size_t(1) << 18;  // unpacked at once: 2 MiB of doubles
// Of each variable while the file is open. netCDF's own 16 MiB keep all that was ever read; here
// everything is read once, or nearly.
constexpr std::size_t kChunkCache_bytes = std::size_t(1) << 20, kChunkCacheSlots = 1009;

// netCDF switches HDF5's error printing off on the thread that first calls it; HDF5 keeps that
// setting per thread.
void silence_hdf5() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

[[noreturn]] void refuse(const std::string& path, int status) {
  if (status == NC_ENOTNC)
    throw Error({"this is not a netCDF file", path, "netCDF-3 (CDF) or netCDF-4 (HDF5)",
                 "another kind of file",
                 "a GRIB file can be converted: grib_to_netcdf, cdo -f nc"});
  throw Error({"netCDF cannot read the file", path, "an intact netCDF file", nc_strerror(status),
               "it is cut short or damaged: write or copy it again"});
}

void check_plain_file(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw Error({"no such file", path, "", "", ""});
  if (!std::filesystem::is_regular_file(status))
    throw Error({"this is no file", path, "a netCDF file", "a folder or a device", ""});
  if (std::filesystem::file_size(path, error) == 0)
    throw Error({"the file is empty", path, "a netCDF file", "0 bytes", "write or copy it again"});
}

bool is_hdf5(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string magic(4, '\0');
  in.read(magic.data(), 4);
  return magic == "\x89HDF";
}

std::string trimmed(std::string text) {
  while (!text.empty() &&
         (text.back() == '\0' || std::isspace(static_cast<unsigned char>(text.back()))))
    text.pop_back();
  const auto first = std::ranges::find_if(text, [](unsigned char c) { return !std::isspace(c); });
  return {first, text.end()};
}

bool is_number(int type) {
  return type != NC_CHAR && type != NC_STRING && type <= NC_UINT64 && type >= NC_BYTE;
}

FileAttribute read_attribute(int file, int variable, const char* name) {
  FileAttribute result{name, "", {}};
  nc_type type = 0;
  std::size_t length = 0;
  if (nc_inq_att(file, variable, name, &type, &length) != NC_NOERR) return result;
  if (type == NC_CHAR) {
    std::string text(length, '\0');
    if (length && nc_get_att_text(file, variable, name, text.data()) == NC_NOERR)
      result.text = trimmed(text);
  } else if (type == NC_STRING && length > 0) {
    std::vector<char*> strings(length, nullptr);
    if (nc_get_att_string(file, variable, name, strings.data()) == NC_NOERR) {
      if (strings[0]) result.text = trimmed(strings[0]);
      nc_free_string(length, strings.data());
    }
  } else if (is_number(type)) {
    result.numbers.resize(length);
    if (length && nc_get_att_double(file, variable, name, result.numbers.data()) != NC_NOERR)
      result.numbers.clear();
  }
  return result;
}

void read_attributes(int file, int variable, int count, std::vector<FileAttribute>& attributes) {
  for (int a = 0; a < count; ++a) {
    char name[NC_MAX_NAME + 1] = {};
    if (nc_inq_attname(file, variable, a, name) == NC_NOERR)
      attributes.push_back(read_attribute(file, variable, name));
  }
}

}  // namespace

template <class Action>
auto NcFile::locked(Action&& action) const {
  return tbb::this_task_arena::isolate([&] {
    const IoGuard guard(io_lock_);
    silence_hdf5();
    return action();
  });
}

NcFile::NcFile(std::string path, IoLock io_lock) : DataFile(std::move(path)), io_lock_(io_lock) {
  check_plain_file(path_);
  check_classic_size(path_);
  const auto open = [&] {
#ifndef NEPHO_MUTANT_KEPT_CHUNKS
    nc_set_chunk_cache(kChunkCache_bytes, kChunkCacheSlots, 0.75f);
#endif
    if (const int status = nc_open(path_.c_str(), NC_NOWRITE, &id_)) refuse(path_, status);
    try {
      inquire();
    } catch (...) {
      nc_close(id_);
      throw;
    }
  };
  locked([&] {
    // Elsewhere first, all of it: much of the headers is read only when it is asked for.
    if (is_hdf5(path_) && !forecast::survives([&] { open(), nc_close(id_); }))
      throw Error({"netCDF cannot read the file", path_, "an intact netCDF file",
                   "headers that the HDF5 library breaks down on",
                   "it is damaged: write or copy it again"});
    open();
  });
}

NcFile::~NcFile() {
  locked([&] { nc_close(id_); });
}

// What the groups hold, as it is met; dimensions_ and variables_ go along.
struct NcFile::Contents {
  std::vector<InGroup> dimensions, variables;
  std::map<int, int> dimension_of;  // by netCDF's number, which is one in all groups
};

void NcFile::inquire() {
  Contents contents;
  inquire_group(id_, "", contents);
  bytes_ = std::vector<std::atomic<std::uint64_t>>(variables_.size());
  const GroupNames flat = flat_names(contents.dimensions, contents.variables);
  for (std::size_t d = 0; d < dimensions_.size(); ++d) dimensions_[d].name = flat.dimensions[d];
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    FileVariable& variable = variables_[v];
    variable.id = int(v);
    variable.name = flat.variables[v];
    for (FileAttribute& a : variable.attributes)
      if (names_variables(a.name))
        a.text = flat_references(a.name, a.text, contents.variables[v].group, contents.variables,
                                 flat.variables);
  }
}

// Ancestors first: what the root says of the file comes before what its groups say.
void NcFile::inquire_group(int group, const std::string& path, Contents& contents) {
  int variables = 0, attributes = 0, dimensions = 0, groups = 0;
  if (const int status = nc_inq(group, nullptr, &variables, &attributes, nullptr))
    refuse(path_, status);
  if (const int status = nc_inq_dimids(group, &dimensions, nullptr, 0)) refuse(path_, status);
  std::vector<int> ids(static_cast<std::size_t>(dimensions));  // NC_MAX_DIMS is not kept
  if (const int status = nc_inq_dimids(group, &dimensions, ids.data(), 0)) refuse(path_, status);
  for (int d = 0; d < dimensions; ++d) {
    char name[NC_MAX_NAME + 1] = {};
    const int id = ids[std::size_t(d)];
    forecast::FileDimension dimension;
    if (const int status = nc_inq_dim(group, id, name, &dimension.size)) refuse(path_, status);
    contents.dimension_of[id] = int(dimensions_.size());
    contents.dimensions.push_back({path, name});
    dimensions_.push_back(dimension);
  }
  for (int v = 0; v < variables; ++v) {
    variables_.push_back(inquire_variable(group, v));
    FileVariable& variable = variables_.back();
    variable.group = path;
    for (int& d : variable.dimensions) d = contents.dimension_of.at(d);
    const int axis = variable.dimensions.size() == 1 ? variable.dimensions[0] : -1;
    const bool named_so = axis >= 0 && contents.dimensions[std::size_t(axis)].name == variable.name;
    contents.variables.push_back({path, variable.name, named_so ? axis : -1});
  }
  std::vector<FileAttribute> own;
  read_attributes(group, NC_GLOBAL, attributes, own);
  for (FileAttribute& a : own)
    if (!global_.attribute(a.name)) global_.attributes.push_back(std::move(a));
  if (const int status = nc_inq_grps(group, &groups, nullptr)) refuse(path_, status);
  std::vector<int> below(static_cast<std::size_t>(groups));
  if (const int status = nc_inq_grps(group, &groups, below.data())) refuse(path_, status);
  for (const int child : below) {
    char name[NC_MAX_NAME + 1] = {};
    if (const int status = nc_inq_grpname(child, name)) refuse(path_, status);
    inquire_group(child, (path.empty() ? "" : path + "/") + name, contents);
  }
}

FileVariable NcFile::inquire_variable(int group, int id) {
  char name[NC_MAX_NAME + 1] = {};
  FileVariable variable;
  int type = 0, dimensions = 0, attributes = 0;
  std::vector<int> ids(NC_MAX_VAR_DIMS);
  if (const int status = nc_inq_var(group, id, name, &type, &dimensions, ids.data(), &attributes))
    refuse(path_, status);
  variable.name = name;
  handles_.push_back({group, id, type});
  variable.numeric = is_number(type);
  nc_inq_type(group, type, nullptr, &variable.value_bytes);
  ids.resize(std::size_t(dimensions));
  variable.dimensions = ids;
  read_attributes(group, id, attributes, variable.attributes);
  return variable;
}

forecast::VariableBytes NcFile::bytes_read(const FileVariable& variable) const {
  return {variable.name, bytes_[std::size_t(variable.id)],
          values_in(variable) * variable.value_bytes};
}

// Floats without packing are read where they stay; all else goes through blocks of doubles along
// the slowest dimension.
template <class T>
std::vector<T> NcFile::read(const FileVariable& variable, const std::vector<std::size_t>& start,
                            const std::vector<std::size_t>& count) const {
  const auto [group, id, type] = handles_[std::size_t(variable.id)];
  const Packing packing = packing_of(variable, type);
  const std::size_t total =
      std::accumulate(count.begin(), count.end(), std::size_t{1}, std::multiplies<>());
  std::vector<T> result(total);
  if (total == 0) return result;
  bytes_[std::size_t(variable.id)] += total * variable.value_bytes;
  const auto fail = [&](int status) {
    throw Error({"netCDF cannot read the variable", where(variable), "an intact netCDF file",
                 nc_strerror(status), "the file is cut short or damaged: write or copy it again"});
  };
  if constexpr (std::is_same_v<T, float>)
    if (type == NC_FLOAT) {
      locked([&] {
        if (const int status =
                nc_get_vara_float(group, id, start.data(), count.data(), result.data()))
          fail(status);
      });
      packing.unpack(result.data(), result.size(), result.data());
      return result;
    }
  std::vector<std::size_t> at = start, some = count;
  const std::size_t rows = count.empty() ? 1 : count[0], row = total / rows;
  const std::size_t block_rows = std::max<std::size_t>(1, kBlockValues / row);
  std::vector<double> block(std::min(rows, block_rows) * row);
  for (std::size_t first = 0; first < rows; first += block_rows) {
    const std::size_t height = std::min(block_rows, rows - first);
    if (!count.empty()) {
      at[0] = start[0] + first;
      some[0] = height;
    }
    locked([&] {
      if (const int status = nc_get_vara_double(group, id, at.data(), some.data(), block.data()))
        fail(status);
    });
    packing.unpack(block.data(), height * row, &result[first * row]);
  }
  return result;
}

std::vector<float> NcFile::read_floats(const FileVariable& variable,
                                       const std::vector<std::size_t>& start,
                                       const std::vector<std::size_t>& count) const {
  return read<float>(variable, start, count);
}

std::vector<double> NcFile::read_doubles(const FileVariable& variable,
                                         const std::vector<std::size_t>& start,
                                         const std::vector<std::size_t>& count) const {
  return read<double>(variable, start, count);
}

std::vector<std::string> NcFile::read_texts(const FileVariable& variable) const {
  const std::vector<std::size_t> count = shape(variable);
  const std::size_t total = values_in(variable);
  bytes_[std::size_t(variable.id)] += total * variable.value_bytes;
  const auto [group, id, type] = handles_[std::size_t(variable.id)];
  std::vector<std::string> result;
  locked([&] {
    if (type == NC_CHAR) {
      const std::size_t length = count.empty() ? 1 : count.back();
      std::string all(total, '\0');
      if (nc_get_var_text(group, id, all.data()) != NC_NOERR) return;
      for (std::size_t at = 0; length > 0 && at + length <= total; at += length)
        result.push_back(trimmed(all.substr(at, length)));
    } else if (type == NC_STRING) {
      std::vector<char*> strings(total, nullptr);
      if (nc_get_var_string(group, id, strings.data()) != NC_NOERR) return;
      for (const char* text : strings) result.push_back(text ? trimmed(text) : "");
      nc_free_string(total, strings.data());
    }
  });
  return result;
}

}  // namespace nepho::netcdf
