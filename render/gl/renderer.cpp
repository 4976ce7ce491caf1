// forest -> buffers and atlas -> light tiles (sun, sky) -> view -> picture -> error line
#include "renderer.h"

#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "core/error.h"
#include "gl/atlas.h"
#include "gl/frame_data.h"
#include "gl/ground_pass.h"
#include "gl/light_pass.h"
#include "gl/light_samples.h"
#include "gl/object.h"
#include "gl/picture.h"
#include "gl/planet_passes.h"
#include "gl/programs.h"
#include "gl/switches.h"
#include "gl/view_pass.h"
#include "reference/probe.h"
#include "tree/forest.h"

extern const char* const nepho_shader_view;
extern const char* const nepho_shader_ground;

namespace nepho {
namespace {

constexpr double kFilterError = 3.0 / 512;  // of weights of 8 bits (lattice.md 5)
// Of the picture, rms: a step that begins in clear air takes a neighbour's light there. Measured:
// 1.4e-3 on a thin ball, 2e-4 and less on thick ones, plume, forecast and LES.
constexpr double kSparedLightError = 2e-3;

class Renderer {
 public:
  explicit Renderer(const RenderRequest& request) : request_(request) {}
  RenderResult run();

 private:
  bool sky_light() const { return scene_.sky; }
  std::string defines(bool lit) const;
  void timed(const char* name, const std::function<void()>& work);
  void upload();
  void light();
  void view();
  void ground();
  void keep_lights();
  void read_counters();
  void report();

  const RenderRequest& request_;
  Forest forest_;
  gl::GpuScene scene_;
  gl::Programs programs_;
  double spared_light_ = 0;                 // part of the light's samples that took another's
  std::optional<gl::PlanetPasses> planet_;  // absent: no planet
  std::array<int, 3> atlas_size_{}, light_size_{};
  gl::Texture atlas_, ice_atlas_, light_atlas_;
  gl::Buffer frame_, volumes_, nodes_, bricks_, phases_, lit_, counters_, ice_;
  gl::PixelValues values_;
  gl::PixelReport view_report_, ground_report_;
  RenderResult result_;
};

void Renderer::timed(const char* name, const std::function<void()>& work) {
  gl::timed(result_.report.passes, name, work);
}

std::string Renderer::defines(bool lit) const {
  return gl::shader_switches(request_, scene_, planet_ ? planet_->defines() : "", lit);
}

void Renderer::upload() {
  atlas_size_ = gl::atlas_size(scene_.bricks.size());
  light_size_ = gl::atlas_size(scene_.lit.size());
  atlas_ = gl::upload_bricks(forest_, atlas_size_, scene_.has_ice);
  light_atlas_ = gl::make_texture_3d(light_size_, sky_light() ? GL_RGBA16F : GL_R16F);
  frame_ = gl::Buffer(&scene_.frame, sizeof(FrameData));
  volumes_ = gl::Buffer(std::span<const VolumeData>(scene_.volumes));
  nodes_ = gl::Buffer(std::span<const NodeRecord>(scene_.nodes));
  bricks_ = gl::Buffer(std::span<const BrickRecord>(scene_.bricks));
  phases_ = gl::Buffer(std::span<const float>(scene_.phases));
  lit_ = gl::Buffer(std::span<const LitRecord>(scene_.lit));
  const gl::MarchCounters none{};
  counters_ = gl::Buffer(&none, sizeof none);
  GLuint binding = 0;
  for (const gl::Buffer* buffer :
       {&frame_, &volumes_, &nodes_, &bricks_, &phases_, &lit_, &counters_})
    buffer->bind(binding++);
  glBindTextureUnit(0, atlas_.id());
  glBindTextureUnit(1, light_atlas_.id());
  if (scene_.has_ice) {
    ice_atlas_ = gl::view_of_ice(atlas_);
    glBindTextureUnit(2, ice_atlas_.id());
    ice_ = gl::Buffer(std::span<const BrickRecord>(scene_.ice));
    ice_.bind(8);
  }
  if (planet_) {
    planet_->upload();
    planet_->bind();
  }
}

void Renderer::light() {
  if (scene_.lit.empty()) return;
  gl::LightPass pass(programs_, defines(false), light_atlas_, sky_light(), phases_);
  std::optional<gl::LightSamples> samples;
  timed("sun depth", [&] {
    samples.emplace(forest_, request_.march_all_light);
    spared_light_ = samples->spared_share();
    pass.sun_depth(*samples);
  });
  if (sky_light()) timed("sky visibility", [&] { pass.sky_visibility(*samples); });
  timed("light of clear samples", [&] { pass.clear_samples(*samples); });
}

// The light tiles, out of their texture.
void Renderer::keep_lights() {
  LightTiles tiles;
  std::size_t count = 0;
  for (const VolumeTree& tree : forest_.volumes) {
    tiles.first.push_back(count);
    count += tree.lit_nodes;
  }
  tiles.channels = sky_light() ? 4 : 1;
  const auto channels = std::size_t(tiles.channels);
  const auto [nx, ny, nz] = light_size_;
  std::vector<float> texels(channels * gl::texels(light_size_));
  glGetTextureImage(light_atlas_.id(), 0, sky_light() ? GL_RGBA : GL_RED, GL_FLOAT,
                    GLsizei(sizeof(float) * texels.size()), texels.data());
  tiles.values.reserve(count * 729 * channels);
  for (std::size_t tile = 0; tile < count; ++tile) {
    const auto [x, y, z] = gl::tile_origin(tile, light_size_);
    for (int s = 0; s < 729; ++s) {
      const auto row = std::size_t((z + s / 81) * ny + y + s / 9 % 9);
      const float* texel = &texels[channels * (row * std::size_t(nx) + std::size_t(x + s % 9))];
      tiles.values.insert(tiles.values.end(), texel, texel + channels);
    }
  }
  result_.lights = std::make_shared<const LightTiles>(std::move(tiles));
}

void Renderer::view() {
  const gl::Program& program = programs_.get("view", nepho_shader_view, defines(true));
  view_report_ = gl::march_view(request_, forest_, program, values_);
}

void Renderer::ground() {
  const gl::Program& program = programs_.get("ground", nepho_shader_ground, defines(false));
  ground_report_ =
      gl::light_ground(request_, forest_, scene_.frame, planet_->scene(), program, values_);
}

// llvmpipe ends all loops of an invocation after 65535 iterations: a picture that lost some is
// refused, not shown.
void Renderer::read_counters() {
  gl::MarchCounters counters;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glGetNamedBufferSubData(counters_.id(), 0, sizeof counters, &counters);
  result_.report.samples = {double(counters.rays), double(counters.extinction_samples),
                            double(counters.source_samples)};
  const std::uint32_t count = counters.overruns;
  if (count == 0) return;
  throw Error({.what = "rays needed more steps than this OpenGL device runs",
               .where = "render",
               .expected = "at most about 65000 loop iterations for a ray on llvmpipe",
               .found = std::to_string(count) + " rays that were cut off",
               .hint = "use longer steps (--step, --tolerance), a smaller --budget-mib, or a GPU"});
}

void Renderer::report() {
  RenderReport& report = result_.report;
  const auto text = [](GLenum name) {
    return std::string(reinterpret_cast<const char*>(glGetString(name)));
  };
  report.device = text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
  std::string line;
  for (const char c : defines(true)) {
    if (c == '\n') {
      report.shader_switches.push_back(line.substr(std::string("#define NEPHO_").size()));
      line.clear();
    } else {
      line += c;
    }
  }
  if (gl::uses_parabolas(request_, scene_))
    report.left_out.push_back(
        "curves of third order within leaves: predicted to move samples by less than " +
        std::to_string(gl::parabola_error_cells(scene_)) + " voxels");
  const auto left_out = [&](const char* format, auto... numbers) {
    char sentence[200];
    std::snprintf(sentence, sizeof sentence, format, numbers...);
    report.left_out.push_back(sentence);
  };
  if (!gl::reads_texels8(request_.settings) && !scene_.bricks.empty())
    left_out(
        "exact look-ups: filtered, predicted to move extinction by less than %.2g %% of its cell's "
        "range",
        100 * kFilterError);
  if (spared_light_ > 0)
    left_out(
        "light of %.1f %% of the samples: that of another there or nearby, predicted to change the "
        "picture by less than %.2g %% rms",
        100 * spared_light_, 100 * kSparedLightError);
  if (!scene_.has_shell)
    report.left_out.push_back("curved walls: no volume is on a planet's shell");
  if (!scene_.has_box) report.left_out.push_back("flat walls: no volume is in a box");
  if (!sky_light())
    report.left_out.push_back("sky visibility: the sky is black; light tiles hold one channel");
  if (!scene_.has_ice) report.left_out.push_back("the second channel: no volume tells ice apart");
  if (!scene_.absorbs) report.left_out.push_back("absorption: every co-albedo is 0");
  if (scene_.lit.empty()) report.left_out.push_back("light passes: nothing scatters");
  report.budget_bound = forest_.budget_bound;
  if (forest_.budget_bound)
    report.left_out.push_back("finer nodes that this view asks for: the budget is full");
  report.atlas_bytes = (scene_.has_ice ? 4 : 2) * gl::texels(atlas_size_);
  report.sun_bytes = (sky_light() ? 8 : 2) * gl::texels(light_size_);
  report.node_bytes = scene_.nodes.size() * sizeof(NodeRecord) +
                      (scene_.bricks.size() + scene_.ice.size()) * sizeof(BrickRecord) +
                      scene_.lit.size() * sizeof(LitRecord);
  report.staging_bytes =
      scene_.bricks.size() * sizeof(LeafBrick) + scene_.ice.size() * sizeof(IceCodes);
  report.image_bytes =
      32 * std::uint64_t(request_.settings.width) * std::uint64_t(request_.settings.height);
  const auto interpolated = [&](const char* what, const gl::PixelReport& pixels) {
    if (pixels.interpolates)
      left_out(
          "%s of %.1f %% of the pixels: interpolated, predicted to change the picture by "
          "less than %.2g %% rms (%zu checked)",
          what, 100 * (1 - pixels.marched_share), 100 * pixels.predicted_rms, pixels.checks);
  };
  interpolated("marches", view_report_);
  interpolated("the ground's light", ground_report_);
  if (planet_)
    planet_->add_to(report);
  else
    report.left_out.push_back("air and ground: the scene is on no planet");
  for (const VolumeTree& tree : forest_.volumes) {
    const VolumeInfo& info = tree.source->info();
    VolumeReport volume;
    volume.name = info.name;
    volume.nodes = tree.nodes.size();
    volume.bricks = tree.bricks.size();
    volume.sun_tiles = tree.lit_nodes;
    volume.finest_level_used = tree.finest_level_used;
    volume.finest_level = info.lattice.max_level();
    for (const TreeNode& node : tree.nodes) {
      if (node.kind == NodeKind::kConstant) ++volume.constant_nodes;
      if (node.kind == NodeKind::kEmpty) ++volume.empty_nodes;
    }
    report.volumes.push_back(volume);
    report.source_bytes += info.source_bytes;
  }
}

RenderResult Renderer::run() {
  timed("refine and read", [&] {
    forest_ = build_forest(request_.volumes, gl::refinement_of(request_));
    scene_ = gl::make_gpu_scene(request_, forest_);
    if (request_.planet) planet_.emplace(request_, forest_);
    scene_.frame.least_transmittance = gl::least_transmittance(request_.settings);
  });
  timed("upload", [&] { upload(); });
  light();
  if (planet_ && planet_->scene().sun_map)
    timed("sun map", [&] {
      for (int part = 0; part < planet_->sun_map_parts(); ++part)
        planet_->draw_sun_map_part(programs_, defines(false), part);
    });
  if (planet_)
    timed("surface", [&] {
      values_.met = planet_->ground_distances(programs_, defines(false), request_.settings.width,
                                              request_.settings.height);
    });
  timed("view", [&] { view(); });
  if (planet_) timed("ground", [&] { ground(); });
  result_.image = gl::picture_of(values_, request_.settings.width, request_.settings.height);
  values_ = {};
  read_counters();
  if (request_.keep_lights) keep_lights();
  if (request_.settings.probe_pixels > 0)
    timed("error probe", [&] {
      result_.error =
          estimate_error(request_, forest_, result_.image, planet_ ? planet_->tables() : nullptr);
    });
  report();
  return std::move(result_);
}

}  // namespace

RenderResult render(const RenderRequest& request) {
  if (!request.leave_nothing_out || !request.planet || request.planet->air)
    return Renderer(request).run();
  RenderRequest with_air = request;  // of no density
  Air& air = with_air.planet->air.emplace();
  air.rayleigh_per_m = air.aerosol_extinction_per_m = air.ozone_per_m = glm::dvec3(0.0);
  return Renderer(with_air).run();
}

}  // namespace nepho
