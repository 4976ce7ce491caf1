#pragma once

#include <cstddef>
#include <vector>

#include "bricks/shell_chart.h"
#include "sources/noise/layer.h"

namespace nepho::noise {

// What a layer is on one level: which octaves its voxels can hold, and the expectation over those
// that they cannot.
//
// Octaves whose wavelength (two cells) is above 4 voxels count in full, those below 2 not at all,
// with a smooth roll-off between; what is left out goes into the spread s of the closure. A sample
// is then  sum_k' hat(k, k') profile(k') E rise(x + s Z - lift(k')),  over the finest layers k' in
// its vertical hat with the lattice's own weights: a function of x alone, tabulated per k.
class LevelResponse {
 public:
  // Keeps a reference to the layer.
  LevelResponse(const Layer& layer, const ShellChart& chart, const Lattice& lattice, int level);

  // Per octave of the layer; 0: not evaluated.
  const std::vector<double>& weights() const { return weights_; }
  // Layers of samples with anything in them: [first, last]; first > last: none.
  std::uint32_t first() const { return first_; }
  std::uint32_t last() const { return last_; }

  struct Row {
    double foot = 0;  // x at and below which the response is 0
    double full = 0;  // x from which it is `most`
    double most = 0;
    double lift = 0;        // finest level: of its one layer of samples
    std::size_t begin = 0;  // into the table
  };
  const Row& row(std::uint32_t k) const { return rows_[k - first_]; }
  // Extinction in units of the layer's, and its variance over what is left out.
  double mean(const Row& row, double x) const;
  double variance(const Row& row, double x) const;

 private:
  static constexpr int kKnots = 256;
  double at(const std::vector<double>& table, const Row& row, double x) const;
  void fill(const Layer& layer, const ShellChart& chart, const Lattice& lattice, int level,
            double spread);

  const Layer& layer_;
  bool finest_;
  std::vector<double> weights_;
  std::uint32_t first_ = 1, last_ = 0;
  std::vector<Row> rows_;
  std::vector<double> mean_, square_;
};

// The layer's rise without closure: the finest level and the field itself.
double rise(const Layer& layer, double x);

}  // namespace nepho::noise
