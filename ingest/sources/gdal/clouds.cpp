#include "sources/gdal/clouds.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "forecast/rasters/raster_forecast.h"
#include "sources/gdal/band_meaning.h"

namespace nepho::gdal {
namespace {

using forecast::CellWindow;
using forecast::CloudQuantity;
using forecast::HorizontalGrid;
using Fields = std::map<CloudQuantity, std::vector<float>>;

// Part of one file, in blocks.
struct Layer {
  RasterPlace place;  // of the pixels
  int coarse = 1;
  Fields fields;

  int nx() const { return (place.nx + coarse - 1) / coarse; }
};

bool is_mean(CloudQuantity quantity) {
  using enum CloudQuantity;
  return quantity == kLiquidPath || quantity == kIcePath || quantity == kWaterPath ||
         quantity == kCover;
}

// Of one block's pixels: what is a mean over the cell counts missing pixels as none of it; optical
// depth is weighted by the cover, heights and radii by the depth under them.
class Block {
 public:
  explicit Block(const Fields& pixels) : pixels_(pixels) {}

  void add(std::size_t n) {
    ++count_;
    const auto value = [&](CloudQuantity quantity) {
      const auto at = pixels_.find(quantity);
      return at == pixels_.end() ? 1.0 : std::max(0.0, double(at->second[n]));  // NaN: 0
    };
    using enum CloudQuantity;
    const double cover = value(kCover);
    double depth = cover;
    if (pixels_.contains(kOpticalDepth))
      depth *= value(kOpticalDepth);
    else if (pixels_.contains(kLiquidPath) || pixels_.contains(kIcePath) ||
             pixels_.contains(kWaterPath))
      depth = (pixels_.contains(kLiquidPath) ? value(kLiquidPath) : 0) +
              (pixels_.contains(kIcePath) ? value(kIcePath) : 0) +
              (pixels_.contains(kWaterPath) ? value(kWaterPath) : 0);
    for (const auto& [quantity, field] : pixels_) {
      const double here = double(field[n]);
      Sum& sum = sums_[quantity];
      const bool missing = std::isnan(here);
      sum.any |= !missing;
      const double weight = is_mean(quantity)           ? 1
                            : quantity == kOpticalDepth ? cover
                            : missing                   ? 0
                                                        : depth;
      sum.weight += weight;
      if (!missing) sum.value += weight * here;
    }
  }
  float mean(CloudQuantity quantity) const {
    const auto at = sums_.find(quantity);
    if (at == sums_.end() || !at->second.any) return NAN;
    const Sum& sum = at->second;
    const bool whole = is_mean(quantity) || (quantity == CloudQuantity::kOpticalDepth &&
                                             !pixels_.contains(CloudQuantity::kCover));
    const double weight = whole ? count_ : sum.weight;
    return weight > 0 ? float(sum.value / weight) : NAN;
  }

 private:
  struct Sum {
    double value = 0, weight = 0;
    bool any = false;
  };
  const Fields& pixels_;
  std::map<CloudQuantity, Sum> sums_;
  double count_ = 0;
};

// Rows [y, y + count) of the window, all bands in SI.
Fields rows_of(const RasterFile& file, const std::vector<CloudBand>& bands,
               const CellWindow& window, int y, int count) {
  Fields rows;
  for (const CloudBand& band : bands) {
    std::vector<float> values = file.read(band.band, {window.x0, window.y0 + y, window.nx, count});
    for (float& value : values) value = float(band.unit.to_si(double(value)));
    rows[band.quantity] = std::move(values);
  }
  return rows;
}

Layer read_layer(const RasterFile& file, const std::vector<CloudBand>& bands,
                 const CellWindow& window, int coarse) {
  Layer layer{file.place().part(window), coarse, {}};
  if (coarse == 1) {
    layer.fields = rows_of(file, bands, window, 0, window.ny);
    return layer;
  }
  for (int y = 0; y < window.ny; y += coarse) {
    const int count = std::min(coarse, window.ny - y);
    const Fields rows = rows_of(file, bands, window, y, count);
    for (int x = 0; x < window.nx; x += coarse) {
      Block block(rows);
      for (int b = 0; b < count; ++b)
        for (int a = x; a < std::min(x + coarse, window.nx); ++a)
          block.add(std::size_t(b) * std::size_t(window.nx) + std::size_t(a));
      for (const auto& [quantity, field] : rows)
        layer.fields[quantity].push_back(block.mean(quantity));
    }
  }
  return layer;
}

int coarse_for(const CellWindow& window, double most_cells) {
  return std::max(1, int(std::ceil(std::sqrt(double(window.nx) * window.ny / most_cells))));
}

CellWindow whole(const RasterFile& file) {
  return {0, 0, file.place().nx, file.place().ny};
}

// The other file's pixel under each cell's centre.
void sample(const Layer& from, const std::string& where, const HorizontalGrid& grid, Fields& to) {
  const auto map = pixel_map(from.place, where);
  for (const auto& [quantity, field] : from.fields) {
    std::vector<float>& values = to[quantity];
    values.assign(std::size_t(grid.nx()) * std::size_t(grid.ny()), NAN);
  }
  for (int j = 0; j < grid.ny(); ++j)
    for (int i = 0; i < grid.nx(); ++i) {
      const glm::dvec2 place = grid.lat_lon_deg(i + 0.5, j + 0.5);
      if (std::isnan(place.x)) continue;
      const glm::dvec2 at = map->map_m(place);
      if (!(at.x >= 0 && at.x < from.place.nx && at.y >= 0 && at.y < from.place.ny)) continue;
      const std::size_t n = std::size_t(at.y) / std::size_t(from.coarse) * std::size_t(from.nx()) +
                            std::size_t(at.x) / std::size_t(from.coarse);
      const std::size_t cell = std::size_t(j) * std::size_t(grid.nx()) + std::size_t(i);
      for (const auto& [quantity, field] : from.fields) to[quantity][cell] = field[n];
    }
}

// The column that a grid of whole turns leaves out.
void drop_repeated(Layer& layer, int nx) {
  const std::size_t row = std::size_t(layer.nx()), kept = std::size_t(nx);
  if (row == kept) return;
  for (auto& [quantity, field] : layer.fields) {
    std::vector<float> cut;
    for (std::size_t at = 0; at < field.size(); at += row)
      cut.insert(cut.end(), field.begin() + std::ptrdiff_t(at),
                 field.begin() + std::ptrdiff_t(at + kept));
    field = std::move(cut);
  }
}

std::string grid_fact(const RasterFile& file, const HorizontalGrid& grid, int coarse) {
  std::string text = "Grid: " + std::to_string(grid.nx()) + " x " + std::to_string(grid.ny()) +
                     " cells" +
                     (file.place().geographic ? " of latitude and longitude" : " of a map");
  if (coarse > 1)
    text += ", each of " + std::to_string(coarse) + " x " + std::to_string(coarse) +
            " pixels with their mean optical depth";
  return text + ".";
}

// The window that the region leaves, without the turn of rasters that go around.
CellWindow window_in(const RasterFile& file, const CloudRequest& request,
                     std::vector<std::string>& facts) {
  if (!request.region) return whole(file);
  const std::shared_ptr<const HorizontalGrid> grid = grid_of(file.place(), 1, file.path());
  CellWindow window = forecast::window_of({&grid, 1}, *request.region, file.path());
  if (window.x0 + window.nx > file.place().nx) {  // across the raster's seam: all columns
    window.x0 = 0;
    window.nx = file.place().nx;
  }
  facts.push_back(forecast::window_fact(*request.region, window, *grid));
  return window;
}

}  // namespace

std::unique_ptr<forecast::Forecast> open_clouds(const CloudRequest& request) {
  std::vector<std::unique_ptr<RasterFile>> files;
  for (const std::string& path : request.files) files.push_back(std::make_unique<RasterFile>(path));
  const std::vector<CloudBand> bands = cloud_bands(files, request.options);
  forecast::Raster raster;
  RasterPlace main;
  for (std::size_t n = 0; n < files.size(); ++n) {
    std::vector<CloudBand> mine;
    std::ranges::copy_if(bands, std::back_inserter(mine),
                         [&](const CloudBand& band) { return band.file == n; });
    if (mine.empty()) {
      raster.facts.push_back(files[n]->path() + " holds nothing of a cloud: left out.");
      continue;
    }
    const RasterFile& file = *files[n];
    const bool first = !raster.grid;
    const bool like_first = !first && file.place() == main;
    const CellWindow window =
        first || like_first ? window_in(file, request, raster.facts) : whole(file);
    const int coarse = coarse_for(window, request.most_cells);
    Layer layer = read_layer(file, mine, window, coarse);
    if (first) {
      main = file.place();
      raster.path = file.path();
      raster.grid = grid_of(layer.place, coarse, file.path());
      raster.facts.push_back(grid_fact(file, *raster.grid, coarse));
    }
    if (first || like_first) {
      drop_repeated(layer, raster.grid->nx());
      raster.fields.merge(layer.fields);
      continue;
    }
    sample(layer, file.path(), *raster.grid, raster.fields);
    raster.assumptions.push_back(
        file.path() + " is of another grid: its pixel at the middle of each cell counts.");
  }
  return forecast::make_raster_forecast(std::move(raster), request.options, request.force);
}

}  // namespace nepho::gdal
