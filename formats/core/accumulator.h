#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace nepho {

// Neumaier's compensated sum (1974, doi:10.1002/zamm.19740540106). For n terms the error is
// <= eps |sum| + 2 n^2 eps^2 sum |x|: the plain sum has n eps sum |x|. 4 flops and a branch a term.
// Not for infinite terms, and not under -ffast-math.
class CompensatedSum {
 public:
  void add(double x) {
    const double next = sum_ + x;
    lost_ += std::abs(sum_) >= std::abs(x) ? (sum_ - next) + x : (x - next) + sum_;
    sum_ = next;
  }
  void add(const CompensatedSum& other) {
    add(other.sum_);
    lost_ += other.lost_;
  }
  double value() const { return sum_ + lost_; }

 private:
  double sum_ = 0, lost_ = 0;
};

// Welford's mean and variance in one pass (1962, doi:10.2307/1266577), merged by Chan's formula.
// Shift-proof: sum x^2 - n mean^2 loses all digits where the mean is 1e8 standard deviations.
class MeanVariance {
 public:
  void add(double x) {
    ++count_;
    const double from_old_mean = x - mean_;
    mean_ += from_old_mean / double(count_);
    squares_ += from_old_mean * (x - mean_);
  }
  void add(const MeanVariance& other) {
    if (other.count_ == 0) return;
    const double n = double(count_ + other.count_), share = double(other.count_) / n;
    const double apart = other.mean_ - mean_;
    squares_ += other.squares_ + apart * apart * (double(count_) * share);
    mean_ += apart * share;
    count_ += other.count_;
  }
  std::uint64_t count() const { return count_; }
  double mean() const { return mean_; }  // 0 of none
  // Unbiased (n - 1); NaN of fewer than two.
  double variance() const {
    return count_ > 1 ? squares_ / double(count_ - 1) : std::numeric_limits<double>::quiet_NaN();
  }
  double standard_error() const { return std::sqrt(variance() / double(count_)); }

 private:
  std::uint64_t count_ = 0;
  double mean_ = 0, squares_ = 0;
};

}  // namespace nepho
