#pragma once

#include <netcdf.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "nc_output.h"

namespace nepho::test {

namespace fs = std::filesystem;

// A folder of this process, gone at its end.
class MadeFolder {
 public:
  MadeFolder() : path_(fs::temp_directory_path() / ("nepho_made_" + std::to_string(getpid()))) {
    fs::create_directories(path_);
  }
  ~MadeFolder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

inline const fs::path& made_folder() {
  static const MadeFolder folder;
  return folder.path();
}

inline const samples::NcWriter& nc_writer() {
  static const samples::NcWriter writer({NEPHO_TEST_MODULES});
  return writer;
}

// A file as netCDF-C reads it: nothing of ours between.
class MadeFile {
 public:
  explicit MadeFile(const fs::path& path) {
    check(nc_open(path.c_str(), NC_NOWRITE, &id_), path.string());
  }
  ~MadeFile() { nc_close(id_); }
  MadeFile(const MadeFile&) = delete;
  MadeFile& operator=(const MadeFile&) = delete;

  std::size_t length(const std::string& dimension) const {
    int dim = 0;
    std::size_t size = 0;
    check(nc_inq_dimid(id_, dimension.c_str(), &dim), dimension);
    check(nc_inq_dimlen(id_, dim, &size), dimension);
    return size;
  }
  std::vector<std::size_t> shape(const std::string& name) const {
    int rank = 0, dimensions[NC_MAX_VAR_DIMS];
    check(nc_inq_varndims(id_, variable(name), &rank), name);
    check(nc_inq_vardimid(id_, variable(name), dimensions), name);
    std::vector<std::size_t> sizes(std::size_t(rank), 0);
    for (std::size_t at = 0; at < sizes.size(); ++at)
      check(nc_inq_dimlen(id_, dimensions[at], &sizes[at]), name);
    return sizes;
  }
  // As stored: no scale, no offset.
  std::vector<double> values(const std::string& name) const {
    std::size_t size = 1;
    for (const std::size_t s : shape(name)) size *= s;
    std::vector<double> all(size);
    check(nc_get_var_double(id_, variable(name), all.data()), name);
    return all;
  }
  std::string text(const std::string& name) const {
    std::size_t size = 1;
    for (const std::size_t s : shape(name)) size *= s;
    std::string all(size, ' ');
    check(nc_get_var_text(id_, variable(name), all.data()), name);
    return all;
  }
  // Of a variable, or of the file ("").
  double number(const std::string& of, const std::string& attribute) const {
    double value = 0;
    check(nc_get_att_double(id_, owner(of), attribute.c_str(), &value), attribute);
    return value;
  }
  std::string note(const std::string& of, const std::string& attribute) const {
    std::size_t size = 0;
    check(nc_inq_attlen(id_, owner(of), attribute.c_str(), &size), of + ":" + attribute);
    std::string value(size, ' ');
    check(nc_get_att_text(id_, owner(of), attribute.c_str(), value.data()), attribute);
    return value;
  }

 private:
  static void check(int code, const std::string& what) {
    if (code != NC_NOERR) throw std::runtime_error(what + ": " + nc_strerror(code));
  }
  int variable(const std::string& name) const {
    int id = 0;
    check(nc_inq_varid(id_, name.c_str(), &id), name);
    return id;
  }
  int owner(const std::string& of) const { return of.empty() ? NC_GLOBAL : variable(of); }
  int id_ = 0;
};

}  // namespace nepho::test
