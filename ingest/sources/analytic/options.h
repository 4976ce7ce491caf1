#pragma once

#include <optional>
#include <string>

#include "api/module_support.h"
#include "bricks/volume_info.h"
#include "sources/analytic/kinds.h"

namespace nepho::analytic {

// The volume that a request asks for: its info (chart, lattice, phase) and its field.
struct Volume {
  VolumeInfo info;
  std::unique_ptr<Kind> kind;
};

// Throws Error on unknown, mistyped, missing or senseless parameters.
Volume make_volume(const SourceRequest& request);

}  // namespace nepho::analytic
