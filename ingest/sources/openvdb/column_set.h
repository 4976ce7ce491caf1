#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>

namespace nepho::vdb {

// A set of integer columns (a, b), entered as squares of the tree's tile sizes or as 8 x 8 masks;
// memory goes with the number of entries, not with their area.
class ColumnSet {
 public:
  void add_square(std::int32_t a, std::int32_t b, std::int32_t size) {
    if (size == kSizes[0])
      squares_[0].insert(key(a, b, size));
    else if (size == kSizes[1])
      squares_[1].insert(key(a, b, size));
    else
      masks_[key(a, b, 8)] = ~std::uint64_t{0};
  }
  // Bit 8 (a & 7) + (b & 7).
  void add_mask(std::int32_t a, std::int32_t b, std::uint64_t mask) {
    masks_[key(a, b, 8)] |= mask;
  }

  double count() const {
    double total = double(squares_[0].size()) * kSizes[0] * kSizes[0];
    for (const std::uint64_t square : squares_[1])
      if (!squares_[0].contains(coarser(square, kSizes[0] / kSizes[1])))
        total += double(kSizes[1]) * kSizes[1];
    for (const auto& [block, mask] : masks_)
      if (!squares_[1].contains(coarser(block, kSizes[1] / 8)) &&
          !squares_[0].contains(coarser(block, kSizes[0] / 8)))
        total += std::popcount(mask);
    return total;
  }

 private:
  static constexpr std::array<std::int32_t, 2> kSizes{4096, 128};

  static std::uint64_t pack(std::int32_t a, std::int32_t b) {
    return std::uint64_t(std::uint32_t(a)) << 32 | std::uint32_t(b);
  }
  // Sizes are powers of two, so the arithmetic shift rounds down for negative columns too.
  static std::uint64_t key(std::int32_t a, std::int32_t b, std::int32_t size) {
    const int shift = std::countr_zero(std::uint32_t(size));
    return pack(a >> shift, b >> shift);
  }
  static std::uint64_t coarser(std::uint64_t packed, std::int32_t ratio) {
    return key(std::int32_t(packed >> 32), std::int32_t(packed & 0xffffffffu), ratio);
  }

  std::array<std::unordered_set<std::uint64_t>, 2> squares_;
  std::unordered_map<std::uint64_t, std::uint64_t> masks_;
};

}  // namespace nepho::vdb
