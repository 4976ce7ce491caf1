#include "scene/parameter.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "units/parse_unit.h"

namespace nepho {
namespace {

struct NamedUnit {
  std::string base, text;  // radius_km: "radius", "km"
  Unit unit;
};

std::optional<Unit> try_parse(const std::string& text) {
  try {
    return parse_unit(text);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// The longest end of the name that is a unit: radius_m, extinction_per_m, water_kg_per_m3.
std::optional<NamedUnit> unit_of_name(const std::string& name) {
  for (std::size_t at = name.find('_'); at != std::string::npos; at = name.find('_', at + 1)) {
    std::string text = name.substr(at + 1);
    if (text.empty() || (text[0] >= '0' && text[0] <= '9')) continue;
    if (text.starts_with("per_")) text.insert(0, "1_");
    for (std::size_t i; (i = text.find("_per_")) != std::string::npos;) text.replace(i, 5, "/");
    for (char& c : text)
      if (c == '_') c = ' ';
    const std::optional<Unit> unit = try_parse(text);
    if (unit && unit->dimension != kDimensionless)
      return NamedUnit{name.substr(0, at), text, *unit};
  }
  return std::nullopt;
}

// The number at the head of the text, and what follows it.
std::optional<double> leading_number(const std::string& text, std::string& rest) {
  const std::size_t start = text.find_first_not_of(" +");
  if (start == std::string::npos) return std::nullopt;
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data() + start, end, value);
  if (failure != std::errc{} || !std::isfinite(value)) return std::nullopt;
  rest.assign(stop, end);
  return value;
}

// The end of a name in SI: "_m", "_kg_per_m3", "_per_m"; "" for a ratio.
std::string si_ending(const Dimension& d) {
  std::string above, below;
  const auto add = [](std::string& side, const char* unit, int power) {
    side += std::string("_") + unit + (power == 1 ? "" : std::to_string(power));
  };
  const std::pair<const char*, int> powers[] = {
      {"kg", d.kg}, {"m", d.m}, {"s", d.s}, {"K", d.K}, {"rad", d.rad}};
  for (const auto& [unit, power] : powers) {
    if (power > 0) add(above, unit, power);
    if (power < 0) add(below, unit, -power);
  }
  return above + (below.empty() ? "" : "_per" + below);
}

SourceParameter in_si(const std::string& written, const std::string& base, const Unit& unit,
                      const std::string& unit_text, double value, const std::string& where) {
  const std::string name = base + si_ending(unit.dimension);
  return {name, unit_text, unit.to_si(value), "", false, where, name == written ? "" : written};
}

SourceParameter number_parameter(const std::string& name, double value, const std::string& where) {
  const std::optional<NamedUnit> named = unit_of_name(name);
  if (!named) return {name, "", value, "", false, where, ""};
  return in_si(name, named->base, named->unit, named->text, value, where);
}

SourceParameter unit_parameter(const std::string& name, double value, const std::string& unit_text,
                               const std::string& where) {
  Unit unit;
  try {
    unit = parse_unit(unit_text);
  } catch (const Error& e) {
    Error::Parts parts = e.parts();
    parts.where = where;
    throw Error(parts);
  }
  const std::optional<NamedUnit> named = unit_of_name(name);
  if (named && named->unit.dimension != unit.dimension)
    throw Error({"wrong unit", where, "a unit like " + named->text, "'" + unit_text + "'", ""});
  return in_si(name, named ? named->base : name, unit, unit_text, value, where);
}

}  // namespace

SourceParameter make_parameter(const std::string& name, const JsonValue& value,
                               const std::string& where) {
  switch (value.kind) {
    case JsonValue::Kind::kNumber:
      return number_parameter(name, value.number, where);
    case JsonValue::Kind::kBool:
      return {name, "", value.boolean ? 1.0 : 0.0, "", false, where, ""};
    case JsonValue::Kind::kString:
      break;
    default:
      throw Error(
          {"wrong type", where, "a number, a text, or true or false", kind_name(value.kind), ""});
  }
  std::string rest;
  const std::optional<double> number = leading_number(value.text, rest);
  if (number && rest.empty())
    throw Error({"missing unit", where, "a number with its unit, such as \"0.02 1/m\"",
                 "'" + value.text + "'", "write a dimensionless number without quotes"});
  if (number && rest[0] == ' ')
    return unit_parameter(name, *number, rest.substr(rest.find_first_not_of(' ')), where);
  return {name, "", 0, value.text, true, where, ""};
}

SourceParameter make_parameter(const std::string& name, const std::string& text,
                               const std::string& where) {
  std::string rest;
  const std::optional<double> number = leading_number(text, rest);
  if (number && rest.empty()) return number_parameter(name, *number, where);
  JsonValue value;
  value.kind = JsonValue::Kind::kString;
  value.text = text;
  return make_parameter(name, value, where);
}

}  // namespace nepho
