// forest -> buffers and atlas -> light tiles (sun, sky) -> view -> picture -> error line
#include "renderer.h"

#include <cmath>
#include <ctime>
#include <functional>
#include <optional>
#include <string>

#include "core/error.h"
#include "gl/atlas.h"
#include "gl/frame_data.h"
#include "gl/gpu_clock.h"
#include "gl/ground_pass.h"
#include "gl/light_samples.h"
#include "gl/object.h"
#include "gl/planet_passes.h"
#include "gl/view_pass.h"
#include "reference/probe.h"
#include "tree/forest.h"

extern const char* const nepho_shader_view;
extern const char* const nepho_shader_ground;
extern const char* const nepho_shader_light_sun;
extern const char* const nepho_shader_light_sky;
extern const char* const nepho_shader_light_fill;
extern const char* const nepho_shader_light_extend;

namespace nepho {
namespace {

// A ray is dropped when it can add no more than this share of what lies behind.
constexpr float kLeastTransmittance = 1.0f / 8192, kLeastTransmittanceExact = 1e-6f;
constexpr double kLeastBend_cells = 2e-3;   // of curved coordinates, that a parabola may miss
constexpr double kFilterError = 3.0 / 512;  // of weights of 8 bits (lattice.md 5)
// Of the picture, rms: a step that begins in clear air takes a neighbour's light there. Measured:
// 1.4e-3 on a thin ball, 2e-4 and less on thick ones, plume, forecast and LES.
constexpr double kSparedLightError = 2e-3;
constexpr GLuint kSampleBinding = 4;  // the phases' in the view pass
constexpr std::size_t kTilesPerDispatch =
    512;  // 729 samples each: within the 65535 groups of OpenGL 4.5

// A part of what the tolerance allows.
float least_transmittance(const RenderSettings& settings) {
  const float most = settings.step_voxels ? kLeastTransmittance : 0.01f;
  return std::clamp(0.1f * float(settings.tolerance), kLeastTransmittanceExact, most);
}

double process_cpu_s() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

struct Counters {  // march.glsl: CounterBuffer
  std::uint32_t overruns = 0, rays = 0, extinction_samples = 0, source_samples = 0;
};

class Renderer {
 public:
  explicit Renderer(const RenderRequest& request) : request_(request) {}
  RenderResult run();

 private:
  bool exact() const { return request_.settings.step_voxels == 0.0; }
  bool sky_light() const { return scene_.sky; }
  bool texels8() const;
  bool parabolas() const;
  std::string defines(bool lit) const;
  void timed(const char* name, const std::function<void()>& work);
  void upload();
  void light();
  using SampleList = std::vector<std::uint32_t> (gl::LightSamples::*)(std::size_t,
                                                                      std::size_t) const;
  void light_pass(const gl::Program& program, SampleList list, int entries_each = 1);
  void view();
  void ground();
  void make_image();
  void keep_lights();
  void read_counters();
  void report();

  const RenderRequest& request_;
  Forest forest_;
  gl::GpuScene scene_;
  std::optional<gl::LightSamples> light_samples_;
  double spared_light_ = 0;                 // part of the light's samples that took another's
  std::optional<gl::PlanetPasses> planet_;  // absent: no planet
  std::array<int, 3> atlas_size_{}, light_size_{};
  gl::Texture atlas_, ice_atlas_, light_atlas_;
  gl::Buffer frame_, volumes_, nodes_, bricks_, phases_, lit_, counters_, ice_;
  gl::PixelValues values_;
  gl::PixelReport view_report_, ground_report_;
  RenderResult result_;
};

bool Renderer::texels8() const {
  const RenderSettings& s = request_.settings;
  if (s.fetch) return *s.fetch == Fetch::kTexels8;
  return exact() || (!s.step_voxels && s.tolerance < 2e-3);
}

// Parabolas for the curved coordinates within a leaf: no more than kLeastBend of a cell off.
double parabola_error_cells(double leaf_rad) {
  return 0.2 * leaf_rad * leaf_rad;
}
bool Renderer::parabolas() const {
  return scene_.has_shell && !texels8() && !request_.leave_nothing_out &&
         parabola_error_cells(scene_.widest_leaf_rad) <= kLeastBend_cells;
}

void Renderer::timed(const char* name, const std::function<void()>& work) {
  const double before_s = process_cpu_s();
  gl::GpuClock clock;
  work();
  const double gpu_s = clock.stop_s();
  glFinish();
  gl::check_errors(name);
  result_.report.passes.push_back({name, process_cpu_s() - before_s, gpu_s});
}

std::string Renderer::defines(bool lit) const {
  const RenderSettings& s = request_.settings;
  std::string text;
  const auto define = [&](const std::string& name, const std::string& value = "1") {
    text += "#define NEPHO_" + name + " " + value + "\n";
  };
  define("VOLUMES", std::to_string(std::max<std::size_t>(scene_.volumes.size(), 1)));
  // Loops over volumes and octaves are written out: see shaders/march.glsl.
  const int octaves = s.light == Light::kSingle ? 1 : s.octaves;
  std::string each_volume, each_octave;
  for (std::size_t v = 0; v < scene_.volumes.size(); ++v)
    each_volume += "NEPHO_DO(" + std::to_string(v) + ") ";
  for (int n = 1; n < octaves; ++n) each_octave += "NEPHO_DO_OCTAVE(" + std::to_string(n) + ") ";
  define("EACH_VOLUME", each_volume);
  define("EACH_OCTAVE", each_octave);
  define("OCTAVES", std::to_string(octaves));
  if (s.light == Light::kSingle) define("SINGLE");
  if (scene_.has_box) define("BOX");
  if (scene_.has_shell) define("SHELL");
  if (texels8()) define("TEXELS8");
  if (exact()) define("CELL_EXACT");
  if (!s.step_voxels) define("ADAPTIVE");
  if (parabolas()) define("LEAF_PARABOLA");
  if (sky_light()) define("SKY_LIGHT");
  if (scene_.absorbs) define("ABSORPTION");
  if (scene_.has_ice) define("ICE");
  if (lit) define("LIT");
  if (request_.count_samples) define("COUNT_SAMPLES");
  if (planet_) text += planet_->defines();
  const double own_step = s.step_voxels && *s.step_voxels > 0 ? *s.step_voxels : 2.0;
  define("SUN_STEP", std::to_string(request_.light_step_voxels.value_or(own_step)));
#ifdef NEPHO_MUTANT_SHADER  // tests: one planted mistake, by name
  define(NEPHO_MUTANT_SHADER);
#endif
  define("LIGHT_FORMAT", sky_light() ? "rgba16f" : "r16f");
  return text;
}

void Renderer::upload() {
  atlas_size_ = gl::atlas_size(scene_.bricks.size());
  light_size_ = gl::atlas_size(scene_.lit.size());
  atlas_ = gl::upload_bricks(forest_, atlas_size_);
  light_atlas_ = gl::make_texture_3d(light_size_, sky_light() ? GL_RGBA16F : GL_R16F);
  frame_ = gl::Buffer(&scene_.frame, sizeof(FrameData));
  volumes_ = gl::Buffer(std::span<const VolumeData>(scene_.volumes));
  nodes_ = gl::Buffer(std::span<const NodeRecord>(scene_.nodes));
  bricks_ = gl::Buffer(std::span<const BrickRecord>(scene_.bricks));
  phases_ = gl::Buffer(std::span<const float>(scene_.phases));
  lit_ = gl::Buffer(std::span<const LitRecord>(scene_.lit));
  const Counters none{};
  counters_ = gl::Buffer(&none, sizeof none);
  GLuint binding = 0;
  for (const gl::Buffer* buffer :
       {&frame_, &volumes_, &nodes_, &bricks_, &phases_, &lit_, &counters_})
    buffer->bind(binding++);
  glBindTextureUnit(0, atlas_.id());
  glBindTextureUnit(1, light_atlas_.id());
  if (scene_.has_ice) {
    ice_atlas_ = gl::upload_ice(forest_, atlas_size_);
    glBindTextureUnit(2, ice_atlas_.id());
    ice_ = gl::Buffer(std::span<const BrickRecord>(scene_.ice));
    ice_.bind(8);
  }
  if (planet_) planet_->upload();
}

// One invocation for each sample that `list` names.
void Renderer::light_pass(const gl::Program& program, SampleList list, int entries_each) {
  glUseProgram(program.id());
  glBindImageTexture(0, light_atlas_.id(), 0, GL_TRUE, 0, GL_READ_WRITE,
                     sky_light() ? GL_RGBA16F : GL_R16F);
  for (std::size_t tile = 0; tile < light_samples_->tiles(); tile += kTilesPerDispatch) {
    const std::size_t count = std::min(kTilesPerDispatch, light_samples_->tiles() - tile);
    const std::vector<std::uint32_t> samples = ((*light_samples_).*list)(tile, count);
    if (samples.empty()) continue;
    const gl::Buffer buffer{std::span<const std::uint32_t>(samples)};
    buffer.bind(kSampleBinding);
    const std::size_t invocations = samples.size() / std::size_t(entries_each);
    glDispatchCompute(GLuint((invocations + 63) / 64), 1, 1);
  }
  phases_.bind(kSampleBinding);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void Renderer::light() {
  if (scene_.lit.empty()) return;
  using gl::LightSamples;
  const std::string switches = defines(false);
  gl::Program copy;
  timed("sun depth", [&] {
    light_samples_.emplace(forest_, request_.march_all_light);
    spared_light_ = light_samples_->spared_share();
    copy = gl::compile("light_extend", nepho_shader_light_extend, switches);
    light_pass(gl::compile("light_sun", nepho_shader_light_sun, switches), &LightSamples::owned);
    light_pass(copy, &LightSamples::shared, 2);
  });
  if (sky_light())
    timed("sky visibility", [&] {
      light_pass(gl::compile("light_sky", nepho_shader_light_sky, switches), &LightSamples::coarse);
      light_pass(copy, &LightSamples::shared_coarse, 2);
      light_pass(gl::compile("light_fill", nepho_shader_light_fill, switches),
                 &LightSamples::needed);
    });
  timed("light of clear samples", [&] { light_pass(copy, &LightSamples::pairs, 2); });
  light_samples_.reset();
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
  const gl::Program program = gl::compile("view", nepho_shader_view, defines(true));
  view_report_ = gl::march_view(request_, forest_, program, values_);
}

void Renderer::ground() {
  const gl::Program program = gl::compile("ground", nepho_shader_ground, defines(false));
  ground_report_ =
      gl::light_ground(request_, forest_, scene_.frame, planet_->scene(), program, values_);
}

void Renderer::make_image() {
  HdrImage& image = result_.image;
  image.width = request_.settings.width;
  image.height = request_.settings.height;
  const std::size_t pixels = values_.seen.size();
  image.rgb.resize(3 * pixels);
  image.optical_depth.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * p + c] = values_.seen[p][c];
    image.optical_depth[p] = values_.seen[p][3];
  }
  values_ = {};
}

// llvmpipe ends all loops of an invocation after 65535 iterations: a picture that lost some is
// refused, not shown.
void Renderer::read_counters() {
  Counters counters;
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
  if (parabolas())
    report.left_out.push_back(
        "curves of third order within leaves: predicted to move samples by less than " +
        std::to_string(parabola_error_cells(scene_.widest_leaf_rad)) + " voxels");
  const auto left_out = [&](const char* format, auto... numbers) {
    char sentence[200];
    std::snprintf(sentence, sizeof sentence, format, numbers...);
    report.left_out.push_back(sentence);
  };
  if (!texels8() && !scene_.bricks.empty())
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
    scene_.frame.least_transmittance =
        exact() ? kLeastTransmittanceExact : least_transmittance(request_.settings);
  });
  timed("upload", [&] { upload(); });
  light();
  if (planet_ && planet_->scene().sun_map)
    timed("sun map", [&] { planet_->draw_sun_map(defines(false)); });
  if (planet_) timed("surface", [&] { values_.met = planet_->ground_distances(defines(false)); });
  timed("view", [&] { view(); });
  if (planet_) timed("ground", [&] { ground(); });
  make_image();
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
