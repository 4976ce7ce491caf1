#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "nc_output.h"

namespace nepho::samples {

// A whole file in memory, to be changed before it is written.
struct TinyFile {
  NcLayout layout;
  std::map<std::string, std::vector<double>> values;

  void add(const NcField& field, std::vector<double> all) {
    values[field.name] = std::move(all);
    layout.fields.push_back(field);
  }
  void scale(const std::string& field, double factor) {
    for (double& v : values.at(field)) v *= factor;
  }
  void reverse(const std::string& axis);  // with all that lies along it
};

void write_tiny(const std::filesystem::path& path, const TinyFile& file, const NcWriter& writer);

}  // namespace nepho::samples
