// make_rasters FOLDER: rasters for tests of the program and of the module.

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "made_raster.h"

int main(int count, char** arguments) {
  using namespace nepho::gdal::test;
  if (count != 2) return 2;
  const std::filesystem::path folder = arguments[1];
  std::filesystem::create_directories(folder);
  // Broken cloud over the Alps, tops from fair weather cumulus to an anvil.
  MadeRaster clouds;
  clouds.nx = clouds.ny = 160;
  clouds.system = "EPSG:3035";
  clouds.transform = {4300000, 2000, 0, 2780000, 0, -2000};
  std::vector<double> depth, top, water;
  for (int n = 0; n < clouds.nx * clouds.ny; ++n) {
    const double x = n % clouds.nx, y = n / clouds.nx;
    double wave = 0;
    for (int octave = 1; octave <= 5; ++octave) {
      const double k = 0.035 * std::pow(1.9, octave);
      wave += std::pow(0.62, octave) * (std::sin(k * x + 1.3 * octave + 2 * std::sin(0.6 * k * y)) +
                                        std::cos(k * y - 0.7 * octave + 2 * std::sin(0.7 * k * x)));
    }
    const double anvil = std::exp(-(std::pow(x - 110, 2) + std::pow(y - 45, 2)) / 400);
    depth.push_back(std::max(0.0, 22 * (wave - 0.15)) + 60 * anvil);
    top.push_back(1800 + 900 * std::max(wave, 0.0) + 8500 * anvil);
    water.push_back(depth.back() / 150);
  }
  clouds.bands = {{"cloud_optical_depth", "1", depth, {}, {}, {}},
                  {"cloud_top_height", "m", top, {}, {}, {}}};
  clouds.write(folder / "clouds.tif");
  MadeRaster part = clouds;
  part.bands = {clouds.bands[0]};
  part.write(folder / "depth.tif");
  part.bands = {clouds.bands[1]};
  part.write(folder / "tops.tif");
  part.bands = {{"", "", depth, {}, {}, {}}};
  part.write(folder / "nameless.tif");
  part.bands = {{"liquid_water_path", "", water, {}, {}, {}}, clouds.bands[1]};
  part.write(folder / "unitless.tif");
  part.bands = clouds.bands;
  part.system = "";
  part.write(folder / "placeless.tif");
  part.system = "EPSG:4326";
  part.control_points = 4;
  part.write(folder / "points.tif");
  MadeRaster photo;
  photo.type = GDT_Byte;
  photo.bands = std::vector<MadeBand>(3, {"", "", photo.constant(128), {}, {}, {}});
  photo.write(folder / "photo.tif");
  std::printf("%s\n", folder.c_str());
  return 0;
}
