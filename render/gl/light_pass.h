#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "gl/light_samples.h"
#include "gl/object.h"
#include "gl/programs.h"

namespace nepho::gl {

// The light of tiles: optical depth towards the sun, then what is visible of the sky. Frame, trees
// and bricks are bound, and a tile's place in `atlas` is that of its number, or the one that
// `places` names for it.
class LightPass {
 public:
  // `phases`: bound again where the samples' lists were; `switches` without LIT.
  LightPass(Programs& programs, const std::string& switches, const Texture& atlas, bool sky,
            const Buffer& phases, std::span<const std::uint32_t> places = {})
      : programs_(programs),
        switches_(switches),
        atlas_(atlas),
        sky_(sky),
        phases_(phases),
        places_(places) {}

  void sun_depth(const LightSamples& samples);
  void sky_visibility(const LightSamples& samples);  // after it, where there is a sky
  void clear_samples(const LightSamples& samples);   // last

 private:
  using List = std::vector<std::uint32_t> (LightSamples::*)(std::size_t, std::size_t) const;
  void run(const Program& program, const LightSamples& samples, List list, int entries_each = 1);
  const Program& copy();

  Programs& programs_;
  std::string switches_;
  const Texture& atlas_;
  bool sky_;
  const Buffer& phases_;
  std::span<const std::uint32_t> places_;
};

}  // namespace nepho::gl
