#include "plume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "hash_noise.h"

namespace nepho::samples {
namespace {

constexpr int kRowsAhead = 14;  // of the smoke's top
constexpr float kTraceSmoke = 1e-3f;

glm::vec3 cell(int i, int j, int k) {
  return {float(i), float(j), float(k)};
}

}  // namespace

float CellField::lookup(glm::vec3 p, float* low, float* high) const {
  const auto split = [](float x, int n, int& index) {
    x = std::clamp(x, 0.0f, float(n - 1));
    index = std::min(int(x), n - 2);
    return x - float(index);
  };
  int i, j, k;
  const float x = split(p.x, nx_, i), y = split(p.y, ny_, j), z = split(p.z, nz_, k);
  const std::size_t row = std::size_t(nx_), slice = row * std::size_t(ny_);
  const float* c = &values_[offset(i, j, k)];
  const float* d = c + slice;
  if (low) {
    const auto [least, most] =
        std::minmax({c[0], c[1], c[row], c[row + 1], d[0], d[1], d[row], d[row + 1]});
    *low = least, *high = most;
  }
  const auto face = [&](const float* f) {
    const float a = f[0] + x * (f[1] - f[0]), b = f[row] + x * (f[row + 1] - f[row]);
    return a + y * (b - a);
  };
  const float front = face(c);
  return front + z * (face(d) - front);
}

Plume::Plume(const PlumeSettings& s)
    : s_(s),
      rows_(std::min(s.ny, 12 + kRowsAhead)),
      u_(s.nx + 1, s.ny, s.nz),
      v_(s.nx, s.ny + 1, s.nz),
      w_(s.nx, s.ny, s.nz + 1),
      smoke_(s.nx, s.ny, s.nz),
      heat_(s.nx, s.ny, s.nz),
      pressure_(s.nx, s.ny, s.nz) {}

glm::vec3 Plume::velocity(glm::vec3 p) const {
  return {u_.sample({p.x + 0.5f, p.y, p.z}), v_.sample({p.x, p.y + 0.5f, p.z}),
          w_.sample({p.x, p.y, p.z + 0.5f})};
}

glm::vec3 Plume::centre_velocity(int i, int j, int k) const {
  return 0.5f * glm::vec3(u_.at(i, j, k) + u_.at(i + 1, j, k), v_.at(i, j, k) + v_.at(i, j + 1, k),
                          w_.at(i, j, k) + w_.at(i, j, k + 1));
}

// To where the air of a cell was a step ago (direction -1) or will be (+1): midpoint rule.
glm::vec3 Plume::displacement(int i, int j, int k, float direction) const {
  return direction * velocity(cell(i, j, k) + 0.5f * direction * centre_velocity(i, j, k));
}

template <class Visit>
void Plume::for_each_cell(Visit&& visit) const {
  tbb::parallel_for(0, s_.nz, [&](int k) {
    for (int j = 0; j < rows_; ++j)
      for (int i = 0; i < s_.nx; ++i) visit(i, j, k);
  });
}

// A fire of flickering patches on the floor.
void Plume::emit() {
  const glm::dvec3 middle = {0.5 * (s_.nx - 1), 0, 0.5 * (s_.nz - 1)};
  const double time = 0.045 * steps_, radius = double(s_.source_radius);
  for_each_cell([&](int i, int j, int k) {
    const glm::dvec3 d = glm::dvec3(i, j, k) - middle;
    if (j > 3 || glm::length(d) > 1.8 * radius) return;
    const glm::dvec3 at = {d.x / 6, d.z / 6, time};
    const double ragged = radius * (1 + 0.6 * gradient_noise(at, s_.seed));
    const double amount = smooth_step(ragged + 1, ragged - 2, std::sqrt(d.x * d.x + d.z * d.z));
    if (amount <= 0) return;
    const double fire = amount * (0.75 + 0.5 * gradient_noise(1.7 * at, s_.seed + 1));
    smoke_.at(i, j, k) = std::max(smoke_.at(i, j, k), float(fire));
    heat_.at(i, j, k) = std::max(heat_.at(i, j, k), float(1.25 * fire));
    // a breath from the side that turns with time breaks the symmetry
    v_.at(i, j, k) += 0.02f * float(fire);
    u_.at(i, j, k) += 0.03f * float(gradient_noise({0.5, 0.3, 2 * time}, s_.seed + 2));
    w_.at(i, j, k) += 0.03f * float(gradient_noise({0.5, 0.7, 2 * time}, s_.seed + 3));
  });
}

void Plume::push() {
  for_each_cell([&](int i, int j, int k) {
    if (j == 0) return;
    v_.at(i, j, k) += s_.buoyancy * 0.5f * (heat_.at(i, j - 1, k) + heat_.at(i, j, k));
  });
}

// Force of strength eps * (N x omega), N towards stronger vorticity: gives back the small eddies
// that semi-Lagrangian steps lose.
void Plume::confine() {
  const int nx = s_.nx, ny = s_.ny, nz = s_.nz;
  std::array<CellField, 3> omega{CellField(nx, ny, nz), CellField(nx, ny, nz),
                                 CellField(nx, ny, nz)};
  CellField strength(nx, ny, nz);
  const auto inside = [&](int i, int j, int k) {
    return i > 0 && j > 0 && k > 0 && i < nx - 1 && j < rows_ - 1 && k < nz - 1;
  };
  for_each_cell([&](int i, int j, int k) {
    if (!inside(i, j, k)) return;
    const glm::vec3 dx = 0.5f * (centre_velocity(i + 1, j, k) - centre_velocity(i - 1, j, k));
    const glm::vec3 dy = 0.5f * (centre_velocity(i, j + 1, k) - centre_velocity(i, j - 1, k));
    const glm::vec3 dz = 0.5f * (centre_velocity(i, j, k + 1) - centre_velocity(i, j, k - 1));
    const glm::vec3 curl = {dy.z - dz.y, dz.x - dx.z, dx.y - dy.x};
    for (int a = 0; a < 3; ++a) omega[std::size_t(a)].at(i, j, k) = curl[a];
    strength.at(i, j, k) = glm::length(curl);
  });
  std::array<CellField, 3> force = {CellField(nx, ny, nz), CellField(nx, ny, nz),
                                    CellField(nx, ny, nz)};
  for_each_cell([&](int i, int j, int k) {
    if (!inside(i, j, k)) return;
    const glm::vec3 slope = {strength.at(i + 1, j, k) - strength.at(i - 1, j, k),
                             strength.at(i, j + 1, k) - strength.at(i, j - 1, k),
                             strength.at(i, j, k + 1) - strength.at(i, j, k - 1)};
    const float steep = glm::length(slope);
    if (steep < 1e-6f) return;
    const glm::vec3 curl = {omega[0].at(i, j, k), omega[1].at(i, j, k), omega[2].at(i, j, k)};
    // only where there is smoke to see it
    const float eps = s_.confinement * std::min(1.0f, 4 * smoke_.at(i, j, k));
    const glm::vec3 f = eps * glm::cross(slope / steep, curl);
    for (int a = 0; a < 3; ++a) force[std::size_t(a)].at(i, j, k) = f[a];
  });
  for_each_cell([&](int i, int j, int k) {
    if (!inside(i, j, k)) return;
    u_.at(i, j, k) += 0.5f * (force[0].at(i, j, k) + force[0].at(i - 1, j, k));
    v_.at(i, j, k) += 0.5f * (force[1].at(i, j, k) + force[1].at(i, j - 1, k));
    w_.at(i, j, k) += 0.5f * (force[2].at(i, j, k) + force[2].at(i, j, k - 1));
  });
}

float Plume::divergence(int i, int j, int k) const {
  return u_.at(i + 1, j, k) - u_.at(i, j, k) + v_.at(i, j + 1, k) - v_.at(i, j, k) +
         w_.at(i, j, k + 1) - w_.at(i, j, k);
}

double Plume::largest_divergence() const {
  float most = 0;
  for (int k = 0; k < s_.nz; ++k)
    for (int j = 0; j < s_.ny; ++j)
      for (int i = 0; i < s_.nx; ++i) most = std::max(most, std::abs(divergence(i, j, k)));
  return double(most);
}

void Plume::project() {
  const int nx = s_.nx, ny = s_.ny, nz = s_.nz;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j) u_.at(0, j, k) = u_.at(nx, j, k) = 0;
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) w_.at(i, j, 0) = w_.at(i, j, nz) = 0;
  for (int k = 0; k < nz; ++k)
    for (int i = 0; i < nx; ++i) v_.at(i, 0, k) = 0;

  CellField source(nx, ny, nz);
  for_each_cell([&](int i, int j, int k) { source.at(i, j, k) = divergence(i, j, k); });
  constexpr float kOverRelaxation = 1.82f;
  for (int sweep = 0; sweep < 2 * s_.pressure_sweeps; ++sweep)
    tbb::parallel_for(0, nz, [&](int k) {
      for (int j = 0; j < rows_; ++j)
        for (int i = (sweep + j + k) & 1; i < nx; i += 2) {
          // a solid neighbour takes no part; the open top has pressure 0 and counts
          float sum = 0, count = 1;
          if (i > 0) sum += pressure_.at(i - 1, j, k), ++count;
          if (i < nx - 1) sum += pressure_.at(i + 1, j, k), ++count;
          if (k > 0) sum += pressure_.at(i, j, k - 1), ++count;
          if (k < nz - 1) sum += pressure_.at(i, j, k + 1), ++count;
          if (j > 0) sum += pressure_.at(i, j - 1, k), ++count;
          if (j < rows_ - 1) sum += pressure_.at(i, j + 1, k);
          float& p = pressure_.at(i, j, k);
          p += kOverRelaxation * ((sum - source.at(i, j, k)) / count - p);
        }
    });
  for_each_cell([&](int i, int j, int k) {
    const float p = pressure_.at(i, j, k);
    if (i > 0) u_.at(i, j, k) -= p - pressure_.at(i - 1, j, k);
    if (j > 0) v_.at(i, j, k) -= p - pressure_.at(i, j - 1, k);
    if (k > 0) w_.at(i, j, k) -= p - pressure_.at(i, j, k - 1);
    if (j == rows_ - 1) v_.at(i, rows_, k) += p;
  });
}

// Air carries its own velocity (semi-Lagrangian: a face is displaced as the two cells beside it),
// and smoke and heat (MacCormack: there and back again, half of what that lost is put back, within
// the range of the values that it came from).
void Plume::advect() {
  const CellField smoke = smoke_, heat = heat_;
  CellField smoke_there = smoke_, heat_there = heat_;
  std::array<CellField, 3> back{smoke_, smoke_, smoke_};
  for_each_cell([&](int i, int j, int k) {
    const glm::vec3 d = displacement(i, j, k, -1), from = cell(i, j, k) + d;
    for (int a = 0; a < 3; ++a) back[std::size_t(a)].at(i, j, k) = d[a];
    smoke_there.at(i, j, k) = smoke.sample(from);
    heat_there.at(i, j, k) = heat.sample(from);
  });
  const auto departure = [&](int i, int j, int k) {
    return cell(i, j, k) + glm::vec3(back[0].at(i, j, k), back[1].at(i, j, k), back[2].at(i, j, k));
  };
  CellField u = u_, v = v_, w = w_;
  for_each_cell([&](int i, int j, int k) {
    const glm::vec3 from = departure(i, j, k), ahead = cell(i, j, k) + displacement(i, j, k, 1);
    const auto corrected = [&](const CellField& now, const CellField& there) {
      float low, high;
      now.sample(from, low, high);
      return std::clamp(there.at(i, j, k) + 0.5f * (now.at(i, j, k) - there.sample(ahead)), low,
                        high);
    };
    smoke_.at(i, j, k) = corrected(smoke, smoke_there);
    heat_.at(i, j, k) = corrected(heat, heat_there) * (1 - s_.cooling);
    // The face between this cell and the one before it; half a cell lies between face and lattice.
    if (i > 0)
      u.at(i, j, k) = u_.sample(0.5f * (from + departure(i - 1, j, k)) + glm::vec3(.5f, 0, 0));
    if (j > 0)
      v.at(i, j, k) = v_.sample(0.5f * (from + departure(i, j - 1, k)) + glm::vec3(0, .5f, 0));
    if (k > 0)
      w.at(i, j, k) = w_.sample(0.5f * (from + departure(i, j, k - 1)) + glm::vec3(0, 0, .5f));
  });
  u_ = std::move(u), v_ = std::move(v), w_ = std::move(w);
}

void Plume::raise_rows() {
  int top = 0;
  for (int k = 0; k < s_.nz; ++k)
    for (int j = top; j < rows_; ++j)
      for (int i = 0; i < s_.nx; ++i)
        if (smoke_.at(i, j, k) > kTraceSmoke) top = j;
  rows_ = std::clamp(top + kRowsAhead, rows_, s_.ny);
}

void Plume::step() {
  emit();
  push();
  confine();
  project();
  advect();
  raise_rows();
  ++steps_;
}

std::vector<SampleGrid> make_plume(const PlumeSettings& settings, double voxel_m,
                                   const std::vector<int>& steps) {
  constexpr double kLeast = 0.004;  // thinner smoke is not worth a voxel
  std::vector<SampleGrid> frames;
  Plume plume(settings);
  int done = 0;
  for (const int wanted : steps) {
    for (; done < wanted; ++done) plume.step();
    SampleGrid frame;
    frame.columns = glm::dmat3(voxel_m);
    frame.translation = {-0.5 * voxel_m * settings.nx, 0, -0.5 * voxel_m * settings.nz};
    const Voxel high = {settings.nx - 1, settings.ny - 1, settings.nz - 1};
    frame.blocks = sample({0, 0, 0}, high, [&](const Voxel& at) {
      // the bed of the fire is no smoke: fade in over the rows where the air is drawn in
      const double density =
          double(plume.smoke().at(at[0], at[1], at[2])) * smooth_step(3, 10, at[1]);
      return wanted == 0 || density < kLeast ? 0.0 : double(float(density));
    });
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace nepho::samples
