#include "nc_twins.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>

#include "global_forecast.h"
#include "tiny_file.h"
#include "wrf_forecast.h"

namespace nepho::samples {
namespace {

namespace fs = std::filesystem;
constexpr double kFill = -9999;

// 2 times, 12 levels 250 m apart, 16 x 20 places 0.02 degrees apart.
TinyFile plain() {
  TinyFile file;
  const std::vector<std::string> solid = {"time", "height", "lat", "lon"};
  const auto field = [&](const char* name, const char* standard, const char* units) {
    return NcField{name,
                   NcValue::kFloat,
                   solid,
                   {{"standard_name", standard}, {"units", units}, {"_FillValue", "", {kFill}}}};
  };
  NcLayout& l = file.layout;
  l.axes = {{"time", 2, true}, {"height", 12}, {"lat", 16}, {"lon", 20}};
  l.fields = {{"time",
               NcValue::kDouble,
               {"time"},
               {{"standard_name", "time"}, {"units", "hours since 2020-06-21 00:00:00"}}},
              {"height",
               NcValue::kFloat,
               {"height"},
               {{"standard_name", "altitude"}, {"units", "m"}, {"positive", "up"}, {"axis", "Z"}}},
              {"lat",
               NcValue::kDouble,
               {"lat"},
               {{"standard_name", "latitude"}, {"units", "degrees_north"}}},
              {"lon",
               NcValue::kDouble,
               {"lon"},
               {{"standard_name", "longitude"}, {"units", "degrees_east"}}},
              field("clw", "mass_fraction_of_cloud_liquid_water_in_air", "kg kg-1"),
              field("ta", "air_temperature", "K"),
              field("pa", "air_pressure", "Pa")};
  l.notes = {{"Conventions", "CF-1.8"}, {"source", "nephoscope make_samples"}};
  std::map<std::string, std::vector<double>>& v = file.values;
  v["time"] = {11, 12};
  for (int k = 0; k < 12; ++k) v["height"].push_back(125 + 250 * k);
  for (int j = 0; j < 16; ++j) v["lat"].push_back(47 + 0.02 * j);
  for (int i = 0; i < 20; ++i) v["lon"].push_back(8 + 0.02 * i);
  for (int time = 0; time < 2; ++time)
    for (const double z : v["height"])
      for (const double lat : v["lat"])
        for (const double lon : v["lon"]) {
          v["clw"].push_back(twin_water(lat, lon - 0.04 * time, z));
          v["ta"].push_back(288.15 - 6.5e-3 * z);
          v["pa"].push_back(101325 * std::pow(1 - 6.5e-3 * z / 288.15, 5.2559));
        }
  return file;
}

NcTwin changed(const std::string& name, const std::string& what,
               const std::function<void(TinyFile&)>& change) {
  return {name, what,
          [=](const fs::path& folder, const NcWriter& writer) {
            TinyFile file = plain();
            change(file);
            write_tiny(folder / (name + ".nc"), file, writer);
          },
          name + ".nc"};
}

NcTwin spoilt(const std::string& name, const std::string& what,
              const std::function<std::string(const std::string& intact)>& damage) {
  return {name, what,
          [=](const fs::path& folder, const NcWriter& writer) {
            const fs::path path = folder / (name + ".nc");
            write_tiny(path, plain(), writer);
            std::ifstream in(path, std::ios::binary);
            const std::string intact((std::istreambuf_iterator<char>(in)), {});
            in.close();
            std::ofstream(path, std::ios::binary) << damage(intact);
          },
          name + ".nc"};
}

NcTwin wrf(const std::string& name, const std::string& what, const WrfShape& shape,
           const WrfChange& change = {}) {
  return {name, what,
          [=](const fs::path& folder, const NcWriter& writer) {
            write_wrf(writer, folder / (name + ".nc"), shape, change);
          },
          name + ".nc"};
}

void drop(TinyFile& file, const std::string& field) {
  std::erase_if(file.layout.fields, [&](const NcField& f) { return f.name == field; });
}

void drop_note(TinyFile& file, const std::string& field, const std::string& note) {
  std::erase_if(file.layout.field(field).notes, [&](const NcNote& n) { return n.name == note; });
}

// 16-bit numbers whose zero unpacks to about -1e-19, as ecCodes writes them.
void pack(TinyFile& file) {
  const double step = 2e-8, offset = std::nextafter(step * 32766, 0);
  NcField& field = file.layout.field("clw");
  field.value = NcValue::kShort;
  drop_note(file, "clw", "_FillValue");
  for (const NcNote& note : {NcNote{"scale_factor", "", {step}, NcValue::kDouble},
                             NcNote{"add_offset", "", {offset}, NcValue::kDouble},
                             NcNote{"_FillValue", "", {-32767}, NcValue::kShort}})
    field.notes.push_back(note);
  for (double& v : file.values.at("clw")) v = std::round((v - offset) / step);
}

void make_profiles(TinyFile& file) {  // time x height, as of one station
  for (const char* name : {"clw", "ta", "pa"}) {
    NcField& field = file.layout.field(name);
    field.axes = {"time", "height"};
    field.notes.push_back({"coordinates", "lat lon"});
    std::vector<double>& all = file.values.at(name);
    for (std::size_t at = 0; at < 24; ++at) all[at] = all[at * 320 + 8 * 20 + 10];
    all.resize(24);
  }
  for (const char* name : {"lat", "lon"}) {
    file.layout.field(name).axes = {};
    file.values.at(name).resize(1);
  }
  file.layout.axes.resize(2);
}

void make_triangles(TinyFile& file) {  // ICON's own grid: cells in a row
  NcLayout& l = file.layout;
  l.axes = {{"time", 2, true}, {"height", 12}, {"ncells", 320}, {"nv", 3}};
  for (const char* name : {"clw", "ta", "pa"}) {
    l.field(name).axes = {"time", "height", "ncells"};
    l.field(name).notes.push_back({"CDI_grid_type", "unstructured"});
    l.field(name).notes.push_back({"coordinates", "clat clon"});
  }
  drop(file, "lat"), drop(file, "lon");
}

std::vector<NcTwin> regular() {
  const WrfShape small = {.nx = 16, .ny = 14, .nz = 12, .cell_m = 9000};
  WrfShape nest = small;
  nest.times = 3, nest.nest_step_m = 18000;
  const std::vector<std::string> water = {"QVAPOR", "QCLOUD", "QRAIN", "QICE", "QSNOW", "QGRAUP"};
  WrfChange grams;
  grams.layout = [=](NcLayout& l) {
    for (const std::string& name : water) l.set_note(name, {"units", "g kg-1"});
  };
  grams.slab = [=](const std::string& field, std::size_t, std::vector<double>& values) {
    if (std::ranges::find(water, field) != water.end())
      for (double& v : values) v *= 1000;
  };
  return {
      changed("nc_plain", "CF: heights, latitudes, longitudes, two times", [](TinyFile&) {}),
      changed("nc_packed_zero", "16-bit numbers whose zero unpacks to -1e-19", pack),
      changed("nc_negative", "tiny negative amounts where there is no cloud",
              [](TinyFile& f) {
                for (double& v : f.values.at("clw")) v = v == 0 ? -7.9e-14 : v;
              }),
      changed("nc_top_down", "levels from the top down", [](TinyFile& f) { f.reverse("height"); }),
      changed("nc_descending_lat", "latitudes from north to south",
              [](TinyFile& f) { f.reverse("lat"); }),
      changed("nc_lon_360", "longitudes 0..360, west of Greenwich",
              [](TinyFile& f) {
                for (double& v : f.values.at("lon")) v += 340;
              }),
      changed("nc_g_per_kg", "water in g/kg",
              [](TinyFile& f) {
                f.scale("clw", 1000);
                f.layout.set_note("clw", {"units", "g kg-1"});
              }),
      changed("nc_fill_time", "the first time is missing as a whole",
              [](TinyFile& f) {
                std::fill_n(f.values.at("clw").begin(), f.values.at("clw").size() / 2, kFill);
              }),
      changed("nc_some_nan", "a few values are not numbers",
              [](TinyFile& f) {
                for (std::size_t at = 0; at < f.values.at("clw").size(); at += 97)
                  f.values.at("clw")[at] = std::numeric_limits<double>::quiet_NaN();
              }),
      changed("nc_classic", "the classic format",
              [](TinyFile& f) { f.layout.format = NcFormat::kClassic; }),
      {"nc_global", "a global analysis on pressure levels, 10 degrees",
       [](const fs::path& folder, const NcWriter& writer) {
         write_global(writer, folder / "nc_global.nc", {36, 19});
       },
       "nc_global.nc"},
      wrf("nc_wrf", "a WRF forecast", small),
      wrf("nc_wrf_g_per_kg", "a WRF forecast with water in g/kg", small, grams),
      wrf("nc_moving_nest", "a WRF nest that moves 18 km with each of three times", nest),
  };
}

std::vector<NcTwin> refused() {
  return {
      changed("nc_no_units", "water without units",
              [](TinyFile& f) { drop_note(f, "clw", "units"); }),
      changed("nc_unknown_units", "water in units that nobody knows",
              [](TinyFile& f) {
                f.layout.set_note("clw", {"units", "furlongs"});
              }),
      changed("nc_too_much_water", "g/kg that call themselves kg/kg",
              [](TinyFile& f) { f.scale("clw", 1000); }),
      changed("nc_levels_disorder", "heights that neither rise nor fall, and nothing else to go by",
              [](TinyFile& f) {
                std::swap(f.values.at("height")[3], f.values.at("height")[7]);
                drop(f, "pa"), drop(f, "ta");
                f.layout.set_note("clw", {"units", "kg m-3"});
                f.layout.set_note(
                    "clw", {"standard_name", "mass_concentration_of_cloud_liquid_water_in_air"});
              }),
      changed("nc_lat_range", "latitudes beyond the pole",
              [](TinyFile& f) {
                for (double& v : f.values.at("lat")) v += 43;
              }),
      changed("nc_all_fill", "nothing but missing values",
              [](TinyFile& f) { std::ranges::fill(f.values.at("clw"), kFill); }),
      changed("nc_all_nan", "nothing but values that are not numbers",
              [](TinyFile& f) {
                std::ranges::fill(f.values.at("clw"), std::numeric_limits<double>::quiet_NaN());
              }),
      changed("nc_no_cloud", "temperature and pressure, no cloud",
              [](TinyFile& f) { drop(f, "clw"); }),
      changed("nc_time_height", "profiles of one station", make_profiles),
      changed("nc_triangles", "ICON's triangles without their grid", make_triangles),
      spoilt("nc_text", "text named .nc",
             [](const std::string&) { return std::string("netcdf but not really\n"); }),
      spoilt("nc_no_bytes", "an empty file", [](const std::string&) { return std::string(); }),
      spoilt("nc_truncated", "the first half of a file",
             [](const std::string& intact) { return intact.substr(0, intact.size() / 2); }),
      spoilt("nc_truncated_header", "the first 80 bytes of a file",
             [](const std::string& intact) { return intact.substr(0, 80); }),
  };
}

}  // namespace

const std::vector<NcTwin>& nc_twins() {
  static const std::vector<NcTwin> all = [] {
    std::vector<NcTwin> list = regular(), bad = refused();
    list.insert(list.end(), bad.begin(), bad.end());
    return list;
  }();
  return all;
}

double twin_water(double lat_deg, double lon_deg, double height_m) {
  const double x = (lon_deg - 8.2) / 0.12, y = (lat_deg - 47.16) / 0.10;
  const double z = (height_m - 1500) / 900;
  return 5e-4 * std::max(0.0, 1 - x * x - y * y - z * z);
}

}  // namespace nepho::samples
