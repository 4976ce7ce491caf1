#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>

#include "bench/progress.h"
#include "common/open_scene.h"
#include "reference/level_set.h"
#include "reference/path/path_picture.h"
#include "reference/planet_model.h"
#include "reference/ray_march.h"
#include "tree/forest.h"

namespace nepho::bench {

// The march's estimate of a step goes by its ends: in voxels of optical depth 1 it leaves 0.5 % of
// a picture at its usual tolerance, and with a cell in four below 0.1 %.
inline const MarchSettings kReferenceMarch{
    .source_tolerance = 2.5e-5, .least_transmittance = 1e-6, .least_halvings = 2};
inline const MarchSettings kStricterMarch{
    .source_tolerance = 1.25e-5, .least_transmittance = 1e-7, .least_halvings = 3};

inline constexpr std::uint32_t kLeastPaths = 8;  // a pixel: a standard error of fewer is none

struct ReferenceGoals {
  double finest_step_voxels = 1.0 / 16;  // of the march that steps are measured against
  std::uint32_t most_paths = 4096;       // a pixel, at least kLeastPaths; 0: no path tracing
  double host_mib = 1024;                // memory for the finest bricks
};

// A picture that errors are measured against, and by how much a stricter one differs from it: rms
// of luminance over its mean, on the pixels that count. No error below five times that is told.
struct Reference {
  HdrImage picture;
  double change = 0;
};
inline constexpr double kLeastRatio = 5;
inline constexpr double kNotYet = -1;  // a change that is not measured yet

// What the sources' own fields look like, and what their finest bricks do by the same march: every
// second pixel, or fewer, so that there are 512 or more. Or why there are none.
struct OwnPicture {
  struct Pair {
    Reference own;
    HdrImage bricks;
  };
  std::optional<Pair> seen;
  std::string why_not;
};
inline const MarchSettings kOwnMarch{.least_halvings = 1};

// The path traced picture. `noise`: rms of the pixels' standard errors over mean luminance, of
// those that count.
struct Truth {
  HdrImage picture;
  double noise = 0;
  std::uint32_t paths = 0;  // a pixel
};

// The pictures of one scene that differ in one thing each. Each is made when it is asked for, and
// kept. The renderer's context is current. Throws Error.
//
//   picture          as set
//   fine_steps       the renderer with the same bricks, in fine steps, every pixel, exact fetches
//   converged        the same bricks by the march in double on the CPU: no light interpolated
//   coarser_codes    the same with as much noise as 16-bit codes have
//   finest           that march on the finest bricks
//   truth            paths on the finest bricks
//   own              a march over the sources' own fields, where the finest bricks are all levels
//
// The optical depths of all of them are one mask, 1 or 0, by the finest march: what counts in a
// rms (over a planet all pixels but those on the sun's disc).
class References {
 public:
  References(const OpenedScene& opened, const ReferenceGoals& goals, Progress& progress,
             const RenderSettings& finest_of_sweep);

  const Reference& fine_steps(const RenderSettings& settings);
  const Reference& converged(const RenderSettings& settings);
  const HdrImage& coarser_codes(const RenderSettings& settings);
  const Reference& finest(const RenderSettings& settings);
  // Paths until their noise is under a fifth of the smallest light model error of these settings,
  // or most_paths. Absent without path tracing.
  const std::optional<Truth>& truth(std::span<const RenderSettings> settings);
  const OwnPicture& own(const RenderSettings& settings);

  // `image` with the scene's mask for its optical depths.
  HdrImage masked(HdrImage image) const;
  // Of the finest bricks: "all levels", or where they end.
  std::string description() const;

 private:
  using LightKey = int;                                            // octaves
  using TreeKey = std::tuple<std::uint64_t, int, double, double>;  // nodes, and what grew them
  using Key = std::pair<TreeKey, LightKey>;
  struct Tree {
    TreeKey key;
    Forest forest;
  };

  RenderRequest request_with(const RenderSettings& settings) const;
  const Tree& tree(const RenderSettings& settings);
  void make_finest(const RenderSettings& finest_of_sweep);
  void make_mask(const HdrImage& finest);
  Key key_of(const RenderSettings& settings);
  HdrImage draw(const RenderSettings& settings, const std::string& what);
  HdrImage march(const LevelSet& levels, const RenderRequest& request, const std::string& what);
  // By a stricter march, on some of the pixels.
  double march_change(const LevelSet& levels, const RenderRequest& request,
                      const HdrImage& picture) const;
  // Of `picture` by another march, on some of the pixels.
  double change_by(const RayMarch& other, const RenderRequest& request,
                   const HdrImage& picture) const;
  OwnPicture march_own(const RenderRequest& request);
  HdrImage thinned(const LevelSet& levels, const RenderRequest& request, std::size_t stride) const;
  double noise_of(const PathPicture& paths) const;

  const OpenedScene& opened_;
  ReferenceGoals goals_;
  Progress& progress_;
  std::shared_ptr<const PlanetModel> planet_;
  Forest finest_forest_;
  std::optional<Forest> less_fine_;  // where the finest is not all that there is
  bool holds_everything_ = true, endless_ = false;
  double beyond_ = kNotYet;  // of what has no end: by bricks half as fine
  std::vector<float> mask_;
  std::map<std::tuple<double, int, double, double>, Tree> trees_;  // by what was asked for
  std::map<Key, Reference> fine_steps_, converged_;
  std::map<Key, HdrImage> coarser_codes_;
  std::map<LightKey, Reference> finest_;
  std::map<LightKey, OwnPicture> own_;
  std::optional<std::optional<Truth>> truth_;
};

}  // namespace nepho::bench
