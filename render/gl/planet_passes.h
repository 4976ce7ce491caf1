#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gl/object.h"
#include "gl/pixel_plan.h"
#include "gl/planet_data.h"
#include "gl/programs.h"

namespace nepho::gl {

// A planet's textures, buffer and passes. Made only where a scene has one.
class PlanetPasses {
 public:
  PlanetPasses(const RenderRequest& request, const Forest& forest);

  // Lines of #define for all passes.
  std::string defines() const;
  const PlanetScene& scene() const { return scene_; }
  void upload();
  // What the clouds leave of the sun, for the air; `switches` as for the light passes.
  void draw_sun_map(Programs& programs, const std::string& switches);
  // In the last component of each pixel's, row 0 first.
  std::vector<PixelTexel> ground_distances(Programs& programs, const std::string& switches);
  void add_to(RenderReport& report) const;
  // As uploaded; null without air.
  std::shared_ptr<const AirTables> tables() const { return tables_; }

 private:
  const RenderRequest& request_;
  PlanetScene scene_;
  std::shared_ptr<const AirTables> tables_;
  Buffer data_;
  Texture depth_, light_, surface_, sun_map_, met_;
  std::uint64_t table_bytes_ = 0, surface_bytes_ = 0, map_bytes_ = 0, met_bytes_ = 0;
};

}  // namespace nepho::gl
