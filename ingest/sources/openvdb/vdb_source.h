#pragma once

#include <memory>

#include "api/source_module.h"
#include "bricks/brick_source.h"

namespace nepho::vdb {

// A .vdb file or sequence as bricks. Finest samples are the file's active values times the density
// scale, bit for bit before quantisation; everything else is 0. They are served from the file's own
// tree, never copied. Frames are loaded when asked for; the two last used are kept.
std::unique_ptr<BrickSource> open_source(const SourceRequest& request);

}  // namespace nepho::vdb
