#include "forecast/conventions/hybrid_pressure.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "forecast/conventions/formula_terms.h"
#include "forecast/conventions/levels.h"
#include "forecast/water/air.h"

namespace nepho::forecast {
namespace {

constexpr double kReference_Pa = 1e5;  // of coefficients a without units and p0

// Larger coefficients are pressures, whatever they are called.
constexpr double kLargestRatio = 2;

double scalar(const DataFile& file, const FileVariable* variable, double otherwise) {
  if (!variable || !variable->numeric || file.values_in(*variable) != 1) return otherwise;
  const UnitOf unit = unit_of(*variable, kPressure);
  return file.read_all(*variable).front() * (unit.fits ? unit.factor : 1);
}

void scale(std::vector<double>& values, double factor) {
  for (double& value : values) value *= factor;
}

// `a` in Pa: its own unit, or a ratio of p0.
double a_factor(const DataFile& file, const FileVariable& a, const std::vector<double>& values,
                const FileVariable* p0) {
  if (const UnitOf unit = unit_of(a, kPressure); unit.fits) return unit.factor;
  const double largest =
      std::abs(*std::ranges::max_element(values, {}, [](double value) { return std::abs(value); }));
  return largest > kLargestRatio ? 1 : scalar(file, p0, kReference_Pa);
}

struct Coefficients {
  LevelCoefficients a, b;  // in Pa; in the file's order
  const FileVariable* surface = nullptr;
  std::string how;
};

void fill_zero(LevelCoefficients& b, const LevelCoefficients& like) {
  b.level.assign(like.level.size(), 0.0);
  b.interface.assign(like.interface.size(), 0.0);
}

std::optional<Coefficients> by_terms(const DataFile& file, int z) {
  const FormulaTerms formula = formula_terms(file, z);
  if (!formula.coordinate) return {};
  const auto of = [&](const char* term) { return coefficients_of(file, formula, term, z); };
  const auto each = [](LevelCoefficients& values, const auto& change) {
    for (std::vector<double>* part : {&values.level, &values.interface})
      for (double& value : *part) value = change(value);
  };
  Coefficients c;
  c.surface = formula.find(file, "ps");
  c.how = "hydrostatic from the " + (formula.formula.empty() ? "formula_terms" : formula.formula) +
          " of " + formula.coordinate->name;
  if (formula.terms.contains("sigma")) {
    c.b = of("sigma");
    const double top_Pa = scalar(file, formula.find(file, "ptop"), 0);
    c.a = c.b;
    each(c.a, [&](double sigma) { return top_Pa * (1 - sigma); });
  } else if (formula.terms.contains("lev") && formula.terms.contains("p0")) {
    c.a = of("lev");
    const double p0_Pa = scalar(file, formula.find(file, "p0"), kReference_Pa);
    each(c.a, [&](double lev) { return p0_Pa * std::exp(-lev); });
    fill_zero(c.b, c.a);
  } else if (formula.terms.contains("ap") || formula.terms.contains("a")) {
    const char* const term = formula.terms.contains("ap") ? "ap" : "a";
    if (formula.terms.contains("orog")) return {};
    c.a = of(term);
    if (c.a.level.empty()) return {};
    const double factor =
        a_factor(file, *formula.find(file, term), c.a.level, formula.find(file, "p0"));
    each(c.a, [&](double a) { return a * factor; });
    c.b = of("b");
    if (c.b.level.size() != c.a.level.size()) return {};
  } else {
    return {};
  }
  if (c.a.level.empty()) return {};
  return c;
}

// Numbers of the levels, from 0, where the axis counts some of `all` of them.
std::optional<std::size_t> first_of_some(const DataFile& file, int z, std::size_t all) {
  const std::size_t nz = file.size(z);
  if (nz == all) return 0;
  const FileVariable* axis = file.find(file.name(z));
  if (nz > all || !axis || !axis->numeric || axis->dimensions != std::vector<int>{z}) return {};
  const std::vector<double> number = file.read_all(*axis);
  for (std::size_t k = 0; k < nz; ++k)
    if (number[k] != number[0] + double(k)) return {};
  const double first = number[0] - 1;
  if (!(first >= 0 && first + double(nz) <= double(all))) return {};
  return std::size_t(first);
}

std::optional<Coefficients> by_names(const DataFile& file, int z) {
  const std::size_t nz = file.size(z);
  const auto read = [&](const char* name, std::size_t more) {
    std::vector<double> values;
    const FileVariable* v = find_named(
        file, std::vector<std::string>{name},
        [](const FileVariable& found) { return found.numeric && found.dimensions.size() == 1; });
    if (!v || file.values_in(*v) <= more) return values;
    const auto first = first_of_some(file, z, file.values_in(*v) - more);
    if (!first) return values;
    values = file.read_all(*v);
    const auto begin = values.begin() + std::ptrdiff_t(*first);
    return std::vector<double>(begin, begin + std::ptrdiff_t(nz + more));
  };
  Coefficients c;
  c.a = {read("hyam", 0), read("hyai", 1)};
  c.b = {read("hybm", 0), read("hybi", 1)};
  if (c.a.interface.size() != c.b.interface.size()) c.a.interface = c.b.interface = {};
  if (c.a.level.size() != c.b.level.size()) c.a.level = c.b.level = {};
  const bool halves_only = c.a.level.empty();
  if (halves_only && c.a.interface.empty()) return {};
  const char* const name = halves_only ? "hyai" : "hyam";
  const FileVariable* a =
      find_named(file, std::vector<std::string>{name}, [](const auto& v) { return v.numeric; });
  const double factor =
      a_factor(file, *a, halves_only ? c.a.interface : c.a.level,
               find_named(file, std::vector<std::string>{"p0"}, [](const auto&) { return true; }));
  scale(c.a.level, factor);
  scale(c.a.interface, factor);
  if (halves_only)
    for (std::size_t k = 0; k < nz; ++k) {
      c.a.level.push_back(0.5 * (c.a.interface[k] + c.a.interface[k + 1]));
      c.b.level.push_back(0.5 * (c.b.interface[k] + c.b.interface[k + 1]));
    }
  c.how = halves_only ? "hydrostatic from hybrid half levels hyai, hybi"
                      : "hydrostatic from hybrid levels hyam, hybm";
  return c;
}

// Of half levels, from the top or the ground, beside the levels: ak and bk of FV3 (global
// attributes of its history files; also pk), in Pa.
std::optional<Coefficients> by_half_coefficients(const DataFile& file, int z) {
  const std::size_t nz = file.size(z);
  const auto read = [&](const char* name) -> std::vector<double> {
    const FileVariable* v = find_named(file, {{}, {name}}, [&](const FileVariable& found) {
      return found.numeric && found.dimensions.size() == 1 && file.values_in(found) == nz + 1;
    });
    if (v) return file.read_all(*v);
    const FileAttribute* attribute = file.attribute(name);
    return attribute && attribute->numbers.size() == nz + 1 ? attribute->numbers
                                                            : std::vector<double>{};
  };
  for (const char* const name : {"ak", "pk"}) {
    Coefficients c;
    c.a.interface = read(name);
    c.b.interface = read("bk");
    if (c.a.interface.empty() || c.b.interface.empty()) continue;
    const FileVariable* a = find_named(file, {{}, {name}}, [](const auto& v) { return v.numeric; });
    if (a)
      if (const UnitOf unit = unit_of(*a, kPressure); unit.fits) scale(c.a.interface, unit.factor);
    for (std::size_t k = 0; k < nz; ++k) {
      c.a.level.push_back(0.5 * (c.a.interface[k] + c.a.interface[k + 1]));
      c.b.level.push_back(0.5 * (c.b.interface[k] + c.b.interface[k + 1]));
    }
    c.how = std::string("hydrostatic from hybrid half levels ") + name + ", bk";
    return c;
  }
  return {};
}

bool find_surface(const FieldReader& reader, HybridPressure& hybrid, const FileVariable* named) {
  const auto is_pressure = [&](const FileVariable& v) {
    return reader.is_surface(v) && unit_of(v, kPressure).fits;
  };
  if (!named || !is_pressure(*named))
    named = find_named(*reader.file, names::kSurfacePressure, is_pressure);
  if (named) {
    hybrid.surface = named;
    hybrid.surface_factor = unit_of(*named, kPressure).factor;
    return true;
  }
  hybrid.surface = find_named(*reader.file, names::kLogSurfacePressure,
                              [&](const FileVariable& v) { return reader.is_surface(v); });
  hybrid.surface_is_log = true;
  return hybrid.surface;
}

}  // namespace

double HybridPressure::surface_Pa(double value) const {
  return surface_is_log ? std::exp(value) : value * surface_factor;
}

std::optional<HybridPressure> hybrid_pressure(const VerticalRequest& request, bool optional) {
  const FieldReader& reader = *request.reader;
  const DataFile& file = *reader.file;
  auto found = by_terms(file, request.z);
  if (!found) found = by_names(file, request.z);
  if (!found) found = by_half_coefficients(file, request.z);
  if (!found) return {};
  HybridPressure hybrid;
  hybrid.a_Pa = std::move(found->a.level);
  hybrid.b = std::move(found->b.level);
  hybrid.interface_a_Pa = std::move(found->a.interface);
  hybrid.interface_b = std::move(found->b.interface);
#ifdef NEPHO_MUTANT_HALVED_B
  scale(hybrid.b, 0.5);
  scale(hybrid.interface_b, 0.5);
#endif
  hybrid.how = found->how;
  const bool needs_surface =
      std::ranges::any_of(hybrid.b, [](double b) { return b != 0; }) ||
      std::ranges::any_of(hybrid.interface_b, [](double b) { return b != 0; });
  if (needs_surface && !find_surface(reader, hybrid, found->surface)) {
    if (optional) return {};
    throw Error({"hybrid levels without surface pressure",
                 file.path() + " [" + file.name(request.z) + "]",
                 "a field of surface pressure (standard_name surface_air_pressure, or named ps, sp "
                 "or lnsp) on the grid of the water",
                 "none", "add it to the file, or write geopotential heights of the levels"});
  }
  std::vector<double> usual(hybrid.a_Pa.size());
  for (std::size_t k = 0; k < usual.size(); ++k)
    usual[k] = hybrid.a_Pa[k] + hybrid.b[k] * kStandardSurfacePressure_Pa;
  if (usual.size() > 1)
    hybrid.from_top = direction(usual, file.path() + " [" + file.name(request.z) + "]") > 0;
  if (hybrid.interface_a_Pa.size() > 1 && usual.size() == 1) {
    const double low =
        hybrid.interface_a_Pa[0] + hybrid.interface_b[0] * kStandardSurfacePressure_Pa;
    const double high =
        hybrid.interface_a_Pa[1] + hybrid.interface_b[1] * kStandardSurfacePressure_Pa;
    hybrid.from_top = high > low;
  }
  if (hybrid.from_top)
    for (std::vector<double>* values :
         {&hybrid.a_Pa, &hybrid.b, &hybrid.interface_a_Pa, &hybrid.interface_b})
      std::ranges::reverse(*values);
  return hybrid;
}

std::function<std::vector<float>(std::size_t time)> hybrid_field(const VerticalRequest& request,
                                                                 HybridPressure hybrid) {
  return [reader = request.reader, hybrid = std::move(hybrid)](std::size_t time) {
    std::vector<float> surface(std::size_t(reader->nx) * std::size_t(reader->ny), 0.0f), result;
    if (hybrid.surface) surface = reader->surface(*hybrid.surface, time);
    for (std::size_t k = 0; k < hybrid.b.size(); ++k)
      for (const float value : surface) {
        const double b = hybrid.b[k];
        result.push_back(
            float(hybrid.a_Pa[k] + (b == 0 ? 0 : b * hybrid.surface_Pa(double(value)))));
      }
    return result;
  };
}

}  // namespace nepho::forecast
