#pragma once

#include <array>
#include <cstdint>

#include "gl/object.h"
#include "tree/forest.h"

namespace nepho::gl {

// 3D textures of 9^3 tiles, tile n at 9 (a, b, c) with a fastest. Sides are powers of two, grown
// one at a time; the whole texture counts.

inline constexpr int kTileSide = 9;
inline constexpr int kLargestSide = 2048;  // what OpenGL 4.5 promises

// {0, 0, 0} where `tiles` do not fit one texture.
std::array<int, 3> atlas_size(std::uint64_t tiles);
inline std::uint64_t texels(const std::array<int, 3>& size) {
  return std::uint64_t(size[0]) * std::uint64_t(size[1]) * std::uint64_t(size[2]);
}
std::array<int, 3> tile_origin(std::uint64_t tile, const std::array<int, 3>& size);

// Bytes that nodes, bricks and light tiles take on the GPU, staging included: TileCost::total.
std::uint64_t bytes_with_sky(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit);
std::uint64_t bytes_without_sky(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit);
// With ice beside extinction in the atlas, and at most as many bricks of ice.
std::uint64_t bytes_with_sky_and_ice(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit);
std::uint64_t bytes_with_ice(std::uint64_t nodes, std::uint64_t bricks, std::uint64_t lit);

// Linear filter, clamped. Made once: on llvmpipe a change of sampler state compiles anew.
Texture make_texture_3d(const std::array<int, 3>& size, GLenum format);

// Codes of bricks, 16 bits UNORM; with `ice` a second channel beside the first has those of their
// ice: llvmpipe gathers texels of 32 bits at once and others one by one.
Texture make_brick_atlas(const std::array<int, 3>& size, bool ice);
// The ice's channel as the first one of a texture that shares its memory.
Texture view_of_ice(const Texture& atlas);
// One tile of an atlas made with the same `ice`. Returns its bytes.
std::uint64_t upload_tile(const Texture& atlas, const std::array<int, 3>& size, std::uint64_t tile,
                          const LeafBrick& brick, bool ice);
Texture upload_bricks(const Forest& forest, const std::array<int, 3>& size, bool ice);

}  // namespace nepho::gl
