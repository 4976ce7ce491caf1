#include "live/fingerprint.h"

#include <bit>

namespace nepho {
namespace {

class Numbers {
 public:
  void add(double number) { numbers_.push_back(number); }
  void add(const glm::dvec3& v) {
    for (int c = 0; c < 3; ++c) numbers_.push_back(v[c]);
  }
  void add(const Phase& phase) {
    add(double(phase.kind));
    add(phase.effective_radius_m);
    add(phase.asymmetry);
  }
  std::vector<double> take() { return std::move(numbers_); }

 private:
  std::vector<double> numbers_;
};

void add_volumes(Numbers& numbers, const RenderRequest& request) {
  numbers.add(double(request.volumes.size()));
  for (const RenderVolume& volume : request.volumes) {
    // Of an address no double holds more than 53 bits: no address has more.
    numbers.add(double(reinterpret_cast<std::uintptr_t>(volume.source)));
    numbers.add(volume.time_s);
  }
}

void add_looks(Numbers& numbers, const RenderRequest& request) {
  for (const RenderVolume& volume : request.volumes) {
    numbers.add(volume.phase);
    numbers.add(volume.ice_phase);
    numbers.add(volume.co_albedo);
  }
  numbers.add(request.sun.to_sun);
  numbers.add(request.sun.irradiance_W_per_m2_nm);
  const Sky& sky = request.sky;
  for (const glm::dvec3& v :
       {sky.up, sky.zenith_W_per_m2_sr_nm, sky.horizon_W_per_m2_sr_nm, sky.below_W_per_m2_sr_nm})
    numbers.add(v);
  numbers.add(request.planet.has_value());
  if (!request.planet) return;
  const Planet& planet = *request.planet;
  for (const double number : {planet.body.equatorial_m, planet.body.polar_m,
                              planet.ground.wind_m_per_s, double(planet.air.has_value())})
    numbers.add(number);
  numbers.add(planet.ground.land_albedo);
  numbers.add(planet.ground.water_albedo);
  if (!planet.air) return;
  const Air& air = *planet.air;
  for (const glm::dvec3& v : {air.rayleigh_per_m, air.aerosol_extinction_per_m, air.ozone_per_m})
    numbers.add(v);
  for (const double number :
       {air.rayleigh_scale_m, air.aerosol_albedo, air.aerosol_asymmetry, air.aerosol_scale_m,
        air.ozone_low_m, air.ozone_peak_m, air.ozone_high_m, air.top_m})
    numbers.add(number);
}

void add_settings(Numbers& numbers, const RenderRequest& request) {
  const RenderSettings& s = request.settings;
  for (const double number :
       {s.step_voxels.value_or(-1), s.tolerance, s.fetch ? double(*s.fetch) : -1, double(s.light),
        double(s.octaves), double(s.pixels), s.pixels_per_voxel, double(s.max_level),
        request.light_step_voxels.value_or(-1)})
    numbers.add(number);
}

}  // namespace

std::vector<double> fingerprint(const RenderRequest& request) {
  Numbers numbers;
  add_volumes(numbers, request);
  add_looks(numbers, request);
  add_settings(numbers, request);
  const Camera& camera = request.camera;
  for (const glm::dvec3& v : {camera.eye_m, camera.target_m, camera.up}) numbers.add(v);
  for (const double number :
       {camera.vertical_fov_rad, double(request.settings.width), double(request.settings.height)})
    numbers.add(number);
  return numbers.take();
}

std::vector<double> look_fingerprint(const RenderRequest& request) {
  Numbers numbers;
  add_volumes(numbers, request);
  add_looks(numbers, request);
  add_settings(numbers, request);
  return numbers.take();
}

std::vector<double> contents_fingerprint(const RenderRequest& request) {
  Numbers numbers;
  add_volumes(numbers, request);
  return numbers.take();
}

}  // namespace nepho
