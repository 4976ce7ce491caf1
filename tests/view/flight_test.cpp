// Moving an eye, and remembering where it was.
#include "view/flight.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/error.h"
#include "geo/place.h"
#include "test_folder.h"
#include "view/camera_path.h"

namespace nepho::test {
namespace {

constexpr double kRadius_m = 6.36e6;

PlanetGround ball() {
  return {Ellipsoid::sphere(kRadius_m), {}};
}
Camera above(double height_m) {
  const glm::dvec3 eye(0, 0, kRadius_m + height_m);
  return {eye, eye + glm::dvec3(0, 1000, -100), {0, 0, 1}, 0.8};
}
WindowInput keys(double right, double up, double forward) {
  WindowInput input;
  input.height = 540;
  input.right = right;
  input.up = up;
  input.forward = forward;
  return input;
}
WindowInput drag(double x, double y) {
  WindowInput input = keys(0, 0, 0);
  input.turn_x = x;
  input.turn_y = y;
  return input;
}

TEST(Flight, SpeedFollowsTheHeightFromTheGroundToOrbit) {
  for (const double height_m : {100.0, 1e4, 1e6, 1e7}) {
    Flight flight(above(height_m), ball(), 1);
    EXPECT_NEAR(flight.height_m(), height_m, 1e-6 * kRadius_m);
    EXPECT_NEAR(flight.speed_m_per_s(), 0.5 * height_m, 1e-3 * height_m);
    // Rises to five times the height within some seconds, from anywhere.
    double seconds = 0;
    for (; flight.height_m() < 5 * height_m && seconds < 60; seconds += 0.02)
      flight.move(keys(0, 1, 0), 0.02);
    EXPECT_LT(seconds, 6);
  }
}

TEST(Flight, TheHorizonStaysLevelAroundThePlanet) {
  Flight flight(above(1e5), ball(), 1);
  WindowInput input = keys(0, 0, 1);
  double least_m = 1e9;
  for (int n = 0; n < 1000; ++n) {
    flight.move(input, 0.2);
    const Camera& camera = flight.camera();
    least_m = std::min(least_m, flight.height_m());
    EXPECT_NEAR(glm::dot(camera.up, glm::normalize(camera.eye_m)), 1, 1e-9);
  }
  EXPECT_GE(least_m, Flight::kLeastHeight_m - 1e-3);  // it looks down, and never goes below
}

TEST(Flight, DraggingTurnsWithoutMoving) {
  Flight flight(above(1e4), ball(), 1);
  const Camera before = flight.camera();
  EXPECT_FALSE(flight.move(keys(0, 0, 0), 1));
  EXPECT_TRUE(flight.move(drag(120, -40), 0.02));
  EXPECT_EQ(flight.camera().eye_m, before.eye_m);
  EXPECT_NEAR(glm::length(flight.camera().target_m - before.eye_m),
              glm::length(before.target_m - before.eye_m), 1e-6);
  for (int n = 0; n < 1000; ++n) flight.move(drag(0, 50), 0.02);  // never over the top
  const glm::dvec3 sight = glm::normalize(flight.camera().target_m - flight.camera().eye_m);
  EXPECT_LT(std::abs(sight.z), 0.9995);
  flight.reset();
  EXPECT_EQ(flight.camera().target_m, before.target_m);
}

TEST(Flight, OrbitsKeepTheirDistanceUnlessTheyAreAsked) {
  const Camera start{{0, -5000, 1000}, {0, 0, 500}, {0, 0, 1}, 0.8};
  Flight flight(start, std::nullopt, 5000);
  flight.set_mode(FlightMode::kOrbit);
  const double away_m = glm::length(start.eye_m - start.target_m);
  for (int n = 0; n < 50; ++n) flight.move(drag(9, 3), 0.02);
  EXPECT_NEAR(glm::length(flight.camera().eye_m - start.target_m), away_m, 1e-6);
  EXPECT_EQ(flight.camera().target_m, start.target_m);
  EXPECT_GT(glm::length(flight.camera().eye_m - start.eye_m), 0.2 * away_m);
  flight.move(keys(0, 0, 1), 1);
  EXPECT_NEAR(glm::length(flight.camera().eye_m - start.target_m), away_m / std::numbers::e, 1e-6);
}

TEST(Flight, AFirstPersonStandsOnTheGround) {
  Flight flight(above(9000), ball(), 1);
  flight.set_mode(FlightMode::kFirstPerson);
  EXPECT_NEAR(flight.height_m(), Flight::kLeastHeight_m, 1e-6);
  const glm::dvec3 ahead = flight.camera().target_m - flight.camera().eye_m;
  EXPECT_NEAR(glm::length(ahead), std::hypot(1000, 100), 1e-6);
  EXPECT_NEAR(glm::dot(ahead, glm::dvec3(0, 0, 1)), 0, 1e-6);  // it looked down
  EXPECT_GT(ahead.y, 1000);
  const glm::dvec3 before = flight.camera().eye_m;
  for (int n = 0; n < 100; ++n) flight.move(keys(1, 1, 1), 0.1);
  EXPECT_NEAR(flight.height_m(), Flight::kLeastHeight_m, 1e-6);
  EXPECT_GT(glm::length(flight.camera().eye_m - before), 20);
}

TEST(Flight, GoesToAPlaceWithItsHeading) {
  const Ellipsoid body = Ellipsoid::wgs84();
  const glm::dvec3 eye = ecef_m(body, {10, 20, 3000});
  PlanetGround ground{body, {}};
  const LocalAxes from = ground.axes(eye);
  const glm::dvec3 sight = 800.0 * from.east + 300.0 * from.north - 200.0 * from.up;
  Flight flight({eye, eye + sight, from.up, 0.8}, ground, 1);
  flight.go_to(-35.5, 178, 1200);
  const GeodeticPoint there = geodetic_point(body, flight.camera().eye_m);
  EXPECT_NEAR(there.latitude_deg, -35.5, 1e-9);
  EXPECT_NEAR(there.longitude_deg, 178, 1e-9);
  EXPECT_NEAR(there.height_m, 1200, 1e-6);
  const LocalAxes to = ground.axes(flight.camera().eye_m);
  const glm::dvec3 ahead = flight.camera().target_m - flight.camera().eye_m;
  EXPECT_NEAR(glm::dot(ahead, to.east), 800, 1e-6);
  EXPECT_NEAR(glm::dot(ahead, to.north), 300, 1e-6);
  EXPECT_NEAR(glm::dot(ahead, to.up), -200, 1e-6);
  flight.go_to(-35.5, 178, -50);  // never below
  EXPECT_NEAR(geodetic_point(body, flight.camera().eye_m).height_m, Flight::kLeastHeight_m, 1e-3);
  const glm::dvec3 before = flight.camera().eye_m;
  EXPECT_THROW(flight.go_to(95, 0, 1000), Error);
  EXPECT_EQ(flight.camera().eye_m, before);
  Flight free({{0, -5000, 0}, {0, 0, 0}, {0, 0, 1}, 0.8}, std::nullopt, 5000);
  EXPECT_THROW(free.go_to(0, 0, 1000), Error);
}

TEST(CameraPath, IsTheSameWhenItIsRead) {
  const TestFolder folder("camera_path");
  CameraPath path;
  for (int n = 0; n < 5; ++n) {
    Camera camera = above(1000.0 / 3 * n);
    camera.vertical_fov_rad = 0.1 + std::numbers::pi / 10 * n;
    path.cameras.push_back(camera);
  }
  write_camera_path(folder.path() / "a.json", path);
  const CameraPath again = read_camera_path(folder.path() / "a.json");
  ASSERT_EQ(again.cameras.size(), path.cameras.size());
  for (std::size_t n = 0; n < path.cameras.size(); ++n) {
    EXPECT_EQ(again.cameras[n].eye_m, path.cameras[n].eye_m);
    EXPECT_EQ(again.cameras[n].target_m, path.cameras[n].target_m);
    EXPECT_EQ(again.cameras[n].vertical_fov_rad, path.cameras[n].vertical_fov_rad);
  }
}

TEST(CameraPath, SaysWhatIsWrong) {
  const TestFolder folder("camera_path_bad");
  const auto refused = [&](const std::string& text) {
    std::ofstream(folder.path() / "bad.json") << text;
    try {
      read_camera_path(folder.path() / "bad.json");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(refused("{").find("no camera path"), std::string::npos);
  EXPECT_NE(refused(R"({"cameras": []})").find("empty"), std::string::npos);
  EXPECT_NE(refused(R"({"cameras": [{"eye_m": [0, 0]}]})").find("no camera path"),
            std::string::npos);
  EXPECT_NE(refused(R"({"cameras": [{"eye_m": [0,0,1], "target_m": [0,0,1], "up": [0,0,1],
                        "fov_rad": 1}]})")
                .find("looks nowhere"),
            std::string::npos);
}

TEST(FrameTimes, AreSummedUpByPass) {
  std::vector<FrameTimes> frames;
  for (const double ms : {10.0, 30.0, 20.0, 400.0, 15.0})
    frames.push_back({ms, ms / 4, {{"view", 1e-3 * ms / 2, -1}}});
  const std::vector<PassTimes> times = summarise(frames);
  ASSERT_EQ(times.size(), 2u);
  EXPECT_EQ(times[0].name, "gap");
  EXPECT_EQ(times[0].clock, "wall");
  EXPECT_EQ(times[1].clock, "cpu");
  EXPECT_DOUBLE_EQ(times[0].median_ms, 20);
  EXPECT_DOUBLE_EQ(times[0].worst_ms, 400);
  EXPECT_DOUBLE_EQ(times[1].worst_ms, 200);
  // A frame without a picture has no passes; a GPU that has a clock is told apart.
  frames.push_back({5, 0, {}});
  frames.push_back({5, 0, {{"view", 0.2, 0.05}}});
  const std::vector<PassTimes> more = summarise(frames);
  ASSERT_EQ(more.size(), 3u);
  EXPECT_EQ(more[0].frames, 7u);
  EXPECT_EQ(more[1].frames, 6u);
  EXPECT_EQ(more[2].clock, "gpu");
  EXPECT_DOUBLE_EQ(more[2].median_ms, 50);
  frames.resize(5);
  const std::string text = gap_histogram(frames);
  EXPECT_NE(text.find("below 17 ms: 2"), std::string::npos) << text;
  EXPECT_NE(text.find("longest block 400 ms, at most 100 ms of CPU"), std::string::npos) << text;
}

}  // namespace
}  // namespace nepho::test
