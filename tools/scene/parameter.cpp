#include "scene/parameter.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "units/parse_unit.h"

namespace nepho {
namespace {

struct NamedUnit {
  std::string text;
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
    if (unit && unit->dimension != kDimensionless) return NamedUnit{text, *unit};
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

SourceParameter number_parameter(const std::string& name, double value, const std::string& where) {
  SourceParameter result{name, "", value, "", false, where};
  if (const std::optional<NamedUnit> named = unit_of_name(name)) {
    result.unit = named->text;
    result.number = named->unit.to_si(value);
  }
  return result;
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
  return {name, unit_text, unit.to_si(value), "", false, where};
}

std::string exact(double value) {
  char buffer[32];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

SourceParameter make_parameter(const std::string& name, const JsonValue& value,
                               const std::string& where) {
  switch (value.kind) {
    case JsonValue::Kind::kNumber: return number_parameter(name, value.number, where);
    case JsonValue::Kind::kBool:
      return {name, "", value.boolean ? 1.0 : 0.0, "", false, where};
    case JsonValue::Kind::kString: break;
    default:
      throw Error({"wrong type", where, "a number, a text, or true or false",
                   kind_name(value.kind), ""});
  }
  std::string rest;
  const std::optional<double> number = leading_number(value.text, rest);
  if (number && rest.empty())
    throw Error({"missing unit", where, "a number with its unit, such as \"0.02 1/m\"",
                 "'" + value.text + "'", "write a dimensionless number without quotes"});
  if (number && rest[0] == ' ')
    return unit_parameter(name, *number, rest.substr(rest.find_first_not_of(' ')), where);
  return {name, "", 0, value.text, true, where};
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

std::string parameter_text(const SourceParameter& parameter) {
  const Unit unit = parameter.unit.empty() ? Unit{} : parse_unit(parameter.unit);
  if (unit.dimension == kDimensionless) return exact(parameter.number);
  return exact(parameter.number) + " " + to_string(unit.dimension);
}

}  // namespace nepho
