// Files of models that no one of us wrote.

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <cstdio>
#include <set>

#include "accuracy_report.h"
#include "core/error.h"
#include "forecast/conventions/names.h"
#include "forecast/water/air.h"
#include "forecast/water/water.h"
#include "geo/place.h"
#include "nc_writer.h"
#include "optical_depths.h"
#include "sources/netcdf/nc_file.h"
#include "sources/netcdf/open_netcdf.h"

namespace nepho::forecast {
using nepho::test::report_accuracy;
namespace {

std::unique_ptr<Forecast> open(const std::string& name) {
  OpenRequest request;
  request.files = {std::string(NEPHO_TEST_REAL_DATA) + "/" + name};
  return netcdf::open_netcdf(request);
}

void print(const Forecast& f) {
  for (const auto& fact : f.facts()) std::printf("measured: fact: %s\n", fact.c_str());
  for (const auto& text : f.assumptions()) std::printf("measured: assumption: %s\n", text.c_str());
  std::printf("measured: heights %.1f to %.1f m, thinnest %.2f m, radius %.2f um, %zu times\n",
              f.height_range_m().x, f.height_range_m().y, f.thinnest_layer_m(),
              f.liquid_radius_m() * 1e6, f.times_s().size());
  const auto grid = f.grid(0);
  const auto low = grid->lat_lon_deg(0, 0), high = grid->lat_lon_deg(grid->nx(), grid->ny());
  std::printf("measured: grid %d x %d, around %d, %.4f %.4f to %.4f %.4f\n", grid->nx(), grid->ny(),
              int(grid->around()), low.x, low.y, high.x, high.y);
}

bool says(const Forecast& f, const std::string& part) {
  for (const auto& texts : {f.facts(), f.assumptions()})
    for (const auto& text : texts)
      if (text.find(part) != std::string::npos) return true;
  return false;
}

// Finite, not negative, ice no more than all, interfaces rising: at every time.
void expect_sound(const Forecast& f) {
  for (std::size_t t = 0; t < f.times_s().size(); ++t) {
    const ForecastColumns c = f.columns(t);
    const std::size_t nz = std::size_t(c.nz), cells = std::size_t(c.nx) * std::size_t(c.ny);
    ASSERT_EQ(c.extinction_per_m.size(), cells * nz);
    ASSERT_EQ(c.interface_m.size(), cells * (nz + 1));
    for (std::size_t n = 0; n < c.extinction_per_m.size(); ++n) {
      ASSERT_TRUE(c.extinction_per_m[n] >= 0 && c.extinction_per_m[n] < 1);
      if (!c.ice_extinction_per_m.empty()) {
        ASSERT_LE(c.ice_extinction_per_m[n], c.extinction_per_m[n]);
      }
    }
    for (std::size_t n = 0; n < cells; ++n)
      for (std::size_t k = 0; k < nz; ++k)
        ASSERT_GT(c.interface_m[n * (nz + 1) + k + 1], c.interface_m[n * (nz + 1) + k]);
    for (const float z : c.interface_m) {
      ASSERT_GE(double(z), f.height_range_m().x - 0.01);
      ASSERT_LE(double(z), f.height_range_m().y + 0.01);
    }
  }
}

TEST(RealFiles, Katrina) {
  const auto f = open("nc/wrf_katrina_10km_nest_4t.nc");
  print(*f);
  ASSERT_EQ(f->times_s(), (std::vector<double>{0, 10800, 21600, 32400}));
  EXPECT_EQ(f->time_origin_ns(), 1125230400000000000);  // 2005-08-28 12:00 UTC
  // The nest's corner moves from 21.80 to 22.80 N.
  EXPECT_NEAR(f->grid(0)->lat_lon_deg(0.5, 0.5).x, 21.80, 0.01);
  EXPECT_NEAR(f->grid(3)->lat_lon_deg(0.5, 0.5).x, 22.80, 0.01);
  EXPECT_TRUE(says(*f, "agree with the map"));
  EXPECT_TRUE(says(*f, "data end at 6.2 km"));
  EXPECT_TRUE(says(*f, "WSM3"));
  EXPECT_TRUE(says(*f, "Cloud water of a column: up to 3.67 kg/m2"));
  expect_sound(*f);
}

TEST(RealFiles, GfsPackedCf) {
  const auto f = open("nc/gfs_2p5deg_20110110_f120_DERIVED_cf_packed.nc");
  print(*f);
  const auto grid = f->grid(0);
  EXPECT_TRUE(grid->around());
  EXPECT_EQ(grid->lat_lon_deg(0, 0), glm::dvec2(90, -1.25));
  EXPECT_EQ(grid->lat_lon_deg(144, 73), glm::dvec2(-90, 358.75));
  EXPECT_TRUE(says(*f, "166704 negative"));
  EXPECT_TRUE(says(*f, "52560 of 273312"));
  EXPECT_EQ(f->time_origin_ns(), 1295092800000000000);  // 2011-01-15 12:00 UTC
  expect_sound(*f);
}

// The file's own optical depth of stratiform cloud (made with radii of its own) against a copy
// without the convective water: 10 % more in all when it is read as it stands, 1.9 times when it is
// taken as that of the cloudy part of each layer.
TEST(RealFiles, UnifiedModel) {
  expect_sound(*open("nc/um_38lev_cosp_input_2d.nc"));
  const nepho::test::TestFolder folder("real");
  const std::string path = folder / "stratiform.nc";
  std::filesystem::copy_file(std::string(NEPHO_TEST_REAL_DATA) + "/nc/um_38lev_cosp_input_2d.nc",
                             path);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  int id = 0, variable = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &id), NC_NOERR);
  for (const char* name : {"mr_ccliq", "mr_ccice"}) {
    ASSERT_EQ(nc_inq_varid(id, name, &variable), NC_NOERR);
    ASSERT_EQ(nc_rename_var(id, variable, (std::string("x") + (name + 3)).c_str()), NC_NOERR);
  }
  nc_close(id);
  const auto f = test::open(path);
  print(*f);
  const std::vector<double> ours = nepho::test::optical_depths(f->columns(0));
  const netcdf::NcFile file(std::string(NEPHO_TEST_REAL_DATA) + "/nc/um_38lev_cosp_input_2d.nc",
                            {});
  const std::vector<double> depth = file.read_all(*file.find("dtau_s"));
  const std::vector<double> cover = file.read_all(*file.find("tca"));
  double in_cloud = 0, mean = 0, total = 0, xy = 0, xx = 0, yy = 0;
  for (std::size_t n = 0; n < ours.size(); ++n) {
    double column = 0, of_mean = 0;
    for (std::size_t k = 0; k < 38; ++k) {
      column += depth[k * ours.size() + n];
      of_mean += depth[k * ours.size() + n] * cover[k * ours.size() + n];
    }
    in_cloud += column;
    mean += of_mean;
    total += ours[n];
    xy += ours[n] * of_mean;
    xx += ours[n] * ours[n];
    yy += of_mean * of_mean;
  }
  std::printf(
      "measured: optical depth, ours / file's in cloud %.3f, / file's grid mean %.3f, "
      "cosine of both fields %.3f\n",
      total / in_cloud, total / mean, xy / std::sqrt(xx * yy));
  EXPECT_GT(total / in_cloud, 0.7);
  EXPECT_LT(total / in_cloud, 1.4);
  EXPECT_GT(xy / std::sqrt(xx * yy), 0.9);
}

// Each layer of stratiform cloud. The file's optical depths are of the cloudy part of a layer:
// times the cover they are those of its water with one radius for droplets and one for crystals, to
// a fifth (and to a half without the cover). Those radii, 17 and 51 um, are the difference to ours:
// Martin's droplets over land are 5 to 6 um.
TEST(RealFiles, UnifiedModelsLayers) {
  const netcdf::NcFile file(std::string(NEPHO_TEST_REAL_DATA) + "/nc/um_38lev_cosp_input_2d.nc",
                            {});
  const auto all = [&](const char* name) { return file.read_all(*file.find(name)); };
  const std::vector<double> depth = all("dtau_s"), cover = all("tca"), convective = all("cca"),
                            liquid = all("mr_lsliq"), ice = all("mr_lsice"), half = all("phalf");
  const ForecastColumns c = open("nc/um_38lev_cosp_input_2d.nc")->columns(0);
  const std::size_t cells = 17 * 9, nz = 38;
  struct Layer {
    double liquid, ice, ours;  // kg/m2; optical depth
    double in_cloud, mean;     // the file's
  };
  std::vector<Layer> layers;
  for (std::size_t k = 0; k + 1 < nz; ++k)
    for (std::size_t n = 0; n < cells; ++n) {
      const std::size_t at = k * cells + n;
      if (!(depth[at] > 0) || !(cover[at] > 0.01) || convective[at] > 0) continue;
      const double mass = (half[at] - half[at + cells]) / 9.80665;
      const float* z = &c.interface_m[n * (nz + 1) + k];
      layers.push_back({liquid[at] * mass, ice[at] * mass,
                        double(c.extinction_per_m[n * nz + k]) * (double(z[1]) - double(z[0])),
                        depth[at], depth[at] * cover[at]});
    }
  ASSERT_GT(layers.size(), 500u);
  // Least squares of depth = a liquid + b ice: what is left of it, and the radii 3 / (2 rho a).
  struct Fit {
    double rest, liquid_um, ice_um;
  };
  const auto fit = [&](double Layer::*what) {
    double ll = 0, li = 0, ii = 0, ly = 0, iy = 0, yy = 0, rest = 0;
    for (const Layer& n : layers) {
      ll += n.liquid * n.liquid;
      li += n.liquid * n.ice;
      ii += n.ice * n.ice;
      ly += n.liquid * n.*what;
      iy += n.ice * n.*what;
      yy += n.*what * n.*what;
    }
    const double det = ll * ii - li * li, a = (ly * ii - iy * li) / det,
                 b = (iy * ll - ly * li) / det;
    for (const Layer& n : layers) {
      const double apart = a * n.liquid + b * n.ice - n.*what;
      rest += apart * apart;
    }
    return Fit{std::sqrt(rest / yy), 1.5e3 / a, 1.5e6 / (917 * b)};
  };
  const Fit mean = fit(&Layer::mean), in_cloud = fit(&Layer::in_cloud), ours = fit(&Layer::ours);
  double total = 0, theirs = 0;
  for (const Layer& n : layers) {
    total += n.ours;
    theirs += n.mean;
  }
  std::printf(
      "measured: %zu layers: ours over the file's times cover %.3f; one radius each leaves %.3f of "
      "it (%.1f and %.1f um), %.3f without the cover, %.3f of ours (%.1f and %.1f um)\n",
      layers.size(), total / theirs, mean.rest, mean.liquid_um, mean.ice_um, in_cloud.rest,
      ours.rest, ours.liquid_um, ours.ice_um);
  EXPECT_LT(mean.rest, 0.25);
  EXPECT_GT(in_cloud.rest, 0.35);
  EXPECT_NEAR(mean.liquid_um, 17, 2);
  // With the radii apart, the same water: what ours and theirs are per radius.
  EXPECT_GT(mean.liquid_um / ours.liquid_um, 1.3);
  EXPECT_NEAR(total / theirs, 1.9, 0.3);
}

// Mie sums of a gamma distribution by another program (ecRad's droplet table, Hogan & Bozzo 2018,
// doi:10.1029/2018MS001364): extinction of 1 g/m3 at 0.55 um.
TEST(RealFiles, DropletsAreEcRads) {
  const netcdf::NcFile file(
      std::string(NEPHO_TEST_REAL_DATA) + "/optics_truth/mie_droplet_scattering.nc", {});
  const auto all = [&](const char* name) { return file.read_all(*file.find(name)); };
  const std::vector<double> radius = all("effective_radius"), wavelength = all("wavelength"),
                            table = all("mass_extinction_coefficient");
  std::size_t w = 0;
  while (w + 1 < wavelength.size() && !(wavelength[w] >= 550e-9 && wavelength[w + 1] < 550e-9)) ++w;
  ASSERT_LT(w + 1, wavelength.size());
  const double part = (wavelength[w] - 550e-9) / (wavelength[w] - wavelength[w + 1]);
  double worst = 0, at_ten = 1;
  for (std::size_t r = 0; r < radius.size(); ++r) {
    if (radius[r] < 3.99e-6 || radius[r] > 30.01e-6) continue;
    const double theirs =
        (1 - part) * table[r * wavelength.size() + w] + part * table[r * wavelength.size() + w + 1];
    const double apart = droplet_extinction_m2_per_kg(radius[r]) / theirs - 1;
    worst = std::max(worst, std::abs(apart));
    if (std::abs(radius[r] - 10e-6) < 1e-8) at_ten = apart;
  }
  report_accuracy("netcdf", "droplet extinction at 10 um against ecRad's Mie table",
                  std::abs(at_ten), 0.01, "1");
  report_accuracy("netcdf", "droplet extinction from 4 to 30 um against ecRad's Mie table", worst,
                  0.02, "1");
  EXPECT_LT(std::abs(at_ten), 0.01);
  EXPECT_LT(worst, 0.02);
}

// Rows of the table of names that are marked as behind a real file are those of these files.
TEST(RealFiles, MarksOfNamesAreTrue) {
  std::set<const NameRow*> held;
  for (const char* name :
       {"nc/wrf_katrina_10km_nest_4t.nc", "nc/um_38lev_cosp_input_2d.nc",
        "nc/icon_les_stratocumulus_L150.nc", "nc/gfs_2p5deg_20110110_f120_DERIVED_cf_packed.nc",
        "edge/psyplot_icon_test.nc"}) {
    const netcdf::NcFile file(std::string(NEPHO_TEST_REAL_DATA) + "/" + name, {});
    for (const NameRow& row : name_table())
      for (const FileVariable& v : file.variables()) {
        std::string lower = v.name;
        for (char& c : lower) c = char(std::tolower(static_cast<unsigned char>(c)));
        if (*row.name ? lower == row.name : v.text("standard_name") == row.standard_name)
          held.insert(&row);
      }
  }
  std::size_t marked = 0;
  for (const NameRow& row : name_table()) {
    if (row.evidence != Evidence::kReal) continue;
    ++marked;
    EXPECT_TRUE(held.contains(&row)) << row.model << ": " << word_of(row.quantity) << " "
                                     << row.name << row.standard_name << " is marked only";
  }
  EXPECT_GT(marked, 20u);
}

TEST(RealFiles, IconLes) {
  const auto f = open("nc/icon_les_stratocumulus_L150.nc");
  print(*f);
  expect_sound(*f);
  EXPECT_EQ(f->time_origin_ns(), 1367502000000000000);  // 2013-05-02 13:40 UTC
  // Cloud from 700 to 1890 m, and the "ice" of 1e-19 is nothing.
  const ForecastColumns c = f->columns(0);
  double inside = 0, outside = 0, ice = 0;
  for (std::size_t cell = 0; cell < 54; ++cell)
    for (std::size_t k = 0; k < 150; ++k) {
      const double low = double(c.interface_m[cell * 151 + k]);
      const double high = double(c.interface_m[cell * 151 + k + 1]);
      const double depth = double(c.extinction_per_m[cell * 150 + k]) * (high - low);
      (low > 650 && high < 1950 ? inside : outside) += depth;
      ice += double(c.ice_extinction_per_m[cell * 150 + k]) * (high - low);
    }
  std::printf("measured: optical depth inside %.2f, outside %.2e, ice %.2e (means)\n", inside / 54,
              outside / 54, ice / 54);
  EXPECT_GT(inside / 54, 5);
  EXPECT_LT(outside, 0.02 * inside);
  EXPECT_LT(ice, 0.01 * inside);
}

// ICON's triangles, two levels of pressure; its temperature under the name of cloud water.
TEST(RealFiles, IconTriangles) {
  const nepho::test::TestFolder folder("real");
  const std::string path = folder / "icon.nc";
  std::filesystem::copy_file(std::string(NEPHO_TEST_REAL_DATA) + "/edge/psyplot_icon_test.nc",
                             path);
  std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  int id = 0, variable = 0;
  ASSERT_EQ(nc_open(path.c_str(), NC_WRITE, &id), NC_NOERR);
  ASSERT_EQ(nc_inq_varid(id, "t2m", &variable), NC_NOERR);
  ASSERT_EQ(nc_rename_var(id, variable, "clw"), NC_NOERR);
  ASSERT_EQ(nc_put_att_text(id, variable, "units", 9, "mg kg**-1"), NC_NOERR);
  nc_close(id);
  const auto f = test::open(path);
  print(*f);
  EXPECT_TRUE(says(*f, "5120 x 1 cells, cells in a row, clat, clon"));
  expect_sound(*f);
  const auto grid = f->grid(0);
  ASSERT_NE(grid->polygons(), nullptr);
  // Triangles that cover the planet once, each with its centre inside.
  double area = 0, worst = 0;
  const auto& cells = *grid->polygons();
  for (std::size_t n = 0; n + 1 < cells.first.size(); ++n) {
    ASSERT_EQ(cells.first[n + 1] - cells.first[n], 3u);
    const glm::dvec3 a = unit_vector(cells.corner_deg[3 * n]),
                     b = unit_vector(cells.corner_deg[3 * n + 1]),
                     c = unit_vector(cells.corner_deg[3 * n + 2]);
    // Van Oosterom & Strackee (1983), doi:10.1109/TBME.1983.325207.
    area += 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))),
                           1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
    const glm::dvec3 middle = glm::normalize(a + b + c);
    const glm::dvec2 centre = grid->lat_lon_deg(double(n) + 0.5, 0.5);
    worst = std::max(worst, glm::length(middle - unit_vector(centre)));
  }
  EXPECT_NEAR(area, 4 * M_PI, 1e-6);
  EXPECT_LT(worst, 0.01);
}

TEST(RealFiles, EdgesAreRefusedInWords) {
  struct Case {
    const char *name, *says;
  };
  for (const Case& c : {Case{"edge/gdal_byte_truncated.nc", "cut short or damaged"},
                        {"edge/gdal_netcdf-4d.nc", "no cloud water"},
                        {"edge/gdal_rotated_pole.nc", "no cloud water"},
                        {"edge/gdal_scale_offset.nc", "no cloud water"},
                        {"edge/psyplot_icon_test.nc", "no cloud water"},
                        {"raster/goes16_abi_l2_acha_conus_20171025_2056.nc", "no cloud water"},
                        {"raster/gfs_1deg_cloudwater_20120515.nc", "no cloud water"}}) {
    std::string text;
    try {
      open(c.name);
    } catch (const Error& e) {
      text = e.what();
    }
    EXPECT_NE(text.find(c.says), std::string::npos) << c.name << ": " << text;
  }
}

}  // namespace
}  // namespace nepho::forecast
