// Several files that hold times of one forecast, such as one wrfout a file.
#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "forecast/conventions/convention.h"

namespace nepho::forecast {
namespace {

struct Place {
  const Forecast* part;
  std::size_t time;  // of the part
};

class JoinedForecast : public Forecast {
 public:
  explicit JoinedForecast(std::vector<std::unique_ptr<Forecast>> parts) : parts_(std::move(parts)) {
    std::map<std::int64_t, Place> places;  // of two states of one time the later file's stays
    std::size_t states = 0;
    for (const auto& part : parts_)
      for (std::size_t t = 0; t < part->times_s().size(); ++t, ++states)
        places.insert_or_assign(part->time_origin_ns() + std::llround(part->times_s()[t] * 1e9),
                                Place{part.get(), t});
    origin_ns_ = places.begin()->first;
    for (const auto& [ns, place] : places) {
      times_s_.push_back(double(ns - origin_ns_) / 1e9);
      places_.push_back(place);
    }
    if (states > places.size())
      facts_.push_back(std::to_string(states - places.size()) +
                       " times occur twice; the later file's state of each is used.");
  }

  std::int64_t time_origin_ns() const override { return origin_ns_; }
  const std::vector<double>& times_s() const override { return times_s_; }
  bool has_ice() const override {
    return std::ranges::any_of(parts_, [](const auto& part) { return part->has_ice(); });
  }
  std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const override {
    return at(time).part->grid(at(time).time);
  }
  ForecastColumns columns(std::size_t time) const override {
    ForecastColumns columns = at(time).part->columns(at(time).time);
    if (has_ice() && columns.ice_extinction_per_m.empty())
      columns.ice_extinction_per_m.assign(columns.extinction_per_m.size(), 0.0f);
    return columns;
  }
  ForecastGround ground(std::size_t time) const override {
    return at(time).part->ground(at(time).time);
  }
  glm::dvec2 height_range_m() const override {
    glm::dvec2 range = parts_.front()->height_range_m();
    for (const auto& part : parts_) {
      range.x = std::min(range.x, part->height_range_m().x);
      range.y = std::max(range.y, part->height_range_m().y);
    }
    return range;
  }
  double thinnest_layer_m() const override {
    double thinnest = parts_.front()->thinnest_layer_m();
    for (const auto& part : parts_) thinnest = std::min(thinnest, part->thinnest_layer_m());
    return thinnest;
  }
  // One phase for the volume: the first time's, as of one file.
  double liquid_radius_m() const override { return places_.front().part->liquid_radius_m(); }
  std::vector<std::string> assumptions() const override {
    return places_.front().part->assumptions();
  }
  std::vector<std::string> facts() const override {
    std::vector<std::string> facts = places_.front().part->facts();
    facts.insert(facts.end(), facts_.begin(), facts_.end());
    return facts;
  }
  std::vector<VariableBytes> bytes_read() const override {
    std::vector<VariableBytes> all;
    for (const auto& part : parts_)
      for (VariableBytes& bytes : part->bytes_read()) all.push_back(std::move(bytes));
    return all;
  }

 private:
  const Place& at(std::size_t time) const { return places_.at(time); }

  std::vector<std::unique_ptr<Forecast>> parts_;
  std::vector<Place> places_;
  std::int64_t origin_ns_ = 0;
  std::vector<double> times_s_;
  std::vector<std::string> facts_;
};

}  // namespace

std::unique_ptr<Forecast> join_forecasts(std::vector<std::unique_ptr<Forecast>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<JoinedForecast>(std::move(parts));
}

}  // namespace nepho::forecast
