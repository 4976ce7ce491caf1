#pragma once

#include <gtest/gtest.h>
#include <netcdf.h>

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"
#include "sources/netcdf/open_netcdf.h"
#include "test_folder.h"

namespace nepho::forecast::test {

inline const nepho::test::TestFolder& folder() {
  static const nepho::test::TestFolder folder("nc");
  return folder;
}

using Attribute = std::variant<std::string, double, std::vector<double>>;
using Attributes = std::map<std::string, Attribute>;

// Writes one file with netCDF-C: dimensions, then variables with their values, in any order. Names
// may be paths: "group/name".
class NcWriter {
 public:
  explicit NcWriter(const std::string& path, int format = NC_NETCDF4) {
    check(nc_create(path.c_str(), NC_CLOBBER | format, &id_));
  }
  ~NcWriter() { nc_close(id_); }
  void dimension(const std::string& name, std::size_t size) {
    const auto [group, plain] = place(name);
    check(nc_def_dim(group, plain.c_str(), size, &dimensions_[name]));
  }
  // Numbers are attributes of the variable's own type where it is one of numbers. Chunks have a
  // checksum.
  void variable(const std::string& name, int type, const std::vector<std::string>& dimensions,
                const std::vector<double>& values, const Attributes& attributes = {},
                const std::vector<std::size_t>& checked_chunks = {}) {
    int variable = 0;
    std::vector<int> ids;
    for (const auto& d : dimensions) ids.push_back(dimensions_.at(d));
    nc_redef(id_);
    const auto [group, plain] = place(name);
    check(nc_def_var(group, plain.c_str(), type, int(ids.size()), ids.data(), &variable));
    if (!checked_chunks.empty()) {
      check(nc_def_var_chunking(group, variable, NC_CHUNKED, checked_chunks.data()));
      check(nc_def_var_fletcher32(group, variable, NC_FLETCHER32));
    }
    for (const auto& [key, value] : attributes) attribute(group, variable, key, value, type);
    nc_enddef(id_);
    if (!values.empty()) check(nc_put_var_double(group, variable, values.data()));
  }
  void text(const std::string& name, const std::vector<std::string>& dimensions,
            const std::string& characters) {
    variable(name, NC_CHAR, dimensions, {});
    int id = 0;
    check(nc_inq_varid(id_, name.c_str(), &id));
    check(nc_put_var_text(id_, id, characters.data()));
  }
  void global(const std::string& name, const Attribute& value) {
    nc_redef(id_);
    const auto [group, plain] = place(name);
    attribute(group, NC_GLOBAL, plain, value, NC_DOUBLE);
    nc_enddef(id_);
  }

 private:
  static void check(int status) { ASSERT_EQ(status, NC_NOERR) << nc_strerror(status); }
  // The group of a path, made where it is not there yet, and the last of its names.
  std::pair<int, std::string> place(const std::string& path) const {
    int group = id_;
    std::size_t from = 0;
    for (std::size_t to; (to = path.find('/', from)) != std::string::npos; from = to + 1) {
      const std::string name = path.substr(from, to - from);
      int child = 0;
      if (nc_inq_grp_ncid(group, name.c_str(), &child) != NC_NOERR)
        check(nc_def_grp(group, name.c_str(), &child));
      group = child;
    }
    return {group, path.substr(from)};
  }
  static void attribute(int group, int variable, const std::string& key, const Attribute& value,
                        int type) {
    if (const auto* text = std::get_if<std::string>(&value)) {
      check(nc_put_att_text(group, variable, key.c_str(), text->size(), text->data()));
      return;
    }
    const auto* one = std::get_if<double>(&value);
    const std::vector<double> list =
        one ? std::vector<double>{*one} : std::get<std::vector<double>>(value);
    const bool is_packing = key == "scale_factor" || key == "add_offset";
    check(nc_put_att_double(group, variable, key.c_str(), is_packing ? NC_DOUBLE : type,
                            list.size(), list.data()));
  }

  int id_ = -1;
  std::map<std::string, int> dimensions_;
};

inline std::unique_ptr<Forecast> open(const std::string& path, bool force = false,
                                      std::optional<Region> region = {}) {
  OpenRequest request;
  request.files = {path};
  request.force = force;
  request.region = region;
  return netcdf::open_netcdf(request);
}

// What opening says; "" where it succeeds.
inline std::string refusal(const std::string& path) {
  try {
    open(path);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace nepho::forecast::test
