#pragma once

#include <string>
#include <vector>

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

// What both are made of: appends the fields, tabs between them, to the file that the environment
// names in `variable`; nothing where it names none. A number as all reports write it: "1.2e-03".
void append_report_row(const char* variable, const std::vector<std::string>& fields);
std::string report_number(double value);

}  // namespace nepho::test
