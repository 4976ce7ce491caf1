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
  return nodes * (sizeof(NodeRecord) + 4 * kGridCellsPerNode) +
         bricks * (sizeof(BrickRecord) + sizeof(LeafBrick)) + lit * sizeof(LitRecord) +
         2 * texels(atlas) + light_texel * texels(light) +
         (ice ? bricks * (sizeof(BrickRecord) + sizeof(IceCodes)) + 2 * texels(atlas) : 0);
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
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R})
    glTextureParameteri(id, axis, GL_CLAMP_TO_EDGE);
  check_errors("3D texture");
  return texture;
}

void upload_tile(const Texture& atlas, const std::array<int, 3>& size, std::uint64_t tile,
                 const std::uint16_t* codes) {
  const auto [x, y, z] = tile_origin(tile, size);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(atlas.id(), 0, x, y, z, kTileSide, kTileSide, kTileSide, GL_RED,
                      GL_UNSIGNED_SHORT, codes);
}

namespace {

// `codes_of`: of a brick, or null for a tile that is left as it is.
template <class CodesOf>
Texture upload(const Forest& forest, const std::array<int, 3>& size, CodesOf codes_of) {
  Texture atlas = make_texture_3d(size, GL_R16);
  std::uint64_t tile = 0;
  for (const VolumeTree& tree : forest.volumes)
    for (const LeafBrick& brick : tree.bricks) {
      if (const std::uint16_t* codes = codes_of(brick)) upload_tile(atlas, size, tile, codes);
      ++tile;
    }
  check_errors("upload of bricks");
  return atlas;
}

}  // namespace

Texture upload_bricks(const Forest& forest, const std::array<int, 3>& size) {
  return upload(forest, size, [](const LeafBrick& brick) { return brick.codes.data(); });
}
Texture upload_ice(const Forest& forest, const std::array<int, 3>& size) {
  return upload(forest, size, [](const LeafBrick& brick) {
    return brick.ice ? brick.ice->codes.data() : nullptr;
  });
}

}  // namespace nepho::gl
