#include "cli/report.h"

#include <sys/resource.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace nepho {
namespace {

std::string format(const char* pattern, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string percent(double part) {
  if (part < 0) return "not measured";
  // Two digits, and no exponent where a reader can do without.
  char text[32];
  const double value = 100 * part;
  std::snprintf(text, sizeof text, value >= 9.95 ? "%.0f %%" : "%.2g %%", value);
  return text;
}

std::string mib(std::uint64_t bytes) {
  return format("%.2f MiB", double(bytes) / (1 << 20));
}

double seconds(const timeval& t) {
  return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
}

// Field 22 of /proc/self/stat: start in clock ticks after boot.
double start_after_boot_s() {
  std::ifstream in("/proc/self/stat");
  std::string line;
  std::getline(in, line);
  // The second field, the program's name in brackets, may hold anything: count from its end.
  std::istringstream rest(line.substr(line.rfind(')') + 1));
  std::string word;
  for (int field = 3; field <= 22; ++field) rest >> word;
  return std::atof(word.c_str()) / double(sysconf(_SC_CLK_TCK));
}

void list(std::ostringstream& out, const char* title, const std::vector<std::string>& lines) {
  out << title << (lines.empty() ? "  none\n" : "\n");
  for (const std::string& line : lines) out << "  " << line << '\n';
}

}  // namespace

std::string error_line(const ErrorEstimate& error) {
  std::string line = "error (estimated): integration " + percent(error.integration) +
                     ", level of detail " + percent(error.level_of_detail) + ", quantisation " +
                     percent(error.quantisation) + ", light model " + percent(error.light_model);
  if (!error.light_model_basis.empty()) line += " (" + error.light_model_basis + ")";
  return line;
}

Usage usage_now() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  const double now_s = double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
  return {seconds(used.ru_utime) + seconds(used.ru_stime), now_s - start_after_boot_s(),
          double(used.ru_maxrss) / 1024};
}

std::string explanation(const OpenedScene& opened, const RenderResult& result,
                        const std::string& context, bool picture_module_used) {
  const RenderReport& report = result.report;
  std::ostringstream out;
  out << "device: " << context << "; " << report.device << '\n';
  std::vector<std::string> modules = SourceHost::loaded();
  if (picture_module_used) modules.push_back("nepho_image_oiio (pictures)");
  list(out, "modules loaded:", modules);
  out << "volumes:\n";
  for (const VolumeReport& v : report.volumes)
    out << format(
        "  %s: %llu nodes, %llu bricks, %llu constant, %llu empty, %llu sun tiles, "
        "level %d of %d\n",
        v.name.c_str(), static_cast<unsigned long long>(v.nodes),
        static_cast<unsigned long long>(v.bricks),
        static_cast<unsigned long long>(v.constant_nodes),
        static_cast<unsigned long long>(v.empty_nodes),
        static_cast<unsigned long long>(v.sun_tiles), v.finest_level_used, v.finest_level);
  for (const auto& source : opened.sources)
    for (const std::string& fact : source->info().facts)
      out << "  " << source->info().name << ": " << fact << '\n';
  const std::uint64_t inside =
      report.atlas_bytes + report.sun_bytes + report.node_bytes + report.staging_bytes;
  out << "bytes: budget " << opened.scene.render.budget_mib << " MiB, used " << mib(inside)
      << " (atlas " << mib(report.atlas_bytes) << ", sun " << mib(report.sun_bytes) << ", nodes "
      << mib(report.node_bytes) << ", staging " << mib(report.staging_bytes) << "); apart: image "
      << mib(report.image_bytes) << ", sources " << mib(report.source_bytes) << '\n';
  out << "passes (CPU):\n";
  for (const PassReport& pass : report.passes)
    out << format("  %-24s %8.3f s\n", pass.name.c_str(), pass.cpu_s);
  list(out, "shader switches:", report.shader_switches);
  list(out, "left out:", report.left_out);
  return out.str();
}

}  // namespace nepho
