// NetCDF-4 files in groups: read as the same file without them.

#include <glm/glm.hpp>

#include "cf_twin.h"
#include "forecast/conventions/horizontal.h"
#include "sources/netcdf/groups.h"

namespace nepho::forecast::test {
namespace {

// Extinctions, layers and places of all columns at the twin's second time.
std::vector<double> contents(const std::string& path) {
  const auto forecast = open(path);
  const ForecastColumns c = forecast->columns(1);
  std::vector<double> all(c.extinction_per_m.begin(), c.extinction_per_m.end());
  all.insert(all.end(), c.interface_m.begin(), c.interface_m.end());
  const auto grid = forecast->grid(1);
  for (int j = 0; j < c.ny; ++j)
    for (int i = 0; i < c.nx; ++i) {
      const glm::dvec2 here = grid->lat_lon_deg(i + 0.5, j + 0.5);
      all.insert(all.end(), {here.x, here.y});
    }
  all.push_back(forecast->times_s().at(1));
  return all;
}

class Groups : public testing::Test {
 protected:
  const std::vector<double> flat = contents(CfTwin{}.write("groups_flat"));
};

TEST_F(Groups, FileInAnyGroupsIsTheFlatFile) {
  struct Case {
    const char *name, *dimensions, *axes, *fields;
  };
  for (const Case& c : {Case{"all", "model/", "model/", "model/"},
                        {"fields", "", "", "model/fields/"},
                        {"nested", "grid/", "grid/", "grid/run/fields/"},
                        {"axes", "", "geometry/", "fields/"}}) {
    CfTwin twin;
    twin.dimensions_in = c.dimensions;
    twin.axes_in = c.axes;
    twin.fields_in = c.fields;
    EXPECT_EQ(contents(twin.write(std::string("groups_") + c.name)), flat) << c.name;
  }
}

// Another group's axes of the same names, and other dimensions: each variable keeps to its own.
TEST_F(Groups, NamesAreSoughtInTheirOwnGroupFirst) {
  CfTwin twin;
  twin.axes_in = twin.fields_in = "model/";
  twin.more = [](NcWriter& nc) {
    for (const std::string name : {"lat", "lon", "level", "time"}) {
      nc.dimension("above/" + name, 3);
      nc.variable("above/" + name, NC_DOUBLE, {"above/" + name}, {1, 2, 3},
                  {{"units", std::string(name == "lat" ? "degrees_north" : "degrees_east")}});
    }
    nc.variable("above/height_of_something", NC_FLOAT, {"above/lat", "above/lon"},
                std::vector<double>(9, 7.0), {{"units", std::string("m")}});
  };
  EXPECT_EQ(contents(twin.write("groups_two")), flat);
  twin.dimensions_in = "model/";
  EXPECT_EQ(contents(twin.write("groups_own_dimensions")), flat);
}

// Nothing says which is meant.
TEST_F(Groups, FieldsOfTwoGroupsAreRefusedWithTheCure) {
  struct Rival {
    std::string name, units, standard_name;
  };
  const auto write = [](const std::vector<Rival>& rivals) {
    CfTwin twin;
    twin.fields_in = "first/";
    twin.more = [&rivals](NcWriter& nc) {
      for (const Rival& r : rivals) {
        Attributes attributes = {{"units", r.units}};
        if (!r.standard_name.empty()) attributes["standard_name"] = r.standard_name;
        nc.variable(r.name, NC_FLOAT, {"time", "level", "lat", "lon"},
                    std::vector<double>(2 * 4 * 5 * 6, 1e-4), attributes);
      }
    };
    return twin.write("groups_rivals");
  };
  const auto is_refused = [&](const std::vector<Rival>& rivals, const std::string& a,
                              const std::string& b) {
    const std::string said = refusal(write(rivals));
    for (const std::string& part : {std::string("two groups"), std::string("--names"), a, b})
      EXPECT_NE(said.find(part), std::string::npos) << part << " in: " << said;
  };
  is_refused({{"second/clw", "kg kg-1", ""}}, "first/clw", "second/clw");
  is_refused({{"second/t", "K", ""}}, "first/t", "second/t");
  const std::string liquid = "mass_fraction_of_cloud_liquid_water_in_air";
  is_refused({{"second/water", "kg kg-1", liquid}, {"third/liquid", "kg kg-1", liquid}}, "water",
             "liquid");
  EXPECT_EQ(contents(write({{"second/other", "kg kg-1", ""}})), flat);
}

TEST(GroupNames, AreShortWhereTheyCanBe) {
  using netcdf::InGroup;
  const std::vector<InGroup> dimensions = {{"", "time"}, {"a", "x"}, {"b", "x"}, {"a", "y"}};
  const std::vector<InGroup> variables = {{"a", "x", 1}, {"a", "y", 3},    {"", "q"},
                                          {"a/c", "q"},  {"a", "time", 0}, {"b", "time", 0}};
  const auto names = netcdf::flat_names(dimensions, variables);
  EXPECT_EQ(names.dimensions, (std::vector<std::string>{"time", "a/x", "b/x", "y"}));
  EXPECT_EQ(names.variables,
            (std::vector<std::string>{"a/x", "y", "q", "a/c/q", "time", "b/time"}));
  const auto said = [&](const char* attribute, const char* text, const char* group) {
    return netcdf::flat_references(attribute, text, group, variables, names.variables);
  };
  EXPECT_EQ(said("coordinates", "x y", "a/c"), "a/x y");
  EXPECT_EQ(said("coordinates", "q", "a/c"), "a/c/q");
  EXPECT_EQ(said("coordinates", "q", "a"), "q");
  EXPECT_EQ(said("coordinates", "/a/c/q ../x", "a/c"), "a/c/q a/x");
  EXPECT_EQ(said("coordinates", "x", "b"), "a/x");  // one only
  EXPECT_EQ(said("coordinates", "nothing /b/x", "b"), "nothing /b/x");
  EXPECT_EQ(said("formula_terms", "q: q x: x", "a/c"), "q: a/c/q x: a/x");
  EXPECT_EQ(said("grid_mapping", "q: x y", "a/c"), "a/c/q: a/x y");
}

}  // namespace
}  // namespace nepho::forecast::test
