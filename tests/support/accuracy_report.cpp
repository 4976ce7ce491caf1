#include "accuracy_report.h"

#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace nepho::test {
namespace {

void refuse_separators(const std::string& text) {
  if (text.empty() || text.find_first_of("\t\n|") != std::string::npos)
    throw std::invalid_argument("report_accuracy: empty, or a tab, line end or bar in: " + text);
}

}  // namespace

void report_accuracy(const std::string& section, const std::string& name, double measured,
                     double bound, const std::string& unit) {
  std::printf("measured: %s: %s: %.2e (bound %.2e) %s\n", section.c_str(), name.c_str(), measured,
              bound, unit.c_str());
  append_accuracy_row(section, name, measured, bound, unit);
}

void append_accuracy_row(const std::string& section, const std::string& name, double measured,
                         double bound, const std::string& unit) {
  append_report_row("NEPHO_ACCURACY_OUT",
                    {section, name, report_number(measured), report_number(bound), unit});
}

std::string report_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

void append_report_row(const char* variable, const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    refuse_separators(field);
    line += (line.empty() ? "" : "\t") + field;
  }
  line += '\n';
  const char* path = std::getenv(variable);
  if (!path || !*path) return;
  std::FILE* file = std::fopen(path, "a");
  if (!file) throw std::runtime_error(std::string("report_accuracy: cannot append to ") + path);
  // One write of one short line: tests that run side by side do not tear each other's rows.
  std::setvbuf(file, nullptr, _IOFBF, line.size());
  std::fwrite(line.data(), 1, line.size(), file);
  if (std::fclose(file) != 0)
    throw std::runtime_error(std::string("report_accuracy: cannot write to ") + path);
}

}  // namespace nepho::test
