#include "forecast/forecast.h"
#include "geo/place.h"

namespace nepho::forecast {

glm::dvec3 HorizontalGrid::direction(double x, double y) const {
  return unit_vector(lat_lon_deg(x, y));
}

}  // namespace nepho::forecast
