#pragma once

#include <string>

#include "common/open_scene.h"

namespace nepho {

// A scene by the path tracer: its picture, and what is to be said of it ("error (measured): ...").
// On a terminal it tells how far it is; Ctrl-C keeps what is done. Throws Error.
struct ReferencePicture {
  RenderResult result;  // without estimates of error
  std::string error_line;
};
ReferencePicture draw_reference(const OpenedScene& opened);

}  // namespace nepho
