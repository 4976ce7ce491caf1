#pragma once

#include <map>

#include "made_file.h"

namespace nepho::test {

// A netCDF file cut along dimensions as ncks does it: all variables and attributes, indices
// [first, first + count) of the dimensions that are named.
struct CutRange {
  std::size_t first, count;
};
using Cuts = std::map<std::string, CutRange>;

class CutFile {
 public:
  CutFile(const fs::path& from, const fs::path& to, const Cuts& cuts) : cuts_(cuts) {
    check(nc_open(from.c_str(), NC_NOWRITE, &in_));
    check(nc_create(to.c_str(), NC_NETCDF4 | NC_CLOBBER, &out_));
    copy();
    check(nc_close(out_));
    check(nc_close(in_));
  }

  // Names of a variable's dimensions, slowest first; and all with their lengths.
  static std::vector<std::string> dimensions_of(const fs::path& path, const std::string& name) {
    int file = 0, id = 0, rank = 0, dims[NC_MAX_VAR_DIMS];
    check(nc_open(path.c_str(), NC_NOWRITE, &file));
    check(nc_inq_varid(file, name.c_str(), &id));
    check(nc_inq_varndims(file, id, &rank));
    check(nc_inq_vardimid(file, id, dims));
    std::vector<std::string> names;
    for (int n = 0; n < rank; ++n) {
      char text[NC_MAX_NAME + 1];
      check(nc_inq_dimname(file, dims[n], text));
      names.push_back(text);
    }
    check(nc_close(file));
    return names;
  }
  static std::map<std::string, std::size_t> lengths(const fs::path& path) {
    int file = 0, count = 0;
    check(nc_open(path.c_str(), NC_NOWRITE, &file));
    check(nc_inq_ndims(file, &count));
    std::map<std::string, std::size_t> all;
    for (int n = 0; n < count; ++n) {
      char text[NC_MAX_NAME + 1];
      std::size_t size = 0;
      check(nc_inq_dim(file, n, text, &size));
      all[text] = size;
    }
    check(nc_close(file));
    return all;
  }

 private:
  static void check(int code) {
    if (code != NC_NOERR) throw std::runtime_error(nc_strerror(code));
  }
  void copy_attributes(int from, int to, int count) {
    for (int n = 0; n < count; ++n) {
      char name[NC_MAX_NAME + 1];
      check(nc_inq_attname(in_, from, n, name));
      if (std::string(name) != "_FillValue") check(nc_copy_att(in_, from, name, out_, to));
    }
  }
  void copy() {
    int dims = 0, variables = 0, attributes = 0;
    check(nc_inq(in_, &dims, &variables, &attributes, nullptr));
    std::vector<CutRange> ranges;
    for (int n = 0; n < dims; ++n) {
      char name[NC_MAX_NAME + 1];
      std::size_t size = 0;
      check(nc_inq_dim(in_, n, name, &size));
      const auto cut = cuts_.find(name);
      ranges.push_back(cut == cuts_.end() ? CutRange{0, size} : cut->second);
      int made = 0;
      check(nc_def_dim(out_, name, ranges.back().count, &made));
    }
    copy_attributes(NC_GLOBAL, NC_GLOBAL, attributes);
    for (int v = 0; v < variables; ++v) copy_variable(v, ranges);
  }
  void copy_variable(int v, const std::vector<CutRange>& ranges) {
    char name[NC_MAX_NAME + 1];
    nc_type type = 0;
    int rank = 0, dims[NC_MAX_VAR_DIMS], attributes = 0, made = 0;
    check(nc_inq_var(in_, v, name, &type, &rank, dims, &attributes));
    check(nc_def_var(out_, name, type, rank, dims, &made));
    copy_attributes(v, made, attributes);
    std::vector<std::size_t> start, count;
    std::size_t total = 1, bytes = 0;
    for (int d = 0; d < rank; ++d) {
      const CutRange& range = ranges[std::size_t(dims[d])];
      start.push_back(range.first);
      count.push_back(range.count);
      total *= range.count;
    }
    check(nc_inq_type(in_, type, nullptr, &bytes));
    std::vector<char> values(total * bytes);
    check(nc_get_vara(in_, v, start.data(), count.data(), values.data()));
    check(nc_put_vara(out_, made, std::vector<std::size_t>(start.size(), 0).data(), count.data(),
                      values.data()));
  }

  Cuts cuts_;
  int in_ = 0, out_ = 0;
};

}  // namespace nepho::test
