#include "forecast/files/data_file.h"

#include <algorithm>

namespace nepho::forecast {

const FileAttribute* FileVariable::attribute(const std::string& wanted) const {
  const auto at = std::ranges::find(attributes, wanted, &FileAttribute::name);
  return at == attributes.end() ? nullptr : &*at;
}

std::string FileVariable::text(const std::string& wanted) const {
  const FileAttribute* found = attribute(wanted);
  return found ? found->text : "";
}

std::optional<double> FileVariable::number(const std::string& wanted) const {
  const FileAttribute* found = attribute(wanted);
  if (!found || found->numbers.empty()) return {};
  return found->numbers.front();
}

const FileVariable* DataFile::find(const std::string& wanted) const {
  const auto at = std::ranges::find(variables_, wanted, &FileVariable::name);
  return at == variables_.end() ? nullptr : &*at;
}

std::vector<std::size_t> DataFile::shape(const FileVariable& variable) const {
  std::vector<std::size_t> sizes;
  for (const int d : variable.dimensions) sizes.push_back(size(d));
  return sizes;
}

std::string DataFile::shape_text(const FileVariable& variable) const {
  std::string text;
  for (const int d : variable.dimensions)
    text += (text.empty() ? "" : ", ") + name(d) + " " + std::to_string(size(d));
  return variable.name + "(" + text + ")";
}

std::size_t DataFile::values_in(const FileVariable& variable) const {
  std::size_t total = 1;
  for (const int d : variable.dimensions) total *= size(d);
  return total;
}

std::vector<double> DataFile::read_all(const FileVariable& variable) const {
  const std::vector<std::size_t> count = shape(variable);
  return read_doubles(variable, std::vector<std::size_t>(count.size(), 0), count);
}

void DataFile::set_attribute(int variable, const std::string& name, const std::string& text) {
  std::vector<FileAttribute>& all = variables_[std::size_t(variable)].attributes;
  std::erase_if(all, [&](const FileAttribute& a) { return a.name == name; });
  all.push_back({name, text, {}});
}

}  // namespace nepho::forecast
