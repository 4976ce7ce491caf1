#include <cmath>

#include "made_levels.h"

namespace nepho::samples {
namespace {

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

}  // namespace

std::vector<LevelEntry> made_pressures() {
  const auto pressure_axis = [](const Writing& w, std::vector<NcNote> more) {
    w.line("lev", along([](double k) { return level_Pa(k) / 100; }),
           joined({text_note("standard_name", "air_pressure"), text_note("units", "hPa")}, more));
  };
  const OfLevel fixed_Pa = [](const MadeCell&, double k) { return level_Pa(k); };
  const OfLevel fixed_m = [](const MadeCell&, double k) { return height_m(level_Pa(k)); };
  const auto hybrid_axis = [](const Writing& w, const char* standard, const char* terms,
                              std::vector<NcNote> more) {
    w.line("lev", along([](double k) { return k; }),
           joined({text_note("standard_name", standard), text_note("units", "1"),
                   text_note("formula_terms", terms)},
                  more));
  };
  const char* const kHybrid = "atmosphere_hybrid_sigma_pressure_coordinate";
  const auto ground = [](const Writing& w) {
    w.surface_pressure();
    w.orography();
    w.temperature(hybrid_Pa);
  };
  const auto numbers = [](const Writing& w) {
    w.line("lev", along([](double k) { return k + 0.5; }), {text_note("units", "level")});
  };
  return {{"pressure", fixed_m, false,
           [=](const Writing& w) {
             pressure_axis(w, {});
             w.temperature(fixed_Pa);
           }},
          {"pressure_bounds", fixed_m, true,
           [=](const Writing& w) {
             pressure_axis(w, {text_note("bounds", "lev_bnds")});
             w.pairs("lev_bnds", bounds([](double k) { return level_Pa(k) / 100; }));
             w.temperature(fixed_Pa);
           }},
          {"pressure_gh", fixed_m, false,
           [=](const Writing& w) {
             pressure_axis(w, {});
             w.field(
                 "gh",
                 [](const MadeCell&, double k) { return geopotential_m(height_m(level_Pa(k))); },
                 {text_note("standard_name", "geopotential_height"), text_note("units", "gpm")});
           }},
          {"pressure_field", hybrid_m, false,
           [=](const Writing& w) {
             w.field("pfull", hybrid_Pa,
                     {text_note("standard_name", "air_pressure"), text_note("units", "Pa")});
             ground(w);
           }},
          {"ln_pressure", fixed_m, false,
           [=](const Writing& w) {
             hybrid_axis(w, "atmosphere_ln_pressure_coordinate", "p0: p0 lev: lev", {});
             w.file.values.at("lev") = along([](double k) { return std::log(1e5 / level_Pa(k)); });
             w.scalar("p0", 1000, {text_note("units", "hPa")});
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
             w.scalar("ptop", 200, {text_note("units", "hPa")});
             w.surface_pressure();
             w.orography();
             w.temperature(p);
           }},
          {"hybrid_ap", hybrid_m, false,
           [=](const Writing& w) {
             hybrid_axis(w, kHybrid, "ap: ap b: b ps: ps", {});
             w.line("ap", along(a_Pa), {text_note("units", "Pa")});
             w.line("b", along(b_of), {text_note("units", "1")});
             ground(w);
           }},
          {"hybrid_a_p0", hybrid_m, true,
           [=](const Writing& w) {
             hybrid_axis(w, kHybrid, "a: a b: b p0: p0 ps: ps", {text_note("bounds", "lev_bnds")});
             w.pairs("lev_bnds", bounds([](double k) { return k; }),
                     {text_note("formula_terms", "a: a_bnds b: b_bnds p0: p0 ps: ps")});
             w.line("a", along([](double k) { return a_Pa(k) / 1e5; }), {});
             w.line("b", along(b_of), {});
             w.pairs("a_bnds", bounds([](double k) { return a_Pa(k) / 1e5; }));
             w.pairs("b_bnds", bounds(b_of));
             w.scalar("p0", 1e5, {text_note("units", "Pa")});
             ground(w);
           }},
          {"ifs", hybrid_m, true,
           [=](const Writing& w) {
             numbers(w);
             w.halves();
             w.line("hyam", along(a_Pa), {text_note("units", "Pa")});
             w.line("hybm", along(b_of), {});
             w.line("hyai", along(a_Pa, true), {text_note("units", "Pa")}, "ilev");
             w.line("hybi", along(b_of, true), {}, "ilev");
             ground(w);
           }},
          {"ifs_halves",  // half levels alone, the logarithm of ps, the ground's geopotential
           hybrid_m, true, [=](const Writing& w) {
             numbers(w);
             w.halves();
             w.line("hyai", along(a_Pa, true), {text_note("units", "Pa")}, "ilev");
             w.line("hybi", along(b_of, true), {}, "ilev");
             w.surface("lnsp", [](const MadeCell& c) { return std::log(pressure_Pa(ground_m(c))); },
                       {});
             w.surface("z", [](const MadeCell& c) { return 9.80665 * geopotential_m(ground_m(c)); },
                       {text_note("units", "m2 s-2")});
             w.temperature([](const MadeCell& c, double k) {
               return (hybrid_Pa(c, k - 0.5) + hybrid_Pa(c, k + 0.5)) / 2;
             });
           }}};
}

}  // namespace nepho::samples
