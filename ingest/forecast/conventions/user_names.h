#pragma once

#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/name_table.h"
#include "forecast/files/data_file.h"

namespace nepho::forecast {

// Names of a model that the table does not know, from a user's file (docs/names.md). Lines:
//
//   # a comment
//   QUANTITY NAME [units=UNIT] [per=dry_air|moist_air]
//
// QUANTITY is a word_of(); or x_axis, y_axis, level_axis or time_axis, of a dimension. NAME is one
// of
//   QLIQ                     a netCDF variable, or a GRIB shortName of ecCodes
//   standard_name:WORD       of the variable
//   grib2:0/1/200            discipline, category, number
//   grib1:98/128/246         centre, table, number
// `units` stands in place of the file's ("kg m-3" in quotes, as it has blanks), `per` says what a
// mixing ratio counts against (moist air). Rows of one quantity of water add up.
struct UserName {
  enum class Kind { kName, kStandardName, kGrib1, kGrib2 };
  Quantity quantity;
  char axis = 0;  // T, Z, Y, X: of a dimension, and `quantity` says nothing
  Kind kind = Kind::kName;
  std::string name;               // of a variable, or a standard_name
  int code[3] = {0, 0, 0};        // of GRIB
  std::string units, per, where;  // "": not said; `where`: "file, line 3"
};

struct UserNames {
  std::string path;  // "": no file
  std::vector<UserName> rows;

  // The row of a field by its numbers, or by ecCodes's shortName; null where there is none.
  const UserName* of_grib(long edition, long a, long b, long c,
                          const std::string& short_name) const;
};

// Throws Error with the line, and what is known there. An empty path is a file without rows.
UserNames read_user_names(const std::string& path);

// Says of the file's variables what the rows say of them, as attributes; a fact of the file tells
// which rows it has no variable for. Dimensions that have a coordinate of another name (CM1's ni with
// xh) take its name, with or without rows.
void apply_names(const UserNames& names, DataFile& file);

}  // namespace nepho::forecast
