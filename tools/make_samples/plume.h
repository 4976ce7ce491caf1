#pragma once

#include <cstdint>
#include <vector>

#include "sample_grid.h"

namespace nepho::samples {

// Values at the cells of a box, x fastest; asked between cells it is trilinear, beyond the ends it
// continues the last value.
class CellField {
 public:
  CellField(int nx, int ny, int nz, float value = 0)
      : nx_(nx),
        ny_(ny),
        nz_(nz),
        values_(std::size_t(nx) * std::size_t(ny) * std::size_t(nz), value) {}
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int nz() const { return nz_; }
  float& at(int i, int j, int k) { return values_[offset(i, j, k)]; }
  float at(int i, int j, int k) const { return values_[offset(i, j, k)]; }
  float sample(glm::vec3 p) const { return lookup(p, nullptr, nullptr); }
  // And the range of the eight values that it was made from.
  float sample(glm::vec3 p, float& low, float& high) const { return lookup(p, &low, &high); }

 private:
  std::size_t offset(int i, int j, int k) const {
    return std::size_t(i) + std::size_t(nx_) * (std::size_t(j) + std::size_t(ny_) * std::size_t(k));
  }
  float lookup(glm::vec3 p, float* low, float* high) const;
  int nx_, ny_, nz_;
  std::vector<float> values_;
};

// Stable fluids (Stam, 1999) for a buoyant plume, y up, on a staggered grid in units of cells and
// steps: velocity by semi-Lagrangian steps, smoke and heat by MacCormack's with clamping (Selle et
// al., 2008), vorticity confinement (Fedkiw et al., 2001), pressure by red-black SOR from the last
// step's. Walls and floor are solid, the top is open; rows well above the smoke rest until it
// comes. The same bits for any number of threads.
struct PlumeSettings {
  int nx = 80, ny = 144, nz = 80;
  float source_radius = 9, buoyancy = 0.15f, confinement = 0.42f, cooling = 0.005f;
  int pressure_sweeps = 24;
  std::uint64_t seed = 3;
};

class Plume {
 public:
  explicit Plume(const PlumeSettings& settings);
  void step();
  const CellField& smoke() const { return smoke_; }
  double largest_divergence() const;

 private:
  glm::vec3 velocity(glm::vec3 p) const;
  glm::vec3 centre_velocity(int i, int j, int k) const;
  glm::vec3 displacement(int i, int j, int k, float direction) const;
  template <class Visit>
  void for_each_cell(Visit&& visit) const;
  void emit();
  void push();
  void confine();
  void project();
  void advect();
  void raise_rows();
  float divergence(int i, int j, int k) const;

  PlumeSettings s_;
  int steps_ = 0, rows_;
  CellField u_, v_, w_;  // on the lower faces of the cells, and one more
  CellField smoke_, heat_, pressure_;
};

// Smoke of each listed step (ascending) as a grid of `voxel_m`; step 0 is the empty start.
std::vector<SampleGrid> make_plume(const PlumeSettings& settings, double voxel_m,
                                   const std::vector<int>& steps);

}  // namespace nepho::samples
