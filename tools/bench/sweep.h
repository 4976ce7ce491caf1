#pragma once

#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "scene/scene.h"

namespace nepho::bench {

// The settings of a march that a sweep may change, under the names of render's options.

// "step=0.25,0.5,1,2": one setting and its values, as they were written.
struct Axis {
  std::string name;
  std::vector<std::string> values;
};

// Throws Error: no such setting (lists those that there are), no value, a value twice, or one
// outside of what the setting takes.
Axis parse_axis(const std::string& text);

// One choice of a value on each axis, in the order of the axes.
struct Setting {
  std::vector<std::pair<std::string, std::string>> values;

  std::string label() const;  // "step 0.5, budget-mib 64"; "as the scene says" without any
  std::optional<double> number(const std::string& name) const;  // absent: not set, or a word
  std::string value(const std::string& name) const;             // "": not set
};

// Without what is the same in all of them: a sweep of one value holds it fast.
std::vector<std::string> varied_axes(std::span<const Setting> settings);

inline constexpr std::size_t kMostSettings = 500;

// Every combination, the last axis fastest; without an axis one setting that changes nothing.
// Throws Error where an axis comes twice, where two exclude each other (step and tolerance), where
// one has no effect beside another, and above kMostSettings.
std::vector<Setting> combinations(std::span<const Axis> axes);

// The values were checked by parse_axis.
void lay_over(const Setting& setting, RenderSettings& settings);

// "step (voxels), tolerance, budget-mib (MiB), ...": for messages and --help.
std::string known_settings();
std::string unit_of(const std::string& name);  // "": a number without unit, or a word

}  // namespace nepho::bench
