// Domains that are drawn together: each place is one domain's alone, and nothing shows where they
// meet.

#include <gtest/gtest.h>

#include "accuracy_report.h"
#include "made_source.h"
#include "nests.h"

namespace nepho::test {
namespace {

constexpr double kFog_per_m = 2e-4;

// A layer of one value from 1 to 3 km, or blobs, on a grid.
std::shared_ptr<SyntheticForecast> domain(std::shared_ptr<const HorizontalGrid> cells, bool fog) {
  auto f = std::make_shared<SyntheticForecast>();
  f->cells = std::move(cells);
  f->nz = 16;
  f->level_m = [](double t) { return 8000 * t; };
  if (fog)
    f->extinction_per_m = [](glm::dvec2, double z, double) {
      return z > 1000 && z < 3000 ? kFog_per_m : 0.0;
    };
  else
    f->extinction_per_m = [](glm::dvec2 p, double z, double) { return blobs(p, z, 0.6); };
  return f;
}

// Three domains, none of whose walls lie on another's; the middle one turned.
struct Nest final : forecast::Forecast {
  std::vector<std::shared_ptr<SyntheticForecast>> parts;  // finest first

  explicit Nest(bool fog) {
    const glm::dvec2 middle(24.1, -88.2);
    parts = {domain(std::make_shared<MercatorGrid>(22, 18, middle, 0.05), fog),
             domain(std::make_shared<RotatedGrid>(16, 17, glm::dvec2(24.3, -88), 20, 0.15), fog),
             domain(std::make_shared<MercatorGrid>(14, 13, glm::dvec2(24, -88), 0.4), fog)};
  }
  std::int64_t time_origin_ns() const override { return 0; }
  const std::vector<double>& times_s() const override { return parts[0]->times_s(); }
  bool has_ice() const override { return false; }
  std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const override {
    return parts[0]->grid(time);
  }
  forecast::ForecastColumns columns(std::size_t time) const override {
    return parts[0]->columns(time);
  }
  forecast::ForecastGround ground(std::size_t time) const override {
    return parts[0]->ground(time);
  }
  std::vector<forecast::DomainTime> domains(std::size_t time) const override {
    std::vector<forecast::DomainTime> all;
    for (const auto& part : parts) all.push_back({part.get(), time});
    return all;
  }
  glm::dvec2 height_range_m() const override { return parts[0]->height_range_m(); }
  double thinnest_layer_m() const override { return parts[0]->thinnest_layer_m(); }
  double liquid_radius_m() const override { return 10e-6; }
  std::vector<std::string> assumptions() const override { return {}; }
  std::vector<std::string> facts() const override { return {}; }
};

TEST(Nests, EvenFogOfThreeDomainsHasNoSeam) {
  const double seam = Together(std::make_shared<Nest>(true)).worst_seam(kFog_per_m);
  report_accuracy("netcdf", "an even layer in three nests, farthest sample from it", seam, 1e-5,
                  "1");
  EXPECT_LT(seam, 1e-5);
}

TEST(Nests, TotalIsTheFilesWithoutWhatIsCovered) {
  const Together nests(std::make_shared<Nest>(false));
  const double drift = std::abs(nests.all().total() / nests.files_total() - 1);
  report_accuracy("netcdf", "optical depth of three nests, finest bricks against the files'", drift,
                  2e-3, "1");
  EXPECT_LT(drift, 2e-3);
}

// Cells of a fine domain without data leave their place to the coarse one: no gap.
TEST(Nests, CellsWithoutDataCoverNothing) {
  const auto make_holes = [](std::vector<forecast::ForecastColumns>& columns) {
    for (forecast::ForecastColumns& c : columns) {
      if (&c == &columns.back()) break;
      c.without_data.assign(std::size_t(c.nx) * std::size_t(c.ny), 0);
      for (std::size_t cell = 0; cell < c.without_data.size(); ++cell) {
        if (cell % std::size_t(c.nx) + cell / std::size_t(c.nx) > 12 && cell % 7) continue;
        c.without_data[cell] = 1;
        std::fill_n(c.extinction_per_m.begin() + std::ptrdiff_t(cell) * c.nz, c.nz, 0.0f);
      }
    }
  };
  EXPECT_LT(Together(std::make_shared<Nest>(true), 0, make_holes).worst_seam(kFog_per_m), 1e-5);
  const Together holed(std::make_shared<Nest>(false), 0, make_holes);
  EXPECT_LT(std::abs(holed.all().total() / holed.files_total() - 1), 2e-3);
}

// The source's own field is that of the finest domain at a place.
TEST(Nests, PointsAreTheFinestDomains) {
  auto nest = std::make_shared<Nest>(true);
  for (std::size_t d = 0; d < 3; ++d)
    nest->parts[d]->extinction_per_m = [d](glm::dvec2, double z, double) {
      return z > 1000 && z < 3000 ? 1e-4 * double(d + 1) : 0.0;
    };
  const auto source = made_source(nest);
  const auto at = [&](double lat, double lon) {
    double value = -1;
    source->point_extinction_per_m(
        geodetic_to_ecef_m(Ellipsoid::wgs84(), lat * kDegree, lon * kDegree, 2000), 0, value);
    return value;
  };
  EXPECT_FLOAT_EQ(float(at(24.1, -88.2)), 1e-4f);
  EXPECT_FLOAT_EQ(float(at(24.9, -87.4)), 2e-4f);
  EXPECT_FLOAT_EQ(float(at(25.8, -86.5)), 3e-4f);
  EXPECT_EQ(at(40, -86.5), 0);
}

}  // namespace
}  // namespace nepho::test
