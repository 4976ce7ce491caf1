#include "sources/gdal/raster_file.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>
#include <ogr_spatialref.h>

#include <cmath>
#include <mutex>
#include <numbers>

#include "core/error.h"
#include "forecast/files/survives.h"

namespace nepho::gdal {
namespace {

constexpr double kMostPixels = 4e9;

// GDAL's messages are kept for an error of ours, and printed nowhere.
class Quiet {
 public:
  Quiet() {
    CPLErrorReset();
    CPLPushErrorHandler(CPLQuietErrorHandler);
  }
  ~Quiet() { CPLPopErrorHandler(); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;
  static std::string said(const char* otherwise) {
    std::string text = CPLGetLastErrorMsg();
    for (char& c : text)
      if (c == '\n') c = ' ';
    return text.empty() ? otherwise : text.substr(0, 300);
  }
};

void register_drivers() {
  static std::once_flag once;
  std::call_once(once, [] {
    // A VRT can name sources on the network and code to run.
    CPLSetConfigOption("GDAL_VRT_ENABLE_PYTHON", "NO");
    CPLSetConfigOption("GDAL_VRT_ENABLE_RAWRASTERBAND", "NO");
    CPLSetConfigOption("GDAL_HTTP_TIMEOUT", "2");
    CPLSetConfigOption("PROJ_NETWORK", "OFF");
    GDALRegister_GTiff();
    GDALRegister_VRT();
    GDALRegister_MEM();
    GDALRegister_HFA();
    GDALRegister_ENVI();
    GDALRegister_EHdr();
    GDALRegister_AAIGrid();
    GDALRegister_SRTMHGT();
    GDALRegister_JP2OpenJPEG();
  });
}

GDALDataset* open_dataset(const std::string& path) {
  return GDALDataset::Open(path.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR);
}

// Drivers trust the headers of damaged files: a copy of the process reads the first and last pixels
// before this one does.
bool opens_alive(const std::string& path) {
  return forecast::survives([&] {
    const Quiet quiet;
    const std::unique_ptr<GDALDataset> data(open_dataset(path));
    if (!data || data->GetRasterCount() < 1) return;
    float value = 0;
    GDALRasterBand* band = data->GetRasterBand(1);
    for (const int end : {0, 1})
      if (band->RasterIO(GF_Read, end * (data->GetRasterXSize() - 1),
                         end * (data->GetRasterYSize() - 1), 1, 1, &value, 1, 1, GDT_Float32, 0, 0,
                         nullptr) != CE_None)
        return;
  });
}

std::string item(GDALMajorObject& object, const char* name) {
  const char* text = object.GetMetadataItem(name);
  return text ? text : "";
}

// "cth [km]" names its unit.
void split_unit(Band& band) {
  const std::size_t open = band.description.rfind('[');
  if (open == std::string::npos || !band.description.ends_with("]")) return;
  if (band.unit.empty())
    band.unit = band.description.substr(open + 1, band.description.size() - open - 2);
  band.description.resize(open);
}

}  // namespace

struct RasterFile::Dataset {
  std::unique_ptr<GDALDataset> data;

  GDALRasterBand& band(int index) const { return *data->GetRasterBand(index + 1); }
};

RasterFile::RasterFile(const std::string& path)
    : path_(path), dataset_(std::make_unique<Dataset>()) {
  register_drivers();
  const Quiet quiet;
  if (!opens_alive(path))
    throw Error({"the raster is damaged", path, "a file that GDAL can read",
                 "one that ends the process that opens it", "write the file again"});
  dataset_->data.reset(open_dataset(path));
  if (!dataset_->data)
    throw Error({"cannot read the raster", path, "GeoTIFF, VRT or another raster of GDAL",
                 Quiet::said("no driver knows it"), ""});
  place_.nx = dataset_->data->GetRasterXSize();
  place_.ny = dataset_->data->GetRasterYSize();
  if (dataset_->data->GetRasterCount() < 1 || place_.nx < 2 || place_.ny < 2)
    throw Error({"the raster is empty", path, "a band of at least 2 x 2 pixels",
                 std::to_string(dataset_->data->GetRasterCount()) + " bands of " +
                     std::to_string(place_.nx) + " x " + std::to_string(place_.ny),
                 ""});
  if (double(place_.nx) * place_.ny > kMostPixels)
    throw Error({"the raster is too large", path, "at most 4e9 pixels",
                 std::to_string(place_.nx) + " x " + std::to_string(place_.ny),
                 "cut or reduce it first: gdal_translate -outsize 10% 0 IN OUT"});
  find_bands();
  find_place();
}

RasterFile::~RasterFile() = default;

void RasterFile::find_bands() {
  GDALDataset& data = *dataset_->data;
  for (int index = 0; index < data.GetRasterCount(); ++index) {
    GDALRasterBand& of = dataset_->band(index);
    if (GDALDataTypeIsComplex(of.GetRasterDataType()))
      throw Error({"the raster's values are complex numbers", path_, "real ones",
                   "band " + std::to_string(index + 1), ""});
    Band band;
    band.description = of.GetDescription();
    band.unit = of.GetUnitType() ? of.GetUnitType() : "";
    for (const char* name : {"units", "unit"})
      if (band.unit.empty()) band.unit = item(of, name);
    split_unit(band);
    band.type = GDALGetDataTypeName(of.GetRasterDataType());
    const GDALColorInterp colour = of.GetColorInterpretation();
    band.coloured = colour >= GCI_PaletteIndex;
    band.names = {item(of, "standard_name"), band.description, item(of, "long_name"),
                  item(of, "NETCDF_VARNAME"), item(of, "name")};
    if (data.GetRasterCount() == 1)
      for (const char* name : {"standard_name", "long_name", "TIFFTAG_IMAGEDESCRIPTION"})
        band.names.push_back(item(data, name));
    std::erase(band.names, "");
    bands_.push_back(std::move(band));
  }
}

void RasterFile::find_place() {
  GDALDataset& data = *dataset_->data;
  const bool has_transform = data.GetGeoTransform(place_.transform.data()) == CE_None;
  if (!has_transform && (data.GetGCPCount() > 0 || data.GetMetadata("GEOLOCATION")))
    throw Error({"the raster's pixels lie on no regular map", path_,
                 "a geotransform and a coordinate reference system",
                 data.GetGCPCount() > 0 ? "ground control points" : "geolocation arrays",
                 "warp it first: gdalwarp -t_srs EPSG:4326 IN OUT"});
  const OGRSpatialReference* found = data.GetSpatialRef();
  if (!has_transform || !found || found->IsEmpty())
    throw Error({"the raster has no place on the planet", path_,
                 "a geotransform and a coordinate reference system",
                 has_transform ? "no coordinate reference system" : "neither, or no geotransform",
                 "set them: gdal_edit.py -a_srs EPSG:4326 -a_ullr WEST NORTH EAST SOUTH FILE"});
  OGRSpatialReference system(*found);
  system.StripVertical();
  if (system.IsLocal() || system.IsGeocentric())
    throw Error({"the raster's coordinate system lies nowhere on the planet", path_,
                 "geographic or projected", system.GetName() ? system.GetName() : "a local one",
                 "warp it first: gdalwarp -t_srs EPSG:4326 IN OUT"});
  place_.geographic = system.IsGeographic() && !system.IsDerivedGeographic();
  place_.unit_deg = system.GetAngularUnits() * 180 / std::numbers::pi;
  if (place_.geographic) return;
  const char* const options[] = {"FORMAT=WKT2_2019", nullptr};
  char* wkt = nullptr;
  if (system.exportToWkt(&wkt, options) == OGRERR_NONE && wkt) place_.wkt = wkt;
  CPLFree(wkt);
}

std::vector<float> RasterFile::read(int band, const forecast::CellWindow& window) const {
  return read_reduced(band, window, window.nx, window.ny);
}

int RasterFile::overviews(int band) const {
  return dataset_->band(band).GetOverviewCount();
}

std::vector<float> RasterFile::read_reduced(int index, const forecast::CellWindow& window, int nx,
                                            int ny) const {
  const Quiet quiet;
  GDALRasterBand& band = dataset_->band(index);
  const std::size_t pixels = std::size_t(nx) * std::size_t(ny);
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  const bool reduced = nx < window.nx || ny < window.ny;
  if (reduced) how.eResampleAlg = GRIORA_Average;
  const auto fetch = [&](GDALRasterBand& from, void* values, GDALDataType type) {
    if (from.RasterIO(GF_Read, window.x0, window.y0, window.nx, window.ny, values, nx, ny, type, 0,
                      0, &how) != CE_None)
      throw Error({"the raster cannot be read to its end", path_,
                   "band " + std::to_string(index + 1), Quiet::said("a read error"),
                   "write the file again"});
  };
  std::vector<double> raw(pixels);
  fetch(band, raw.data(), GDT_Float64);
  // A mask tells pixels without data; a nodata value is compared here, in double.
  std::vector<unsigned char> mask;
  const int flags = band.GetMaskFlags();
  if (flags & (GMF_PER_DATASET | GMF_ALPHA) && !(flags & GMF_ALL_VALID)) {
    how.eResampleAlg = GRIORA_NearestNeighbour;
    mask.resize(pixels);
    fetch(*band.GetMaskBand(), mask.data(), GDT_Byte);
  }
  int has_nodata = 0, has_scale = 0, has_offset = 0;
  const double nodata = band.GetNoDataValue(&has_nodata);
  double scale = band.GetScale(&has_scale), offset = band.GetOffset(&has_offset);
  if (!has_scale || scale == 0) scale = 1;
  if (!has_offset) offset = 0;
#ifdef NEPHO_MUTANT_RASTER_SCALE
  scale = 1, offset = 0;
#endif
#ifdef NEPHO_MUTANT_RASTER_NODATA
  has_nodata = 0;
#endif
  // Float32 bands name their nodata value with the digits of a double.
  const bool single = band.GetRasterDataType() == GDT_Float32;
  std::vector<float> values(pixels);
  for (std::size_t n = 0; n < pixels; ++n) {
    const bool missing =
        !std::isfinite(raw[n]) || (!mask.empty() && mask[n] == 0) ||
        (has_nodata && (raw[n] == nodata || (single && float(raw[n]) == float(nodata))));
    values[n] = missing ? NAN : float(raw[n] * scale + offset);
  }
  return values;
}

}  // namespace nepho::gdal
