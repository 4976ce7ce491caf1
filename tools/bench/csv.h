#pragma once

#include <string>
#include <vector>

#include "bench/run.h"

namespace nepho::bench {

// RFC 4180, lines end with \n; the first row names each column and its unit: "frame median [s]".
// A number that was withheld is an empty field.

// One row a setting: times (process CPU), and the rms of each term.
std::string settings_csv(const std::vector<SceneResult>& scenes);
// One row a setting and term, with every metric, and why a number is withheld. Then one row a
// volume: the source's own field against its finest bricks, of extinction, over that of the field.
std::string terms_csv(const std::vector<SceneResult>& scenes);
// One row a fit of an order of convergence.
std::string orders_csv(const std::vector<SceneResult>& scenes);

}  // namespace nepho::bench
