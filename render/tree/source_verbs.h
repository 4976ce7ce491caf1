#pragma once

#include "bricks/brick_source.h"
#include "tree/forest.h"

namespace nepho {

// Throws Error with the source's own text. Call it on the thread on which the verb failed.
void throw_on_failure(Status status, const BrickSource& source, const char* verb, NodeKey key);

// Whether a volume tells ice apart.
bool has_ice(const VolumeInfo& info);

// Extinction of one node, and its ice where there is some, or Error.
void read_brick(const BrickSource& source, double time_s, NodeKey key, LeafBrick& brick);

}  // namespace nepho
