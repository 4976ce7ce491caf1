#include "geo/proj_map.h"

#include <cmath>

#include "core/error.h"

#ifdef NEPHO_HAS_PROJ
#include <proj.h>

#include <mutex>
#include <vector>
#endif

namespace nepho {

#ifdef NEPHO_HAS_PROJ
namespace {

// A transformation belongs to one thread at a time: each takes one of a pool, or a copy.
struct Transform {
  PJ_CONTEXT* context = proj_context_create();
  PJ* pj = nullptr;

  Transform() {
    proj_log_level(context, PJ_LOG_NONE);
    proj_context_set_enable_network(context, 0);
  }
  ~Transform() {
    proj_destroy(pj);
    proj_context_destroy(context);
  }
  Transform(const Transform&) = delete;
  Transform& operator=(const Transform&) = delete;

  // From longitude and latitude of the system's own datum to the map.
  void open(const std::string& crs) {
    PJ* made = proj_create(context, crs.c_str());
    if (!made || !proj_is_crs(made)) {
      pj = made;
      return;
    }
    PJ* geodetic = proj_crs_get_geodetic_crs(context, made);
    PJ* way = geodetic ? proj_create_crs_to_crs_from_pj(context, geodetic, made, nullptr, nullptr)
                       : nullptr;
    pj = way ? proj_normalize_for_visualization(context, way) : nullptr;
    proj_destroy(way);
    proj_destroy(geodetic);
    proj_destroy(made);
  }
};

class ProjMap : public MapFormula {
 public:
  ProjMap(const std::string& crs, const std::string& where) {
    auto first = std::make_unique<Transform>();
    first->open(crs);
    if (!first->pj)
      throw Error({"PROJ does not understand this map", where, "a map that PROJ knows",
                   "\"" + crs.substr(0, 200) + "\"",
                   "fields of latitude and longitude would do instead"});
    pool_.push_back(std::move(first));
  }
  glm::dvec2 map_m(glm::dvec2 place) const override {
    return transformed({place.y, place.x}, PJ_FWD);
  }
  glm::dvec2 lat_lon_deg(glm::dvec2 m) const override {
    const glm::dvec2 lon_lat = transformed(m, PJ_INV);
    return {lon_lat.y, lon_lat.x};
  }

 private:
  glm::dvec2 transformed(glm::dvec2 from, PJ_DIRECTION direction) const {
    std::unique_ptr<Transform> mine;
    {
      const std::lock_guard lock(mutex_);
      if (pool_.size() > 1) {
        mine = std::move(pool_.back());
        pool_.pop_back();
      } else {  // the first is never lent
        mine = std::make_unique<Transform>();
        mine->pj = proj_clone(mine->context, pool_.front()->pj);
      }
    }
    if (proj_angular_input(mine->pj, direction)) from = {proj_torad(from.x), proj_torad(from.y)};
    proj_errno_reset(mine->pj);
    const PJ_COORD at = proj_trans(mine->pj, direction, proj_coord(from.x, from.y, 0, 0));
    glm::dvec2 to = {at.xy.x, at.xy.y};
    if (proj_angular_output(mine->pj, direction)) to = {proj_todeg(to.x), proj_todeg(to.y)};
    {
      const std::lock_guard lock(mutex_);
      pool_.push_back(std::move(mine));
    }
    return std::isfinite(to.x) && std::isfinite(to.y) ? to : glm::dvec2(NAN);
  }

  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Transform>> pool_;
};

}  // namespace

MapProjection proj_map(const std::string& crs, const std::string& where) {
  return MapProjection(std::make_shared<ProjMap>(crs, where));
}

#else

MapProjection proj_map(const std::string& crs, const std::string& where) {
  throw Error({"this build has no PROJ", where, "a map that needs no PROJ",
               "\"" + crs.substr(0, 200) + "\"",
               "build with libproj-dev, or give fields of latitude and longitude"});
}

#endif

}  // namespace nepho
