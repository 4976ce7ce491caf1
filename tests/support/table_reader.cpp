#include "table_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>

#include "core/error.h"

namespace nepho::test {
namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  for (std::size_t first = 0, comma = 0; comma != std::string::npos; first = comma + 1) {
    comma = text.find(',', first);
    parts.push_back(trimmed(text.substr(first, comma - first)));
  }
  return parts;
}

struct NumberAndRest {
  double number;
  std::string rest;
};
NumberAndRest leading_number(const std::string& text) {
  NumberAndRest result{};
  const char* last = text.data() + text.size();
  const auto [end, error] = std::from_chars(text.data(), last, result.number);
  // "1e3/m" is a number and a unit, "1m" too; "1" alone has no unit and fails in the parser.
  if (error != std::errc{})
    throw Error(
        {.what = "a number is expected", .where = "", .expected = "", .found = text, .hint = ""});
  result.rest = trimmed(std::string(end, last));
  return result;
}

// Error of each result as a share of its tolerance.
double share_of_tolerance(const std::string& tolerance, std::size_t index, std::size_t count,
                          const Quantity& actual, double expected) {
  const std::vector<std::string> parts = split(tolerance);
  if (parts.size() != 1 && parts.size() != count)
    throw Error({.what = "as many tolerances as results, or one",
                 .where = "",
                 .expected = "",
                 .found = tolerance,
                 .hint = ""});
  const auto [number, unit] = leading_number(parts[parts.size() == 1 ? 0 : index]);
  const double allowed =
      unit == "relative" ? number * std::abs(expected) : to_si(number, unit, actual.dimension);
  const double error = std::abs(actual.value - expected);
  if (error == 0) return 0;
  return error / allowed;  // a NaN stays one: see within()
}

bool within(double share) {
  return share <= 1;
}

CaseResult compare(const TableCase& row, const Quantities& actual) {
  const std::vector<std::string> expected = split(row.expect);
  if (expected.size() != actual.size())
    return {"gave " + std::to_string(actual.size()) + " results, expected " + row.expect, 0};
  CaseResult result;
  for (std::size_t n = 0; n < actual.size(); ++n) {
    const auto [number, unit] = leading_number(expected[n]);
    if (unit != to_string(actual[n].dimension))
      return {"has unit " + to_string(actual[n].dimension) + ", expected " + expected[n], 0};
    const double share = share_of_tolerance(row.tolerance, n, actual.size(), actual[n], number);
    if (!within(share)) {
      char text[160];
      std::snprintf(text, sizeof text, "result %zu is %.17g, expected %.17g: %.3g tolerances off",
                    n + 1, actual[n].value, number, share);
      return {text, share};
    }
    result.worst_share = std::max(result.worst_share, share);
  }
  return result;
}

CaseResult round_trip(const TableCase& row, const Operation& operation, const Quantities& input) {
  const Quantities first = operation.forward(input);
  Quantities last = first;
  for (int n = 0; n < row.round_trips; ++n) last = operation.forward(operation.inverse(last));
  CaseResult result;
  for (std::size_t n = 0; n < first.size(); ++n) {
    const double share =
        share_of_tolerance(row.tolerance, n, first.size(), last[n], first[n].value);
    if (!within(share)) return {"drifts by " + std::to_string(share) + " tolerances", share};
    result.worst_share = std::max(result.worst_share, share);
  }
  return result;
}

}  // namespace

Quantities parse_quantities(const std::string& text) {
  Quantities result;
  for (const std::string& part : split(text)) {
    const auto [number, unit] = leading_number(part);
    const Unit parsed = parse_unit(unit);
    result.push_back({parsed.to_si(number), parsed.dimension});
  }
  return result;
}

std::vector<TableCase> read_table(const std::string& path) {
  std::ifstream file(path);
  std::vector<TableCase> cases;
  TableCase now;
  std::string text;
  for (int line = 1; std::getline(file, text); ++line) {
    text = trimmed(text.substr(0, text.find('#')));
    if (text.empty()) continue;
    now.where = path.substr(path.rfind('/') + 1) + ":" + std::to_string(line);
    const auto refuse = [&](const char* what) {
      throw Error({.what = what, .where = now.where, .expected = "", .found = text, .hint = ""});
    };
    const std::size_t blank = std::min(text.find(' '), text.size());
    const std::string command = text.substr(0, blank), rest = trimmed(text.substr(blank));
    if (rest.empty()) refuse("a command has nothing after it");
    if (command == "operation") {
      now = {.where = now.where, .operation = rest, .accept = {}, .tolerance = {}, .expect = {}};
    } else if (command == "tolerance") {
      now.tolerance = rest;
    } else if (command == "accept") {
      now.accept = rest;
    } else if (command == "expect" || command == "roundtrip") {
      TableCase row = now;
      row.fails = command == "expect" && rest.starts_with("failure");
      row.expect = row.fails ? trimmed(rest.substr(7)) : rest;
      if (command == "roundtrip") row.round_trips = std::stoi(rest);
      if (row.operation.empty() || row.accept.empty()) refuse("a case needs operation and accept");
      if (row.fails ? row.expect.empty() : row.tolerance.empty())
        refuse("a case needs a tolerance, a failure its words");
      cases.push_back(row);
    } else {
      refuse("an unknown command");
    }
  }
  if (cases.empty())
    throw Error(
        {.what = "no case in the table", .where = path, .expected = "", .found = "", .hint = ""});
  return cases;
}

CaseResult run_case(const TableCase& row, const std::map<std::string, Operation>& operations) {
  const auto found = operations.find(row.operation);
  if (found == operations.end()) return {"unknown operation " + row.operation, 0};
  try {
    const Quantities input = parse_quantities(row.accept);
    if (row.round_trips > 0) return round_trip(row, found->second, input);
    const Quantities actual = found->second.forward(input);
    if (row.fails) return {"was accepted, expected a failure: " + row.expect, 0};
    return compare(row, actual);
  } catch (const Error& error) {
    if (row.fails && std::string(error.what()).find(row.expect) != std::string::npos) return {};
    return {std::string("failed: ") + error.what(), 0};
  }
}

}  // namespace nepho::test
