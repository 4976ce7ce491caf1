#pragma once

#include <string>
#include <vector>

#include "sources/grib/field_header.h"
#include "sources/grib/field_scan.h"
#include "sources/grib/grid.h"

namespace nepho::grib {

// All fields of one or several files, by their headers.
struct Field {
  FieldPlace place;
  FieldHeader header;
  int layout = 0;  // of FieldTable::grids: how its values are arranged
  int grid = 0;    // likewise, the first of the same places
};

struct FieldTable {
  std::vector<std::string> paths;
  std::vector<Field> fields;  // in the files' order
  std::vector<Grid> grids;
  // Half levels' a (Pa) and b from the top down, as `pv` of the first hybrid level holds them; a
  // and b in one list. Empty: none.
  std::vector<double> pv;

  std::string where(const Field& field) const;  // "path, message at byte N (t, isobaric 50000)"
};

// Reads headers only, once. To be called under the I/O lock. Throws Error: scan_fields(), Message.
FieldTable table_of(const std::vector<std::string>& paths, const forecast::UserNames& names = {});

// Leaves the fields of one grid that a forecast can use, each once, and says what it left out. The
// grid is the cloud water's, or the first field's. Throws Error where water is on several grids,
// and where its grid is not read.
struct Choice {
  int grid = 0;
  std::vector<int> fields;  // of FieldTable::fields
  std::vector<std::string> facts, assumptions;
};
Choice usable_fields(const FieldTable& table);

}  // namespace nepho::grib
