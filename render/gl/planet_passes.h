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
  // No OpenGL yet. `tables`: of this planet's air; null: made by upload(), 0.2 CPU s.
  PlanetPasses(const RenderRequest& request, const Forest& forest,
               std::shared_ptr<const AirTables> tables = nullptr);

  // Lines of #define for all passes.
  std::string defines() const;
  const PlanetScene& scene() const { return scene_; }
  // Those of `last` that are the same are used again; null: all are new.
  void upload(const PlanetPasses* last = nullptr);
  // All is bound again: for a renderer with more than one of these.
  void bind() const;
  // What the clouds leave of the sun, for the air; `switches` as for the light passes. In parts, so
  // that no frame waits for all of it.
  int sun_map_parts() const;
  void draw_sun_map_part(Programs& programs, const std::string& switches, int part);
  // In the last component of each pixel's, row 0 first. The frame that is bound is of that size.
  std::vector<PixelTexel> ground_distances(Programs& programs, const std::string& switches,
                                           int width, int height);
  void add_to(RenderReport& report) const;
  // As uploaded; null without air.
  std::shared_ptr<const AirTables> tables() const { return tables_; }

  std::uint64_t gpu_bytes() const { return surface_bytes_ + table_bytes_ + map_bytes_; }

 private:
  void upload_tables(const PlanetPasses* last);
  void upload_surface(const PlanetPasses* last);

  const RenderRequest& request_;
  PlanetScene scene_;
  std::shared_ptr<const AirTables> tables_;
  Buffer data_;
  std::shared_ptr<const Texture> depth_, light_, surface_;
  Texture sun_map_, met_;
  int met_width_ = 0, met_height_ = 0;
  std::uint64_t table_bytes_ = 0, surface_bytes_ = 0, map_bytes_ = 0, met_bytes_ = 0;
};

}  // namespace nepho::gl
