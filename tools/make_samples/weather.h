#pragma once

#include <cstdint>
#include <vector>

#include "landscape.h"

namespace nepho::samples {

// Water in kg per kg of dry air.
struct Hydrometeors {
  double cloud = 0, rain = 0, ice = 0, snow = 0, graupel = 0;
  double sum() const { return cloud + rain + ice + snow + graupel; }
};

// A summer afternoon on a west coast, made and not simulated: a stratocumulus deck under an
// inversion over the sea, fair-weather cumulus with level bases in streets over the valley, cloud
// piled up on the windward slope of the range and waves in its lee, two cumulonimbus with anvils
// and the line of towers that feeds them, and cirrus. Cloud water grows with height over its base
// as the adiabatic does. Everything drifts with the wind of its height.
//
// Shapes are some 6 km wide and more, and their edges soft, as a model of 2 km carries them.
class Weather {
 public:
  explicit Weather(double time_s);

  // What depends on the place alone: worked out once per column.
  struct Column {
    double x_m, y_m;
    Landscape ground;
    double along_m, across_m;  // with the wind, and to its left
    double marine;             // 1 under the sea's inversion .. 0 inland
    double deck_base_m, deck_top_m;
    double cumulus, cumulus_base_m, cumulus_top_m;  // first: 0 clear .. 1 core
    double cap, cap_top_m;                          // against the windward slope
    double wave;                                    // in its lee
    double cirrus;
  };
  Column column(double x_m, double y_m) const;
  // Air that is not in cloud, and what condensed at a height over the sea.
  static double temperature_K(const Column& column, double height_m);
  static double relative_humidity(const Column& column, double height_m);
  Hydrometeors water(const Column& column, double height_m) const;
  // Along the grid's x and y.
  static double wind_along_m_per_s(double height_m);
  static constexpr double kWindTurn_rad = 0.35;  // from x towards y

 private:
  struct Tower;
  static const std::vector<Tower>& towers();
  void add_layers(const Column& column, double height_m, Hydrometeors& water) const;
  void add_tower(const Tower& tower, const Column& column, double height_m,
                 Hydrometeors& water) const;
  void add_anvil(const Tower& tower, const Column& column, double height_m,
                 Hydrometeors& water) const;
  double time_s_;
};

}  // namespace nepho::samples
