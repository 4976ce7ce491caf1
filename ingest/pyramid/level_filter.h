#pragma once

#include <array>

#include "bricks/coarsen.h"
#include "pyramid/sparse_pyramid.h"

namespace nepho {

// The filter of lattice.md 2, one node at a time. A node hands each of its samples' hats, cut at
// the root's ends, to its parent's 9^3 sums; nodes that share a coarse sample then add their sums.
// That is sum(omega V c) over all names, taps in ascending key order; the divisor is the coarse
// hat's volume, which is sum(omega V) by the two-scale relation.

// Per node, so that a shared face counts once: the upper face belongs to the next node.
struct HatWeights {
  std::array<double, kBrickSamples * kBrickSamples> horizontal;
  std::array<double, kBrickSamples> vertical;
};
HatWeights owned_hats(const Chart& chart, const Lattice& lattice, NodeKey key);
// Volumes of the whole hats of a node's samples, all names together.
HatWeights whole_hats(const Chart& chart, const Lattice& lattice, NodeKey key);

// Sums of c and of c^2 + variance, in a parent's 9^3.
struct FilterSums {
  double* mean;
  float* square;
};
// Adds one child's samples (and unresolved variances, null = 0).
void add_child(const double* samples, const float* variance, const HatWeights& hats, SplitMask mask,
               SplitMask octant, FilterSums parent);

// A node's own trilinear field at the 9^3 sample positions of a descendant (or of itself).
void refine(const Lattice& lattice, NodeKey node, const double* samples, NodeKey descendant,
            double* refined);

// The least and the greatest of the samples that refine() would look at.
std::pair<double, double> range_around(const Lattice& lattice, NodeKey node, const double* samples,
                                       NodeKey descendant);

// How far `own` is outside [low, high] at the worst sample; 0 where it is within.
double greatest_gap(const BrickSamples& own, const BrickSamples& low, const BrickSamples& high);

// Samples and unresolved variances of a node whose region is a closed form. A block's filtered
// indicator is separable: hats of hats are hats, so each axis is a sum of an arithmetic series.
void closed_form_samples(const Lattice& lattice, NodeKey key, const SparsePyramid::Region& region,
                         double* samples, float* variance);

}  // namespace nepho
