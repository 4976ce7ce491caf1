// Domains that are drawn together: nests, or forecasts of any models at one place.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <set>

#include "core/error.h"
#include "forecast/conventions/convention.h"
#include "forecast/grids/cell_size.h"
#include "geo/place.h"

namespace nepho::forecast {
namespace {

constexpr double kSameWidth = 0.02;      // of cells of one domain
constexpr double kSamePlace_rad = 1e-6;  // 6 m: coordinates in float

struct Domain {
  std::vector<NamedForecast> parts;
  double width_m = 0;
  std::unique_ptr<Forecast> forecast;  // of the joined parts
  std::string name() const {
    return parts.size() == 1 ? parts.front().name : parts.front().name + " and others";
  }
};

std::set<std::int64_t> utc_of(const Forecast& forecast) {
  std::set<std::int64_t> utc;
  for (const double time_s : forecast.times_s())
    utc.insert(forecast.time_origin_ns() + std::llround(time_s * 1e9));
  return utc;
}

bool any_common(const std::set<std::int64_t>& a, const std::set<std::int64_t>& b) {
  return std::ranges::any_of(a, [&](std::int64_t ns) { return b.contains(ns); });
}

bool same_place(const HorizontalGrid& a, const HorizontalGrid& b) {
  if (a.nx() != b.nx() || a.ny() != b.ny()) return false;
  for (const double x : {0.0, 0.5, 1.0})
    for (const double y : {0.0, 0.5, 1.0}) {
      const glm::dvec2 p = a.lat_lon_deg(x * a.nx(), y * a.ny()),
                       q = b.lat_lon_deg(x * b.nx(), y * b.ny());
      if (std::isnan(p.x) && std::isnan(q.x)) continue;
      if (!(glm::length(unit_vector(p) - unit_vector(q)) < kSamePlace_rad)) return false;
    }
  return true;
}

bool belongs(const NamedForecast& part, double width_m, const Domain& domain) {
  if (std::abs(width_m / domain.width_m - 1) > kSameWidth) return false;
  const auto utc = utc_of(*part.forecast);
  return std::ranges::all_of(domain.parts, [&](const NamedForecast& other) {
    return same_place(*part.forecast->grid(0), *other.forecast->grid(0)) ||
           !any_common(utc, utc_of(*other.forecast));
  });
}

std::string span_of_time(double s) {
  char text[40];
  std::snprintf(text, sizeof text, std::abs(s) < 5400 ? "%.3g min" : "%.3g h",
                std::abs(s) < 5400 ? std::abs(s) / 60 : std::abs(s) / 3600);
  return text;
}

class NestedForecast : public Forecast {
 public:
  explicit NestedForecast(std::vector<Domain> domains) : domains_(std::move(domains)) {
    std::set<std::int64_t> all;
    for (Domain& domain : domains_) {
      utc_ns_.emplace_back();
      for (const std::int64_t ns : utc_of(*domain.forecast)) {
        all.insert(ns);
        if (!utc_ns_.back().empty())
          longest_step_ns_ = std::max(longest_step_ns_, ns - utc_ns_.back().back());
        utc_ns_.back().push_back(ns);
      }
    }
    origin_ns_ = *all.begin();
    for (const std::int64_t ns : all) {
      all_ns_.push_back(ns);
      times_s_.push_back(double(ns - origin_ns_) / 1e9);
    }
    say();
  }

  std::int64_t time_origin_ns() const override { return origin_ns_; }
  const std::vector<double>& times_s() const override { return times_s_; }
  bool has_ice() const override {
    return std::ranges::any_of(domains_, [](const Domain& d) { return d.forecast->has_ice(); });
  }
  std::vector<DomainTime> domains(std::size_t time) const override {
    std::vector<DomainTime> drawn;
    for (std::size_t n = 0; n < domains_.size(); ++n)
      if (const auto at = nearest(n, all_ns_.at(time)))
        drawn.push_back({domains_[n].forecast.get(), *at});
    return drawn;
  }
  std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const override {
    const DomainTime first = domains(time).front();
    return first.domain->grid(first.time);
  }
  ForecastColumns columns(std::size_t time) const override {
    const DomainTime first = domains(time).front();
    return first.domain->columns(first.time);
  }
  ForecastGround ground(std::size_t time) const override {
    const DomainTime first = domains(time).front();
    return first.domain->ground(first.time);
  }
  glm::dvec2 height_range_m() const override {
    glm::dvec2 range = domains_.front().forecast->height_range_m();
    for (const Domain& domain : domains_) {
      const glm::dvec2 own = domain.forecast->height_range_m();
      range = {std::min(range.x, own.x), std::max(range.y, own.y)};
    }
    return range;
  }
  double thinnest_layer_m() const override {
    double thinnest = 1e30;
    for (const Domain& domain : domains_)
      thinnest = std::min(thinnest, domain.forecast->thinnest_layer_m());
    return thinnest;
  }
  // One phase for the volume: the finest domain's.
  double liquid_radius_m() const override { return domains_.front().forecast->liquid_radius_m(); }
  std::vector<std::string> assumptions() const override;
  std::vector<std::string> facts() const override;
  std::vector<VariableBytes> bytes_read() const override {
    std::vector<VariableBytes> all;
    for (const Domain& domain : domains_)
      for (VariableBytes& bytes : domain.forecast->bytes_read()) all.push_back(std::move(bytes));
    return all;
  }

 private:
  void say();

  // Of a domain's own times; none where it has nothing near enough.
  std::optional<std::size_t> nearest(std::size_t domain, std::int64_t ns) const {
    const std::vector<std::int64_t>& own = utc_ns_[domain];
    const auto apart = [&](std::int64_t other) { return std::abs(other - ns); };
    const auto at = std::ranges::min_element(own, {}, apart);
#ifndef NEPHO_MUTANT_ALWAYS_NEAREST
    if (own.size() > 1 && 2 * apart(*at) > longest_step_ns_) return {};
#endif
    return std::size_t(at - own.begin());
  }

  std::vector<Domain> domains_;                    // finest first
  std::vector<std::vector<std::int64_t>> utc_ns_;  // of each
  std::int64_t longest_step_ns_ = 0, origin_ns_ = 0;
  std::vector<std::int64_t> all_ns_;
  std::vector<double> times_s_;
  std::vector<std::string> facts_;
};

void NestedForecast::say() {
  std::string list;
  for (const Domain& domain : domains_) {
    char text[300];
    std::snprintf(text, sizeof text, "%s%s (cells of %.4g km, %zu times)",
                  list.empty() ? "" : " over ", domain.name().c_str(), domain.width_m / 1000,
                  domain.forecast->times_s().size());
    list += text;
  }
  facts_.push_back("Domains: " + list +
                   ". Where a finer one has cells, coarser ones are cut away.");
  for (std::size_t n = 0; n < domains_.size(); ++n) {
    std::int64_t farthest_ns = 0;
    std::size_t absent = 0;
    for (const std::int64_t ns : all_ns_) {
      if (const auto at = nearest(n, ns))
        farthest_ns = std::max(farthest_ns, std::abs(utc_ns_[n][*at] - ns));
      else
        ++absent;
    }
    if (farthest_ns > 0)
      facts_.push_back(domains_[n].name() + " is drawn at its nearest time, up to " +
                       span_of_time(double(farthest_ns) * 1e-9) + " off.");
    if (absent > 0)
      facts_.push_back(domains_[n].name() + " has nothing near " + std::to_string(absent) + " of " +
                       std::to_string(all_ns_.size()) + " times: it is left out there.");
  }
}

// What all domains say is said once; else with the domain's name.
std::vector<std::string> merged(const std::vector<Domain>& domains,
                                std::vector<std::string> (Forecast::*said)() const) {
  std::vector<std::string> all;
  std::map<std::string, std::size_t> count;
  for (const Domain& domain : domains)
    for (const std::string& text : (domain.forecast.get()->*said)()) ++count[text];
  std::set<std::string> done;
  for (const Domain& domain : domains)
    for (const std::string& text : (domain.forecast.get()->*said)()) {
      const bool by_all = count[text] == domains.size();
      if (!by_all)
        all.push_back(domain.name() + ": " + text);
      else if (done.insert(text).second)
        all.push_back(text);
    }
  return all;
}

std::vector<std::string> NestedForecast::assumptions() const {
  std::vector<std::string> all = merged(domains_, &Forecast::assumptions);
  all.push_back("Droplets of all domains scatter as those of " + domains_.front().name() + ".");
  return all;
}

std::vector<std::string> NestedForecast::facts() const {
  std::vector<std::string> all = facts_;
  for (std::string& text : merged(domains_, &Forecast::facts)) all.push_back(std::move(text));
  return all;
}

}  // namespace

std::unique_ptr<Forecast> nest_forecasts(std::vector<NamedForecast> parts) {
  std::vector<Domain> domains;
  for (NamedForecast& part : parts) {
    const double width_m = cell_width_m(*part.forecast->grid(0));
    const auto own = std::ranges::find_if(
        domains, [&](const Domain& domain) { return belongs(part, width_m, domain); });
    Domain& domain = own != domains.end() ? *own : domains.emplace_back();
    if (domain.parts.empty()) domain.width_m = width_m;
    domain.parts.push_back(std::move(part));
  }
  for (Domain& domain : domains) {
    std::vector<std::unique_ptr<Forecast>> of_domain;
    for (NamedForecast& part : domain.parts) of_domain.push_back(std::move(part.forecast));
    domain.forecast = join_forecasts(std::move(of_domain));
  }
  if (domains.size() == 1) return std::move(domains.front().forecast);
  // Of equals the first file is on top.
  std::ranges::stable_sort(domains, {}, &Domain::width_m);
  return std::make_unique<NestedForecast>(std::move(domains));
}

}  // namespace nepho::forecast
