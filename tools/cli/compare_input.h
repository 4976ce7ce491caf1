#pragma once

#include <optional>
#include <string>

#include "cli/commands.h"
#include "image/picture_file.h"
#include "renderer.h"
#include "scene/scene.h"

namespace nepho {

// How linear light becomes an 8-bit picture (image/tone.h), and who said so.
struct Display {
  double exposure_ev = 0;
  ToneMap tone_map = ToneMap::kAces;
  glm::dvec3 white{1};
  bool dither = false;
  std::string from;
};

// Two pictures of one size and one meaning.
struct ComparedPair {
  // Linear light; of 8-bit pictures that of the display, where A or B is one.
  HdrImage picture, truth;
  ByteImage picture_shown, truth_shown;  // shown alike
  bool linear = false;                   // both were
  bool has_depth = false;                // the truth says where its cloud is
  std::optional<Display> display;        // absent: both were 8-bit already
  std::string note;                      // what the numbers cannot say
};

// Reads both. Linear pictures are shown as B's scene says, else A's, else at the exposure that
// render would find for B; --exposure and --tone-map come before all of these. A linear picture and
// an 8-bit one are compared in 8 bits, as the latter's scene or the options say it was shown;
// where neither does, and where the sizes differ: Error.
ComparedPair read_pair(const CompareOptions& options, const PictureFiles& pictures);

}  // namespace nepho
