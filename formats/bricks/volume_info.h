#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bricks/chart.h"
#include "bricks/lattice.h"
#include "bricks/surface_map.h"

namespace nepho {

enum class Channel : std::uint8_t { kExtinction = 0, kIceExtinction = 1, kTemperature = 2 };

struct ChannelInfo {
  Channel channel = Channel::kExtinction;
  std::string name = "extinction", unit = "m-1";
  int code_bits = 16;        // 16, or 8 with one scale for all bricks
  double max_abs_error = 0;  // largest over all bricks, in `unit`
};

// What a sample of the finest level is (lattice.md 2): a mean over its hat, or the field's value.
enum class SampleKind : std::uint8_t { kHat, kPoint };

enum class PhaseKind : std::uint8_t { kMie, kHenyeyGreenstein, kHgDraine };
struct Phase {
  PhaseKind kind = PhaseKind::kMie;
  double effective_radius_m = 10e-6;  // Mie, and its fit by HG + Draine
  double asymmetry = 0.85;            // Henyey-Greenstein
};

// The part of the world that can hold extinction: root coordinates of one root (BoxChart), or the
// whole of every root (ShellChart).
struct DataBounds {
  glm::dvec3 low{0.0}, high{1.0};
};

struct VolumeInfo {
  std::string name;
  std::shared_ptr<const Chart> chart;
  Lattice lattice{{}};
  SampleKind finest = SampleKind::kPoint;
  std::vector<ChannelInfo> channels{ChannelInfo{}};
  std::int64_t time_origin_ns = 0;  // since 1970-01-01T00:00:00 UTC
  std::vector<double> times_s{
      0.0};  // since the origin, ascending; read and summary take only these
  DataBounds bounds;
  glm::dvec3 co_albedo{0.0};  // 1 - single scattering albedo at 650, 550, 450 nm
  Phase phase;
  // Of the part that is ice (channel kIceExtinction), where there is one. Rough aggregates.
  Phase ice_phase{PhaseKind::kHenyeyGreenstein, 30e-6, 0.75};
  // Weather of a planet: a picture of it wants the planet's ground and air, unless the scene says
  // otherwise.
  bool on_planet = false;
  // Error bounds hold for whatever may lie below a node, which is far above what does (noise: each
  // octave left out at its largest). Trees are refined by the unresolved variance instead.
  bool refine_by_variance = false;
  std::shared_ptr<const SurfaceMap> surface;  // null: the data have no ground
  std::uint64_t source_bytes = 0;             // memory that the source itself holds
  std::vector<std::string> assumptions;       // one sentence each: what was not in the data
  std::vector<std::string> facts;             // one sentence each: counts, ranges, what was clamped
};

}  // namespace nepho
