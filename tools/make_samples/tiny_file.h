#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "nc_output.h"

namespace nepho::samples {

// Attributes of text and of numbers.
inline NcNote text_note(const char* name, const std::string& value) {
  return {name, value};
}
inline NcNote real_note(const char* name, std::vector<double> values) {
  return {name, "", std::move(values), NcValue::kDouble};
}

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
