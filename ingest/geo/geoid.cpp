#include "geo/geoid.h"

#include <cmath>
#include <memory>
#include <mutex>

#include "core/error.h"

#ifdef NEPHO_HAS_PROJ
#include <proj.h>
#endif

namespace nepho {

#ifdef NEPHO_HAS_PROJ

GeoidHeight egm96_m() {
  struct Grid {
    PJ_CONTEXT* context = proj_context_create();
    PJ* shift = nullptr;
    std::mutex mutex;
    ~Grid() {
      proj_destroy(shift);
      proj_context_destroy(context);
    }
  };
  const auto grid = std::make_shared<Grid>();
  proj_log_level(grid->context, PJ_LOG_NONE);
  proj_context_set_enable_network(grid->context, 0);
  // Heights over the geoid to heights over the ellipsoid.
  grid->shift = proj_create(grid->context, "+proj=vgridshift +grids=egm96_15.gtx +multiplier=1");
  const auto height_m = [grid](glm::dvec2 lat_lon_deg) {
    const double longitude = std::remainder(lat_lon_deg.y, 360.0);
    const std::lock_guard lock(grid->mutex);
    proj_errno_reset(grid->shift);
    return proj_trans(grid->shift, PJ_FWD,
                      proj_coord(proj_torad(longitude), proj_torad(lat_lon_deg.x), 0, 0))
        .xyz.z;
  };
  if (!grid->shift || !std::isfinite(height_m({0, 0})))
    throw Error({"the geoid is not installed", "parameter 'geoid'", "PROJ's grid egm96_15.gtx",
                 "none", "install proj-data, or leave the parameter out"});
  return height_m;
}

#else

GeoidHeight egm96_m() {
  throw Error({"this build has no PROJ", "parameter 'geoid'", "none", "egm96",
               "build it with libproj-dev, or leave the parameter out"});
}

#endif

}  // namespace nepho
