#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer.h"
#include "shaders/frame.layout.h"

namespace nepho {

// Every `step`th pixel of rows and columns, from (x, y) on.
struct PixelGrid {
  int step, x, y;
};

// A picture that is marched in shares: each is every n'th pixel of rows and columns, as a small
// picture of its own, and n^2 of them are the whole. n is a power of two.
class PixelShares {
 public:
  // Begins anew. Width and height are multiples of `each`. `go_on`: with the share that would have
  // been next, if the picture has the same size and shares: views that change all the time then get
  // each of them in turn.
  void begin(int each, int width, int height, bool go_on = false);
  int each() const { return each_; }
  bool whole() const { return done_ == int(order_.size()); }
  // Of the next share: its first pixel. Those in between come before their neighbours (Bayer 1973).
  std::array<int, 2> offset() const { return order_[std::size_t(done_)]; }
  void add(const HdrImage& share);
  // As many pixels as there are; the first share alone is small, later the others are the nearest
  // ones of their block.
  HdrImage picture() const;
  // Their pixels, where they are, and 0 elsewhere; whether those of this offset are there.
  const HdrImage& marched() const { return image_; }
  bool has(int x, int y) const { return known_[std::size_t((y % each_) * each_ + x % each_)] != 0; }
  std::array<int, 2> last_offset() const { return order_[std::size_t(done_ - 1)]; }
  // The finest grid of which all pixels are there; of several, the first that was.
  PixelGrid finest_grid() const;

 private:
  std::vector<std::array<int, 2>> order_;
  std::vector<std::uint8_t> known_;  // by offset
  int each_ = 1, done_ = 0;
  HdrImage first_, image_;
};

// Of a frame of `frame`'s size: moved so that its pixels are those of a picture `each` times as
// wide, beginning with `offset`.
void shift_to_share(FrameData& frame, int each, const std::array<int, 2>& offset);

}  // namespace nepho
