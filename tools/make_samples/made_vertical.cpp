#include "made_vertical.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace nepho::samples {
namespace {

constexpr std::size_t kLevels = 20;
constexpr double kTop_m = 10000, kRadius_m = 6356766, kSea_Pa = 101325, kSea_K = 288.15;
constexpr double kPower = 9.80665 / (287.0529 * 0.0065);

NcNote text(const char* name, const std::string& value) {
  return {name, value};
}

// Geometric and geopotential height, and pressure, of the lowest 11 km.
double geopotential_m(double z) {
  return kRadius_m * z / (kRadius_m + z);
}
double geometric_m(double h) {
  return kRadius_m * h / (kRadius_m - h);
}
double pressure_Pa(double z) {
  return kSea_Pa * std::pow(1 - 0.0065 * geopotential_m(z) / kSea_K, kPower);
}
double height_m(double p) {
  return geometric_m(kSea_K / 0.0065 * (1 - std::pow(p / kSea_Pa, 1 / kPower)));
}
double temperature_K(double p) {
  return kSea_K * std::pow(p / kSea_Pa, 1 / kPower);
}

double ground_m(const MadeCell& cell) {
  const double lat = std::isnan(cell.centre_deg.x) ? 0 : cell.centre_deg.x;
  const double lon = std::isnan(cell.centre_deg.y) ? 0 : cell.centre_deg.y;
  return 350 + 250 * std::sin(0.05 * lat) * std::cos(0.11 * lon);
}

// Uneven steps of 0 to 1, level k's middle at k + 0.5.
double part(double k) {
  const double t = k / double(kLevels);
  return 0.35 * t + 0.65 * t * t;
}

// What a vertical is made of: height or pressure of a (fractional) level of a cell.
using OfLevel = std::function<double(const MadeCell&, double k)>;

std::vector<double> interfaces(const MadeCell& cell, const OfLevel& height, bool own) {
  std::vector<double> all;
  if (own) {
    for (std::size_t k = 0; k <= kLevels; ++k) all.push_back(height(cell, double(k)));
    return all;
  }
  std::vector<double> level;
  for (std::size_t k = 0; k < kLevels; ++k) level.push_back(height(cell, double(k) + 0.5));
  all.push_back(level[0] - (level[1] - level[0]) / 2);
  for (std::size_t k = 1; k < kLevels; ++k) all.push_back((level[k - 1] + level[k]) / 2);
  all.push_back(level.back() + (level.back() - level[kLevels - 2]) / 2);
  return all;
}

std::vector<std::string> with(const std::string& axis, std::vector<std::string> axes) {
  axes.insert(axes.begin(), axis);
  return axes;
}

std::vector<NcNote> joined(std::vector<NcNote> a, const std::vector<NcNote>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<double> along(const std::function<double(double k)>& value, bool halves = false) {
  std::vector<double> all;
  for (std::size_t k = 0; k < kLevels + halves; ++k)
    all.push_back(value(double(k) + (halves ? 0 : 0.5)));
  return all;
}

std::vector<double> bounds(const std::function<double(double k)>& value) {
  std::vector<double> all;
  for (std::size_t k = 0; k < kLevels; ++k) {
    all.push_back(value(double(k)));
    all.push_back(value(double(k + 1)));
  }
  return all;
}

// A file's parts.
struct Writing {
  TinyFile& file;
  const MadeGrid& grid;

  void line(const char* name, std::vector<double> values, std::vector<NcNote> notes,
            const char* axis = "lev") const {
    file.add({name, NcValue::kDouble, {axis}, std::move(notes)}, std::move(values));
  }
  void pairs(const char* name, std::vector<double> values, std::vector<NcNote> notes = {}) const {
    if (std::ranges::none_of(file.layout.axes, [](const NcAxis& a) { return a.name == "bnds"; }))
      file.layout.axes.push_back({"bnds", 2});
    file.add({name, NcValue::kDouble, {"lev", "bnds"}, std::move(notes)}, std::move(values));
  }
  void scalar(const char* name, double value, std::vector<NcNote> notes) const {
    file.add({name, NcValue::kDouble, {}, std::move(notes)}, {value});
  }
  void field(const char* name, const OfLevel& value, std::vector<NcNote> notes,
             bool halves = false) const {
    std::vector<double> all;
    for (std::size_t k = 0; k < kLevels + halves; ++k)
      for (std::size_t n = 0; n < grid.nx * grid.ny; ++n)
        all.push_back(value(grid.cell(n), double(k) + (halves ? 0 : 0.5)));
    file.add({name, NcValue::kDouble, with(halves ? "ilev" : "lev", grid.axes),
              joined(std::move(notes), grid.notes)},
             std::move(all));
  }
  void surface(const char* name, const std::function<double(const MadeCell&)>& value,
               std::vector<NcNote> notes) const {
    std::vector<double> all;
    for (std::size_t n = 0; n < grid.nx * grid.ny; ++n) all.push_back(value(grid.cell(n)));
    file.add({name, NcValue::kDouble, grid.axes, joined(std::move(notes), grid.notes)},
             std::move(all));
  }
  void halves() const { file.layout.axes.push_back({"ilev", kLevels + 1}); }
  void orography() const {
    surface("orog", ground_m, {text("standard_name", "surface_altitude"), text("units", "m")});
  }
  void surface_pressure() const {
    surface("ps", [](const MadeCell& cell) { return pressure_Pa(ground_m(cell)); },
            {text("standard_name", "surface_air_pressure"), text("units", "Pa")});
  }
  void temperature(const OfLevel& p) const {
    field("ta", [&](const MadeCell& cell, double k) { return temperature_K(p(cell, k)); },
          {text("standard_name", "air_temperature"), text("units", "K")});
  }
};

struct Entry {
  const char* name;
  OfLevel height;  // of the fractional level k + 0.5, and of interfaces k where it has its own
  bool has_interfaces;
  std::function<void(const Writing&)> write;
};

double flat_m(const MadeCell&, double k) {
  return 100 + kTop_m * part(k);
}
double following_m(const MadeCell& cell, double k) {
  return ground_m(cell) + (kTop_m - ground_m(cell)) * part(k);
}

std::vector<Entry> by_height() {
  const auto metres = [](const char* standard) {
    return std::vector<NcNote>{text("standard_name", standard), text("units", "m")};
  };
  return {
      {"height", flat_m, false,
       [=](const Writing& w) {
         w.line("lev", along([](double k) { return flat_m({}, k); }), metres("altitude"));
       }},
      {"height_km", flat_m, false,
       [](const Writing& w) {
         w.line("lev", along([](double k) { return flat_m({}, k) / 1000; }),
                {text("standard_name", "altitude"), text("units", "km")});
       }},
      {"height_bounds", [](const MadeCell&, double k) { return 50 + 9000 * std::sqrt(k / 20); },
       true,
       [=](const Writing& w) {
         const auto z = [](double k) { return 50 + 9000 * std::sqrt(k / 20); };
         w.line("lev", along(z), joined(metres("altitude"), {text("bounds", "lev_bnds")}));
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
                 {text("standard_name", "geopotential"), text("units", "m2 s-2")});
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
                       {text("formula_terms", "a: level_height b: sigma orog: orog")}));
         w.line("level_height", along(a),
                {text("units", "m"), text("bounds", "level_height_bnds")});
         w.line("sigma", along(b), {text("units", "1"), text("bounds", "sigma_bnds")});
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
                {text("standard_name", "atmosphere_sleve_coordinate"), text("units", "1"),
                 text("formula_terms",
                      "a: a b1: b1 b2: b2 ztop: ztop zsurf1: zsurf1 zsurf2: zsurf2")});
         w.line("a", along([](double k) { return part(k); }), {});
         w.line("b1", along([](double k) { return std::exp(-k / 9); }), {});
         w.line("b2", along([](double k) { return std::exp(-k / 3); }), {});
         w.scalar("ztop", 12000, {text("units", "m")});
         w.surface("zsurf1", [](const MadeCell& c) { return 0.7 * ground_m(c); },
                   {text("units", "m")});
         w.surface("zsurf2", [](const MadeCell& c) { return 0.3 * ground_m(c); },
                   {text("units", "m")});
       }}};
}

// Pressures: one per level, or a + b ps.
double level_Pa(double k) {
  return 1e5 * std::exp(-1.3 * part(k));
}
double a_Pa(double k) {
  return 25000 * part(k) * (2 - part(k));
}
double b_of(double k) {
  return (1 - part(k)) * (1 - part(k));
}
double hybrid_Pa(const MadeCell& cell, double k) {
  return a_Pa(k) + b_of(k) * pressure_Pa(ground_m(cell));
}
double hybrid_m(const MadeCell& cell, double k) {
  return height_m(hybrid_Pa(cell, k));
}

std::vector<Entry> by_pressure() {
  const auto pressure_axis = [](const Writing& w, std::vector<NcNote> more) {
    w.line("lev", along([](double k) { return level_Pa(k) / 100; }),
           joined({text("standard_name", "air_pressure"), text("units", "hPa")}, more));
  };
  const OfLevel fixed_Pa = [](const MadeCell&, double k) { return level_Pa(k); };
  const OfLevel fixed_m = [](const MadeCell&, double k) { return height_m(level_Pa(k)); };
  const auto hybrid_axis = [](const Writing& w, const char* standard, const char* terms,
                              std::vector<NcNote> more) {
    w.line(
        "lev", along([](double k) { return k; }),
        joined({text("standard_name", standard), text("units", "1"), text("formula_terms", terms)},
               more));
  };
  const char* const kHybrid = "atmosphere_hybrid_sigma_pressure_coordinate";
  const auto ground = [](const Writing& w) {
    w.surface_pressure();
    w.orography();
    w.temperature(hybrid_Pa);
  };
  const auto numbers = [](const Writing& w) {
    w.line("lev", along([](double k) { return k + 0.5; }), {text("units", "level")});
  };
  return {
      {"pressure", fixed_m, false,
       [=](const Writing& w) {
         pressure_axis(w, {});
         w.temperature(fixed_Pa);
       }},
      {"pressure_bounds", fixed_m, true,
       [=](const Writing& w) {
         pressure_axis(w, {text("bounds", "lev_bnds")});
         w.pairs("lev_bnds", bounds([](double k) { return level_Pa(k) / 100; }));
         w.temperature(fixed_Pa);
       }},
      {"pressure_gh", fixed_m, false,
       [=](const Writing& w) {
         pressure_axis(w, {});
         w.field("gh",
                 [](const MadeCell&, double k) { return geopotential_m(height_m(level_Pa(k))); },
                 {text("standard_name", "geopotential_height"), text("units", "gpm")});
       }},
      {"pressure_field", hybrid_m, false,
       [=](const Writing& w) {
         w.field("pfull", hybrid_Pa, {text("standard_name", "air_pressure"), text("units", "Pa")});
         ground(w);
       }},
      {"ln_pressure", fixed_m, false,
       [=](const Writing& w) {
         hybrid_axis(w, "atmosphere_ln_pressure_coordinate", "p0: p0 lev: lev", {});
         w.file.values.at("lev") = along([](double k) { return std::log(1e5 / level_Pa(k)); });
         w.scalar("p0", 1000, {text("units", "hPa")});
         w.temperature(fixed_Pa);
       }},
      {"sigma",
       [](const MadeCell& cell, double k) {
         return height_m(20000 + (1 - part(k)) * (pressure_Pa(ground_m(cell)) - 20000));
       },
       false,
       [=](const Writing& w) {
         const OfLevel p = [](const MadeCell& cell, double k) {
           return 20000 + (1 - part(k)) * (pressure_Pa(ground_m(cell)) - 20000);
         };
         hybrid_axis(w, "atmosphere_sigma_coordinate", "sigma: lev ps: ps ptop: ptop", {});
         w.file.values.at("lev") = along([](double k) { return 1 - part(k); });
         w.scalar("ptop", 200, {text("units", "hPa")});
         w.surface_pressure();
         w.orography();
         w.temperature(p);
       }},
      {"hybrid_ap", hybrid_m, false,
       [=](const Writing& w) {
         hybrid_axis(w, kHybrid, "ap: ap b: b ps: ps", {});
         w.line("ap", along(a_Pa), {text("units", "Pa")});
         w.line("b", along(b_of), {text("units", "1")});
         ground(w);
       }},
      {"hybrid_a_p0", hybrid_m, true,
       [=](const Writing& w) {
         hybrid_axis(w, kHybrid, "a: a b: b p0: p0 ps: ps", {text("bounds", "lev_bnds")});
         w.pairs("lev_bnds", bounds([](double k) { return k; }),
                 {text("formula_terms", "a: a_bnds b: b_bnds p0: p0 ps: ps")});
         w.line("a", along([](double k) { return a_Pa(k) / 1e5; }), {});
         w.line("b", along(b_of), {});
         w.pairs("a_bnds", bounds([](double k) { return a_Pa(k) / 1e5; }));
         w.pairs("b_bnds", bounds(b_of));
         w.scalar("p0", 1e5, {text("units", "Pa")});
         ground(w);
       }},
      {"ifs", hybrid_m, true,
       [=](const Writing& w) {
         numbers(w);
         w.halves();
         w.line("hyam", along(a_Pa), {text("units", "Pa")});
         w.line("hybm", along(b_of), {});
         w.line("hyai", along(a_Pa, true), {text("units", "Pa")}, "ilev");
         w.line("hybi", along(b_of, true), {}, "ilev");
         ground(w);
       }},
      {"ifs_halves",  // half levels alone, the logarithm of ps, the ground's geopotential
       hybrid_m, true, [=](const Writing& w) {
         numbers(w);
         w.halves();
         w.line("hyai", along(a_Pa, true), {text("units", "Pa")}, "ilev");
         w.line("hybi", along(b_of, true), {}, "ilev");
         w.surface("lnsp", [](const MadeCell& c) { return std::log(pressure_Pa(ground_m(c))); },
                   {});
         w.surface("z", [](const MadeCell& c) { return 9.80665 * geopotential_m(ground_m(c)); },
                   {text("units", "m2 s-2")});
         w.temperature([](const MadeCell& c, double k) {
           return (hybrid_Pa(c, k - 0.5) + hybrid_Pa(c, k + 0.5)) / 2;
         });
       }}};
}

std::vector<Entry> entries() {
  std::vector<Entry> all = by_height();
  for (Entry& entry : by_pressure()) all.push_back(std::move(entry));
  return all;
}

}  // namespace

const std::vector<std::string>& made_vertical_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Entry& entry : entries()) list.emplace_back(entry.name);
    return list;
  }();
  return names;
}

MadeVertical made_vertical(const std::string& name) {
  for (const Entry& entry : entries()) {
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
  file.layout.notes = {text("Conventions", "CF-1.11"), text("source", "nephoscope make_samples")};
  file.layout.format = NcFormat::kOffset64;
  file.layout.axes = {{"lev", kLevels}};
  grid.write(file);
  vertical.write(file, grid);
  Writing{file, grid}.field(
      "clw", [](const MadeCell&, double) { return 0.0; },
      {text("standard_name", "mass_concentration_of_cloud_liquid_water_in_air"),
       text("units", "g m-3")});
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
