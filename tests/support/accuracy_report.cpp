#include "accuracy_report.h"

#include <algorithm>
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
  for (const std::string& text : {section, name, unit}) refuse_separators(text);
  const char* path = std::getenv("NEPHO_ACCURACY_OUT");
  if (!path || !*path) return;
  std::FILE* file = std::fopen(path, "a");
  if (!file) throw std::runtime_error(std::string("report_accuracy: cannot append to ") + path);
  // One write of one short line: tests that run side by side do not tear each other's rows.
  char line[512];
  const int length = std::snprintf(line, sizeof line, "%s\t%s\t%.1e\t%.1e\t%s\n", section.c_str(),
                                   name.c_str(), measured, bound, unit.c_str());
  std::setvbuf(file, nullptr, _IOFBF, sizeof line);
  std::fwrite(line, 1, std::size_t(std::clamp(length, 0, int(sizeof line) - 1)), file);
  if (std::fclose(file) != 0)
    throw std::runtime_error(std::string("report_accuracy: cannot write to ") + path);
}

}  // namespace nepho::test
