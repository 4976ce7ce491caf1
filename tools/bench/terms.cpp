#include "bench/terms.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/text.h"
#include "common/metrics.h"
#include "image/difference.h"
#include "image/flip.h"
#include "image/tone.h"
#include "reference/error_metric.h"

namespace nepho::bench {
namespace {

// What is known of how well the two pictures of a term are known.
struct Doubt {
  double change = 0;  // of both, by stricter references
  double noise = 0;   // of the truth
  std::uint32_t paths = 0;
};

double mean_luminance(const HdrImage& image) {
  double sum = 0;
  const std::size_t pixels = image.rgb.size() / 3;
  for (std::size_t p = 0; p < pixels; ++p) sum += pixel_luminance(image, p);
  return sum / double(pixels);
}

// Never a number that is noise: why there is none, and what would give one.
std::string why_withheld(double rms, const Doubt& doubt) {
  if (kLeastRatio * doubt.noise > rms) {
    std::string text =
        "the truth's noise of " + percent_text(doubt.noise) + " is above a fifth of it";
    if (!(rms > 0)) return text + "; more paths are needed (--spp)";
    const double ratio = kLeastRatio * doubt.noise / rms;
    char needed[96];
    std::snprintf(needed, sizeof needed, "; about %.0f paths a pixel are needed (--spp)",
                  std::ceil(1.2 * ratio * ratio * doubt.paths));
    return text + needed;
  }
  return "a stricter reference differs by " + percent_text(doubt.change) +
         ", above a fifth of it; finer references are needed (--finest-step, --host-mib)";
}

Term measure(const char* name, const HdrImage& picture, const HdrImage& truth, const Doubt& doubt,
             const Display& display, double scale_of_truth) {
  const PictureDifference d = difference(picture, truth);
  Term term{.name = name};
  if (d.same_bits) return term;
#ifdef NEPHO_MUTANT_BENCH_NOISE_KEPT
  const double squared = d.relative_rms * d.relative_rms;
#else
  const double squared = d.relative_rms * d.relative_rms - doubt.noise * doubt.noise;
#endif
  term.rms = std::sqrt(std::max(squared, 0.0));
  const double least = kLeastRatio * std::max(doubt.change, doubt.noise);
#ifdef NEPHO_MUTANT_BENCH_NOISE_TOLD
  const bool told = true;
#else
  const bool told = term.rms >= least;
#endif
  if (!told) {
    term.withheld = why_withheld(term.rms, doubt);
    // Noise bounds nothing that is worth saying.
    if (kLeastRatio * doubt.noise <= term.rms) term.below = std::max(least, d.relative_rms);
    term.rms = 0;
    return term;
  }
  term.bias = d.bias;
#ifdef NEPHO_MUTANT_BENCH_BIAS
  term.bias_of_truth = d.bias * (scale_of_truth > 0);
#else
  term.bias_of_truth = (mean_luminance(picture) - mean_luminance(truth)) / scale_of_truth;
#endif
  term.relative_mse = d.relative_mse;
  const ByteImage a = shown(display, picture), b = shown(display, truth);
  term.rmse_8bit = byte_difference(a, b).rmse;
  term.flip_mean = mean_of(flip_map(a, b));
  return term;
}

}  // namespace

ByteImage shown(const Display& display, const HdrImage& image) {
  FloatImage radiance(image.width, image.height, 3);
  radiance.values = image.rgb;
  return to_display(radiance, display.exposure_ev, display.tone_map, false, display.white);
}

std::vector<Term> decompose(const Chain& c, const Display& display) {
  const HdrImage& last = c.truth ? c.truth->picture : c.finest->picture;
  const double scale = mean_luminance(last);
  std::vector<Term> terms;
  const auto add = [&](const char* name, const HdrImage& picture, const HdrImage& truth,
                       const Doubt& doubt) {
    terms.push_back(measure(name, picture, truth, doubt, display, scale));
  };
  if (c.truth) add(kTotal, *c.picture, c.truth->picture, {0, c.truth->noise, c.truth->paths});
  add(kMarch, *c.picture, c.finest->picture, {c.finest->change});
  add(kIntegration, *c.picture, c.converged->picture, {c.converged->change});
  add(kSteps, *c.picture, c.fine_steps->picture, {c.fine_steps->change});
  add(kLightCache, c.fine_steps->picture, c.converged->picture,
      {std::hypot(c.fine_steps->change, c.converged->change)});
  add(kLevelOfDetail, c.converged->picture, c.finest->picture,
      {std::hypot(c.finest->change, c.converged->change)});
  if (c.truth)
    add(kLightModel, c.finest->picture, c.truth->picture,
        {c.finest->change, c.truth->noise, c.truth->paths});
  // Both marches take the same way: what one misses the other does.
  add(kQuantisation, *c.coarser_codes, c.converged->picture, {});
  if (c.own && c.own->seen)
    add(kData, c.own->seen->bricks, c.own->seen->own.picture, {c.own->seen->own.change});
  else if (c.own)
    terms.push_back({.name = kData, .withheld = c.own->why_not});
  return terms;
}

const Term* find_term(const std::vector<Term>& terms, const std::string& name) {
  const auto found = std::ranges::find(terms, name, &Term::name);
  return found == terms.end() ? nullptr : &*found;
}

}  // namespace nepho::bench
