#pragma once

#include <cstdint>

#include "common/framing.h"
#include "common/open_scene.h"
#include "view/window_module.h"

namespace nepho {

// The sun of a view: where a date puts it over a planet, or wherever the user does.
class ViewSun {
 public:
  explicit ViewSun(const OpenedScene& opened);

  // By a date its light is that of its distance then, unless the scene says what it is.
  const Sun& sun() const { return sun_; }
  // The data are of that date now: a sun that stands by a date goes along.
  void follow(std::int64_t utc_ns);
  // `at`: where angles are told.
  void fill(Panel& panel, const LocalAxes& at) const;
  // What differs from `before`. Throws Error for a date that is none; nothing is changed then.
  void apply(const Panel& panel, const Panel& before, const LocalAxes& at);

 private:
  void stand(std::int64_t utc_ns);

  Sun sun_;
  bool planet_, dated_;
  std::int64_t utc_ns_;
  double distance_au_;  // 0: not to be changed
};

}  // namespace nepho
