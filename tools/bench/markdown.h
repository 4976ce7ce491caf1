#pragma once

#include <string>

#include "bench/run.h"

namespace nepho::bench {

// One scene's settings as a table in Markdown: times, RMSE of the 8-bit picture against the first
// setting's (as Mulen's Table 6.1 has it) and against the finest march, and the parts of the error.
// What does not vary is left out. Below it: what the references are, and why numbers are missing.
std::string markdown_of(const SceneResult& scene);

}  // namespace nepho::bench
