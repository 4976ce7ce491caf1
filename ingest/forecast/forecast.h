#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

#include "bricks/data_facts.h"
#include "bricks/volume_info.h"

namespace nepho::forecast {

// What a convention (WRF, CF, ...) makes of files, and all that the way to bricks knows of them.
//
//   DataFile --conventions/*--> Forecast --bricks/*--> samples --pyramid--> BrickSource

// Cells of any shape: corners [first[cell], first[cell + 1]) in order around each, latitude and
// longitude (deg). Walls are great circles; cells are convex, or nearly. None: a cell without a
// place.
struct CellPolygons {
  std::vector<std::uint32_t> first;
  std::vector<glm::dvec2> corner_deg;
};

// Where the cells of a model grid lie. Cell (i, j) covers [i, i+1] x [j, j+1]; i runs along the
// fastest axis of ForecastColumns, both in the file's own order (rows may run south).
class HorizontalGrid {
 public:
  virtual ~HorizontalGrid() = default;
  virtual int nx() const = 0;
  virtual int ny() const = 0;
  // x goes all the way round the planet: cell nx is cell 0.
  virtual bool around() const = 0;
  // Geodetic latitude and longitude (deg, longitude continuous along x, any multiple of a turn) at
  // x in [0, nx], y in [0, ny]. NaN: off the planet, as cells beside a satellite's disc are.
  virtual glm::dvec2 lat_lon_deg(double x, double y) const = 0;
  // The unit vector of that place.
  virtual glm::dvec3 direction(double x, double y) const;
  // Where cells are no rows and columns (triangles, Voronoi's cells): nx of them, ny is 1, and
  // lat_lon_deg is the centre of the cell floor(x). Null for all other grids.
  virtual const CellPolygons* polygons() const { return nullptr; }
};

// One time of a forecast: nz layers per cell, from the ground up, in model cells [j * nx + i].
// Cell means: extinction times thickness is the layer's optical depth.
struct ForecastColumns {
  int nx = 0, ny = 0, nz = 0;
  std::vector<float> interface_m;           // [cell * (nz + 1) + k], rising; over the ellipsoid
  std::vector<float> extinction_per_m;      // [cell * nz + k]; liquid and ice; >= 0, finite
  std::vector<float> ice_extinction_per_m;  // the ice part; empty where the data have no ice
  // [cell]: all of its water is missing, so that it covers no coarser domain; empty: none.
  std::vector<char> without_data;
  // For `info`: water of each column, [cell] or empty; cloud apart from rain, snow and graupel.
  std::vector<float> liquid_kg_per_m2, ice_kg_per_m2, precipitation_kg_per_m2;
  std::vector<DataVariable> variables;  // what was read of this time
};

// The model's own ground, [j * nx + i]; empty vectors where the file has none.
struct ForecastGround {
  std::vector<float> height_m, water;  // water: 1 sea .. 0 land
};

// Of a variable of a file: bytes of values that were asked for, and of all its values.
struct VariableBytes {
  std::string name;
  std::uint64_t read = 0, held = 0;
};

class Forecast;

// A domain at one of its own times.
struct DomainTime {
  const Forecast* domain;
  std::size_t time;
};

// Thread-safe; reads under the host's I/O lock. Throws Error.
class Forecast {
 public:
  virtual ~Forecast() = default;
  virtual std::int64_t time_origin_ns() const = 0;
  virtual const std::vector<double>& times_s() const = 0;  // since the origin, ascending
  virtual bool has_ice() const = 0;
  // Of one time: nests move.
  virtual std::shared_ptr<const HorizontalGrid> grid(std::size_t time) const = 0;
  virtual ForecastColumns columns(std::size_t time) const = 0;
  virtual ForecastGround ground(std::size_t time) const = 0;
  // What is drawn at a time, finest first: of nests several, each in place of all after it where it
  // has cells. grid, columns and ground are those of the first.
  virtual std::vector<DomainTime> domains(std::size_t time) const { return {{this, time}}; }
  // Lowest and highest interface over all times, and the thickness of the thin layers
  // that hold cloud: a tenth of all optical depth is in thinner ones.
  virtual glm::dvec2 height_range_m() const = 0;
  virtual double thinnest_layer_m() const = 0;
  // Mean effective radius of the liquid part (m), weighted by extinction: the volume's phase.
  virtual double liquid_radius_m() const = 0;
  // Not so where all water is missing at all times.
  virtual bool has_data() const { return true; }
  virtual std::vector<std::string> assumptions() const = 0;
  virtual std::vector<std::string> facts() const = 0;
  // For `info`: model, grid, levels and optics, as far as they were found.
  virtual std::vector<DataFacts::Recognised> recognised() const { return {}; }
  // What has been read until now, of all variables of all files.
  virtual std::vector<VariableBytes> bytes_read() const { return {}; }
};

}  // namespace nepho::forecast
