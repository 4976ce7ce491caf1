#pragma once

#include <vector>

#include "bricks/brick_source.h"

namespace nepho {

// Decoded extinction of a brick (1/m), in the order of its samples. Throws Error with the source's
// own text.
std::vector<double> brick_values(const BrickSource& source, NodeKey key, double time_s);
// Sum of extinction times volume over the samples that the node owns (m2).
double brick_sum(const VolumeInfo& info, NodeKey key, const std::vector<double>& values);

// Nodes that may hold extinction, of the finest level that has no more than `most` of them.
std::vector<NodeKey> cloudy_nodes(const BrickSource& source, double time_s, std::size_t most);
// Sum of extinction times volume over such a level's bricks: the same on all levels, as far as the
// source filters (a procedural planet does not, quite).
double total_extinction_m2(const BrickSource& source, double time_s, std::size_t most_bricks);

// What can be said of a source without facts of its own, from the bricks of such a level: optical
// depths along the chart's axis that stands
// upright (the mean is that of cloudy columns), cover of a whole
// planet, base and top over the ellipsoid, or over the frame of a free box. `recognised` names the
// level.
DataFacts brick_facts(const BrickSource& source, double time_s);

}  // namespace nepho
