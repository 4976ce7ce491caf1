#include "gl/ground_pass.h"

#include <algorithm>

#include "gl/ground_tiles.h"
#include "physics/physics_cpp.h"

namespace nepho::gl {
namespace {

// Of the tolerance; what is predicted to change the picture by more is lit in all pixels after all.
constexpr double kMostPredicted = 0.5;

class GroundPass {
 public:
  GroundPass(const FrameData& frame, const PlanetScene& planet, const Program& program,
             const GroundTiles& tiles, const PixelValues& view)
      : frame_(frame), program_(program), tiles_(tiles) {
    ground_.met = view.met;
    for (PixelTexel& met : ground_.met) met[0] = met[1] = met[2] = 1;
    ground_.seen.resize(view.met.size());
    night_ = {};
    for (std::size_t c = 0; c < 3 && planet.air; ++c)
      night_[c] = float(f64::night_sky) * frame.sun_irradiance[c];
  }

  void run(PixelPlan& plan) {
    PixelValues found;
    for (auto list = plan.next(found, ground_); !list.empty(); list = plan.next(found, ground_))
      found = light(list);
  }
  // All pixels of which something is seen.
  void run_all(const std::vector<float>& part_seen) {
    std::vector<std::uint32_t> list = all_pixels(frame_.width, frame_.height);
    std::erase_if(list, [&](std::uint32_t p) { return part_seen[p] <= 0; });
    const PixelValues found = light(list);
    for (std::size_t n = 0; n < list.size(); ++n) ground_.seen[list[n]] = found.seen[n];
  }
  const PixelValues& ground() const { return ground_; }

 private:
  // The night sky away from the sun is the same everywhere.
  bool is_night(std::uint32_t p) const {
    const int width = frame_.width, columns = (width + kStrideTile - 1) / kStrideTile;
    const int x = int(p) % width, y = int(p) / width;
    return !(ground_.met[p][3] < kNoGround_m) &&
           !tiles_.near_sun[std::size_t(y / kStrideTile * columns + x / kStrideTile)];
  }
  PixelValues light(const std::vector<std::uint32_t>& list) const {
    std::vector<std::uint32_t> asked;
    for (const std::uint32_t p : list)
      if (!is_night(p)) asked.push_back(p);
    const PixelValues lit = march_pixels(program_, asked, frame_.width, ground_);
    PixelValues found;
    std::size_t next = 0;
    for (const std::uint32_t p : list) {
      found.seen.push_back(is_night(p) ? night_ : lit.seen[next++]);
      found.met.push_back(ground_.met[p]);
    }
    return found;
  }

  const FrameData& frame_;
  const Program& program_;
  const GroundTiles& tiles_;
  PixelValues ground_;
  PixelTexel night_;
};

}  // namespace

PixelReport light_ground(const RenderRequest& request, const Forest& forest, const FrameData& frame,
                         const PlanetScene& planet, const Program& program, PixelValues& values) {
  const std::size_t pixels = values.met.size();
  PixelSettings settings{
      .width = frame.width, .height = frame.height, .tolerance = request.settings.tolerance};
  settings.part_seen.resize(pixels);
  settings.in_front.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    const PixelTexel& met = values.met[p];
    const float most = std::max({met[0], met[1], met[2]});
    settings.part_seen[p] = most < frame.least_transmittance ? 0 : most;
    settings.in_front[p] = luminance(values.seen[p]);
  }
  const GroundTiles tiles = ground_tiles(request, forest, frame, planet, values);
  settings.strides = tiles.strides;
  GroundPass pass(frame, planet, program, tiles, values);
  PixelReport report;
  report.why_all = why_all_pixels(request);
  if (report.why_all.empty()) {
    PixelPlan plan(settings, values);
    report.interpolates = !plan.saves_little();
    if (report.interpolates) {
      pass.run(plan);
      report.marched_share = plan.marched_share();
      report.predicted_rms = plan.predicted_rms();
      report.checks = plan.checks();
      report.interpolates = report.predicted_rms <= kMostPredicted * settings.tolerance;
    }
  }
  if (!report.interpolates) pass.run_all(settings.part_seen);
  for (std::size_t p = 0; p < pixels; ++p)
    if (settings.part_seen[p] > 0)
      for (std::size_t c = 0; c < 3; ++c)
        values.seen[p][c] += values.met[p][c] * pass.ground().seen[p][c];
  return report;
}

}  // namespace nepho::gl
