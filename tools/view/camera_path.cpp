#include "view/camera_path.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "common/output_file.h"
#include "core/error.h"

namespace nepho {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

json to_json(const glm::dvec3& v) {
  return json::array({v.x, v.y, v.z});
}
glm::dvec3 to_point(const json& value) {
  const auto v = value.get<std::array<double, 3>>();
  return {v[0], v[1], v[2]};
}

void write_text(const fs::path& path, const std::string& text) {
  OutputFile file(path, text.size());
  std::ofstream out(file.temporary(), std::ios::binary);
  out << text;
  out.close();
  if (!out) throw Error({"cannot be written", path.string(), "", "", ""});
  file.commit();
}

}  // namespace

CameraPath read_camera_path(const fs::path& file) {
  constexpr const char* shape =
      R"({"cameras": [{"eye_m": [x, y, z], "target_m": [...], "up": [...], "fov_rad": f}, ...]})";
  std::ifstream in(file);
  if (!in) throw Error({"no such camera path", file.string(), "", "", "record one with --record"});
  CameraPath path;
  try {
    const json whole = json::parse(in);
    for (const json& entry : whole.at("cameras")) {
      Camera camera;
      camera.eye_m = to_point(entry.at("eye_m"));
      camera.target_m = to_point(entry.at("target_m"));
      camera.up = to_point(entry.at("up"));
      camera.vertical_fov_rad = entry.at("fov_rad").get<double>();
      const bool good = camera.eye_m != camera.target_m && glm::length(camera.up) > 0 &&
                        camera.vertical_fov_rad > 0 && camera.vertical_fov_rad < 3.1;
      if (!good)
        throw Error({"a camera that looks nowhere", file.string(), shape, entry.dump(), ""});
      path.cameras.push_back(camera);
    }
  } catch (const json::exception& error) {
    throw Error({"no camera path", file.string(), shape, error.what(), ""});
  }
  if (path.cameras.empty()) throw Error({"an empty camera path", file.string(), shape, "", ""});
  return path;
}

void write_camera_path(const fs::path& file, const CameraPath& path) {
  json cameras = json::array();
  for (const Camera& camera : path.cameras)
    cameras.push_back({{"eye_m", to_json(camera.eye_m)},
                       {"target_m", to_json(camera.target_m)},
                       {"up", to_json(camera.up)},
                       {"fov_rad", camera.vertical_fov_rad}});
  write_text(file, json{{"cameras", cameras}}.dump(1) + "\n");
}

std::vector<PassTimes> summarise(const std::vector<FrameTimes>& frames) {
  std::map<std::pair<std::string, std::string>, std::vector<double>> all;
  for (const FrameTimes& frame : frames) {
    all[{"gap", "wall"}].push_back(frame.gap_ms);
    for (const PassReport& pass : frame.passes) {
      all[{pass.name, "cpu"}].push_back(1e3 * pass.cpu_s);
      if (pass.gpu_s >= 0) all[{pass.name, "gpu"}].push_back(1e3 * pass.gpu_s);
    }
  }
  std::vector<PassTimes> result;
  for (auto& [key, values] : all) {
    std::ranges::sort(values);
    result.push_back(
        {key.first, key.second, values.size(), values[values.size() / 2], values.back()});
  }
  return result;
}

void write_pass_times(const fs::path& file, const std::vector<PassTimes>& times) {
  if (file.extension() == ".json") {
    json rows = json::array();
    for (const PassTimes& t : times)
      rows.push_back({{"pass", t.name},
                      {"clock", t.clock},
                      {"frames", t.frames},
                      {"median_ms", t.median_ms},
                      {"worst_ms", t.worst_ms}});
    return write_text(file, json{{"passes", rows}}.dump(1) + "\n");
  }
  if (file.extension() != ".csv")
    throw Error({"unknown kind of table", file.string(), ".csv or .json", "", ""});
  std::string text = "pass,frames,median_ms,worst_ms,clock\n";
  for (const PassTimes& t : times) {
    char line[200];
    std::snprintf(line, sizeof line, "%s,%zu,%.3f,%.3f,%s\n", t.name.c_str(), t.frames, t.median_ms,
                  t.worst_ms, t.clock.c_str());
    text += line;
  }
  write_text(file, text);
}

std::string gap_histogram(const std::vector<FrameTimes>& frames) {
  constexpr std::array kEnds_ms{17.0, 34.0, 67.0, 100.0, 200.0, 500.0, 1e12};
  std::array<int, kEnds_ms.size()> counts{};
  double longest = 0, most_cpu = 0;
  for (const FrameTimes& frame : frames) {
    const auto end = std::ranges::find_if(kEnds_ms, [&](double e) { return frame.gap_ms < e; });
    ++counts[std::size_t(end - kEnds_ms.begin())];
    longest = std::max(longest, frame.gap_ms);
    most_cpu = std::max(most_cpu, frame.cpu_ms);
  }
  std::string text;
  for (std::size_t n = 0; n < counts.size(); ++n) {
    char part[60];
    if (n + 1 < counts.size())
      std::snprintf(part, sizeof part, "below %.0f ms: %d, ", kEnds_ms[n], counts[n]);
    else
      std::snprintf(part, sizeof part, "longer: %d; ", counts[n]);
    text += part;
  }
  char end[80];
  std::snprintf(end, sizeof end, "longest block %.0f ms, at most %.0f ms of CPU", longest,
                most_cpu);
  return text + end;
}

double thread_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

}  // namespace nepho
