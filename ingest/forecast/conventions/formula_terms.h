#pragma once

#include <map>
#include <string>
#include <vector>

#include "forecast/files/data_file.h"

namespace nepho::forecast {

// CF's parametric vertical coordinates (CF 1.11, appendix D): a variable along the levels whose
// `formula_terms` name the variables of its formula.
struct FormulaTerms {
  const FileVariable* coordinate = nullptr;  // null: the levels have none
  std::string formula;                       // its standard_name, or "" where it has none
  std::map<std::string, std::string> terms;  // name of a term -> name of a variable

  // The variable of a term; null where it is not named, or not in the file.
  const FileVariable* find(const DataFile& file, const std::string& term) const;
};
FormulaTerms formula_terms(const DataFile& file, int z);

// Coefficients along the levels `z`, and where the file has them of the nz + 1 interfaces, in the
// file's order. Empty where there are none.
struct LevelCoefficients {
  std::vector<double> level, interface;
};
// Of a term of the formula: interfaces by the terms of the coordinate's bounds, or by the bounds of
// the term itself.
LevelCoefficients coefficients_of(const DataFile& file, const FormulaTerms& formula,
                                  const std::string& term, int z);

}  // namespace nepho::forecast
