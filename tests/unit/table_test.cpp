// The tables of tests/data, each a TEST; and the reader's own tests.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "accuracy_report.h"
#include "bricks/shell_chart.h"
#include "core/error.h"
#include "geo/place.h"
#include "table_reader.h"

namespace nepho::test {
namespace {

const Ellipsoid kMars{constants::kMarsEquatorial_m, constants::kMarsPolar_m};

Quantities lengths(glm::dvec3 p) {
  return {{p.x, kLength}, {p.y, kLength}, {p.z, kLength}};
}
glm::dvec3 vector_of(const Quantities& q) {
  for (const Quantity& component : q) EXPECT_EQ(component.dimension, kLength);
  return {q.at(0).value, q.at(1).value, q.at(2).value};
}
GeodeticPoint point_of(const Quantities& q) {
  EXPECT_EQ(q.at(0).dimension, kAngle);
  EXPECT_EQ(q.at(1).dimension, kAngle);
  EXPECT_EQ(q.at(2).dimension, kLength);
  return {q[0].value * 180 / std::numbers::pi, q[1].value * 180 / std::numbers::pi, q[2].value};
}
Quantities geodetic_of(const Ellipsoid& body, const Quantities& ecef) {
  const GeodeticPoint p = geodetic_point(body, vector_of(ecef));
  return {{p.latitude_deg * std::numbers::pi / 180, kAngle},
          {p.longitude_deg * std::numbers::pi / 180, kAngle},
          {p.height_m, kLength}};
}

// Of formats (radians), and of ingest/geo (GeographicLib): the same rows hold both.
Operation formats_ecef(Ellipsoid body) {
  return {[=](const Quantities& q) {
            return lengths(geodetic_to_ecef_m(body, q.at(0).value, q.at(1).value, q.at(2).value));
          },
          [=](const Quantities& q) { return geodetic_of(body, q); }};
}
Operation geo_ecef(Ellipsoid body) {
  return {[=](const Quantities& q) { return lengths(ecef_m(body, point_of(q))); },
          [=](const Quantities& q) { return geodetic_of(body, q); }};
}

// Runs all rows; reports the worst error as a share of the tolerance, by operation.
void run_table(const std::string& name, const std::map<std::string, Operation>& operations,
               const std::string& by) {
  std::map<std::string, double> worst;
  for (const TableCase& row : read_table(NEPHO_TEST_DATA "/" + name)) {
    const CaseResult result = run_case(row, operations);
    EXPECT_EQ(result.failure, "") << row.where << ": " << row.operation << ": " << row.accept;
    double& share = worst[row.operation];
    share = std::max(share, result.worst_share);
  }
  for (const auto& [operation, share] : worst)
    report_accuracy("tables", name + ": " + operation + by + ", error / tolerance", share, 1, "1");
}

TEST(Table, Units) {
  run_table("units.table", {{"to_si", {[](const Quantities& q) { return q; }, {}}}}, "");
}

std::map<std::string, Operation> geodetic(Operation (*ecef)(Ellipsoid)) {
  return {{"geodetic_to_ecef wgs84", ecef(Ellipsoid::wgs84())},
          {"geodetic_to_ecef mars", ecef(kMars)},
          {"geodetic_to_ecef sphere", ecef(Ellipsoid::sphere(6371000))}};
}
TEST(Table, GeodeticByFormats) {
  run_table("geodetic.table", geodetic(formats_ecef), ", formats");
}
TEST(Table, GeodeticByGeographicLib) {
  run_table("geodetic.table", geodetic(geo_ecef), ", ingest/geo");
}

TEST(Table, GeodeticHeight) {
  const auto height = [](const Quantities& q) {
    return Quantities{{geodetic_height_m(Ellipsoid::wgs84(), vector_of(q)), kLength}};
  };
  run_table("geodetic_height.table", {{"geodetic_height wgs84", {height, {}}}}, "");
}

class TableReader : public testing::Test {
 protected:
  static std::vector<TableCase> read(const std::string& text) {
    const std::string path =
        testing::TempDir() + "nepho_reader_" + std::to_string(getpid()) + ".table";
    std::ofstream(path) << text;
    struct Removed {
      const std::string& path;
      ~Removed() { std::filesystem::remove(path); }
    } removed{path};
    return read_table(path);
  }
  static std::string result(const std::string& text) {
    const Operation doubled{[](Quantities q) {
                              for (Quantity& x : q) x.value *= 2;
                              return q;
                            },
                            [](Quantities q) {
                              for (Quantity& x : q) x.value *= 0.5000001;
                              return q;
                            }};
    return run_case(read("operation double\n" + text).at(0), {{"double", doubled}}).failure;
  }
};

TEST_F(TableReader, SeesWhatIsRight) {
  EXPECT_EQ(result("tolerance 1 mm\naccept 1 km, 2 m # note\nexpect 2000 m, 4.0005 m"), "");
  EXPECT_EQ(result("tolerance 1 mm, 1 m\naccept 1 km, 2 m\nexpect 2000 m, 4.5 m"), "");
  EXPECT_EQ(result("tolerance 1e-3 relative\naccept 1 km\nexpect 2001 m"), "");
  EXPECT_EQ(result("tolerance 1 mm\naccept 1 km\nroundtrip 1"), "");
  EXPECT_EQ(result("accept 1 ell\nexpect failure 'ell'"), "");
}

TEST_F(TableReader, SeesWhatIsWrong) {
  EXPECT_NE(result("tolerance 1 mm\naccept 1 km\nexpect 2000.002 m"), "");
  EXPECT_NE(result("tolerance 1 mm\naccept 1 km, 2 m\nexpect 2000 m, 4.002 m"), "");
  EXPECT_NE(result("tolerance 1 mm\naccept 1 km\nexpect 2000 kg"), "");
  EXPECT_NE(result("tolerance 1 mm\naccept 1 km\nexpect 2000"), "");
  EXPECT_NE(result("tolerance 1 mm\naccept 1 km\nexpect 2000 m, 1 m"), "");
  EXPECT_NE(result("tolerance 1 mm\naccept 1\nexpect 2 m"), "");
  EXPECT_NE(result("tolerance 1 s\naccept 1 km\nexpect 2000 m"), "");
  EXPECT_NE(result("tolerance 1 mm\naccept 1 km\nroundtrip 100"), "");
  EXPECT_NE(result("accept 1 m\nexpect failure not known"), "");
  EXPECT_NE(result("accept 1 ell\nexpect failure bracket"), "");
  EXPECT_NE(result("tolerance 0 relative\naccept 1 m\nexpect nan m"), "");
}

TEST_F(TableReader, RefusesBadTables) {
  for (const char* text :
       {"", "# none\n", "operation a\naccept 1 m\nexpect 1 m\n", "accept 1 m\nexpect failure x\n",
        "operation a\ntolerance 1 m\nexpect 1 m\n", "operation a\nfrobnicate\n",
        "operation a\nfrobnicate 1\n", "operation a\naccept 1 m\nexpect failure\n"})
    EXPECT_THROW(read(text), Error) << text;
  EXPECT_THROW(read_table("/nonexistent/x.table"), Error);
}

}  // namespace
}  // namespace nepho::test
