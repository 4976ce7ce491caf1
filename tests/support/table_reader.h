#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "units/parse_unit.h"

namespace nepho::test {

// Tables of cases in the style of PROJ's gie (*.table), one command a line, # starts a comment:
//   operation geodetic_to_ecef    what the next cases go through
//   tolerance 5 nm                absolute, one for all results or one each (a, b, c); or
//   tolerance 1e-15 relative
//   accept 90 deg, 0 deg, 1 km    a number and its unit each; a bare number is an error
//   expect 0 m, 0 m, 6.36 m       in SI, written as to_string(Dimension) writes it
//   expect failure WORDS          an Error whose text holds WORDS
//   roundtrip 100                 forward and back so often, then within the tolerance of forward
struct Quantity {
  double value = 0;  // SI
  Dimension dimension;
};
using Quantities = std::vector<Quantity>;

// "90 deg, 0 deg, 1 km". Throws Error.
Quantities parse_quantities(const std::string& text);

struct TableCase {
  std::string where;  // file:line
  std::string operation, accept, tolerance;
  std::string expect;   // values, or the words of a failure
  bool fails = false;   // expect failure
  int round_trips = 0;  // > 0: roundtrip
};

// Throws Error naming file and line: unknown commands, a case without operation or tolerance, none.
std::vector<TableCase> read_table(const std::string& path);

struct Operation {
  std::function<Quantities(const Quantities&)> forward, inverse;  // inverse only for roundtrip
};

struct CaseResult {
  std::string failure;     // empty: passed
  double worst_share = 0;  // largest error / its tolerance
};
CaseResult run_case(const TableCase& row, const std::map<std::string, Operation>& operations);

}  // namespace nepho::test
