#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "accuracy_report.h"

namespace nepho::test {

// Shows one row of tests/stability/rows.table: `measured`, the project's worst value, is within the
// row's criterion, and `naive`, what the usual form gives on the same arguments, is not. Reports
// both for docs/stability.md (NEPHO_STABILITY_OUT).
inline void expect_stable(const std::string& row, double measured, double criterion, double naive,
                          const std::string& unit) {
  std::printf("measured: row %s: %.2e (criterion %.2e, naive form %.2e) %s\n", row.c_str(),
              measured, criterion, naive, unit.c_str());
  append_report_row("NEPHO_STABILITY_OUT", {row, report_number(measured), report_number(criterion),
                                            report_number(naive), unit});
  EXPECT_LE(measured, criterion) << "row " << row;
  // Written so that NaN counts as a failure of the naive form.
  EXPECT_FALSE(naive <= criterion) << "row " << row << ": the naive form holds too: " << naive;
}

}  // namespace nepho::test
