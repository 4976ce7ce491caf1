#pragma once

#include <string>
#include <vector>

#include "bench/references.h"
#include "image/image.h"
#include "scene/scene.h"

namespace nepho::bench {

// Linear light as it is shown: exposure of the truth, the scene's tone map, no dither.
struct Display {
  double exposure_ev = 0;
  ToneMap tone_map = ToneMap::kAces;
  glm::dvec3 white{1.0};
};
ByteImage shown(const Display& display, const HdrImage& image);

// One part of an error: how far two pictures are apart that differ in one thing.
struct Term {
  std::string name;
  // Why no number is told, and what would be needed; empty where they are.
  std::string withheld = {};
  double below = 0;  // where withheld: the error is not above it; 0: that is not known either
  double rms = 0;    // of luminance over its mean, where there is cloud (error_metric.h); the
                     // noise of the truth is taken out
  double bias = 0;   // of mean luminance, relative
  double bias_of_truth = 0;  // the same over the last reference's mean: these add up to the total's
  double relative_mse = 0, rmse_8bit = 0, flip_mean = 0;  // all pixels
  bool told() const { return withheld.empty(); }
};

// The names of the terms, in their order; a scene without path tracing has no total and no light
// model.
//   total           picture     against truth
//   march           picture     against finest: all but the light model
//   integration     picture     against converged
//   steps           picture     against fine_steps: a part of integration
//   light cache     fine_steps  against converged: the other part
//   level of detail converged   against finest
//   light model     finest      against truth
//   quantisation    coarser_codes against converged
//   data            finest      against own: what the finest bricks miss of the source, on every
//                   second pixel or fewer; no part of the total, which goes by the bricks
inline constexpr const char* kTotal = "total";
inline constexpr const char* kMarch = "march";
inline constexpr const char* kIntegration = "integration";
inline constexpr const char* kSteps = "steps";
inline constexpr const char* kLightCache = "light cache";
inline constexpr const char* kLevelOfDetail = "level of detail";
inline constexpr const char* kLightModel = "light model";
inline constexpr const char* kQuantisation = "quantisation";
inline constexpr const char* kData = "data";

// What a setting's picture is held against.
struct Chain {
  const HdrImage* picture;
  const Reference* fine_steps;
  const Reference* converged;
  const HdrImage* coarser_codes;
  const Reference* finest;
  const Truth* truth;               // null: no path tracing
  const OwnPicture* own = nullptr;  // null: not asked for
};

// All terms of one setting. A number is told only where it is kLeastRatio times what its references
// change by when they are made stricter, and kLeastRatio times the truth's noise.
std::vector<Term> decompose(const Chain& chain, const Display& display);

const Term* find_term(const std::vector<Term>& terms, const std::string& name);

}  // namespace nepho::bench
