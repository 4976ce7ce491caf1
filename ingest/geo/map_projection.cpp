#include "geo/map_projection.h"

#include <GeographicLib/LambertConformalConic.hpp>
#include <GeographicLib/PolarStereographic.hpp>
#include <GeographicLib/TransverseMercator.hpp>
#include <cmath>
#include <exception>
#include <numbers>
#include <optional>

#include "core/error.h"

namespace nepho {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

// Longitude and latitude of the sphere whose north pole stands at the given place of another.
glm::dvec2 rotate(glm::dvec2 lat_lon_deg, double pole_latitude_deg, double from_deg,
                  double to_deg) {
  const double lat = lat_lon_deg.x * kDegree, lon = (lat_lon_deg.y - from_deg) * kDegree;
  const double s = std::sin(pole_latitude_deg * kDegree), c = std::cos(pole_latitude_deg * kDegree);
  const double x = std::cos(lat) * std::cos(lon), y = std::cos(lat) * std::sin(lon);
  const double z = std::sin(lat);
  const double along = s * x - c * z, up = c * x + s * z;
  return {std::atan2(up, std::hypot(along, y)) / kDegree,
          to_deg + std::atan2(-y, -along) / kDegree};
}

class GeographicMap : public MapFormula {
 public:
  explicit GeographicMap(const MapSpec& of);
  glm::dvec2 map_m(glm::dvec2 lat_lon_deg) const override {
    return forward(lat_lon_deg) - origin_m;
  }
  glm::dvec2 lat_lon_deg(glm::dvec2 map_m) const override { return reverse(map_m + origin_m); }

 private:
  MapSpec spec;
  std::optional<GeographicLib::LambertConformalConic> conic;
  std::optional<GeographicLib::PolarStereographic> polar;
  std::optional<GeographicLib::TransverseMercator> transverse;
  bool north = true;
  glm::dvec2 origin_m{0.0};

  glm::dvec2 forward(glm::dvec2 place) const {
    double x = 0, y = 0;
    if (conic) conic->Forward(spec.central_longitude_deg, place.x, place.y, x, y);
    if (transverse) transverse->Forward(spec.central_longitude_deg, place.x, place.y, x, y);
    if (polar) polar->Forward(north, place.x, place.y - spec.central_longitude_deg, x, y);
    // The rotated pole, seen from the rotated system, lies on its meridian 0.
    if (spec.kind == MapKind::kRotated) {
      const glm::dvec2 rotated = rotate(place, spec.pole_latitude_deg, spec.pole_longitude_deg, 0);
      return {rotated.y + spec.pole_grid_longitude_deg, rotated.x};
    }
    return {x, y};
  }
  glm::dvec2 reverse(glm::dvec2 m) const {
    double lat = 0, lon = 0;
    if (conic) conic->Reverse(spec.central_longitude_deg, m.x, m.y, lat, lon);
    if (transverse) transverse->Reverse(spec.central_longitude_deg, m.x, m.y, lat, lon);
    if (polar) {
      polar->Reverse(north, m.x, m.y, lat, lon);
      lon += spec.central_longitude_deg;
    }
    if (spec.kind == MapKind::kRotated)
      return rotate({m.y, m.x - spec.pole_grid_longitude_deg}, spec.pole_latitude_deg, 0,
                    spec.pole_longitude_deg);
    return {lat, lon};
  }
};

GeographicMap::GeographicMap(const MapSpec& of) : spec(of) {
  const double a = spec.equatorial_m, f = (spec.equatorial_m - spec.polar_m) / spec.equatorial_m;
  try {
    switch (spec.kind) {
      case MapKind::kLambertConformal:
        conic.emplace(a, f, spec.true_latitude1_deg, spec.true_latitude2_deg, spec.scale);
        break;
      case MapKind::kMercator:
        conic.emplace(a, f, spec.true_latitude1_deg, -spec.true_latitude1_deg, spec.scale);
        break;
      case MapKind::kPolarStereographic:
        north = spec.true_latitude1_deg > 0;
        polar.emplace(a, f, 1.0);
        polar->SetScale(std::abs(spec.true_latitude1_deg), spec.scale);
        break;
      case MapKind::kTransverseMercator:
        transverse.emplace(a, f, spec.scale);
        break;
      case MapKind::kRotated:
        break;
    }
  } catch (const std::exception& e) {
    throw Error({"there is no such map projection", "the file's projection attributes",
                 "standard latitudes of a map", e.what(), ""});
  }
  // Polar maps have their origin at the pole.
  if (conic || transverse)
    origin_m = forward({spec.origin_latitude_deg, spec.central_longitude_deg});
  origin_m -= glm::dvec2(spec.false_easting_m, spec.false_northing_m);
}

}  // namespace

MapProjection::MapProjection(const MapSpec& spec)
    : formula_(std::make_shared<GeographicMap>(spec)) {}

}  // namespace nepho
