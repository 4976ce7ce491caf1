#include "sources/gdal/band_meaning.h"

#include <algorithm>

#include "core/error.h"

namespace nepho::gdal {
namespace {

using forecast::CloudQuantity;
using forecast::RasterOptions;

constexpr const char* kCure =
    "state what each band is: --bands \"optical_depth,top_height km\"; heights of ground go to "
    "--terrain";

std::string where(const RasterFile& file, int band) {
  return file.path() + " [band " + std::to_string(band + 1) + "]";
}

std::string listed(const std::vector<std::unique_ptr<RasterFile>>& files) {
  std::string text;
  for (const auto& file : files)
    for (const Band& band : file->bands()) {
      if (text.size() > 200) return text + ", ...";
      text += (text.empty() ? "" : ", ") +
              (band.description.empty() ? std::string("a band without a name")
                                        : "\"" + band.description + "\"") +
              " (" + band.type + (band.coloured ? ", a colour)" : ")");
    }
  return text;
}

std::optional<CloudQuantity> told(const Band& band) {
  for (const std::string& name : band.names)
    if (const auto quantity = forecast::quantity_named(name)) return quantity;
  return std::nullopt;
}

void add(std::vector<CloudBand>& all, const std::vector<std::unique_ptr<RasterFile>>& files,
         std::size_t file, int band, CloudQuantity quantity, const std::string& unit) {
  const std::string place = where(*files[file], band);
  const auto same = std::ranges::find(all, quantity, &CloudBand::quantity);
  if (same != all.end())
    throw Error({"two bands hold the same quantity", place,
                 "each once; tiles of one map go into a VRT (gdalbuildvrt)",
                 std::string(forecast::kind_of(quantity).word) + ", as " +
                     where(*files[same->file], same->band),
                 "leave one out: --bands \"optical_depth,-\""});
  all.push_back({file, band, quantity, forecast::unit_for(quantity, unit, place, kCure)});
}

}  // namespace

std::vector<CloudBand> cloud_bands(const std::vector<std::unique_ptr<RasterFile>>& files,
                                   const RasterOptions& options) {
  std::vector<CloudBand> all;
  std::size_t n = 0;
  for (std::size_t file = 0; file < files.size(); ++file)
    for (int band = 0; band < int(files[file]->bands().size()); ++band, ++n) {
      const Band& of = files[file]->bands()[std::size_t(band)];
      if (!options.bands.empty()) {
        if (n >= options.bands.size() || !options.bands[n].quantity) continue;
        const std::string& unit = options.bands[n].unit;
        add(all, files, file, band, *options.bands[n].quantity, unit.empty() ? of.unit : unit);
      } else if (const auto quantity = told(of)) {
        add(all, files, file, band, *quantity, of.unit);
      }
    }
  if (options.bands.size() > n)
    throw Error({"more bands are stated than there are", files.front()->path(),
                 std::to_string(n) + " at most", std::to_string(options.bands.size()), ""});
  if (all.empty())
    throw Error({"no band of the raster says what it holds of a cloud", files.front()->path(),
                 "a name such as cloud_optical_depth, in the band's description or standard_name",
                 listed(files), kCure});
  return all;
}

}  // namespace nepho::gdal
