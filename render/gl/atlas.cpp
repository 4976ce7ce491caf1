#include "gl/atlas.h"

#include <algorithm>

#include "gl/frame_data.h"
#include "gl/node_grid.h"

namespace nepho::gl {
namespace {

constexpr std::uint64_t kNever = std::uint64_t(1) << 62;  // above any budget

std::uint64_t bytes(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit,
                    std::uint64_t light_texel, bool ice = false) {
  const auto atlas = atlas_size(bricks), light = atlas_size(lit);
  if (atlas[0] == 0 || light[0] == 0) return kNever;
  return nodes * (sizeof(NodeRecord) + kGridBytesPerNode) +
         bricks * (sizeof(BrickRecord) + sizeof(LeafBrick)) + lit * sizeof(LitRecord) +
         2 * texels(atlas) + light_texel * texels(light) +
         (ice ? bricks * (sizeof(BrickRecord) + sizeof(IceCodes)) + 2 * texels(atlas) : 0);
}

void set_sampling(GLuint id) {
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(id, axis, GL_CLAMP_TO_EDGE);
}

}  // namespace

std::array<int, 3> atlas_size(std::uint64_t tiles) {
  std::array<int, 3> size = {16, 16, 16};
  const auto capacity = [&] {
    std::uint64_t count = 1;
    for (const int side : size) count *= std::uint64_t(side / kTileSide);
    return count;
  };
  while (capacity() < tiles) {
    int& least = *std::ranges::min_element(size);
    if (least >= kLargestSide) return {0, 0, 0};
    least *= 2;
  }
  return size;
}

std::array<int, 3> tile_origin(std::uint64_t tile, const std::array<int, 3>& size) {
  const auto nx = std::uint64_t(size[0] / kTileSide), ny = std::uint64_t(size[1] / kTileSide);
  return {int(tile % nx) * kTileSide, int(tile / nx % ny) * kTileSide,
          int(tile / (nx * ny)) * kTileSide};
}

std::uint64_t bytes_with_sky(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) {
  return bytes(nodes, bricks, lit, 8);
}
std::uint64_t bytes_without_sky(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) {
  return bytes(nodes, bricks, lit, 2);
}

std::uint64_t bytes_with_sky_and_ice(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) {
  return bytes(nodes, bricks, lit, 8, true);
}
std::uint64_t bytes_with_ice(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit) {
  return bytes(nodes, bricks, lit, 2, true);
}

Texture make_texture_3d(const std::array<int, 3>& size, GLenum format) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &id);
  Texture texture(id);
  glTextureStorage3D(id, 1, format, size[0], size[1], size[2]);
  set_sampling(id);
  check_errors("3D texture");
  return texture;
}

Texture make_brick_atlas(const std::array<int, 3>& size, bool ice) {
  return make_texture_3d(size, ice ? GL_RG16 : GL_R16);
}

Texture view_of_ice(const Texture& atlas) {
  GLuint id = 0;
  glGenTextures(1, &id);
  Texture view(id);
  glTextureView(id, GL_TEXTURE_3D, atlas.id(), GL_RG16, 0, 1, 0, 1);
  glTextureParameteri(id, GL_TEXTURE_SWIZZLE_R, GL_GREEN);
  set_sampling(id);
  check_errors("view of the ice's texture");
  return view;
}

std::uint64_t upload_tile(const Texture& atlas, const std::array<int, 3>& size, std::uint64_t tile,
                          const LeafBrick& brick, bool ice) {
  const auto [x, y, z] = tile_origin(tile, size);
  const auto put = [&](GLenum format, const void* texels) {
    glTextureSubImage3D(atlas.id(), 0, x, y, z, kTileSide, kTileSide, kTileSide, format,
                        GL_UNSIGNED_SHORT, texels);
  };
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (!ice) {
    put(GL_RED, brick.codes.data());
    return sizeof brick.codes;
  }
  std::array<std::array<std::uint16_t, 2>, std::tuple_size_v<decltype(brick.codes)>> pairs;
  for (std::size_t s = 0; s < pairs.size(); ++s)
    pairs[s] = {brick.codes[s], brick.ice ? brick.ice->codes[s] : std::uint16_t(0)};
  put(GL_RG, pairs.data());
  return sizeof pairs;
}

Texture upload_bricks(const Forest& forest, const std::array<int, 3>& size, bool ice) {
  Texture atlas = make_brick_atlas(size, ice);
  std::uint64_t tile = 0;
  for (const VolumeTree& tree : forest.volumes)
    for (const LeafBrick& brick : tree.bricks) upload_tile(atlas, size, tile++, brick, ice);
  check_errors("upload of bricks");
  return atlas;
}

}  // namespace nepho::gl
