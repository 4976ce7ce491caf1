#pragma once

#include "pyramid/sparse_pyramid.h"

namespace nepho {

// The two verbs of a source whose only channel, extinction, is one pyramid: checks the request,
// quantises, and lets nothing throw out.
Status serve_summary(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key,
                     double time_s, NodeSummary& summary) noexcept;
Status serve_read(const VolumeInfo& info, const SparsePyramid& pyramid, NodeKey key, double time_s,
                  BrickView brick) noexcept;

// What quantisation may add to any brick's sample (VolumeInfo::channels[0].max_abs_error).
double largest_code_error(const SparsePyramid& pyramid, int roots);

}  // namespace nepho
