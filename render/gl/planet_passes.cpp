#include "gl/planet_passes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "reference/surface.h"

extern const char* const nepho_shader_sun_map;
extern const char* const nepho_shader_surface;

namespace nepho::gl {
namespace {

constexpr int kBlock = 128;  // pixels on a side of a dispatch
constexpr GLuint kPlanetBinding = 7;
constexpr GLuint kDepthUnit = 3, kLightUnit = 4, kSunMapUnit = 5, kSurfaceUnit = 6;

void set_filter(GLuint id, GLenum filter) {
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GLint(filter));
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GLint(filter));
  glTextureParameteri(id, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

Texture make_texture_2d(int width, int height, GLenum format, GLenum filter) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  Texture texture(id);
  glTextureStorage2D(id, 1, format, width, height);
  set_filter(id, filter);
  return texture;
}

Texture make_texture_array(int width, int height, int layers) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
  Texture texture(id);
  glTextureStorage3D(id, 1, GL_RGBA32F, width, height, layers);
  set_filter(id, GL_LINEAR);
  return texture;
}

std::vector<PixelTexel> read_texels(GLuint id, int width, int height) {
  std::vector<PixelTexel> texels(std::size_t(width) * std::size_t(height));
  glGetTextureImage(id, 0, GL_RGBA, GL_FLOAT, GLsizei(texels.size() * sizeof(PixelTexel)),
                    texels.data());
  return texels;
}

int blocks(int width, int height) {
  return ((width + kBlock - 1) / kBlock) * ((height + kBlock - 1) / kBlock);
}
void dispatch_block(const Program& program, int width, int height, int block) {
  glUseProgram(program.id());
  const int columns = (width + kBlock - 1) / kBlock;
  const int x = block % columns * kBlock, y = block / columns * kBlock;
  const int w = std::min(kBlock, width - x), h = std::min(kBlock, height - y);
  glUniform2i(glGetUniformLocation(program.id(), "first_pixel"), x, y);
  glDispatchCompute(GLuint((w + 7) / 8), GLuint((h + 7) / 8), 1);
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}
std::string percent(double part) {
  return number(100 * part) + " %";
}

}  // namespace

PlanetPasses::PlanetPasses(const RenderRequest& request, const Forest& forest,
                           std::shared_ptr<const AirTables> tables)
    : request_(request), scene_(make_planet_scene(request, forest)), tables_(std::move(tables)) {}

std::string PlanetPasses::defines() const {
  std::string text = "#define NEPHO_GROUND 1\n";
  if (scene_.air) text += "#define NEPHO_AIR 1\n";
  if (scene_.terrain) text += "#define NEPHO_TERRAIN 1\n";
  if (scene_.sun_map) {
    text += "#define NEPHO_SUN_MAP 1\n#define NEPHO_BANDS " + std::to_string(scene_.map_bands) +
            "\n#define NEPHO_EACH_BAND ";
    for (int band = 0; band < scene_.map_bands; ++band)
      text += "NEPHO_DO_BAND(" + std::to_string(band) + ") ";
    text += "\n";
  }
  if (scene_.clouds) text += "#define NEPHO_CLOUDS 1\n";
  return text;
}

void PlanetPasses::upload(const PlanetPasses* last) {
  data_ = Buffer(&scene_.data, sizeof(PlanetData));
  if (scene_.air) upload_tables(last);
  if (scene_.terrain) upload_surface(last);
  if (scene_.sun_map) {
    const int size = scene_.map_size;
    sun_map_ = make_texture_array(size, size, scene_.map_bands);
    map_bytes_ = 16 * std::uint64_t(size) * std::uint64_t(size) * std::uint64_t(scene_.map_bands);
  }
  check_errors("upload of the planet");
}

void PlanetPasses::upload_tables(const PlanetPasses* last) {
  if (!tables_) {
    const Planet& planet = *request_.planet;
    tables_ = std::make_shared<const AirTables>(
        make_air_tables(*planet.air, planet.body.equatorial_m, mean_ground_albedo(request_)));
  }
  const AirTables& tables = *tables_;
  const std::array<const AirTable*, 6> layers = {&tables.multiple, &tables.multiple_p2,
                                                 &tables.sky_up,   &tables.sky_side,
                                                 &tables.sky_down, &tables.sky_low};
  const int width = layers[0]->width, height = layers[0]->height;
  table_bytes_ = 16 * (std::uint64_t(tables.depth.width) * std::uint64_t(tables.depth.height) +
                       layers.size() * std::uint64_t(width) * std::uint64_t(height));
  if (last && last->tables_ == tables_) {
    depth_ = last->depth_;
    light_ = last->light_;
    return;
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  // Float: twilight is below what half floats hold, and filters of half floats are no faster.
  Texture depth = make_texture_2d(tables.depth.width, tables.depth.height, GL_RGBA32F, GL_LINEAR);
  glTextureSubImage2D(depth.id(), 0, 0, 0, tables.depth.width, tables.depth.height, GL_RGB,
                      GL_FLOAT, tables.depth.rgb.data());
  Texture light = make_texture_array(width, height, int(layers.size()));
  for (std::size_t layer = 0; layer < layers.size(); ++layer)
    glTextureSubImage3D(light.id(), 0, 0, 0, GLint(layer), width, height, 1, GL_RGB, GL_FLOAT,
                        layers[layer]->rgb.data());
  depth_ = std::make_shared<const Texture>(std::move(depth));
  light_ = std::make_shared<const Texture>(std::move(light));
}

void PlanetPasses::upload_surface(const PlanetPasses* last) {
  const SurfaceMap& map = *scene_.surface;
  surface_bytes_ = 8 * std::uint64_t(map.height_m.size());
  if (last && last->scene_.surface == scene_.surface) {
    surface_ = last->surface_;
    return;
  }
  std::vector<float> texels;
  texels.reserve(2 * map.height_m.size());
  for (std::size_t i = 0; i < map.height_m.size(); ++i) {
    texels.push_back(map.height_m[i]);
    texels.push_back(map.water[i]);
  }
  Texture surface = make_texture_2d(map.nx, map.ny, GL_RG32F, GL_NEAREST);
  glTextureParameteri(surface.id(), GL_TEXTURE_WRAP_S, GL_REPEAT);  // around all longitudes
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(surface.id(), 0, 0, 0, map.nx, map.ny, GL_RG, GL_FLOAT, texels.data());
  surface_ = std::make_shared<const Texture>(std::move(surface));
}

void PlanetPasses::bind() const {
  data_.bind(kPlanetBinding);
  if (depth_) glBindTextureUnit(kDepthUnit, depth_->id());
  if (light_) glBindTextureUnit(kLightUnit, light_->id());
  if (surface_) glBindTextureUnit(kSurfaceUnit, surface_->id());
  if (sun_map_.id()) glBindTextureUnit(kSunMapUnit, sun_map_.id());
}

int PlanetPasses::sun_map_parts() const {
  return scene_.sun_map ? blocks(scene_.map_size, scene_.map_size) : 0;
}
void PlanetPasses::draw_sun_map_part(Programs& programs, const std::string& switches, int part) {
  glBindImageTexture(0, sun_map_.id(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  dispatch_block(programs.get("sun_map", nepho_shader_sun_map, switches), scene_.map_size,
                 scene_.map_size, part);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

std::vector<PixelTexel> PlanetPasses::ground_distances(Programs& programs,
                                                       const std::string& switches, int width,
                                                       int height) {
  if (met_width_ != width || met_height_ != height) {
    met_ = make_texture_2d(width, height, GL_RGBA32F, GL_NEAREST);
    met_width_ = width;
    met_height_ = height;
    met_bytes_ = 16 * std::uint64_t(width) * std::uint64_t(height);
  }
  glBindImageTexture(1, met_.id(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32F);
  const Program& program = programs.get("surface", nepho_shader_surface, switches);
  for (int block = 0; block < blocks(width, height); ++block)
    dispatch_block(program, width, height, block);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  return read_texels(met_.id(), width, height);
}

void PlanetPasses::add_to(RenderReport& report) const {
  report.planet_bytes = sizeof(PlanetData) + table_bytes_ + surface_bytes_ + map_bytes_;
  report.image_bytes += met_bytes_;
  if (!scene_.air) report.left_out.push_back("air: the planet has none");
  if (!scene_.clouds && !request_.volumes.empty())
    report.left_out.push_back("clouds over air and ground: no volume holds any");
  if (!scene_.terrain && scene_.surface_known)
    report.left_out.push_back("terrain: all is sea, at most " + number(scene_.terrain_top_m) +
                              " m high; predicted to change at most " +
                              percent(scene_.terrain_change) + " of the ground's light");
  else if (!scene_.terrain)
    report.left_out.push_back("terrain: no volume has a ground of its own; all is sea level water");
  if (scene_.air && !scene_.sun_map)
    report.left_out.push_back("clouds' shadows on the air: predicted to change less than " +
                              percent(scene_.sun_map_change) + " of its light");
}

}  // namespace nepho::gl
