#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <vector>

#include "bricks/coarsen.h"
#include "sources/noise/level_response.h"
#include "sources/noise/planet.h"

namespace nepho::noise {

struct FieldBrick {
  BrickSamples total{}, ice{};  // 1/m
  double variance_per_m2 = 0;   // mean over the node of what the octaves left out would add
};

// Of a closed node and all below it; tests/noise samples descendants against it.
struct FieldBound {
  double most_per_m = 0;   // of decoded samples; 0: nothing anywhere
  double error_per_m = 0;  // |own trilinear - finest|
};

// The layers of a planet on a lattice. Everything depends on a sample's owner position and level.
class Field {
 public:
  Field(std::vector<LayerSpec> layers, std::shared_ptr<const ShellChart> chart,
        const Lattice& lattice);

  void brick(NodeKey key, FieldBrick& brick) const;
  FieldBound bound(NodeKey key) const;
  // The field itself: what the finest samples are.
  double extinction_per_m(const glm::dvec3& direction, double height_m) const;
  double finest_m() const { return finest_m_; }
  const std::vector<Layer>& layers() const { return layers_; }

 private:
  struct Column {
    glm::dvec3 direction;
    double base_x = 0;  // climate - threshold + globe and sheet octaves
    SheetPoints points;
  };

  const LevelResponse& response(std::size_t layer, int level) const;
  void prepare(std::size_t layer, const std::vector<double>& weights, Column& column) const;
  double volume_x(std::size_t layer, const Octave& octave, const Column& column,
                  double height_m) const;
  double full_x(std::size_t layer, const glm::dvec3& direction, double height_m) const;
  void add_layer(std::size_t layer, NodeKey key, std::array<Column, 81>& columns,
                 FieldBrick& brick) const;
  double highest_x(std::size_t layer, int level, const glm::dvec3& direction, double radius_m,
                   double low_m, double high_m) const;

  std::shared_ptr<const ShellChart> chart_;
  Lattice lattice_;
  double radius_m_, finest_m_;
  Directions directions_;
  std::vector<Layer> layers_;
  std::vector<Sheets> sheets_;  // per layer
  std::vector<Storms> storms_;  // one, shared: layers feel the same weather
  struct Lazy {
    std::once_flag once;
    std::unique_ptr<const LevelResponse> response;
  };
  mutable std::vector<std::unique_ptr<Lazy>> responses_;  // layer * levels + level
};

}  // namespace nepho::noise
