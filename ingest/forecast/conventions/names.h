#pragma once

#include <functional>
#include <string>
#include <vector>

#include "forecast/conventions/name_table.h"
#include "forecast/files/data_file.h"
#include "forecast/water/water.h"

namespace nepho::forecast {

namespace names {
using enum Quantity;
}

// What a user's names file says of a variable, as attributes of it (user_names.h): the word of a
// quantity, and for mixing ratios the word of a Basis.
inline constexpr const char* kQuantityAttribute = "nephoscope_quantity";
inline constexpr const char* kPerAttribute = "nephoscope_per";
// What a reader that knows fields by numbers says of a variable: the row behind it (UserName::where of
// a user's), and the row again where no file stands behind it.
inline constexpr const char* kRowAttribute = "nephoscope_row";
inline constexpr const char* kUntestedAttribute = "nephoscope_untested";

// The first variable that answers to the quantity and that `accept` takes: as a user says, then by
// the names of the file's own model that mean other things elsewhere, by standard names, and by
// names in the table's order. Null where there is none.
using Accept = std::function<bool(const FileVariable&)>;
const FileVariable* find_named(const DataFile& file, Quantity wanted, const Accept& accept);
// By plain names, compared without case, for what no quantity stands for.
const FileVariable* find_named(const DataFile& file, const std::vector<std::string>& names,
                               const Accept& accept);

// The row by which a variable answers to a quantity, the file's own model's before others'; null
// where none does.
const NameRow* row_of(const DataFile& file, Quantity quantity, const FileVariable& variable);

struct WaterVariable {
  Species species = Species::kCloudWater;
  const FileVariable* variable = nullptr;
  Basis basis = Basis::kMoistAir;
  double to_si = 1;
  // Two phases in one variable: below the first all is the ice of its kind, above the second all is
  // liquid, linear between. 0: one phase.
  double freezes_below_K = 0, liquid_above_K = 0;
  // The variable is a cloud fraction, and the water is assumed (assumed_water.h).
  bool from_fraction = false;
  const NameRow* row = nullptr;  // null: a user's
};

// Condensate among the numeric variables that `accept` takes, each kind at most once, cloud before
// precipitation. Throws Error on units that are missing, unknown, or of no water content.
std::vector<WaterVariable> find_water(const DataFile& file, const Accept& accept);
// Liquid and ice in one variable, where the file has no ice of its own: clwmr of models with the
// scheme of Zhao & Carr (1997), doi:10.1175/1520-0493(1997)125<1931:APCSFO>2.0.CO;2, and others as
// their rows say. Says so of each.
inline constexpr double kWholeCondensateFreezes_K = 258.15;
void divide_phases(std::vector<WaterVariable>& water, std::vector<std::string>& assumptions);

// Refuses a file without cloud water: lists its variables of three dimensions and more, and the
// names known. Triangles and profiles are named as such.
void require_water(const DataFile& file, const std::vector<WaterVariable>& water);

// One sentence for each of the variables that a row without a file behind it stands for; "" where
// there is one, or a user said it.
std::string untested(const DataFile& file, Quantity quantity, const FileVariable& variable);

}  // namespace nepho::forecast
