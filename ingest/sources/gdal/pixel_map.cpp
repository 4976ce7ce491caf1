#include "sources/gdal/pixel_map.h"

#include <cmath>
#include <numeric>

#include "core/error.h"
#include "forecast/conventions/horizontal.h"
#include "geo/proj_map.h"

namespace nepho::gdal {
namespace {

using forecast::HorizontalGrid;

class PixelMap : public MapFormula {
 public:
  PixelMap(const RasterPlace& place, const std::string& where)
      : place_(place), t_(place.transform) {
    determinant_ = t_[1] * t_[5] - t_[2] * t_[4];
    if (!std::isfinite(determinant_) || determinant_ == 0)
      throw Error({"the raster's pixels have no area", where, "a geotransform", "one without", ""});
    if (!place.geographic) system_.emplace(proj_map(place.wkt, where));
    const glm::dvec2 middle = coordinates({0.5 * place.nx, 0.5 * place.ny});
    if (place.geographic) middle_deg_ = middle.x * place.unit_deg;
  }

  glm::dvec2 map_m(glm::dvec2 lat_lon_deg) const override {
    glm::dvec2 at;
    if (system_) {
      at = system_->map_m(lat_lon_deg);
    } else {
      lat_lon_deg.y += 360 * std::round((middle_deg_ - lat_lon_deg.y) / 360);
      at = glm::dvec2(lat_lon_deg.y, lat_lon_deg.x) / place_.unit_deg;
    }
    at -= glm::dvec2(t_[0], t_[3]);
    return glm::dvec2(t_[5] * at.x - t_[2] * at.y, t_[1] * at.y - t_[4] * at.x) / determinant_;
  }
  glm::dvec2 lat_lon_deg(glm::dvec2 pixel) const override {
    const glm::dvec2 at = coordinates(pixel);
    if (system_) return system_->lat_lon_deg(at);
    return glm::dvec2(at.y, at.x) * place_.unit_deg;
  }

 private:
  glm::dvec2 coordinates(glm::dvec2 pixel) const {
#ifdef NEPHO_MUTANT_RASTER_SHIFTED
    pixel += 1.0;
#endif
    return {t_[0] + t_[1] * pixel.x + t_[2] * pixel.y, t_[3] + t_[4] * pixel.x + t_[5] * pixel.y};
  }

  RasterPlace place_;
  std::array<double, 6> t_;
  double determinant_ = 1, middle_deg_ = 0;
  std::optional<MapProjection> system_;
};

std::vector<double> edges(double first, double step, int pixels, int coarse) {
  std::vector<double> values;
  for (int i = 0; i < pixels; i += coarse) values.push_back(first + step * i);
  values.push_back(first + step * pixels);
  return values;
}

std::vector<double> middles(const std::vector<double>& of) {
  std::vector<double> values;
  for (std::size_t i = 0; i + 1 < of.size(); ++i) values.push_back(0.5 * (of[i] + of[i + 1]));
  return values;
}

}  // namespace

RasterPlace RasterPlace::part(const forecast::CellWindow& window) const {
  RasterPlace result = *this;
  result.nx = window.nx;
  result.ny = window.ny;
  const auto& t = transform;
  result.transform[0] = t[0] + t[1] * window.x0 + t[2] * window.y0;
  result.transform[3] = t[3] + t[4] * window.x0 + t[5] * window.y0;
  return result;
}

std::shared_ptr<const MapFormula> pixel_map(const RasterPlace& place, const std::string& where) {
  return std::make_shared<PixelMap>(place, where);
}

std::shared_ptr<const HorizontalGrid> grid_of(const RasterPlace& place, int coarse,
                                              const std::string& where) {
  if (place.geographic && place.upright() && place.nx > coarse && place.ny > coarse) {
    const double to_deg = place.unit_deg;
    const auto& t = place.transform;
    std::vector<double> longitude = edges(t[0] * to_deg, t[1] * to_deg, place.nx, coarse);
    std::vector<double> latitude = edges(t[3] * to_deg, t[5] * to_deg, place.ny, coarse);
    std::vector<double> rows = middles(latitude), columns = middles(longitude);
    return forecast::axes_grid(std::move(rows), std::move(columns), where,
                               {std::move(latitude), std::move(longitude)});
  }
  return forecast::map_edges_grid(edges(0, 1, place.nx, coarse), edges(0, 1, place.ny, coarse),
                                  MapProjection(pixel_map(place, where)));
}

}  // namespace nepho::gdal
