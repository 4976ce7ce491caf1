#include "cli/report.h"

#include <dlfcn.h>
#include <link.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

namespace nepho {
namespace {

std::string format(const char* pattern, auto... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
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

std::vector<std::string> added(const std::vector<std::string>& before,
                               const std::vector<std::string>& after) {
  std::vector<std::string> result;
  std::ranges::set_difference(after, before, std::back_inserter(result));
  return result;
}

// EACH_*: loops that are written out, one call a turn; they say nothing of the scene.
std::vector<std::string> without_loops(std::vector<std::string> switches) {
  std::erase_if(switches, [](const std::string& s) { return s.starts_with("EACH_"); });
  return switches;
}

// What the modules of this process ask for themselves (DT_NEEDED), from the loader's own list.
std::vector<std::string> needed_by_modules() {
  std::vector<std::string> names;
  link_map* library = nullptr;
  void* const program = dlopen(nullptr, RTLD_NOW);
  if (!program || dlinfo(program, RTLD_DI_LINKMAP, &library) != 0) return names;
  for (; library; library = library->l_next) {
    const std::string path = library->l_name;
    const std::string name = path.substr(path.rfind('/') + 1);
    if (!name.starts_with("nepho_") && !name.starts_with("libnepho_")) continue;
    const char* texts = nullptr;
    for (const ElfW(Dyn)* entry = library->l_ld; entry->d_tag != DT_NULL; ++entry)
      if (entry->d_tag == DT_STRTAB) texts = reinterpret_cast<const char*>(entry->d_un.d_ptr);
    for (const ElfW(Dyn)* entry = library->l_ld; texts && entry->d_tag != DT_NULL; ++entry)
      if (entry->d_tag == DT_NEEDED) names.emplace_back(texts + entry->d_un.d_val);
  }
  dlclose(program);
  return names;
}

// By name: modules and what they ask for; what those need in turn is counted.
std::vector<std::string> grouped(const std::vector<std::string>& libraries) {
  const std::vector<std::string> needed = needed_by_modules();
  std::vector<std::string> lines;
  for (const std::string& name : libraries)
    if (name.find("nepho_") != std::string::npos ||
        std::ranges::any_of(needed, [&](const std::string& wanted) {
          return name == wanted || name.starts_with(wanted + ".");  // libx.so.2 is libx.so.2.4.7
        }))
      lines.push_back(name);
  if (const std::size_t rest = libraries.size() - lines.size(); rest > 0)
    lines.push_back("and " + std::to_string(rest) + " that these need (--explain-all names them)");
  return lines;
}

}  // namespace

std::string percent_text(double part) {
  if (part < 0) return "not measured";
  // Two digits, and no exponent where a reader can do without.
  char text[32];
  const double value = 100 * part;
  std::snprintf(text, sizeof text, value >= 9.95 ? "%.0f %%" : "%.2g %%", value);
  return text;
}

std::vector<std::string> mapped_libraries() {
  std::ifstream maps("/proc/self/maps");
  std::vector<std::string> names;
  for (std::string line; std::getline(maps, line);) {
    const std::size_t slash = line.rfind('/');
    if (slash == std::string::npos || line.find(".so", slash) == std::string::npos) continue;
    names.push_back(line.substr(slash + 1));
  }
  std::ranges::sort(names);
  names.erase(std::ranges::unique(names).begin(), names.end());
  return names;
}

std::string error_line(const ErrorEstimate& error) {
  std::string line = "error (estimated): integration " + percent_text(error.integration) +
                     ", level of detail " + percent_text(error.level_of_detail) +
                     ", quantisation " + percent_text(error.quantisation) + ", light model " +
                     percent_text(error.light_model);
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
                        const std::string& context, const Libraries& libraries, bool all) {
  const auto shown = [&](const std::vector<std::string>& names) {
    return all ? names : grouped(names);
  };
  const RenderReport& report = result.report;
  std::ostringstream out;
  out << "device: " << context << "; " << report.device << '\n';
  list(out, "modules loaded:", SourceHost::loaded());
  list(out, "libraries that the scene brought in:",
       shown(added(libraries.device, libraries.scene_open)));
  std::vector<std::string> of_picture = added(libraries.start, libraries.format_known);
  std::ranges::copy(added(libraries.scene_open, libraries.picture_written),
                    std::back_inserter(of_picture));
  list(out, "libraries that the picture brought in:", shown(of_picture));
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
      << mib(report.image_bytes) << ", planet " << mib(report.planet_bytes) << ", sources "
      << mib(report.source_bytes) << '\n';
  out << "passes (CPU):\n";
  for (const PassReport& pass : report.passes)
    out << format("  %-24s %8.3f s\n", pass.name.c_str(), pass.cpu_s);
  list(out, "shader switches:", without_loops(report.shader_switches));
  list(out, "left out:", report.left_out);
  return out.str();
}

}  // namespace nepho
