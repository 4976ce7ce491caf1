#include "live/pixel_shares.h"

#include <algorithm>
#include <cstdlib>

namespace nepho {
namespace {

// Rank in Bayer's matrix of side 2^bits.
int rank(int x, int y, int bits) {
  int value = 0;
  for (int bit = 0; bit < bits; ++bit) {
    const int low = 2 * (bits - 1 - bit);
    value |= ((x ^ y) >> bit & 1) << (low + 1) | (y >> bit & 1) << low;
  }
  return value;
}

void copy_pixel(const HdrImage& from, std::size_t source, HdrImage& to, std::size_t target) {
  for (std::size_t c = 0; c < 3; ++c) to.rgb[3 * target + c] = from.rgb[3 * source + c];
  to.optical_depth[target] = from.optical_depth[source];
}

}  // namespace

void PixelShares::begin(int each, int width, int height, bool go_on) {
  if (go_on && each == each_ && width == image_.width && height == image_.height) {
    std::ranges::rotate(order_, order_.begin() + done_);
  } else {
    int bits = 0;
    while (1 << bits < each) ++bits;
    order_.clear();
    for (int y = 0; y < each; ++y)
      for (int x = 0; x < each; ++x) order_.push_back({x, y});
    std::ranges::sort(order_, {}, [&](const auto& o) { return rank(o[0], o[1], bits); });
  }
  each_ = each;
  done_ = 0;
  known_.assign(order_.size(), 0);
  image_ = {width, height, {}, {}};
  image_.rgb.resize(3 * std::size_t(width) * std::size_t(height));
  image_.optical_depth.resize(std::size_t(width) * std::size_t(height));
}

void PixelShares::add(const HdrImage& share) {
  const auto [ox, oy] = offset();
  if (done_++ == 0) first_ = share;
  known_[std::size_t(oy * each_ + ox)] = 1;
  for (int y = 0; y < share.height; ++y)
    for (int x = 0; x < share.width; ++x)
      copy_pixel(share, std::size_t(y * share.width + x), image_,
                 std::size_t((each_ * y + oy) * image_.width + each_ * x + ox));
}

HdrImage PixelShares::picture() const {
  if (done_ == 1) return first_;
  if (whole()) return image_;
  HdrImage filled = image_;
  for (std::size_t missing = std::size_t(done_); missing < order_.size(); ++missing) {
    const auto apart = [&](const std::array<int, 2>& known) {
      return std::abs(known[0] - order_[missing][0]) + std::abs(known[1] - order_[missing][1]);
    };
    const auto nearest =
        *std::ranges::min_element(order_.begin(), order_.begin() + done_, {}, apart);
    for (int y = 0; y < image_.height; y += each_)
      for (int x = 0; x < image_.width; x += each_)
        copy_pixel(image_, std::size_t((y + nearest[1]) * image_.width + x + nearest[0]), filled,
                   std::size_t((y + order_[missing][1]) * image_.width + x + order_[missing][0]));
  }
  return filled;
}

PixelGrid PixelShares::finest_grid() const {
  const auto all_there = [&](int step, const std::array<int, 2>& first) {
    for (int y = first[1] % step; y < each_; y += step)
      for (int x = first[0] % step; x < each_; x += step)
        if (!has(x, y)) return false;
    return true;
  };
  for (int step = 1; step < each_; step *= 2)
    for (int n = 0; n < done_; ++n) {
      const auto& offset = order_[std::size_t(n)];
      if (all_there(step, offset)) return {step, offset[0] % step, offset[1] % step};
    }
  return {each_, order_[0][0], order_[0][1]};
}

// camera.glsl: x = (2 i + 1) / width - 1, and y the other way round.
void shift_to_share(FrameData& frame, int each, const std::array<int, 2>& offset) {
  const double dx = (2.0 * offset[0] + 1 - each) / (double(each) * frame.width);
  double dy = -(2.0 * offset[1] + 1 - each) / (double(each) * frame.height);
#if defined(NEPHO_MUTANT_SHARE_ROWS)
  dy = -dy;
#endif
  for (int c = 0; c < 3; ++c) frame.forward[c] += dx * frame.right[c] + dy * frame.up[c];
}

}  // namespace nepho
