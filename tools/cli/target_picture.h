#pragma once

#include <string>

#include "common/open_scene.h"
#include "image/picture_file.h"

namespace nepho {

// Refuses a target of error below what pictures of this format can hold. Throws Error.
void check_target(const PictureTarget& target, const Scene& scene, PictureFormat format);

// The scene's picture with the settings that its target gets: chosen on small pictures, drawn,
// and once again with the next setting where the whole picture misses the target. The choice is
// then the scene's own (`opened.scene.render`), the target is gone from it, and `line` says what
// was chosen and why: "target: error 1 %: ...".
struct TargetPicture {
  RenderResult result;
  std::string line;
};
TargetPicture draw_for_target(OpenedScene& opened);

}  // namespace nepho
