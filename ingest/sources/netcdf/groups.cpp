#include "sources/netcdf/groups.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string_view>

namespace nepho::netcdf {
namespace {

std::string path_of(const InGroup& one) {
  return one.group.empty() ? one.name : one.group + "/" + one.name;
}

std::string parent(const std::string& group) {
  const auto slash = group.rfind('/');
  return slash == std::string::npos ? "" : group.substr(0, slash);
}

// Names that more than one group has.
std::set<std::string> repeated(const std::vector<InGroup>& all) {
  std::map<std::string, int> count;
  for (const InGroup& one : all) ++count[one.name];
  std::set<std::string> names;
  for (const auto& [name, times] : count)
    if (times > 1) names.insert(name);
  return names;
}

// Its index among the variables, or -1.
int resolve(const std::string& word, const std::string& group,
            const std::vector<InGroup>& variables) {
  const auto at = [&](const std::string& path) {
    const auto found = std::ranges::find(variables, path, path_of);
    return found == variables.end() ? -1 : int(found - variables.begin());
  };
  if (word.front() == '/') return at(word.substr(1));
  for (std::string scope = group;; scope = parent(scope)) {
    const auto path = std::filesystem::path(scope) / word;
    if (const int found = at(path.lexically_normal().generic_string()); found >= 0) return found;
    if (scope.empty()) break;
  }
  if (std::ranges::count(variables, word, &InGroup::name) != 1) return -1;
  return int(std::ranges::find(variables, word, &InGroup::name) - variables.begin());
}

}  // namespace

GroupNames flat_names(const std::vector<InGroup>& dimensions,
                      const std::vector<InGroup>& variables) {
  const auto flat = [](const std::vector<InGroup>& all) {
    std::set<std::string> by_path = repeated(all);
#ifdef NEPHO_MUTANT_GROUPS_MIXED
    by_path.clear();
#endif
    std::vector<std::string> names;
    for (const InGroup& one : all)
      names.push_back(by_path.contains(one.name) ? path_of(one) : one.name);
    return names;
  };
  GroupNames names{flat(dimensions), flat(variables)};
  for (std::size_t v = 0; v < variables.size(); ++v) {
    if (variables[v].axis_of < 0) continue;
    const std::string& wanted = names.dimensions[std::size_t(variables[v].axis_of)];
    if (std::ranges::find(names.variables, wanted) == names.variables.end())
      names.variables[v] = wanted;
  }
  return names;
}

bool names_variables(const std::string& attribute) {
  static constexpr std::array<std::string_view, 7> kNaming = {
      "coordinates",      "bounds",           "grid_mapping",          "formula_terms",
      "node_coordinates", "face_coordinates", "face_node_connectivity"};
  return std::ranges::find(kNaming, attribute) != kNaming.end();
}

std::string flat_references(const std::string& attribute, const std::string& text,
                            const std::string& group, const std::vector<InGroup>& variables,
                            const std::vector<std::string>& flat) {
  std::istringstream in(text);
  std::string result;
  for (std::string word; in >> word;) {
    const bool colon = word.back() == ':';
    if (colon) word.pop_back();
    // "ps: surface_pressure": a term, then a variable; "crs: lat lon": variables.
    const bool term = colon && attribute == "formula_terms";
    if (const int found = term || word.empty() ? -1 : resolve(word, group, variables); found >= 0)
      word = flat[std::size_t(found)];
    result += (result.empty() ? "" : " ") + word + (colon ? ":" : "");
  }
  return result;
}

}  // namespace nepho::netcdf
