#pragma once

namespace nepho::samples {

// A coast that faces west, hills behind it, a broad valley, a range of mountains with side valleys,
// and a plateau beyond. Metres east and north of the middle; deterministic, without end.
struct Landscape {
  double inland_m;    // distance from the coast line, negative at sea
  double height_m;    // of the ground, 0 at sea
  double envelope_m;  // of the ground without peaks and valleys: what the air mass feels
};
Landscape landscape(double x_m, double y_m);

}  // namespace nepho::samples
