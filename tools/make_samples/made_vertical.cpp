#include "made_vertical.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "made_levels.h"

namespace nepho::samples {
namespace {

double flat_m(const MadeCell&, double k) {
  return 100 + kTop_m * part(k);
}
double following_m(const MadeCell& cell, double k) {
  return ground_m(cell) + (kTop_m - ground_m(cell)) * part(k);
}

std::vector<LevelEntry> by_height() {
  const auto metres = [](const char* standard) {
    return std::vector<NcNote>{text_note("standard_name", standard), text_note("units", "m")};
  };
  return {
      {"height", flat_m, false,
       [=](const Writing& w) {
         w.line("lev", along([](double k) { return flat_m({}, k); }), metres("altitude"));
       }},
      {"height_km", flat_m, false,
       [](const Writing& w) {
         w.line("lev", along([](double k) { return flat_m({}, k) / 1000; }),
                {text_note("standard_name", "altitude"), text_note("units", "km")});
       }},
      {"height_bounds", [](const MadeCell&, double k) { return 50 + 9000 * std::sqrt(k / 20); },
       true,
       [=](const Writing& w) {
         const auto z = [](double k) { return 50 + 9000 * std::sqrt(k / 20); };
         w.line("lev", along(z), joined(metres("altitude"), {text_note("bounds", "lev_bnds")}));
         w.pairs("lev_bnds", bounds(z));
       }},
      {"above_ground",
       [](const MadeCell& cell, double k) { return ground_m(cell) + flat_m(cell, k); }, false,
       [=](const Writing& w) {
         w.line("lev", along([](double k) { return flat_m({}, k); }), metres("height"));
         w.orography();
       }},
      {"above_ground_field",
       [](const MadeCell& cell, double k) { return ground_m(cell) + flat_m(cell, k) - 95; }, false,
       [=](const Writing& w) {
         w.field(
             "height", [](const MadeCell& c, double k) { return flat_m(c, k) - 95; },
             metres("height"));
         w.orography();
       }},
      {"ellipsoid", flat_m, false,
       [=](const Writing& w) {
         w.line("lev", along([](double k) { return flat_m({}, k); }),
                metres("height_above_reference_ellipsoid"));
       }},
      {"level_heights", following_m, false,
       [=](const Writing& w) { w.field("z_mc", following_m, metres("altitude")); }},
      {"half_heights", following_m, true,
       [=](const Writing& w) {
         w.halves();
         w.field("z_ifc", following_m, metres("geometric_height_at_half_level_center"), true);
       }},
      {"geopotential", following_m, false,
       [](const Writing& w) {
         w.field("phi",
                 [](const MadeCell& c, double k) {
                   return 9.80665 * geopotential_m(following_m(c, k));
                 },
                 {text_note("standard_name", "geopotential"), text_note("units", "m2 s-2")});
       }},
      {"hybrid_height",  // a + b orog
       [](const MadeCell& cell, double k) {
         return kTop_m * part(k) + (1 - part(k)) * (1 - part(k)) * ground_m(cell);
       },
       true,
       [=](const Writing& w) {
         const auto a = [](double k) { return kTop_m * part(k); };
         const auto b = [](double k) { return (1 - part(k)) * (1 - part(k)); };
         w.line("lev", along(a),
                joined(metres("atmosphere_hybrid_height_coordinate"),
                       {text_note("formula_terms", "a: level_height b: sigma orog: orog")}));
         w.line("level_height", along(a),
                {text_note("units", "m"), text_note("bounds", "level_height_bnds")});
         w.line("sigma", along(b), {text_note("units", "1"), text_note("bounds", "sigma_bnds")});
         w.pairs("level_height_bnds", bounds(a));
         w.pairs("sigma_bnds", bounds(b));
         w.orography();
       }},
      {"sleve",
       [](const MadeCell& cell, double k) {
         return 12000 * part(k) + 0.7 * ground_m(cell) * std::exp(-k / 9) +
                0.3 * ground_m(cell) * std::exp(-k / 3);
       },
       false,
       [](const Writing& w) {
         w.line("lev", along([](double k) { return k; }),
                {text_note("standard_name", "atmosphere_sleve_coordinate"), text_note("units", "1"),
                 text_note("formula_terms",
                           "a: a b1: b1 b2: b2 ztop: ztop zsurf1: zsurf1 zsurf2: zsurf2")});
         w.line("a", along([](double k) { return part(k); }), {});
         w.line("b1", along([](double k) { return std::exp(-k / 9); }), {});
         w.line("b2", along([](double k) { return std::exp(-k / 3); }), {});
         w.scalar("ztop", 12000, {text_note("units", "m")});
         w.surface("zsurf1", [](const MadeCell& c) { return 0.7 * ground_m(c); },
                   {text_note("units", "m")});
         w.surface("zsurf2", [](const MadeCell& c) { return 0.3 * ground_m(c); },
                   {text_note("units", "m")});
       }}};
}

std::vector<LevelEntry> entries() {
  std::vector<LevelEntry> all = by_height();
  for (LevelEntry& entry : made_pressures()) all.push_back(std::move(entry));
  return all;
}

}  // namespace

const std::vector<std::string>& made_vertical_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const LevelEntry& entry : entries()) list.emplace_back(entry.name);
    return list;
  }();
  return names;
}

MadeVertical made_vertical(const std::string& name) {
  for (const LevelEntry& entry : entries()) {
    if (name != entry.name) continue;
    return {name,
            [entry](const MadeCell& cell) {
              return interfaces(cell, entry.height, entry.has_interfaces);
            },
            [entry](TinyFile& file, const MadeGrid& grid) {
              entry.write({file, grid});
            }};
  }
  std::string known;
  for (const std::string& one : made_vertical_names()) known += (known.empty() ? "" : ", ") + one;
  throw Error({"no such vertical coordinate", "--vertical", known, name, ""});
}

void write_made(const std::filesystem::path& path, const std::string& grid_name,
                const std::string& vertical_name, const std::string& order,
                const NcWriter& writer) {
  if (order != "up" && order != "down")
    throw Error({"no such order", "--order", "up or down", order, ""});
  const MadeGrid grid = made_grid(grid_name);
  const MadeVertical vertical = made_vertical(vertical_name);
  TinyFile file;
  file.layout.notes = {text_note("Conventions", "CF-1.11"),
                       text_note("source", "nephoscope make_samples")};
  file.layout.format = NcFormat::kOffset64;
  file.layout.axes = {{"lev", kLevels}};
  grid.write(file);
  vertical.write(file, grid);
  Writing{file, grid}.field(
      "clw", [](const MadeCell&, double) { return 0.0; },
      {text_note("standard_name", "mass_concentration_of_cloud_liquid_water_in_air"),
       text_note("units", "g m-3")});
  const std::size_t cells = grid.nx * grid.ny;
  for (std::size_t k = kMadeLowLayer; k <= kMadeHighLayer; ++k)
    for (const std::size_t n : grid.cloudy)
      file.values.at("clw")[k * cells + n] = kMadeContent_g_per_m3;
  if (order == "down")
    for (const char* axis : {"lev", "ilev"})
      if (std::ranges::any_of(file.layout.axes, [&](const NcAxis& a) { return a.name == axis; }))
        file.reverse(axis);
  if (order == "down" && grid.axes.size() == 2) file.reverse(grid.axes[0]);
  write_tiny(path, file, writer);
}

}  // namespace nepho::samples
