#include "forecast/conventions/names.h"

#include <algorithm>
#include <cctype>
#include <cstdio>

#include "core/error.h"
#include "units/constants.h"
#include "units/parse_unit.h"

namespace nepho::forecast {
namespace {

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

bool by_standard_name(const NameRow& row, const FileVariable& variable) {
  return *row.standard_name && lower(variable.text("standard_name")) == row.standard_name;
}

// Without its group.
std::string short_name(const FileVariable& variable) {
  return lower(variable.name.substr(variable.name.rfind('/') + 1));
}

bool by_name(const NameRow& row, const FileVariable& variable) {
  return *row.name && short_name(variable) == row.name;
}

bool answers(const NameRow& row, const FileVariable& variable) {
  return by_standard_name(row, variable) || by_name(row, variable);
}

Species species_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::kRain:
      return Species::kRain;
    case Quantity::kCloudIce:
      return Species::kCloudIce;
    case Quantity::kSnow:
      return Species::kSnow;
    case Quantity::kGraupel:
      return Species::kGraupel;
    default:
      return Species::kCloudWater;
  }
}

// The rows that can hold for a file.
class Names {
 public:
  explicit Names(const DataFile& file) : file_(file), model_(model_of_file(file)) {}

  bool is_own(const NameRow& row) const { return model_ == row.model; }
  bool holds(const NameRow& row) const { return !row.only_there || is_own(row); }

  // A user's word for a variable, and a model's name that means other things elsewhere, leave it no
  // other meaning.
  bool may_be(const FileVariable& variable, Quantity quantity) const {
    if (const std::string word = variable.text(kQuantityAttribute); !word.empty())
      return word == word_of(quantity);
    for (const NameRow& row : name_table())
      if (row.only_there && is_own(row) && by_name(row, variable)) return row.quantity == quantity;
    return true;
  }

  // The table's rows of a quantity: those that hold only in files of this model, those by standard
  // name, this model's, those of any model, other models'.
  std::vector<const NameRow*> rows(Quantity quantity) const {
    std::vector<const NameRow*> ordered;
    const auto rank = [&](const NameRow& row) {
      return row.only_there                        ? 0
             : *row.standard_name                  ? 1
             : is_own(row)                         ? 2
             : row.model == std::string(kAnyModel) ? 3
                                                   : 4;
    };
    for (const NameRow& row : name_table())
      if (row.quantity == quantity && holds(row)) ordered.push_back(&row);
    std::ranges::stable_sort(ordered, {}, [&](const NameRow* row) { return rank(*row); });
    return ordered;
  }

  // In the order of a user's file.
  std::vector<const FileVariable*> users(Quantity quantity) const {
    std::vector<const FileVariable*> found;
    for (const FileVariable& variable : file_.variables())
      if (variable.text(kQuantityAttribute) == word_of(quantity)) found.push_back(&variable);
    return found;
  }

 private:
  const DataFile& file_;
  std::string model_;
};

[[noreturn]] void refuse_units(const DataFile& file, const FileVariable& variable, const char* what,
                               const std::string& found) {
  throw Error({what, file.where(variable), "units such as kg kg-1, g/kg or g m-3", found,
               "set the attribute `units`, for example with ncatted -a units," + variable.name +
                   ",o,c,\"kg kg-1\", or say them in a file for --names: cloud_water " +
                   variable.name + " units=kg/kg"});
}

// The factor to kg/kg, or to kg/m3 with Basis::kVolume.
WaterVariable water_variable(const DataFile& file, const FileVariable& variable, Quantity quantity,
                             const NameRow* row) {
  const std::string unit = row && *row->units ? row->units : variable.text("units");
  if (unit.empty())
    refuse_units(file, variable, "the variable has no units", "no attribute `units`");
  Unit parsed;
  try {
    parsed = parse_unit(unit);
  } catch (const Error&) {
    refuse_units(file, variable, "the variable's units are not known", "\"" + unit + "\"");
  }
  WaterVariable result;
  result.species = species_of(quantity);
  result.variable = &variable;
  result.basis = row ? row->basis : Basis::kMoistAir;
  result.to_si = parsed.factor;
  result.row = row;
  const std::string per = variable.text(kPerAttribute);
  if (!row && per == "dry_air") result.basis = Basis::kDryAir;
#ifdef NEPHO_MUTANT_UNITS_1000
  result.to_si = 1;
#endif
  if (parsed.dimension == kDensity) {
    result.basis = Basis::kVolume;
  } else if (parsed.dimension != kDimensionless) {
    refuse_units(file, variable, "the variable's units are no water content", "\"" + unit + "\"");
  } else if (result.basis == Basis::kVolume) {
    result.basis = Basis::kMoistAir;
  }
  return result;
}

// A vertical sum (kg m-2), whatever it is called, is no field of water.
bool is_column(const FileVariable& variable) {
  try {
    return parse_unit(variable.text("units")).dimension == Dimension{.m = -2, .kg = 1};
  } catch (const Error&) {
    return false;
  }
}

// The first of the file's variables that answer to a row and are usable; null where none is.
// Refuses a second one in another group: nothing says which is meant.
template <class Usable>
const FileVariable* first_of(const DataFile& file, const Names& names, const NameRow& row,
                             Quantity quantity, const Usable& usable) {
  const FileVariable* first = nullptr;
  for (const FileVariable& variable : file.variables()) {
    if (first && variable.group == first->group) continue;
    if (!answers(row, variable) || !names.may_be(variable, quantity) || !usable(variable)) continue;
    if (first)
      throw Error({"variables of two groups stand for one quantity", file.path(), "one",
                   first->name + " and " + variable.name,
                   "say which in a file for --names: " + std::string(word_of(quantity)) + " " +
                       first->name});
    first = &variable;
  }
  return first;
}

// One kind of water: a user's variables, which add up; else the first row that has a variable, with
// the other parts of it.
void find_kind(const DataFile& file, const Names& names, Quantity quantity, const Accept& accept,
               std::vector<WaterVariable>& found) {
  const auto usable = [&](const FileVariable& variable) {
    return variable.numeric && accept(variable) && !is_column(variable);
  };
  const std::size_t before = found.size();
  for (const FileVariable* variable : names.users(quantity))
    if (usable(*variable)) found.push_back(water_variable(file, *variable, quantity, nullptr));
  if (found.size() > before) return;
  const NameRow* first = nullptr;
  for (const NameRow* row : names.rows(quantity)) {
    if (first && !(first->part && row->part && row->model == first->model)) continue;
    if (const FileVariable* variable = first_of(file, names, *row, quantity, usable)) {
      found.push_back(water_variable(file, *variable, quantity, row));
      first = row;
    }
  }
}

}  // namespace

const FileVariable* find_named(const DataFile& file, Quantity wanted, const Accept& accept) {
  const Names names(file);
  for (const FileVariable* variable : names.users(wanted))
    if (accept(*variable)) return variable;
  for (const NameRow* row : names.rows(wanted))
    if (const FileVariable* variable = first_of(file, names, *row, wanted, accept)) return variable;
  return nullptr;
}

const FileVariable* find_named(const DataFile& file, const std::vector<std::string>& names,
                               const Accept& accept) {
  for (const std::string& name : names)
    for (const FileVariable& variable : file.variables())
      if (lower(variable.name) == lower(name) && accept(variable)) return &variable;
  return nullptr;
}

const NameRow* row_of(const DataFile& file, Quantity quantity, const FileVariable& variable) {
  const Names names(file);
  if (!variable.text(kQuantityAttribute).empty()) return nullptr;
  for (const NameRow* row : names.rows(quantity))
    if (answers(*row, variable) && names.may_be(variable, quantity)) return row;
  return nullptr;
}

std::vector<WaterVariable> find_water(const DataFile& file, const Accept& accept) {
  const Names names(file);
  std::vector<WaterVariable> found;
  for (const Quantity quantity : {Quantity::kCloudWater, Quantity::kCloudIce, Quantity::kRain,
                                  Quantity::kSnow, Quantity::kGraupel})
    find_kind(file, names, quantity, accept, found);
  return found;
}

void divide_phases(std::vector<WaterVariable>& water, std::vector<std::string>& assumptions) {
  const auto has = [&](Species species) {
    return std::ranges::any_of(water, [&](const WaterVariable& w) { return w.species == species; });
  };
  const bool has_ice = has(Species::kCloudIce), has_snow = has(Species::kSnow);
  for (WaterVariable& w : water) {
    if (!w.row || w.row->all_ice_K == 0) continue;
    if (w.species == Species::kCloudWater ? has_ice : has_snow) continue;
    w.freezes_below_K = w.row->all_ice_K;
    w.liquid_above_K = w.row->all_liquid_K;
    char range[80];
    const double ice = w.freezes_below_K - constants::kZeroCelsius_K;
    const double liquid = w.liquid_above_K - constants::kZeroCelsius_K;
    if (ice == liquid)
      std::snprintf(range, sizeof range, "ice below %.0f degC is assumed.", ice);
    else
      std::snprintf(range, sizeof range,
                    "ice from %.0f degC down, all of it at %.0f degC, is assumed.", liquid, ice);
    assumptions.push_back(w.variable->name + " holds liquid and ice: " + range);
  }
}

namespace {

// Short enough for one message: standard names are told by their pattern.
std::string known_water_names() {
  std::string text;
  std::vector<std::string> said;
  for (const NameRow& row : name_table()) {
    if (row.quantity != Quantity::kCloudWater && row.quantity != Quantity::kCloudIce) continue;
    if (!*row.name || row.only_there || std::ranges::find(said, row.name) != said.end()) continue;
    said.emplace_back(row.name);
    text += (text.empty() ? "" : ", ") + said.back();
  }
  return text + ", or a standard_name mass_fraction_of_cloud_liquid_water_in_air or its like";
}

constexpr std::size_t kMostNames = 12;  // of a file with hundreds of variables

}  // namespace

void require_water(const DataFile& file, const std::vector<WaterVariable>& water) {
  if (!water.empty()) return;
  std::string found;
  std::size_t count = 0;
  for (const FileVariable& variable : file.variables())
    if (variable.numeric && variable.dimensions.size() >= 3 && ++count <= kMostNames)
      found += (found.empty() ? "" : ", ") + file.shape_text(variable);
  if (count > kMostNames) found += " and " + std::to_string(count - kMostNames) + " more";
  throw Error({"there is no cloud water on levels in this file", file.path(),
               "one of " + known_water_names(),
               found.empty() ? "no variable of three dimensions" : found,
               "vertical sums (kg m-2) and satellite pictures are no forecast; names of another "
               "model can be told in a file for --names"});
}

std::string untested(const DataFile& file, Quantity quantity, const FileVariable& variable) {
  if (const std::string row = variable.text(kUntestedAttribute); !row.empty())
    return variable.name + " is read as " + row + ": untested, no file stands behind that row.";
  if (!variable.text(kRowAttribute).empty()) return "";
  const NameRow* row = row_of(file, quantity, variable);
  if (!row || row->evidence != Evidence::kNone) return "";
  const std::string how = by_standard_name(*row, variable)
                              ? "its standard_name"
                              : "the name that " + std::string(row->model) + " gives it";
  return variable.name + " is read as " + word_of(quantity) + " by " + how +
         ": untested, no file stands behind that row.";
}

}  // namespace nepho::forecast
