// Names of models: what each row of the table stands for, and names that a user tells.

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "accuracy_report.h"
#include "forecast/conventions/particle_sizes.h"
#include "forecast/conventions/user_names.h"
#include "model_files.h"
#include "sources/netcdf/nc_file.h"

namespace nepho::forecast::test {
namespace {

using Variable = ModelFile::Variable;
constexpr double kGas = 287.058, kWater_kg_per_m3 = 999.84;

bool says(const Forecast& f, const std::string& part) {
  for (const auto& texts : {f.facts(), f.assumptions()})
    for (const auto& text : texts)
      if (text.find(part) != std::string::npos) return true;
  return false;
}

// The formulas of water.h, written out again.
double by_radius(double content, double radius) {
  const double efficiency = 2 + 2.12 * std::pow(2 * M_PI * radius / 550e-9, -2.0 / 3);
  return 3 * content * efficiency / (4 * kWater_kg_per_m3 * radius);
}
double radius_of(double in_cloud, double number_per_m3, double k) {
  return std::clamp(std::cbrt(3 * in_cloud / (4 * M_PI * kWater_kg_per_m3 * k * number_per_m3)),
                    4e-6, 30e-6);
}

// What one cell's extinction must be, by what was written and the physics alone.
struct Expected {
  const ModelFile& file;

  const Variable* find(Quantity is) const {
    const auto at = std::ranges::find(file.variables, is, &Variable::is);
    return at == file.variables.end() ? nullptr : &*at;
  }
  double vapour() const {
    return find(Quantity::kSpecificHumidity) || find(Quantity::kVapourMixingRatio)
               ? ModelFile::kVapour
               : 0;
  }
  // In files of liquid potential temperature a cell without cloud water is 1 K colder.
  double density(const Variable& v) const {
    constexpr int k = ModelFile::kCloudLevel;
    if (find(Quantity::kDensity)) return ModelFile::base_density_kg_per_m3(k);
    if (file.model == "DALES")  // the standard atmosphere's pressure at 1000 m
      return 89874.6 / (kGas * (ModelFile::temperature_K(k) * std::pow(89874.6 / 90000, 2.0 / 7) -
                                (v.is == Quantity::kRain ? 2.5e6 / 1004.7 * 4e-4 : 0)));
    return ModelFile::pressure_Pa(k) /
           (kGas * ModelFile::temperature_K(k) * (1 + 0.608 * vapour()));
  }
  double content(const Variable& v) const {
    if (v.units.find("m-3") != std::string::npos) return v.value(0) * 1e-3;
    const bool dry = file.model == "CM1" || file.model == "GFS";
    return v.value(0) * (v.units == "g/kg" ? 1e-3 : 1) * density(v) * (dry ? 1 - vapour() : 1);
  }
  double liquid(double content, double density) const {
    const double in_cloud = find(Quantity::kCloudFraction) ? 2 * content : content;
    if (find(Quantity::kDropletRadius)) return by_radius(content, 12e-6);
    double number = 50.575e6, k = 0.77;
    if (find(Quantity::kLandFraction)) number = 313.2e6, k = 0.69;
    if (const Variable* v = find(Quantity::kDropletNumber))
      number = v->units == "cm-3" ? 200e6 : 2e8 * density;
    return by_radius(content, radius_of(in_cloud, number, k));
  }
  double ice(double content) const {
    const double in_cloud = find(Quantity::kCloudFraction) ? 2 * content : content;
    const double radius =
        find(Quantity::kIceRadius)
            ? 55e-6
            : ice_radius_m(in_cloud, ModelFile::temperature_K(ModelFile::kCloudLevel), 0);
    return 3 * content / (2 * 917 * radius);
  }
  double extinction(const Variable& v) const {
    const double c = content(v), cold_K = ModelFile::temperature_K(ModelFile::kCloudLevel);
    if (v.name == "QN")
      return liquid(c / 2, density(v)) + ice(c / 2);  // half way from 253.16 to 273.16 K
    switch (v.is) {
      case Quantity::kCloudWater:
        return liquid(c, density(v));
      case Quantity::kCloudIce:
        return ice(c);
      case Quantity::kRain:  // SAM's precipitation is snow below 268.16 K
        return precipitation_extinction_m2_per_kg(v.name == "QP" ? Species::kSnow : Species::kRain,
                                                  c, cold_K) *
               c;
      case Quantity::kSnow:
        return precipitation_extinction_m2_per_kg(Species::kSnow, c, cold_K) * c;
      default:
        return precipitation_extinction_m2_per_kg(Species::kGraupel, c, cold_K) * c;
    }
  }
};

TEST(ModelNames, EachKindOfWaterHasItsExtinction) {
  double worst = 0;
  for (const ModelFile& file : model_files()) {
    SCOPED_TRACE(file.file);
    const std::string path = file.write();
    const auto forecast = open(path);
    const ForecastColumns c = forecast->columns(0);
    ASSERT_EQ(c.nz, ModelFile::kNz);
    int cell = 0;
    for (const Variable& v : file.variables) {
      if (v.shape != Variable::kWater) continue;
      const double wanted = Expected{file}.extinction(v);
      const double found =
          double(c.extinction_per_m[std::size_t(cell * c.nz + ModelFile::kCloudLevel)]);
      worst = std::max(worst, std::abs(found / wanted - 1));
      EXPECT_NEAR(found / wanted, 1, 2e-3) << v.name << ": " << found << ", wanted " << wanted;
      ++cell;
    }
    if (!file.model.empty()) {
      EXPECT_TRUE(says(*forecast, "The names are those of " + file.model + "."));
    }
    EXPECT_FALSE(says(*forecast, "untested")) << "every row that the made files use is tested";
  }
  nepho::test::report_accuracy("netcdf", "extinction of made files of models", worst, 2e-3, "1");
}

// The marks of the table are the list of what these files, and the real ones, hold.
TEST(ModelNames, MarksAreTrue) {
  std::set<std::string> made, marked;
  const auto key = [](const NameRow& row) {
    return std::string(row.model) + ": " + word_of(row.quantity) + " " + row.name +
           row.standard_name;
  };
  for (const ModelFile& model : model_files()) {
    const netcdf::NcFile file(model.write(), {});
    EXPECT_EQ(model_of_file(file), model.model) << model.file;
    for (const Variable& v : model.variables) {
      const NameRow* row = row_of(file, v.is, *file.find(v.name));
      ASSERT_NE(row, nullptr) << model.file << " " << v.name;
      EXPECT_TRUE(row->model == model.model || row->model == std::string(kAnyModel))
          << key(*row) << " in a file of " << model.model;
      EXPECT_NE(row->evidence, Evidence::kNone) << key(*row);
      made.insert(key(*row));
    }
  }
  // Written by the tests of WRF's own convention.
  for (const char* row : {"cloud_ice qice", "rain qrain", "snow qsnow", "graupel qgraup",
                          "droplet_number qncloud", "droplet_radius re_cloud", "ice_radius re_ice"})
    made.insert(std::string("WRF: ") + row);
  for (const NameRow& row : name_table())
    if (row.evidence == Evidence::kMade) marked.insert(key(row));
  for (const std::string& row : marked) EXPECT_TRUE(made.contains(row)) << row << " is marked only";
}

TEST(ModelNames, PressureThatIsADeviationIsNotUsed) {
  ModelFile file;
  file.file = "deviation";
  file.variables = {
      {"ql", "kg/kg", Quantity::kCloudWater, Variable::kWater, [](int) { return 4e-4; }},
      {"p", "Pa", Quantity::kOther, Variable::kField, [](int k) { return k - 1.5; }}};
  const auto f = open(file.write());
  EXPECT_TRUE(says(*f, "p falls to 0 and below"));
  EXPECT_TRUE(says(*f, "There is no pressure: air densities are the standard atmosphere's"));
}

TEST(ModelNames, RowsWithoutAFileAreSaid) {
  ModelFile file;
  file.file = "untested";
  file.variables = {
      {"iwc", "g m-3", Quantity::kCloudIce, Variable::kWater, [](int) { return 0.01; }},
      {"temp", "K", Quantity::kTemperature, Variable::kField, ModelFile::temperature_K}};
  const auto f = open(file.write());
  EXPECT_TRUE(says(*f, "iwc is read as cloud_ice by the name that any model gives it: untested"));
  EXPECT_TRUE(
      says(*f, "temp is read as temperature by the name that any model gives it: untested"));
}

// A fraction alone: 0.21 g/m3 exp(-z / h) in the cloudy part.
TEST(ModelNames, FractionWithoutWaterHasAStatedOne) {
  ModelFile file;
  file.file = "fraction";
  file.variables = {{"cloud", "%", Quantity::kCloudFraction, Variable::kField,
                     [](int) { return 30.0; }, "cloud_area_fraction_in_atmosphere_layer"},
                    {"ta", "K", Quantity::kTemperature, Variable::kField, [](int k) {
                       return k == 3 ? 240.0 : k == 2 ? 253.15 : 280.0;
                     }}};
  const auto f = open(file.write());
  EXPECT_TRUE(says(*f, "There is no cloud water, only the cloud fraction cloud"));
  EXPECT_TRUE(says(*f, "25 kg/m2 are taken"));
  const ForecastColumns c = f->columns(0);
  const double h = 700 * std::log(26.0);
  for (std::size_t k = 0; k < 4; ++k) {
    const double middle =
        0.5 * (double(c.interface_m[k]) + double(c.interface_m[k + 1])) - double(c.interface_m[0]);
    const double in_cloud = 0.21e-3 * std::exp(-middle / h), all = double(c.extinction_per_m[k]);
    const double wanted = by_radius(0.3 * in_cloud, radius_of(in_cloud, 50.575e6, 0.77));
    const double ice = double(c.ice_extinction_per_m[k]);
    if (k < 2) {
      EXPECT_NEAR(all / wanted, 1, 2e-3);
      EXPECT_EQ(ice, 0);
    } else if (k == 2) {
      EXPECT_GT(ice, 0.05 * all);  // half and half
      EXPECT_LT(ice, 0.95 * all);
    } else {
      EXPECT_GT(all, 0);
      EXPECT_EQ(ice, all);
    }
  }
}

// CM1 up to release 19: dimensions ni, nj, nk with coordinates xh, yh, z in km; times in seconds.
TEST(ModelNames, OldCm1) {
  const std::string path = folder() / "cm1r19.nc";
  {
    NcWriter nc(path);
    for (const auto& [name, size] : {std::pair{"time", 2}, {"nk", 3}, {"nj", 3}, {"ni", 4}})
      nc.dimension(name, std::size_t(size));
    nc.global("CM1 version", std::string("19.10"));
    nc.variable("time", NC_DOUBLE, {"time"}, {3600, 7200}, {{"units", "s"}});
    nc.variable("xh", NC_DOUBLE, {"ni"}, {-1.5, -0.5, 0.5, 1.5}, {{"units", "km"}});
    nc.variable("yh", NC_DOUBLE, {"nj"}, {-1, 0, 1}, {{"units", "km"}});
    nc.variable("z", NC_DOUBLE, {"nk"}, {0.25, 0.75, 1.25}, {{"units", "km"}});
    const auto put = [&](const char* name, const char* units, auto value) {
      std::vector<double> values;
      for (int n = 0; n < 2 * 36; ++n) values.push_back(value(n / 36, n / 12 % 3, n % 12));
      nc.variable(name, NC_FLOAT, {"time", "nk", "nj", "ni"}, values,
                  {{"units", std::string(units)}});
    };
    put("prs", "Pa", [](int, int k, int) { return 97000.0 - 5000 * k; });
    put("th", "K", [](int, int k, int) { return 300.0 + k; });
    put("qc", "kg/kg", [](int t, int k, int n) { return k == 1 && n == 5 ? 2e-4 * (t + 1) : 0; });
  }
  const auto f = open(path);
  EXPECT_EQ(f->times_s(), (std::vector<double>{0, 3600}));
  EXPECT_EQ(f->time_origin_ns(), 3600'000'000'000);
  EXPECT_TRUE(says(*f, "The times count from no date"));
  const ForecastColumns c = f->columns(1);
  const double density = 92000 / (kGas * 301 * std::pow(0.92, 2.0 / 7)), content = 4e-4 * density;
  EXPECT_NEAR(double(c.extinction_per_m[5 * 3 + 1]) /
                  by_radius(content, radius_of(content, 50.575e6, 0.77)),
              1, 2e-3);
  EXPECT_NEAR(double(c.interface_m[5 * 4 + 1]), 500, 0.5);
}

// The table of docs/names.md says of each model what the marks say.
TEST(ModelNames, PageIsTrue) {
  std::ifstream page(NEPHO_TEST_NAMES_PAGE);
  ASSERT_TRUE(page);
  std::set<std::string> said, marked;
  for (std::string line; std::getline(page, line);) {
    std::istringstream cells(line);
    std::string bar, model, real, made, none;
    if (cells >> bar >> model >> bar >> real >> bar >> made >> bar >> none && bar == "|" &&
        !real.empty() && std::isdigit(static_cast<unsigned char>(real[0])))
      said.insert(model + " " + real + " " + made + " " + none);
  }
  std::map<std::string, std::array<int, 3>> counts;
  for (const NameRow& row : name_table()) ++counts[row.model][std::size_t(row.evidence)];
  for (const auto& [model, n] : counts)
    if (model != kAnyModel)
      marked.insert(model + " " + std::to_string(n[0]) + " " + std::to_string(n[1]) + " " +
                    std::to_string(n[2]));
  EXPECT_EQ(said, marked);
  if (HasFailure())
    for (const std::string& row : marked) std::printf("page: %s\n", row.c_str());
}

TEST(ModelNames, UnitsOfSizes) {
  const auto of = [](const std::string& units) {
    FileVariable v;
    v.attributes = {{"units", units, {}}};
    return v;
  };
  for (const auto& [units, factor, per_kg] : {std::tuple{"m-3", 1.0, false},
                                              {"cm-3", 1e6, false},
                                              {"kg-1", 1.0, true},
                                              {"#/kg", 1.0, true},
                                              {"  kg(-1)", 1.0, true},
                                              {"# kg-1", 1.0, true},
                                              {"# m-3", 1.0, false},
                                              {"1/cm3", 1e6, false}}) {
    const auto unit = number_unit(of(units));
    ASSERT_TRUE(unit) << units;
    EXPECT_NEAR(unit->factor, factor, 1e-9 * factor) << units;
    EXPECT_EQ(unit->per_kg, per_kg) << units;
  }
  EXPECT_FALSE(number_unit(of("kg kg-1")));
  EXPECT_FALSE(number_unit(of("")));
  EXPECT_NEAR(*radius_factor(of("mkm")), 1e-6, 1e-12);
  EXPECT_NEAR(*radius_factor(of("um")), 1e-6, 1e-12);
  EXPECT_EQ(radius_factor(of("m")), 1.0);
  EXPECT_FALSE(radius_factor(of("K")));
}

// A model that nobody knows: all its names are told.
ModelFile invented() {
  ModelFile file;
  file.file = "invented";
  file.z = "etage";
  file.y = "rang";
  file.x = "file";
  file.z_units = "";
  file.variables = {
      {"eau", "milli", Quantity::kCloudWater, Variable::kWater, [](int) { return 0.4; }},
      {"glace", "", Quantity::kCloudIce, Variable::kWater, [](int) { return 1e-5; },
       "frozen_cloud"},
      {"chaleur", "K", Quantity::kTemperature, Variable::kField, ModelFile::temperature_K},
      {"poids", "Pa", Quantity::kPressure, Variable::kField, ModelFile::pressure_Pa},
      {"hauteur", "m", Quantity::kFullLevelHeight, Variable::kField, ModelFile::height_m},
      // Known names that are something else here.
      {"qc", "kg/kg", Quantity::kOther, Variable::kField, [](int) { return 9e-4; }},
      {"t", "K", Quantity::kOther, Variable::kField, [](int) { return 150.0; }}};
  return file;
}

std::string names_file(const std::string& text) {
  const std::string path = folder() / "model.names";
  std::ofstream(path) << text;
  return path;
}

std::unique_ptr<Forecast> open_with(const std::string& path, const std::string& names) {
  OpenRequest request;
  request.files = {path};
  request.names_file = names;
  return netcdf::open_netcdf(request);
}

TEST(UserNames, ReadAModelThatNobodyKnows) {
  const ModelFile file = invented();
  const std::string path = file.write();
  EXPECT_NE(refusal(path), "");
  const std::string names = names_file(
      "# The invented model\n"
      "cloud_water  eau   units=g/kg  # in spite of what it says\n"
      "\n"
      "cloud_ice    standard_name:frozen_cloud  units=\"kg kg-1\"  per=moist_air\n"
      "temperature  chaleur\n"
      "pressure     poids\n"
      "level_height hauteur\n"
      "other        qc\n"
      "level_axis   etage\n"
      "y_axis       rang\n"
      "x_axis       file\n"
      "rain         pluie units=g/kg\n");
  const auto f = open_with(path, names);
  EXPECT_TRUE(says(*f, "9 of 10 rows of " + names + " are of this file; it does not hold pluie."));
  const ForecastColumns c = f->columns(0);
  const double density = ModelFile::pressure_Pa(1) / (kGas * ModelFile::temperature_K(1));
  const double content = 4e-4 * density;
  EXPECT_NEAR(
      double(c.extinction_per_m[1]) / by_radius(content, radius_of(content, 50.575e6, 0.77)), 1,
      2e-3);
  EXPECT_NEAR(double(c.ice_extinction_per_m[4 + 1]) /
                  (3 * 1e-5 * density /
                   (2 * 917 * ice_radius_m(1e-5 * density, ModelFile::temperature_K(1), 0))),
              1, 2e-3);
  EXPECT_NEAR(double(c.interface_m[1]), 750, 1);
}

TEST(UserNames, DryAirAndPartsAddUp) {
  ModelFile file;
  file.file = "parts";
  const auto water = [](const char* name) {
    return Variable{name, "g/kg", Quantity::kCloudWater, Variable::kField,
                    [](int k) { return k == 1 ? 0.2 : 0; }};
  };
  file.variables = {
      water("stratiform"),
      water("convective"),
      {"ta", "K", Quantity::kTemperature, Variable::kField, ModelFile::temperature_K},
      {"q", "kg/kg", Quantity::kSpecificHumidity, Variable::kField, [](int) { return 0.02; }},
      {"p", "Pa", Quantity::kPressure, Variable::kField, ModelFile::pressure_Pa}};
  const std::string path = file.write();
  const auto depth = [&](const std::string& per) {
    const auto f = open_with(path, names_file("cloud_water stratiform per=" + per +
                                              "\ncloud_water convective per=" + per + "\n"));
    return double(f->columns(0).extinction_per_m[1]);
  };
  const double density =
      ModelFile::pressure_Pa(1) / (kGas * ModelFile::temperature_K(1) * (1 + 0.608 * 0.02));
  const auto wanted = [](double part) {
    return 2 * by_radius(part, radius_of(part, 50.575e6, 0.77));
  };
  EXPECT_NEAR(depth("moist_air") / wanted(2e-4 * density), 1, 2e-3);
  EXPECT_NEAR(depth("dry_air") / wanted(2e-4 * density * 0.98), 1, 2e-3);
}

TEST(UserNames, AVariableWithoutUnitsIsNamed) {
  ModelFile file;
  file.file = "unitless";
  file.variables = {
      {"ql", "kg/kg", Quantity::kCloudWater, Variable::kWater, [](int) { return 4e-4; }},
      {"chaleur", "", Quantity::kTemperature, Variable::kField, ModelFile::temperature_K}};
  const std::string path = file.write();
  std::string text;
  try {
    open_with(path, names_file("temperature chaleur"));
  } catch (const Error& e) {
    text = e.what();
  }
  EXPECT_NE(text.find("[chaleur]: the unit of a variable that the names file names"),
            std::string::npos)
      << text;
  open_with(path, names_file("temperature chaleur units=K"));
}

TEST(UserNames, BadLinesAreNamed) {
  struct Case {
    const char *text, *says, *line;
  };
  for (const Case& c :
       {Case{"cloudwater ql", "x_axis, y_axis, level_axis, time_axis, cloud_water, rain", "line 1"},
        {"\n# x\ncloud_water", "a quantity without a name", "line 3"},
        {"cloud_water ql units=bushel", "the unit is not known", "line 1"},
        {"cloud_water ql per=bucket", "per=dry_air or per=moist_air", "line 1"},
        {"cloud_water ql g/kg", "a word too many", "line 1"},
        {"cloud_water ql units=\"kg kg-1", "a quote is not closed", "line 1"},
        {"cloud_water grib2:0/1", "grib2:DISCIPLINE/CATEGORY/NUMBER", "line 1"},
        {"cloud_water grib1:98/x/3", "grib1:CENTRE/TABLE/NUMBER", "line 1"},
        {"# nothing\n", "there are no names", "model.names"}}) {
    std::string text;
    try {
      read_user_names(names_file(c.text));
    } catch (const Error& e) {
      text = e.what();
    }
    EXPECT_NE(text.find(c.says), std::string::npos) << c.text << ": " << text;
    EXPECT_NE(text.find(c.line), std::string::npos) << c.text << ": " << text;
  }
  EXPECT_THROW(read_user_names(folder() / "none.names"), Error);
}

}  // namespace
}  // namespace nepho::forecast::test
