#pragma once

#include <optional>

#include "bench/chart.h"
#include "bench/run.h"

namespace nepho::bench {

// Error against run time of one scene's settings: GPU time where it is known, else process CPU
// time of a frame; the error that the settings are judged by (judged_by), withheld ones left out.
// Colours are the first axis where several vary. Absent where every error is withheld.
struct Pareto {
  Chart chart;
  std::vector<std::size_t> settings;  // of the chart's points, in their order
  std::vector<std::size_t> front;     // indices of settings, cheapest first
};
std::optional<Pareto> pareto_of(const SceneResult& scene);

// What the cheap and the accurate end of the front owe most of their error to, in sentences.
std::string lesson_of(const SceneResult& scene, const Pareto& pareto);

}  // namespace nepho::bench
