#pragma once

#include "pyramid/sparse_pyramid.h"

namespace nepho {

// The two verbs of a source whose channels are pyramids: checks the request, quantises, and lets
// nothing throw out.

// Extinction, and its ice part where the volume has the channel kIceExtinction (null: none at all).
struct ServedPyramids {
  const SparsePyramid& extinction;
  const SparsePyramid* ice_extinction = nullptr;
};

// Of the extinction; the ice part, which is nowhere more, adds its error bound, and a node where it
// varies or is not zero is not constant.
Status serve_summary(const VolumeInfo& info, const ServedPyramids& pyramids, NodeKey key,
                     double time_s, NodeSummary& summary) noexcept;
Status serve_read(const VolumeInfo& info, const ServedPyramids& pyramids, NodeKey key,
                  double time_s, BrickView brick) noexcept;

// The same for extinction alone.
Status serve_summary(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key,
                     double time_s, NodeSummary& summary) noexcept;
Status serve_read(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key, double time_s,
                  BrickView brick) noexcept;

// What quantisation may add to any brick's sample (VolumeInfo::channels[0].max_abs_error).
double largest_code_error(const SparsePyramid& pyramid, int roots);

}  // namespace nepho
