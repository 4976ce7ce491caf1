#include "forecast/rasters/raster_options.h"

#include "core/error.h"

namespace nepho::forecast {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

// "QUANTITY" or "QUANTITY UNIT".
RasterOptions::Band parse_band(const std::string& text, const std::string& where) {
  if (text == "-") return {};
  const std::size_t end = text.find(' ');
  RasterOptions::Band band{quantity_named(text.substr(0, end)), ""};
  if (!band.quantity)
    throw Error({"this is no quantity of clouds", where, quantity_words() + ", or - for none",
                 "\"" + text + "\"", "a band is QUANTITY UNIT, such as top_height km"});
  if (end != std::string::npos) band.unit = trimmed(text.substr(end));
  return band;
}

std::vector<RasterOptions::Band> parse_bands(const std::string& text, const std::string& where) {
  std::vector<RasterOptions::Band> bands;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    bands.push_back(parse_band(trimmed(text.substr(at, comma - at)), where));
    at = comma + 1;
  }
  return bands;
}

std::optional<double> within(Parameters& parameters, const char* name, double low, double high) {
  if (!parameters.number(name)) return std::nullopt;
  return parameters.number_in(name, 0, low, high);
}

}  // namespace

RasterOptions raster_options(Parameters& parameters) {
  RasterOptions options;
  if (const std::string text = parameters.word("bands", ""); !text.empty())
    options.bands = parse_bands(text, parameters.where("bands"));
  options.base_m = within(parameters, "cloud_base_m", -500, 30000);
  options.top_m = within(parameters, "cloud_top_m", -400, 40000);
  options.thickness_m = within(parameters, "cloud_thickness_m", 1, 30000);
  options.optical_depth = within(parameters, "cloud_optical_depth", 1e-6, 1000);
  options.stated = !options.bands.empty() || options.base_m || options.top_m ||
                   options.thickness_m || options.optical_depth;
  options.profile = parameters.choice("cloud_profile", {"uniform", "adiabatic"}) == "adiabatic"
                        ? Profile::kAdiabatic
                        : Profile::kUniform;
  const std::string phase = parameters.choice("cloud_phase", {"by_temperature", "liquid", "ice"});
  options.phase = phase == "liquid" ? RasterPhase::kLiquid
                  : phase == "ice"  ? RasterPhase::kIce
                                    : RasterPhase::kByTemperature;
  options.liquid_radius_m =
      parameters.number_in("liquid_radius_m", options.liquid_radius_m, 1e-6, 100e-6);
  options.ice_radius_m = parameters.number_in("ice_radius_m", options.ice_radius_m, 1e-6, 300e-6);
  options.liquid_content_kg_per_m3 = parameters.number_in(
      "liquid_content_kg_per_m3", options.liquid_content_kg_per_m3, 1e-6, 20e-3);
  options.ice_content_kg_per_m3 =
      parameters.number_in("ice_content_kg_per_m3", options.ice_content_kg_per_m3, 1e-7, 20e-3);
  options.droplets_per_m3 =
      parameters.number_in("droplets_per_m3", options.droplets_per_m3, 1e6, 1e10);
  if (options.base_m && options.top_m && options.thickness_m)
    throw Error({"base, top and thickness of the clouds exclude each other",
                 parameters.where("cloud_thickness_m"), "two of them", "three", ""});
  if (options.base_m && options.top_m && !(*options.base_m + 1 <= *options.top_m))
    throw Error({"the clouds' top is not above their base", parameters.where("cloud_top_m"),
                 "above " + std::to_string(*options.base_m) + " m",
                 std::to_string(*options.top_m) + " m", ""});
  return options;
}

}  // namespace nepho::forecast
