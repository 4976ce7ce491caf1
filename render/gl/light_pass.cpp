#include "gl/light_pass.h"

#include <algorithm>

extern const char* const nepho_shader_light_sun;
extern const char* const nepho_shader_light_sky;
extern const char* const nepho_shader_light_fill;
extern const char* const nepho_shader_light_extend;

namespace nepho::gl {
namespace {

constexpr GLuint kSampleBinding = 4;  // the phases' in the view pass
constexpr std::size_t kTilesPerDispatch =
    512;  // 729 samples each: within the 65535 groups of OpenGL 4.5

}  // namespace

// One invocation for each sample that `list` names.
void LightPass::run(const Program& program, const LightSamples& samples, List list,
                    int entries_each) {
  glUseProgram(program.id());
  glBindImageTexture(0, atlas_.id(), 0, GL_TRUE, 0, GL_READ_WRITE, sky_ ? GL_RGBA16F : GL_R16F);
  for (std::size_t tile = 0; tile < samples.tiles(); tile += kTilesPerDispatch) {
    const std::size_t count = std::min(kTilesPerDispatch, samples.tiles() - tile);
    std::vector<std::uint32_t> entries = (samples.*list)(tile, count);
    if (entries.empty()) continue;
    if (!places_.empty())
      for (std::uint32_t& entry : entries) entry = 729 * places_[entry / 729] + entry % 729;
    const Buffer buffer{std::span<const std::uint32_t>(entries)};
    buffer.bind(kSampleBinding);
    const std::size_t invocations = entries.size() / std::size_t(entries_each);
    glDispatchCompute(GLuint((invocations + 63) / 64), 1, 1);
  }
  phases_.bind(kSampleBinding);
  glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

const Program& LightPass::copy() {
  return programs_.get("light_extend", nepho_shader_light_extend, switches_);
}

void LightPass::sun_depth(const LightSamples& samples) {
  run(programs_.get("light_sun", nepho_shader_light_sun, switches_), samples, &LightSamples::owned);
  run(copy(), samples, &LightSamples::shared, 2);
}
void LightPass::sky_visibility(const LightSamples& samples) {
  run(programs_.get("light_sky", nepho_shader_light_sky, switches_), samples,
      &LightSamples::coarse);
  run(copy(), samples, &LightSamples::shared_coarse, 2);
  run(programs_.get("light_fill", nepho_shader_light_fill, switches_), samples,
      &LightSamples::needed);
}
void LightPass::clear_samples(const LightSamples& samples) {
  run(copy(), samples, &LightSamples::pairs, 2);
}

}  // namespace nepho::gl
