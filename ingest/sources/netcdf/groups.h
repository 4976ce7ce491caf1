#pragma once

#include <string>
#include <vector>

namespace nepho::netcdf {

// One name space over the groups of a netCDF-4 file (CF 1.11, 2.7), so that conventions see a flat
// file. What only one group has keeps its short name, as does all of the root; what several have is
// named by its path without the leading slash: "d02/QCLOUD".

struct InGroup {
  std::string group;  // "" for the root, "a/b" for /a/b
  std::string name;   // short
  int axis_of = -1;  // of a variable: the dimension that it is the coordinate variable of, by index
};

struct GroupNames {
  std::vector<std::string> dimensions, variables;  // as InGroup were given
};

// Coordinate variables bear the name of their dimension.
GroupNames flat_names(const std::vector<InGroup>& dimensions,
                      const std::vector<InGroup>& variables);

// The text of an attribute that names variables ("coordinates", "formula_terms", "bounds", ...),
// each word put by its flat name: by its path where it has one, else sought in the group of the
// variable that has the attribute, then in its ancestors, then, if only one other group has it,
// there (CF 1.11, 2.7.1). Words that name nothing stay.
std::string flat_references(const std::string& attribute, const std::string& text,
                            const std::string& group, const std::vector<InGroup>& variables,
                            const std::vector<std::string>& flat);
bool names_variables(const std::string& attribute);

}  // namespace nepho::netcdf
