#pragma once

#include <memory>
#include <string>
#include <vector>

#include "sources/gdal/pixel_map.h"

namespace nepho::gdal {

// A raster's file, through GDAL: GeoTIFF, VRT, Erdas, ENVI, JPEG 2000, ASCII grids, SRTM. GDAL's
// own drivers for netCDF, HDF and the network are not registered, and its messages go into errors.
// Not thread-safe.

struct Band {
  std::string description, unit;
  std::vector<std::string> names;  // what the metadata call it, best first
  std::string type;                // "Byte", "Float32"
  bool coloured = false;           // red, green, blue, alpha, a palette
};

class RasterFile {
 public:
  // Throws Error: unreadable, not a raster, without a place on the planet.
  explicit RasterFile(const std::string& path);
  ~RasterFile();
  RasterFile(const RasterFile&) = delete;
  RasterFile& operator=(const RasterFile&) = delete;

  const std::string& path() const { return path_; }
  const RasterPlace& place() const { return place_; }
  const std::vector<Band>& bands() const { return bands_; }

  // Pixels of a window, scale and offset applied; NaN where there is no data.
  std::vector<float> read(int band, const forecast::CellWindow& window) const;
  // The same as nx x ny means of what is there, from overviews where there are any.
  std::vector<float> read_reduced(int band, const forecast::CellWindow& window, int nx,
                                  int ny) const;
  // Of the smallest overview, or of the band itself: "6 overviews"
  int overviews(int band) const;

 private:
  struct Dataset;
  void find_place();
  void find_bands();

  std::string path_;
  std::unique_ptr<Dataset> dataset_;
  RasterPlace place_;
  std::vector<Band> bands_;
};

}  // namespace nepho::gdal
