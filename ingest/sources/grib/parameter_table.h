#pragma once

#include <span>
#include <string>

#include "forecast/conventions/name_table.h"

namespace nepho::grib {

// What the numbers of GRIB fields mean: beside forecast::name_table(), which knows the names that
// these rows give. One row: the numbers of a table, and what they mean on levels.
struct ParameterRow {
  int a, b, c;  // GRIB2: discipline, category, number; GRIB1: centre or -1, table or -1, number
  const char *name, *standard_name, *units;
  bool water;         // condensate
  const char* model;  // whose numbers these are
  forecast::Evidence evidence;
};
std::span<const ParameterRow> parameter_table(int edition);
// Numbers of edition 2 that DWD and its partners read otherwise; they come first there.
std::span<const ParameterRow> parameter_table_of_dwd();

// Of a message; `a`, `b`, `c` as in a row.
struct Codes {
  long edition, centre, a, b, c;
};
// Null where the table does not know them.
const ParameterRow* parameter_row(const Codes& codes);
// "clwmr by the number 0/1/22 of GFS".
std::string text_of(const ParameterRow& row);

}  // namespace nepho::grib
