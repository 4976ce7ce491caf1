#include "weather.h"

#include "hash_noise.h"

namespace nepho::samples {
namespace {

constexpr std::uint64_t kSeed = 7700;
constexpr double kCondensed_per_m = 1.9e-6;  // kg/kg per metre of ascent, moist adiabatic at 15 C

// Perlin's noise seldom leaves +-0.6; thresholds below are for +-1.
double noise(double x_m, double y_m, double z_m, double size_m, std::uint64_t seed) {
  return 1.6 * gradient_noise(glm::dvec3(x_m, y_m, z_m) / size_m, kSeed + seed);
}
double noise(double x_m, double y_m, double size_m, std::uint64_t seed) {
  return noise(x_m, y_m, 0.37 * size_m, size_m, seed);
}

// An edge as a model's mixing leaves it: over several cells, water falls off by orders of
// magnitude, so that what is seen (a few 1e-6 kg/kg hide 2 km) bends between the cells and does not
// follow them.
double mixed_edge(double low, double high, double x) {
  const double s = smooth_step(low, high, x);
  return s * s * s;
}

// Water of a cloud from base to top: grows as in adiabatic ascent, and ends within `soft_m`.
double adiabatic(double height_m, double base_m, double top_m, double soft_m, double fraction) {
  if (height_m <= base_m || height_m >= top_m + soft_m) return 0;
  return fraction * kCondensed_per_m * (height_m - base_m) *
         mixed_edge(top_m + soft_m, top_m - soft_m, height_m);
}

double frozen(double temperature_K) {
  return smooth_step(262, 238, temperature_K);
}

// Towers come again along the coast, so that larger domains have them too.
constexpr double kPeriod_m = 190e3;
double repeated(double y_m) {
  return y_m - kPeriod_m * std::round(y_m / kPeriod_m);
}

}  // namespace

// A convective tower over (x, y): its radius and top, and how long its anvil is (0: none yet).
struct Weather::Tower {
  double x_m, y_m, radius_m, top_m, anvil_m;
};

const std::vector<Weather::Tower>& Weather::towers() {
  static const std::vector<Tower> all = {
      {34e3, 22e3, 7.6e3, 11.6e3, 60e3}, {61e3, -56e3, 6.2e3, 10.9e3, 38e3},
      {22e3, 9e3, 5.2e3, 7.8e3, 0},      {14e3, -2e3, 4.4e3, 5.6e3, 0},
      {8e3, -12e3, 3.8e3, 4.3e3, 0},     {50e3, -68e3, 4.2e3, 6.3e3, 0},
  };
  return all;
}

Weather::Weather(double time_s) : time_s_(time_s) {}

double Weather::wind_along_m_per_s(double height_m) {
  return 5 + 22 * smooth_step(500, 11500, height_m);
}

Weather::Column Weather::column(double x_m, double y_m) const {
  Column c{};
  c.x_m = x_m, c.y_m = y_m;
  c.ground = landscape(x_m, y_m);
  const double turn_x = std::cos(kWindTurn_rad), turn_y = std::sin(kWindTurn_rad);
  c.along_m = x_m * turn_x + y_m * turn_y;
  c.across_m = -x_m * turn_y + y_m * turn_x;
  const double s_m = c.ground.inland_m;
  c.marine = smooth_step(13e3, 1e3, s_m);

  // The deck: closed cells, 13 km wide, that tear where it is older and where it meets the land.
  const double dx_m = 4 * time_s_;
  const double u = x_m - dx_m, v = y_m;
  const double cell = cell_distance(
      glm::dvec3(u + 2500 * noise(u, v, 14e3, 1), v + 2500 * noise(u, v, 14e3, 2), 5e3) / 13e3,
      kSeed + 3);
  const double patch = 0.75 * noise(u, v, 52e3, 4) + 0.35 * noise(u, v, 21e3, 5);
  const double shore = smooth_step(5e3 + 7e3 * noise(x_m, y_m, 18e3, 6), -5e3, s_m);
  const double thick_m = 270 + 380 * (0.52 - cell * cell) + 230 * patch + 60 * noise(u, v, 5e3, 7);
  c.deck_base_m = 420 + 25 * noise(u, v, 30e3, 8);
  c.deck_top_m = c.deck_base_m + thick_m * shore - 120 * (1 - shore);

  // Fair-weather cumulus: streets along the wind, broken into cells.
  const double a = c.along_m - 6 * time_s_, b = c.across_m;
  const double street = noise(a / 2, b, 15e3, 10);
  const double cells =
      0.55 * street + 0.95 * noise(a, b, 10.5e3, 11) + 0.4 * noise(a, b, 6.2e3, 12);
  const double heated = smooth_step(7e3, 20e3, s_m) * smooth_step(100e3, 74e3, s_m);
  const double strength = cells - 0.44 - 0.9 * (1 - heated) + 0.55 * noise(a, b, 27e3, 13);
  c.cumulus = mixed_edge(-0.15, 0.55, strength);
  c.cumulus_base_m = 1500 + 0.30 * std::max(0.0, c.ground.envelope_m - 500);
  const double turret = 0.8 + 0.45 * noise(a, b, 7e3, 14);
  c.cumulus_top_m = c.cumulus_base_m + 350 + 2600 * std::max(strength + 0.05, 0.0) * turret;

  // Against the range: lifted where the ground rises towards the crest.
  const double crest = c.ground.envelope_m;
  const double windward = smooth_step(66e3, 80e3, s_m) * smooth_step(112e3, 100e3, s_m);
  c.cap = windward * smooth_step(-0.45, 0.55, noise(a / 1.5, b, 17e3, 16) + 0.1);
  c.cap_top_m = 1900 + 0.45 * crest + 600 * c.cap * (0.6 + 0.5 * noise(a, b, 5.5e3, 17));
  c.wave = smooth_step(104e3, 112e3, s_m) * std::cos(6.283185307 * (s_m - 116e3) / 15e3) *
               smooth_step(190e3, 120e3, s_m) +
           0.5 * noise(x_m, y_m, 28e3, 18);

  const double ci_a = c.along_m - 24 * time_s_, bend_m = 9e3 * noise(ci_a, b, 60e3, 20);
  const double streaks =
      0.7 * noise(ci_a / 9, b + bend_m, 8e3, 21) + 0.55 * noise(ci_a / 7, b + bend_m, 4.2e3, 22);
  const double field = noise(ci_a, b, 85e3, 23) + 0.9 * smooth_step(20e3, -70e3, c.along_m) - 0.45;
  c.cirrus = std::max(0.0, streaks + field) * smooth_step(30e3, -10e3, c.along_m);
  return c;
}

// Well mixed under the cumulus base inland; cool under an inversion at sea; 6.5 K/km above, up to
// the tropopause.
double Weather::temperature_K(const Column& column, double height_m) {
  const double h = height_m, free = std::max(293.5 - 6.5e-3 * (h - 1000), 219.0);
  const double mixed_top_m = column.cumulus_base_m;
  const double mixed = 293.5 - 6.5e-3 * (mixed_top_m - 1000) + 9.6e-3 * (mixed_top_m - h);
  const double inland = h < mixed_top_m ? std::min(mixed, 309.0) : free;
  const double under = 287.5 - (h < 430 ? 9.7e-3 * h : 9.7e-3 * 430 + 5.5e-3 * (h - 430));
  const double lid = smooth_step(720, 980, h);
  const double marine = (1 - lid) * under + lid * free;
  return column.marine * marine + (1 - column.marine) * inland;
}

double Weather::relative_humidity(const Column& column, double height_m) {
  const double h = height_m;
  const double free = 0.22 + 0.18 * smooth_step(4e3, 9e3, h);
  const double rise = std::clamp(h / column.cumulus_base_m, 0.0, 1.0);
  const double inland =
      free + (0.42 + 0.45 * rise - free) * smooth_step(column.cumulus_base_m + 2200, 1400, h);
  const double marine =
      free + (0.80 + 0.16 * std::min(h / 430, 1.0) - free) * smooth_step(1000, 700, h);
  return column.marine * marine + (1 - column.marine) * inland;
}

Hydrometeors Weather::water(const Column& column, double height_m) const {
  Hydrometeors water;
  if (height_m < column.ground.height_m || height_m > 14e3) return water;
  add_layers(column, height_m, water);
  for (const Tower& tower : towers()) {
    add_tower(tower, column, height_m, water);
    if (tower.anvil_m > 0) add_anvil(tower, column, height_m, water);
  }
  return water;
}

void Weather::add_layers(const Column& c, double h, Hydrometeors& water) const {
  if (c.deck_top_m > c.deck_base_m)
    water.cloud += adiabatic(h, c.deck_base_m, c.deck_top_m, 110, 0.85) *
                   mixed_edge(0, 260, c.deck_top_m - c.deck_base_m);
  if (c.cumulus > 0)
    // narrower towards the top
    water.cloud += adiabatic(h, c.cumulus_base_m, c.cumulus_top_m, 380, 0.6) * c.cumulus;
  if (c.cap > 0) water.cloud += adiabatic(h, 1950, c.cap_top_m, 300, 0.4) * c.cap * c.cap * c.cap;
  if (c.wave > 0.4) {
    const double lens = smooth_step(0.4, 1.2, c.wave), middle_m = 5300 + 180 * lens;
    const double half_m = 120 + 260 * lens, off = (h - middle_m) / half_m;
    if (off * off < 1) water.cloud += 0.2e-3 * lens * (1 - off * off);
  }
  if (c.cirrus > 0 && h > 8600 && h < 11200) {
    // fall streaks: the trails hang below and behind
    const double off = (h - 10100) / (h > 10100 ? 450.0 : 1100.0);
    water.ice += 2.2e-5 * std::max(0.0, 1 - off * off) * std::min(c.cirrus, 1.5);
  }
}

void Weather::add_tower(const Tower& tower, const Column& c, double h, Hydrometeors& water) const {
  const double base_m = c.cumulus_base_m, rise = (h - base_m) / (tower.top_m - base_m);
  const double reach_m = 2.2 * tower.radius_m + 5e3;
  const double lean_m = 0.16 * std::clamp(h - base_m, -1500.0, 8e3);
  const double dx = c.x_m - tower.x_m - 5 * time_s_ - lean_m * std::cos(kWindTurn_rad);
  const double dy = repeated(c.y_m - tower.y_m) - lean_m * std::sin(kWindTurn_rad);
  if (std::abs(dx) > reach_m || std::abs(dy) > reach_m || rise > 1.4) return;
  const double away_m = std::hypot(dx, dy), temperature = temperature_K(c, h);

  // Rain and snow fall through the lower half, downwind of the updraught.
  if (tower.anvil_m > 0 && rise < 0.75) {
    const double shaft_m = std::hypot(dx - 2.2e3, dy - 0.8e3);
    const double falling = 2.0e-3 *
                           smooth_step(0.68 * tower.radius_m, 0.2 * tower.radius_m, shaft_m) *
                           smooth_step(0.75, 0.35, rise);
    const double melted = smooth_step(271, 275, temperature);
    water.rain += falling * melted;
    water.graupel += 0.55 * falling * (1 - melted);
    water.snow += 0.45 * falling * (1 - melted);
  }
  if (h <= base_m) return;

  // A column under a dome, as one distance to its axis and its upper end; both bulge in turrets.
  const double x_m = c.x_m - 5 * time_s_, up_m = 1.15 * h - 9 * time_s_;
  const double bulge_m =
      2000 * noise(x_m, c.y_m, up_m, 9e3, 30) + 1400 * noise(x_m, c.y_m, up_m, 5.6e3, 31);
  const double radius_m = tower.radius_m * (1 - 0.12 * smooth_step(0.0, 0.35, rise) +
                                            0.25 * smooth_step(0.35, 0.8, rise));
  const double over_m = std::max(0.0, h - (tower.top_m - 0.5 * tower.radius_m - 600));
  const double inside =
      mixed_edge(-2800, 2400, radius_m - std::hypot(away_m, 2 * over_m) + bulge_m);
  if (inside == 0) return;
  const double lifted = 0.55 * kCondensed_per_m * (h - base_m);
  const double left = std::min(lifted, 3.4e-3 - 2.3e-3 * smooth_step(3500, 10500, h));
  const double ice = frozen(temperature), amount = inside * std::min(left, lifted);
  water.cloud += amount * (1 - ice);
  water.ice += 0.45 * amount * ice;
  water.snow += 0.35 * amount * ice;
  water.graupel += 0.20 * amount * ice;
}

void Weather::add_anvil(const Tower& tower, const Column& c, double h, Hydrometeors& water) const {
  if (h < tower.top_m - 4200 || h > tower.top_m + 300) return;
  const double lean_m = 0.16 * 8e3, dx = c.x_m - tower.x_m - 5 * time_s_ - lean_m;
  const double dy = repeated(c.y_m - tower.y_m) - 0.35 * lean_m;
  const double turn_x = std::cos(kWindTurn_rad), turn_y = std::sin(kWindTurn_rad);
  const double along_m = dx * turn_x + dy * turn_y, across_m = -dx * turn_y + dy * turn_x;
  const double reach = along_m / tower.anvil_m;
  if (reach < -0.35 || reach > 1.3) return;
  // Spreads downwind like a plume, with a blunt upwind edge and fibres at its end.
  const double fringe =
      noise(along_m / 3.5, across_m, 5.2e3, 40) + 0.6 * noise(along_m, across_m, 4e3, 41);
  const double half_m = 1.45 * tower.radius_m + 0.30 * std::max(along_m, 0.0);
  const double upwind_m = along_m + 1.75 * tower.radius_m;
  const double side = smooth_step(1.12, 0.62, std::abs(across_m) / half_m + 0.20 * fringe);
  const double length = smooth_step(1.05, 0.45, reach + 0.20 * fringe) *
                        smooth_step(-1500, 2500, upwind_m + 1500 * fringe);
  const double there = side * length * std::sqrt(side * length);
  if (there == 0) return;
  // Its top is level, with low mounds over the updraught; pouches hang from its underside.
  const double top_m = tower.top_m - 250 + 130 * noise(along_m, across_m, 5e3, 42) - 350 * reach;
  const double pouches = 1 + 0.28 * noise(along_m, across_m, 4.6e3, 43);
  const double depth_m = (350 + 2600 * there * smooth_step(1.1, -0.1, reach)) * pouches;
  const double inside = smooth_step(top_m + 200, top_m - 200, h) *
                        smooth_step(top_m - depth_m - 350, top_m - 0.45 * depth_m, h);
  const double amount = 0.6e-3 * inside * there * std::exp(-1.1 * std::max(reach, 0.0));
  water.ice += 0.6 * amount;
  water.snow += 0.4 * amount;
}

}  // namespace nepho::samples
