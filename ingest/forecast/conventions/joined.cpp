// Several files that hold times of one forecast, such as one wrfout a file.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "forecast/conventions/convention.h"
#include "forecast/files/time_order.h"

namespace nepho::forecast {
namespace {

struct Place {
  const Forecast* part;
  std::size_t time;  // of the part
};

class JoinedForecast : public Forecast {
 public:
  explicit JoinedForecast(std::vector<std::unique_ptr<Forecast>> parts) : parts_(std::move(parts)) {
    std::vector<Place> states;
    std::vector<std::int64_t> utc_ns;
    for (const auto& part : parts_)
      for (std::size_t t = 0; t < part->times_s().size(); ++t) {
        states.push_back({part.get(), t});
        utc_ns.push_back(part->time_origin_ns() + std::llround(part->times_s()[t] * 1e9));
      }
    // Of two states of one time the later file's stays. Files may be given in any order.
    const TimeOrder order = order_times(utc_ns);
    origin_ns_ = utc_ns[order.state.front()];
    for (const std::size_t i : order.state) {
      times_s_.push_back(double(utc_ns[i] - origin_ns_) / 1e9);
      places_.push_back(states[i]);
    }
    facts_.push_back(std::to_string(parts_.size()) + " files are one forecast of " +
                     std::to_string(places_.size()) + " times.");
    std::ranges::copy_if(order.facts, std::back_inserter(facts_), [](const std::string& fact) {
      return fact.find("not in order") == std::string::npos;
    });
    find_first_with_data();
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
  double liquid_radius_m() const override { return first().liquid_radius_m(); }
  std::vector<std::string> assumptions() const override { return first().assumptions(); }
  std::vector<DataFacts::Recognised> recognised() const override { return first().recognised(); }
  std::vector<std::string> facts() const override {
    std::vector<std::string> facts = first().facts();
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
  // The earliest part that has water data speaks for all. Throws Error where there is none.
  void find_first_with_data() {
    const auto has_data = [](const Place& place) { return place.part->has_data(); };
    const auto found = std::ranges::find_if(places_, has_data);
    if (found == places_.end())
      throw Error({"all values of the cloud water are missing",
                   std::to_string(parts_.size()) + " files", "numbers",
                   "fill values or NaN at all times", "write the files again"});
    first_ = std::size_t(found - places_.begin());
    std::string empty;
    for (std::size_t i = 0; i < places_.size(); ++i)
      if (!has_data(places_[i]))
        empty +=
            (empty.empty() ? "" : ", ") + time_text(origin_ns_ + std::llround(times_s_[i] * 1e9));
    if (!empty.empty()) facts_.push_back("Fill values only, and clear: " + empty + ".");
  }
  const Forecast& first() const { return *places_[first_].part; }
  const Place& at(std::size_t time) const { return places_.at(time); }

  std::vector<std::unique_ptr<Forecast>> parts_;
  std::vector<Place> places_;
  std::int64_t origin_ns_ = 0;
  std::size_t first_ = 0;
  std::vector<double> times_s_;
  std::vector<std::string> facts_;
};

}  // namespace

std::unique_ptr<Forecast> join_forecasts(std::vector<std::unique_ptr<Forecast>> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<JoinedForecast>(std::move(parts));
}

}  // namespace nepho::forecast
