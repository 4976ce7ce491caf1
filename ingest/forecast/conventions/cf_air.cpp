#include "forecast/conventions/cf_air.h"

#include <algorithm>
#include <cmath>

#include "forecast/water/air.h"
#include "units/constants.h"

namespace nepho::forecast {
namespace {

// Of the potential temperature of liquid water: T = theta_l (p / 1000 hPa)^(2/7) + L r_l / c_p
// (Betts 1973, doi:10.1002/qj.49709941915, its linear form, as the models that write it have it).
constexpr double kLatentOverHeat_K = 2.5e6 / 1004.7;

void scale(std::vector<float>& values, const UnitOf& unit) {
  if (unit.factor == 1 && unit.offset == 0) return;
  for (float& value : values) value = float(double(value) * unit.factor + unit.offset);
}

}  // namespace

bool is_deviation(const FieldReader& reader, const FileVariable& variable, int z) {
  const int top = int(reader.file->size(z)) - 1;
  for (const int level : {0, top})
    for (const float value : reader.levels(variable, z, false, 0, level, 1))
      if (value <= 0) return true;
  return false;
}

CfAir::CfAir(std::shared_ptr<const FieldReader> reader, int z) : reader_(std::move(reader)), z_(z) {
  find_temperature();
  find_vapour();
}

// One number per level, at all times or at each.
bool CfAir::is_profile(const FileVariable& variable) const {
  const auto is = [&](int d) { return d == z_; };
  return variable.numeric && std::ranges::any_of(variable.dimensions, is) &&
         std::ranges::all_of(variable.dimensions,
                             [&](int d) { return d == z_ || d == reader_->time; }) &&
         variable.name != reader_->file->name(z_);
}

std::vector<double> CfAir::profile(const FileVariable& variable, std::size_t time, bool from_top,
                                   const UnitOf& unit) const {
  std::vector<std::size_t> start, count;
  for (const int d : variable.dimensions) {
    start.push_back(d == z_ ? 0 : time);
    count.push_back(d == z_ ? reader_->file->size(z_) : 1);
  }
  std::vector<double> values = reader_->file->read_doubles(variable, start, count);
  for (double& value : values) value = value * unit.factor + unit.offset;
  if (from_top) std::ranges::reverse(values);
  return values;
}

std::vector<float> CfAir::field(const FileVariable& variable, std::size_t time, bool from_top,
                                const UnitOf& unit) const {
  std::vector<float> values = reader_->field(variable, z_, from_top, time);
  scale(values, unit);
  return values;
}

// Fields before profiles, temperature before what it must be worked out from.
void CfAir::find_temperature() {
  for (const bool profiles : {false, true})
    for (const auto& [quantity, kind] :
         {std::pair{names::kTemperature, Kind::kTemperature},
          {names::kPotentialTemperature, Kind::kPotential},
          {names::kLiquidPotentialTemperature, Kind::kLiquidPotential}}) {
      if (temperature_) return;
      temperature_ = find_named(*reader_->file, quantity, [&](const FileVariable& v) {
        return (profiles ? is_profile(v) : reader_->is_field(v, z_)) &&
               unit_of(v, nepho::kTemperature).fits;
      });
      kind_ = kind;
    }
}

void CfAir::find_vapour() {
  const auto humidity = [&](Quantity quantity, Vapour kind) {
    if (vapour_) return;
    vapour_ = find_named(*reader_->file, quantity, [&](const FileVariable& v) {
      return reader_->is_field(v, z_) && unit_of(v, kDimensionless).fits;
    });
    if (vapour_) vapour_is_ = kind;
    // `r` is relative humidity to some and a mixing ratio to others.
    if (vapour_ && kind == Vapour::kRelative &&
        vapour_->text("units").find('g') != std::string::npos)
      vapour_is_ = Vapour::kMixingRatio;
  };
  humidity(names::kSpecificHumidity, Vapour::kSpecific);
  humidity(names::kVapourMixingRatio, Vapour::kMixingRatio);
  humidity(names::kRelativeHumidity, Vapour::kRelative);
}

// Densities of heights without pressure: the standard atmosphere's at the middle of the layers.
void CfAir::make_standard(const Vertical& vertical) {
  const std::vector<float> z = vertical.interfaces_m(0, nullptr);
  const std::size_t nz = reader_->file->size(z_), cells = z.size() / (nz + 1);
  std::vector<float> pressure(nz * cells);
  for (std::size_t n = 0; n < cells; ++n)
    for (std::size_t k = 0; k < nz; ++k) {
      const double middle = 0.5 * (double(z[n * (nz + 1) + k]) + double(z[n * (nz + 1) + k + 1]));
      constexpr double kRadius_m = 6356766;
      pressure[k * cells + n] =
          float(nepho::forecast::standard_pressure_Pa(kRadius_m * middle / (kRadius_m + middle)));
    }
  standard_Pa_ = std::move(pressure);
}

void CfAir::choose_pressure(Vertical& vertical, const std::vector<WaterVariable>& water,
                            std::vector<std::string>& assumptions,
                            std::vector<std::string>& facts) {
  const DataFile& file = *reader_->file;
  for (const WaterVariable& w : water)
    if (w.species == Species::kCloudWater && w.basis != Basis::kVolume) liquid_.push_back(w);
  const bool per_volume =
      std::ranges::all_of(water, [](const WaterVariable& w) { return w.basis == Basis::kVolume; });
  if (vertical.level_pressure_Pa.empty() && !vertical.pressure)
    vertical.pressure = find_named(file, names::kPressure, [&](const FileVariable& v) {
      if (!reader_->is_field(v, z_) || !unit_of(v, kPressure).fits) return false;
      if (!is_deviation(*reader_, v, z_)) return true;
      facts.push_back(v.name +
                      " falls to 0 and below: it is no pressure but a deviation from one, "
                      "and is not used.");
      return false;
    });
  const bool has_field =
      !vertical.level_pressure_Pa.empty() || vertical.pressure || vertical.pressure_Pa;
  density_ = find_named(file, names::kDensity, [&](const FileVariable& v) {
    return unit_of(v, nepho::kDensity).fits &&
           (is_profile(v) || (!has_field && reader_->is_field(v, z_)));
  });
  if (density_) facts.push_back("Densities are the file's, " + density_->name + ".");
  if (!has_field)
    level_pressure_ = find_named(file, names::kPressure, [&](const FileVariable& v) {
      return is_profile(v) && unit_of(v, kPressure).fits;
    });
  if (level_pressure_)
    facts.push_back("Pressures are those of the base state, " + level_pressure_->name +
                    ": one per level.");
  if (temperature_ && kind_ != Kind::kTemperature)
    facts.push_back(
        "Temperatures are worked out from the potential temperature " + temperature_->name +
        (kind_ == Kind::kLiquidPotential ? ", that of liquid water, and the liquid." : "."));
  if (!has_field && !level_pressure_) {
    make_standard(vertical);
    if (!per_volume && !density_)
      assumptions.push_back(
          "There is no pressure: air densities are the standard atmosphere's at these heights. A "
          "variable of the base state's density or pressure, one per level, would tell them.");
    else if (temperature_ && kind_ != Kind::kTemperature)
      assumptions.push_back(
          "There is no pressure: temperatures are by the standard atmosphere's at these heights.");
  }
  if (!temperature_ && !per_volume && !density_)
    assumptions.push_back(
        "There is no temperature: the standard atmosphere's is taken for densities.");
}

void CfAir::add_latent_heat(std::size_t time, bool from_top, Air& air) const {
  const std::size_t cells = std::size_t(reader_->nx) * std::size_t(reader_->ny);
  for (std::size_t at = 0; at < air.temperature_K.size(); ++at) {
    const double p =
        air.pressure_Pa.empty() ? air.level_pressure_Pa[at / cells] : double(air.pressure_Pa[at]);
    air.temperature_K[at] = float(temperature_of_theta_K(double(air.temperature_K[at]), p));
  }
  air.is_theta = false;
  for (const WaterVariable& w : liquid_) {
    const std::vector<float> ratio = reader_->field(*w.variable, z_, from_top, time);
    for (std::size_t at = 0; at < ratio.size(); ++at)
      if (ratio[at] > 0)
        air.temperature_K[at] += float(kLatentOverHeat_K * double(ratio[at]) * w.to_si);
  }
}

Air CfAir::at(std::size_t time, const Vertical& vertical) const {
  Air air;
  if (!vertical.level_pressure_Pa.empty())
    air.level_pressure_Pa = vertical.level_pressure_Pa;
  else if (vertical.pressure)
    air.pressure_Pa =
        field(*vertical.pressure, time, vertical.from_top, unit_of(*vertical.pressure, kPressure));
  else if (vertical.pressure_Pa)
    air.pressure_Pa = vertical.pressure_Pa(time);
  else if (level_pressure_)
    air.level_pressure_Pa =
        profile(*level_pressure_, time, vertical.from_top, unit_of(*level_pressure_, kPressure));
  else if (standard_Pa_)
    air.pressure_Pa = *standard_Pa_;
#ifdef NEPHO_MUTANT_BASE_DENSITY
  if (false)
#else
  if (density_)
#endif
  {
    const UnitOf unit = unit_of(*density_, nepho::kDensity);
    if (is_profile(*density_))
      air.level_density_kg_per_m3 = profile(*density_, time, vertical.from_top, unit);
    else
      air.density_kg_per_m3 = field(*density_, time, vertical.from_top, unit);
  }
  if (temperature_) {
    const UnitOf unit = unit_of(*temperature_, nepho::kTemperature);
    air.is_theta = kind_ != Kind::kTemperature;
    if (is_profile(*temperature_))
      air.level_temperature_K = profile(*temperature_, time, vertical.from_top, unit);
    else
      air.temperature_K = field(*temperature_, time, vertical.from_top, unit);
    if (kind_ == Kind::kLiquidPotential && !air.temperature_K.empty())
      add_latent_heat(time, vertical.from_top, air);
  }
  if (vapour_) {
    air.vapour = field(*vapour_, time, vertical.from_top, unit_of(*vapour_, kDimensionless));
    air.vapour_is = vapour_is_;
  }
  return air;
}

std::vector<std::string> CfAir::untested_names(const Vertical& vertical) const {
  std::vector<std::string> said;
  const auto note = [&](const FileVariable* variable, Quantity quantity) {
    if (!variable) return;
    if (std::string text = untested(*reader_->file, quantity, *variable); !text.empty())
      said.push_back(std::move(text));
  };
  note(temperature_, kind_ == Kind::kTemperature ? names::kTemperature
                     : kind_ == Kind::kPotential ? names::kPotentialTemperature
                                                 : names::kLiquidPotentialTemperature);
  note(vapour_, vapour_is_ == Vapour::kSpecific      ? names::kSpecificHumidity
                : vapour_is_ == Vapour::kMixingRatio ? names::kVapourMixingRatio
                                                     : names::kRelativeHumidity);
  note(vertical.pressure, names::kPressure);
  note(level_pressure_, names::kPressure);
  note(density_, names::kDensity);
  return said;
}

}  // namespace nepho::forecast
