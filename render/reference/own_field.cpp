#include "reference/own_field.h"

#include <stdexcept>
#include <string>

#include "core/error.h"

namespace nepho {
namespace {

[[noreturn]] void refuse(Status status, const BrickSource& source) {
  const std::string where = "volume '" + source.info().name + "'";
  if (status == Status::kUnsupported)
    throw Error({"the source has no field of its own", where, "", "bricks alone", ""});
  char text[512] = "";
  source.last_error(text, sizeof text);
  throw Error({std::string("a source failed to tell its field: ") + to_string(status), where, "",
               text, ""});
}

}  // namespace

OwnField::OwnField(const LevelSet& bricks, std::span<const RenderVolume> volumes, int steps)
    : bricks_(bricks), volumes_(volumes), steps_(steps) {
  if (steps < 1 || volumes.size() != bricks.size())
    throw std::invalid_argument("OwnField: no steps, or other volumes");
  for (std::size_t v = 0; v < volumes.size(); ++v)
    own_extinction_per_m(v, {0, glm::dvec3{0.5}});  // or it throws
}

double OwnField::own_extinction_per_m(std::size_t volume, const RootPosition& at) const {
  const BrickSource& source = *volumes_[volume].source;
  double own_per_m = 0;
  const Status status = source.point_extinction_per_m(source.info().chart->ecef_m(at),
                                                      volumes_[volume].time_s, own_per_m);
  if (status != Status::kOk) refuse(status, source);
  return own_per_m;
}

}  // namespace nepho
