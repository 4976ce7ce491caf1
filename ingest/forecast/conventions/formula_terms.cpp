#include "forecast/conventions/formula_terms.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "forecast/conventions/cell_bounds.h"

namespace nepho::forecast {
namespace {

// "a: hyam b: hybm", with or without blanks after the colons.
std::map<std::string, std::string> parsed(const std::string& text) {
  std::string spaced;
  for (const char c : text) spaced += c == ':' ? std::string(": ") : std::string(1, c);
  std::map<std::string, std::string> terms;
  std::istringstream words(spaced);
  for (std::string term, name; words >> term >> name;)
    if (term.ends_with(':')) terms[term.substr(0, term.size() - 1)] = name;
  return terms;
}

// Pairs (z, 2) of neighbouring levels that meet, to nz + 1 interfaces; empty otherwise.
std::vector<double> joined(const std::vector<double>& pairs) {
  const std::size_t nz = pairs.size() / 2;
  const auto meet = [&](std::size_t last, std::size_t first) {
    for (std::size_t k = 0; k + 1 < nz; ++k) {
      const double a = pairs[2 * k + last], b = pairs[2 * k + 2 + first];
      if (!(std::abs(a - b) <= 1e-4 * std::max(std::abs(a), std::abs(b)) + 1e-9)) return false;
    }
    return nz > 0;
  };
  std::vector<double> result;
  for (const std::size_t first : {std::size_t{0}, std::size_t{1}}) {
    if (!meet(1 - first, first)) continue;
    for (std::size_t k = 0; k < nz; ++k) result.push_back(pairs[2 * k + first]);
    result.push_back(pairs[2 * nz - 1 - first]);
    break;
  }
  return result;
}

}  // namespace

const FileVariable* FormulaTerms::find(const DataFile& file, const std::string& term) const {
  const auto named = terms.find(term);
  return named == terms.end() ? nullptr : file.find(named->second);
}

FormulaTerms formula_terms(const DataFile& file, int z) {
  const auto has_formula = [&](const FileVariable& v) {
    return v.dimensions == std::vector<int>{z} && !v.text("formula_terms").empty();
  };
  const FileVariable* found = file.find(file.name(z));
  if (!found || !has_formula(*found)) {
    const auto at = std::ranges::find_if(file.variables(), has_formula);
    found = at == file.variables().end() ? nullptr : &*at;
  }
  if (!found) return {};
  return {found, found->text("standard_name"), parsed(found->text("formula_terms"))};
}

LevelCoefficients coefficients_of(const DataFile& file, const FormulaTerms& formula,
                                  const std::string& term, int z) {
  LevelCoefficients result;
  const FileVariable* of = formula.find(file, term);
  if (!of || !of->numeric || of->dimensions != std::vector<int>{z}) return result;
  result.level = file.read_all(*of);
  const FileVariable* bounds = bounds_of(file, *of);
  if (const FileVariable* of_coordinate = bounds_of(file, *formula.coordinate)) {
    const auto terms = parsed(of_coordinate->text("formula_terms"));
    if (const auto named = terms.find(term); named != terms.end())
      bounds = file.find(named->second);
  }
  if (bounds && bounds->numeric && bounds->dimensions.size() == 2 && bounds->dimensions[0] == z &&
      file.size(bounds->dimensions[1]) == 2)
    result.interface = joined(file.read_all(*bounds));
  return result;
}

}  // namespace nepho::forecast
