// By what a file tells its model: name_table.h.
#include <algorithm>
#include <array>

#include "forecast/conventions/name_table.h"

namespace nepho::forecast {
namespace {

// One way to know a model by: a word in any of the file's usual attributes of origin, or variables
// and dimensions that no other has together.
struct Mark {
  const char* model;
  const char* word;
  std::array<const char*, 3> holds = {};  // variables or dimensions, all of them
};
constexpr Mark kMarks[] = {{"WRF", "WRF"},
                           {"WRF", nullptr, {"PHB", "bottom_top_stag"}},
                           {"PALM", "PALM"},
                           {"PALM", nullptr, {"zu_3d"}},
                           {"MicroHH", "MicroHH"},
                           {"UCLA-LES", "UCLA"},
                           {"UCLA-LES", nullptr, {"dn0", "zt", "xt"}},
                           {"DALES", "DALES"},
                           {"DALES", nullptr, {"thl", "zt", "xt"}},
                           {"DALES", nullptr, {"ql", "zt", "xt"}},
                           {"SAM", nullptr, {"TABS"}},
                           {"CM1", "CM1"},
                           {"CM1", nullptr, {"prs", "th", "zh"}},
                           {"UM", "Unified Model"},
                           {"UM", nullptr, {"mr_lsliq"}},
                           {"ICON", "ICON"},
                           {"ICON", nullptr, {"z_ifc", "z_mc"}},
                           {"AROME", "AROME"},
                           {"AROME", "HARMONIE"},
                           {"COSMO", "COSMO"},
                           {"GFS", "GFS"},
                           {"IFS", "ECMWF"},
                           {"IFS", "Integrated Forecast"}};

bool holds(const DataFile& file, const std::string& name) {
  return file.find(name) || std::ranges::find(file.dimensions(), name, &FileDimension::name) !=
                                file.dimensions().end();
}

}  // namespace

std::string model_of_file(const DataFile& file) {
  std::string origin;
  for (const char* attribute : {"TITLE", "title", "source", "model", "Model", "institution"})
    origin += file.text(attribute) + "\n";
  if (!file.text("CM1 version").empty()) return "CM1";
  for (const Mark& mark : kMarks) {
    if (mark.word ? origin.find(mark.word) != std::string::npos
                  : std::ranges::all_of(
                        mark.holds, [&](const char* name) { return !name || holds(file, name); }))
      return mark.model;
  }
  return "";
}

}  // namespace nepho::forecast
