#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "forecast/conventions/field_reader.h"
#include "forecast/conventions/model.h"
#include "forecast/conventions/vertical.h"

namespace nepho::forecast {

// The air of a CF-like file: temperature (or potential temperature, or that of liquid water),
// vapour, pressure and density, as fields or, for models with a base state, as one number per
// level. The standard atmosphere stands in for what is not there, and that is said.
class CfAir {
 public:
  // `z` is the water's level dimension. The file's variables are looked for here.
  CfAir(std::shared_ptr<const FieldReader> reader, int z);

  // What temperature is worked out from; null: the standard atmosphere's.
  const FileVariable* temperature() const { return temperature_; }
  bool has_vapour() const { return vapour_; }
  // Pressure and density, once the levels' heights are known. `water` is what they are for: liquid
  // of it, and whether any of it counts per kg. `vertical` must outlive this.
  void choose_pressure(Vertical& vertical, const std::vector<WaterVariable>& water,
                       std::vector<std::string>& assumptions, std::vector<std::string>& facts);
  Air at(std::size_t time, const Vertical& vertical) const;
  // Sentences on rows of names without a file behind them.
  std::vector<std::string> untested_names(const Vertical& vertical) const;

 private:
  enum class Kind { kTemperature, kPotential, kLiquidPotential };
  bool is_profile(const FileVariable& variable) const;
  std::vector<double> profile(const FileVariable& variable, std::size_t time, bool from_top,
                              const UnitOf& unit) const;
  std::vector<float> field(const FileVariable& variable, std::size_t time, bool from_top,
                           const UnitOf& unit) const;
  void find_temperature();
  void find_vapour();
  void make_standard(const Vertical& vertical);
  void add_latent_heat(std::size_t time, bool from_top, Air& air) const;

  std::shared_ptr<const FieldReader> reader_;
  int z_;
  const FileVariable *temperature_ = nullptr, *vapour_ = nullptr, *density_ = nullptr,
                     *level_pressure_ = nullptr;
  Kind kind_ = Kind::kTemperature;
  Vapour vapour_is_ = Vapour::kNone;
  std::vector<WaterVariable> liquid_;              // of mass ratios
  std::optional<std::vector<float>> standard_Pa_;  // of heights, where no pressure is known
};

// Is a field under the name of pressure a deviation from a base state? It falls to 0 or below.
bool is_deviation(const FieldReader& reader, const FileVariable& variable, int z);

}  // namespace nepho::forecast
