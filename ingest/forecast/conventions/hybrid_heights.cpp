// Levels whose height is a formula of the ground's (CF 1.11, appendix D).
#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "forecast/conventions/formula_terms.h"
#include "forecast/conventions/levels.h"
#include "forecast/water/level_heights.h"

namespace nepho::forecast {
namespace {

// z = constant + sum of factor * surface, in m. From the ground up.
struct HeightFormula {
  struct Term {
    LevelCoefficients factor;
    const FileVariable* surface = nullptr;
    double to_m = 1;
  };
  LevelCoefficients constant_m;
  std::vector<Term> terms;
  std::shared_ptr<Levels> levels;

  std::vector<float> interfaces_m(std::size_t time) const;
};

std::vector<float> HeightFormula::interfaces_m(std::size_t time) const {
  const std::size_t nz = constant_m.level.size(), cells = levels->cells();
  const bool has_interfaces = !constant_m.interface.empty();
  std::vector<std::vector<float>> surface;
  for (const Term& term : terms) surface.push_back(levels->reader().surface(*term.surface, time));
  const std::vector<double> ground = levels->terrain_m(time);
  std::vector<float> result(cells * (nz + 1));
  std::vector<double> level(nz);
  for (std::size_t n = 0; n < cells; ++n) {
    const auto height = [&](std::vector<double> LevelCoefficients::*of, std::size_t k) {
      double z = (constant_m.*of)[k];
      for (std::size_t t = 0; t < terms.size(); ++t) {
        const float here = surface[t][n];  // missing over the sea
        if (std::isfinite(here)) z += (terms[t].factor.*of)[k] * terms[t].to_m * double(here);
      }
      return z;
    };
    if (has_interfaces) {
      for (std::size_t k = 0; k <= nz; ++k)
        result[n * (nz + 1) + k] = float(height(&LevelCoefficients::interface, k));
      continue;
    }
    for (std::size_t k = 0; k < nz; ++k) level[k] = height(&LevelCoefficients::level, k);
    interfaces_of_levels_m(level, ground[n], {&result[n * (nz + 1)], nz + 1});
  }
  return levels->checked(std::move(result));
}

[[noreturn]] void refuse_term(const DataFile& file, const FormulaTerms& formula,
                              const std::string& term) {
  const auto named = formula.terms.find(term);
  throw Error({"a term of the levels' formula is missing", file.where(*formula.coordinate),
               "a variable for each term, on the grid of the water or along the levels",
               term + ": " + (named == formula.terms.end() ? "none" : named->second),
               "add it to the file, or write the levels' heights as a variable"});
}

// Length of a file's surface to m; no units count as m.
double metres(const FileVariable& surface) {
  const UnitOf unit = unit_of(surface, kLength);
  return unit.fits ? unit.factor : 1;
}

struct Names {
  const char *constant, *scale;  // a, times the value of `scale` where there is one
  std::vector<std::pair<const char*, const char*>> factors;  // of which surface
};

}  // namespace

bool by_hybrid_heights(const VerticalRequest& request, Vertical& vertical) {
  const FieldReader& reader = *request.reader;
  const DataFile& file = *reader.file;
  const FormulaTerms formula = formula_terms(file, request.z);
  if (!formula.coordinate) return false;
  static const std::array<Names, 2> kForms = {
      {{"a", nullptr, {{"b", "orog"}}},                        // hybrid height
       {"a", "ztop", {{"b1", "zsurf1"}, {"b2", "zsurf2"}}}}};  // SLEVE
  const auto form = std::ranges::find_if(kForms, [&](const Names& names) {
    return formula.terms.contains(names.factors.front().second);
  });
  if (form == kForms.end()) return false;
  auto heights = std::make_shared<HeightFormula>();
  const auto need = [&](const char* term) {
    LevelCoefficients found = coefficients_of(file, formula, term, request.z);
    if (found.level.empty()) refuse_term(file, formula, term);
    return found;
  };
  heights->constant_m = need(form->constant);
  double factor = metres(*formula.find(file, form->constant));
  if (form->scale) {
    const FileVariable* top = formula.find(file, form->scale);
    if (!top || !top->numeric || file.values_in(*top) != 1) refuse_term(file, formula, form->scale);
    factor = file.read_all(*top).front() * metres(*top);
  }
  for (std::vector<double>* part : {&heights->constant_m.level, &heights->constant_m.interface})
    for (double& value : *part) value *= factor;
  for (const auto& [name, surface] : form->factors) {
    HeightFormula::Term term{need(name), formula.find(file, surface), 1};
    if (!term.surface || !reader.is_surface(*term.surface)) refuse_term(file, formula, surface);
    term.to_m = metres(*term.surface);
    if (term.factor.interface.size() != heights->constant_m.interface.size())
      heights->constant_m.interface.clear();
    heights->terms.push_back(std::move(term));
  }
  heights->levels = levels_of(request, *formula.coordinate, request.z);
  vertical.from_top = direction(heights->constant_m.level, file.where(*formula.coordinate)) < 0;
  if (vertical.from_top) {
    const auto turn = [](LevelCoefficients& c) {
      std::ranges::reverse(c.level);
      std::ranges::reverse(c.interface);
    };
    turn(heights->constant_m);
    for (HeightFormula::Term& term : heights->terms) turn(term.factor);
  }
  vertical.heights_change = std::ranges::any_of(
      heights->terms, [&](const auto& term) { return varies(*term.surface, reader.time); });
  vertical.has_interfaces = !heights->constant_m.interface.empty();
  vertical.how = "heights by the " + (formula.formula.empty() ? "formula_terms" : formula.formula) +
                 " of " + formula.coordinate->name;
  vertical.interfaces_m = [heights](std::size_t time, const Air*) {
    return heights->interfaces_m(time);
  };
  return true;
}

}  // namespace nepho::forecast
