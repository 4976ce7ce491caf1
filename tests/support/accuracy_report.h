#pragma once

#include <string>

namespace nepho::test {

// Prints `measured: ...` and, where the environment names a file in NEPHO_ACCURACY_OUT, appends the
// row "section, name, measured, bound, unit" to it: docs/accuracy.md is rewritten from such rows by
// tools/update_accuracy.sh. Call it beside the assertion on the same bound. Two rows of one name:
// the larger measurement stays. `unit` is "1" for a ratio.
void report_accuracy(const std::string& section, const std::string& name, double measured,
                     double bound, const std::string& unit);
// The row alone, for a test that prints a table of its own.
void append_accuracy_row(const std::string& section, const std::string& name, double measured,
                         double bound, const std::string& unit);

}  // namespace nepho::test
