// What `info` prints for people.
#include <algorithm>
#include <cstdio>

#include "cli/info_facts.h"

namespace nepho {
namespace {

std::string short_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Of a member that may be absent.
std::string number(const Json& object, const char* key, double scale = 1) {
  return object.contains(key) && object[key].is_number()
             ? short_text(object[key].get<double>() * scale)
             : "?";
}

std::string word(const Json& object, const char* key) {
  return object.value(key, std::string());
}

void line(const std::string& what, const std::string& text) {
  std::printf("  %-14s %s\n", what.c_str(), text.c_str());
}

void print_list(const char* title, const Json& lines) {
  for (const Json& text : lines) std::printf("  %s: %s\n", title, text.get<std::string>().c_str());
}

void print_recognised(const Json& recognised) {
  for (const auto& [what, text] : recognised.items()) {
    std::string title = what;
    std::ranges::replace(title, '_', ' ');
    line(title, text.get<std::string>());
  }
}

void print_variables(const Json& variables) {
  for (const Json& v : variables) {
    std::string text = word(v, "name") + " [" + word(v, "unit") + "] " + number(v, "min") + " to " +
                       number(v, "max");
    const auto share = [&](const char* key, const char* what) {
      if (const auto n = v[key].get<std::uint64_t>(); n > 0)
        text += ", " + std::to_string(n) + " of " +
                std::to_string(v["values"].get<std::uint64_t>()) + what;
    };
    share("missing", " missing");
    share("negative", " below 0");
    line(word(v, "meaning"), text);
  }
}

void print_columns(const Json& c) {
  const auto path = [&](const char* what, const std::string& key) {
    return c.contains(key + "_mean_kg_per_m2")
               ? std::string(what) + " mean " + number(c, (key + "_mean_kg_per_m2").c_str()) +
                     " max " + number(c, (key + "_max_kg_per_m2").c_str())
               : std::string();
  };
  const std::string liquid = path("liquid", "liquid_path");
  if (!liquid.empty())
    line("water path", liquid + "; " + path("ice", "ice_path") + "; " +
                           path("precipitation", "precipitation_path") + " kg/m2");
  std::string depth =
      c.contains("optical_depth_mean") ? "mean " + number(c, "optical_depth_mean") + ", max "
      : c.contains("optical_depth_mean_of_cloudy")
          ? "mean of cloudy columns " + number(c, "optical_depth_mean_of_cloudy") + ", max "
          : std::string("max ");
  depth += number(c, "optical_depth_max");
  if (c.contains("cover")) depth += "; cover " + number(c, "cover", 100) + " % (depth from 0.1 on)";
  line("optical depth", depth);
  if (!c.contains("cloud_base_lowest_m")) return line("cloud", "none");
  std::string cloud = number(c, "cloud_base_lowest_m", 1e-3) + " to " +
                      number(c, "cloud_top_highest_m", 1e-3) + " km high";
  if (c.contains("cloud_base_mean_m"))
    cloud += ", mean base " + number(c, "cloud_base_mean_m", 1e-3) + " and top " +
             number(c, "cloud_top_mean_m", 1e-3) + " km";
  if (c.contains("data_top_m")) {
    cloud += "; data " + number(c, "data_bottom_m", 1e-3) + " to " + number(c, "data_top_m", 1e-3) +
             " km";
    if (c.value("cut_at_top_share", 0.0) > 0)
      cloud += ", with cloud still at their top in " + number(c, "cut_at_top_share", 100) +
               " % of the cloudy area";
  }
  line("cloud", cloud);
}

void print_times(const Json& v) {
  constexpr std::size_t kMost = 8;
  const Json& t = v["time"];
  const std::size_t count = t["count"].get<std::size_t>();
  const std::string shown =
      t.contains("shown_utc") ? word(t, "shown_utc") : number(t, "shown_s") + " s, without a date";
  std::string text = shown;
  if (count > 1)
    text = std::to_string(count) + "; shown: index " +
           std::to_string(t["shown_index"].get<std::size_t>()) + ", " + shown + ", " +
           word(t, "shown_because");
  line(count > 1 ? "times" : "time", text);
  if (count < 2) return;
  const Json* rows = v.contains("states") && v["states"].is_array() ? &v["states"] : nullptr;
  const auto name = [&](std::size_t i) {
    return t.contains("times_utc") ? t["times_utc"][i].get<std::string>()
                                   : short_text(t["times_s"][i].get<double>()) + " s";
  };
  for (std::size_t i = 0; i < count; ++i) {
    if (i == kMost - 1 && count > kMost) {
      std::printf("    ... %zu more\n", count - kMost);
      i = count - 1;
    }
    std::string row = "    " + std::to_string(i) + "  " + name(i);
    if (rows) {
      const Json& state = (*rows)[i];
      row += word(state, "state") == "missing" ? "  all values missing"
             : word(state, "state") == "clear"
                 ? "  clear"
                 : "  depth mean " + number(state, "optical_depth_mean") + " max " +
                       number(state, "optical_depth_max") + ", cover " +
                       number(state, "cover", 100) + " %";
    }
    std::printf("%s\n", row.c_str());
  }
}

void print_check(const Json& e) {
  std::string total = number(e, "total_optical_depth_difference", 100) + " %";
  if (e["total_optical_depth_doubt"].get<double>() > 0)
    total += " +- " + number(e, "total_optical_depth_doubt", 100);
  line("check", "bricks against the source: total optical depth off by " + total + " (promised " +
                    number(e, "total_optical_depth_promised", 100) + "), columns " +
                    number(e, "column_rms_difference", 100) + " % rms (" +
                    number(e, "column_rms_least", 100) + " at least, promised " +
                    number(e, "column_rms_promised", 100) + ", " +
                    std::to_string(e["columns"].get<int>()) +
                    " columns): " + (e["kept"].get<bool>() ? "kept" : "NOT KEPT"));
  std::string points = "rms " + number(e, "rms_per_m") + " 1/m";
  if (e["relative_rms"].is_number())
    points += ", " + number(e, "relative_rms", 100) + " % of the field's rms";
  std::printf("  data error: %s, largest %s 1/m (%d points in %d finest nodes)\n", points.c_str(),
              number(e, "largest_per_m").c_str(), e["points"].get<int>(), e["nodes"].get<int>());
}

void print_bricks(const Json& v) {
  const Json cells = v["finest_cells"], size = v["finest_cell_m"];
  char text[240];
  std::snprintf(text, sizeof text,
                "%s, %d root(s), %d levels, %u x %u x %u cells of %.4g x %.4g x "
                "%.4g m; source holds %.3g MiB",
                v["chart"].get<std::string>().c_str(), v["roots"].get<int>(),
                v["levels"].get<int>(), cells[0].get<unsigned>(), cells[1].get<unsigned>(),
                cells[2].get<unsigned>(), size[0].get<double>(), size[1].get<double>(),
                size[2].get<double>(), v["source_bytes"].get<double>() / (1 << 20));
  line("bricks", text);
  std::string channels;
  for (const Json& channel : v["channels"])
    channels += (channels.empty() ? "" : ", ") + word(channel, "name") + " [" +
                word(channel, "unit") + "] to " + number(channel, "max_abs_error");
  line("channels",
       channels + "; phase " + word(v["phase"], "kind") + "; samples " + word(v, "samples"));
}

}  // namespace

void print_volume(const Json& v) {
  std::printf("%s (%s)\n", word(v, "name").c_str(), word(v, "source").c_str());
  print_recognised(v["recognised"]);
  print_times(v);
  print_variables(v["variables"]);
  if (v["all_missing"].get<bool>()) line("water", "all values of this time are missing");
  print_columns(v["columns"]);
  std::printf("  extinction %.6g to %.6g 1/m\n", v["extinction_per_m"]["min"].get<double>(),
              v["extinction_per_m"]["max"].get<double>());
  if (v.contains("cloud") && v["cloud"].is_object()) {
    const Json &lat = v["cloud"]["lat_deg"], &lon = v["cloud"]["lon_deg"];
    line("place", short_text(lat[0]) + " to " + short_text(lat[1]) + " N, " + short_text(lon[0]) +
                      " to " + short_text(lon[1]) + " E (bricks with cloud)");
  }
  print_bricks(v);
  if (v.contains("check")) print_check(v["check"]);
  print_list("fact", v["facts"]);
  print_list("assumed", v["assumptions"]);
}

void print_picture(const Json& p) {
  std::printf("picture by default: %d x %d, %zu bricks of %zu nodes, %.3g MiB on the GPU%s\n",
              p["width"].get<int>(), p["height"].get<int>(), p["bricks"].get<std::size_t>(),
              p["nodes"].get<std::size_t>(), p["gpu_bytes"].get<double>() / (1 << 20),
              p["budget_bound"].get<bool>() ? " (as much as --budget-mib allows)" : "");
}

}  // namespace nepho
