#include "gl/switches.h"

#include <algorithm>

namespace nepho::gl {
namespace {

// A ray is dropped when it can add no more than this share of what lies behind.
constexpr float kLeastTransmittance = 1.0f / 8192, kLeastTransmittanceExact = 1e-6f;
constexpr double kLeastBend_cells = 2e-3;  // of curved coordinates, that a parabola may miss

}  // namespace

bool cell_exact(const RenderSettings& settings) {
  return settings.step_voxels == 0.0;
}

// A part of what the tolerance allows.
float least_transmittance(const RenderSettings& settings) {
  if (cell_exact(settings)) return kLeastTransmittanceExact;
  const float most = settings.step_voxels ? kLeastTransmittance : 0.01f;
  return std::clamp(0.1f * float(settings.tolerance), kLeastTransmittanceExact, most);
}

bool reads_texels8(const RenderSettings& settings) {
  if (settings.fetch) return *settings.fetch == Fetch::kTexels8;
  return cell_exact(settings) || (!settings.step_voxels && settings.tolerance < 2e-3);
}

double parabola_error_cells(const GpuScene& scene) {
  return 0.2 * scene.widest_leaf_rad * scene.widest_leaf_rad;
}
bool uses_parabolas(const RenderRequest& request, const GpuScene& scene) {
  return scene.has_shell && !reads_texels8(request.settings) && !request.leave_nothing_out &&
         !request.any_tree && parabola_error_cells(scene) <= kLeastBend_cells;
}

std::string shader_switches(const RenderRequest& request, const GpuScene& scene,
                            const std::string& planet, bool lit) {
  const RenderSettings& s = request.settings;
  std::string text;
  const auto define = [&](const std::string& name, const std::string& value = "1") {
    text += "#define NEPHO_" + name + " " + value + "\n";
  };
  define("VOLUMES", std::to_string(std::max<std::size_t>(scene.volumes.size(), 1)));
  // Loops over volumes and octaves are written out: see shaders/march.glsl.
  const int octaves = s.light == Light::kSingle ? 1 : s.octaves;
  std::string each_volume, each_octave;
  for (std::size_t v = 0; v < scene.volumes.size(); ++v)
    each_volume += "NEPHO_DO(" + std::to_string(v) + ") ";
  for (int n = 1; n < octaves; ++n) each_octave += "NEPHO_DO_OCTAVE(" + std::to_string(n) + ") ";
  define("EACH_VOLUME", each_volume);
  define("EACH_OCTAVE", each_octave);
  define("OCTAVES", std::to_string(octaves));
  if (s.light == Light::kSingle) define("SINGLE");
  if (scene.has_box) define("BOX");
  if (scene.has_shell) define("SHELL");
  if (reads_texels8(s)) define("TEXELS8");
  if (cell_exact(s)) define("CELL_EXACT");
  if (!s.step_voxels) define("ADAPTIVE");
  if (uses_parabolas(request, scene)) define("LEAF_PARABOLA");
  if (scene.sky) define("SKY_LIGHT");
  if (scene.absorbs) define("ABSORPTION");
  if (scene.has_ice) define("ICE");
  if (lit) define("LIT");
  if (request.count_samples) define("COUNT_SAMPLES");
  text += planet;
  const double own_step = s.step_voxels && *s.step_voxels > 0 ? *s.step_voxels : 2.0;
  define("SUN_STEP", std::to_string(request.light_step_voxels.value_or(own_step)));
#ifdef NEPHO_MUTANT_SHADER  // tests: one planted mistake, by name
  define(NEPHO_MUTANT_SHADER);
#endif
  define("LIGHT_FORMAT", scene.sky ? "rgba16f" : "r16f");
  return text;
}

}  // namespace nepho::gl
