#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"
#include "sources/grib/field_table.h"

namespace nepho::grib {

// Where a variable's values come from: memory, or one field per time and level.
struct VariableValues {
  std::vector<double> here;
  std::vector<int> fields;  // of FieldTable::fields, [time * levels + level]; -1: absent
  Change change = Change::kNone;

  int first() const {
    return *std::ranges::find_if(fields, [](int f) { return f >= 0; });
  }
};

// The usable fields of a table as dimensions and variables of CF 1.11; nothing is decoded.
//
//   time(time), y and x or lat and lon with their grid_mapping `crs`
//   isobaric(isobaric)        air_pressure, Pa
//   hybrid(hybrid)            formula_terms "ap: ap b: b ps: sp", with bounds of half levels
//   clwmr(time, isobaric, lat, lon) ...
//
// Levels are those of the fields that clouds need; a variable without a level there is NaN on it.
// What is the same at all times has no time. Throws Error as usable_fields().
struct CfDataset {
  std::vector<forecast::FileDimension> dimensions;
  std::vector<forecast::FileVariable> variables;
  std::vector<VariableValues> values;  // by variable
  std::vector<std::string> facts, assumptions;
};
CfDataset cf_dataset(const FieldTable& table);

}  // namespace nepho::grib
