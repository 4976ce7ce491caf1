#include "scene/scene_grammar.h"

namespace nepho {
namespace {

using enum FieldKind;
constexpr double kHuge = 1e300;
constexpr double kLargestImageSide = 16384;  // GL_MAX_TEXTURE_SIZE that every driver here has
constexpr double kLargestExact = 9007199254740992.0;  // 2^53: integers that a JSON number holds

constexpr FieldGrammar kPointFields[] = {
    {"lat_deg", kNumber, -90, 90},
    {"lon_deg", kNumber, -360, 360},
    {"height_m", kNumber, -6e6, 1e12},
};
constexpr ObjectGrammar kPoint{"point", kPointFields};

constexpr FieldGrammar kPlaceFields[] = {
    {"lat_deg", kNumber, -90, 90},
    {"lon_deg", kNumber, -360, 360},
    {"height_m", kNumber, -6e6, 1e12},
    {"heading_deg", kNumber, -360, 360},
};
constexpr ObjectGrammar kPlace{"place", kPlaceFields};

constexpr FieldGrammar kPhaseFields[] = {
    {"kind", kChoice, 0, 0, "mie|henyey_greenstein|hg_draine"},
    {"effective_radius_m", kNumber, 1e-7, 1e-3},
    {"asymmetry", kNumber, -0.9999, 0.9999},
};
constexpr ObjectGrammar kPhase{"phase", kPhaseFields};

constexpr FieldGrammar kVolumeFields[] = {
    {"name", kText},
    {"source", kText},
    {"files", kTextList},
    {"parameters", kParameters},
    {"place", kObject, 0, 0, {}, &kPlace},
    {"phase", kObject, 0, 0, {}, &kPhase},
    {"co_albedo", kVector, 0, 1},
    {"time_s", kNumber},
    {"utc", kText},
    {"time", kText},
};
constexpr ObjectGrammar kVolume{"volume", kVolumeFields};

constexpr FieldGrammar kStandFields[] = {
    {"lat_deg", kNumber, -90, 90},        {"lon_deg", kNumber, -360, 360},
    {"azimuth_deg", kNumber, -360, 360},  {"elevation_deg", kNumber, -90, 90},
    {"eye_height_m", kNumber, 0.01, 1e5},
};
constexpr ObjectGrammar kStand{"stand", kStandFields};

constexpr FieldGrammar kCameraFields[] = {
    {"look_from_m", kVector, -1e12, 1e12},
    {"look_from", kObject, 0, 0, {}, &kPoint},
    {"look_from_ecef_m", kVector, -1e12, 1e12},
    {"look_at_m", kVector, -1e12, 1e12},
    {"look_at", kObject, 0, 0, {}, &kPoint},
    {"look_at_ecef_m", kVector, -1e12, 1e12},
    {"up_ecef", kVector, -kHuge, kHuge},
    {"fov_deg", kNumber, 1e-6, 170},
    {"fov_rad", kNumber, 1e-8, 2.967},
    {"stand", kObject, 0, 0, {}, &kStand},
    {"view", kChoice, 0, 0, "auto|oblique|globe|ground"},
};
constexpr ObjectGrammar kCamera{"camera", kCameraFields};

constexpr FieldGrammar kSunFields[] = {
    {"azimuth_deg", kNumber, -360, 360},          {"elevation_deg", kNumber, -90, 90},
    {"to_sun_ecef", kVector, -kHuge, kHuge},      {"utc", kText},
    {"irradiance_W_per_m2_nm", kVector, 0, 1e12},
};
constexpr ObjectGrammar kSun{"sun", kSunFields};

constexpr FieldGrammar kSkyFields[] = {
    {"zenith_W_per_m2_sr_nm", kVector, 0, 1e12},
    {"horizon_W_per_m2_sr_nm", kVector, 0, 1e12},
    {"below_W_per_m2_sr_nm", kVector, 0, 1e12},
    {"up_ecef", kVector, -kHuge, kHuge},
};
constexpr ObjectGrammar kSky{"sky", kSkyFields};

constexpr FieldGrammar kAirFields[] = {
    {"rayleigh_per_m", kVector, 0, 1},
    {"rayleigh_scale_m", kNumber, 1, 1e6},
    {"aerosol_extinction_per_m", kVector, 0, 1},
    {"aerosol_albedo", kNumber, 0, 1},
    {"aerosol_asymmetry", kNumber, -0.9999, 0.9999},
    {"aerosol_scale_m", kNumber, 1, 1e6},
    {"ozone_per_m", kVector, 0, 1},
    {"ozone_low_m", kNumber, 0, 1e6},
    {"ozone_peak_m", kNumber, 0, 1e6},
    {"ozone_high_m", kNumber, 0, 1e6},
    {"top_m", kNumber, 100, 1e6},
};
constexpr ObjectGrammar kAir{"air", kAirFields};

constexpr FieldGrammar kGroundFields[] = {
    {"land_albedo", kVector, 0, 1},
    {"water_albedo", kVector, 0, 1},
    {"wind_m_per_s", kNumber, 0, 100},
};
constexpr ObjectGrammar kGround{"ground", kGroundFields};

constexpr FieldGrammar kPlanetFields[] = {
    {"radius_m", kNumber, 1e4, 1e10},        {"equatorial_m", kNumber, 1e4, 1e10},
    {"polar_m", kNumber, 1e4, 1e10},         {"air", kObjectOrNone, 0, 0, {}, &kAir},
    {"ground", kObject, 0, 0, {}, &kGround},
};
constexpr ObjectGrammar kPlanet{"planet", kPlanetFields};

constexpr FieldGrammar kImageFields[] = {
    {"width", kInteger, 1, kLargestImageSide},
    {"height", kInteger, 1, kLargestImageSide},
};
constexpr ObjectGrammar kImage{"image", kImageFields};

constexpr FieldGrammar kPathsFields[] = {
    {"spp", kInteger, 1, 1e9},
    {"noise", kNumber, 1e-5, 10},
    {"levels", kChoice, 0, 0, "finest|resident"},
    {"host_mib", kNumber, 1, 1e6},
    {"exact_orders", kInteger, -1, 1e6},
};
constexpr ObjectGrammar kPaths{"paths", kPathsFields};

constexpr FieldGrammar kRenderFields[] = {
    {"budget_mib", kNumber, 0.001, 1e6},
    {"target_error", kNumber, 1e-4, 1},
    {"target_ms", kNumber, 1e-3, 1e9},
    {"step_voxels", kNumber, 0, 1024},
    {"tolerance", kNumber, 1e-6, 1},
    {"fetch", kChoice, 0, 0, "filter|texels8"},
    {"light", kChoice, 0, 0, "single|octaves"},
    {"pixels", kChoice, 0, 0, "all|adaptive"},
    {"octaves", kInteger, 1, 8},  // those whose error was measured (light_model_table.h)
    {"pixels_per_voxel", kNumber, 1e-3, 1e6},
    {"max_level", kInteger, 0, 31},
    {"seed", kInteger, 0, kLargestExact},
    {"probe_pixels", kInteger, 0, 1e6},
    {"probe_paths", kInteger, 0, 1e6},
    {"engine", kChoice, 0, 0, "march|reference"},
    {"paths", kObject, 0, 0, {}, &kPaths},
};
constexpr ObjectGrammar kRender{"render", kRenderFields};

constexpr FieldGrammar kSceneFields[] = {
    {"name", kText},
    {"place", kObject, 0, 0, {}, &kPlace},
    {"volumes", kObjectList, 0, 0, {}, &kVolume},
    {"camera", kObject, 0, 0, {}, &kCamera},
    {"sun", kObject, 0, 0, {}, &kSun},
    {"sky", kObject, 0, 0, {}, &kSky},
    {"planet", kObjectOrNone, 0, 0, {}, &kPlanet},
    {"terrain", kText},
    {"image", kObject, 0, 0, {}, &kImage},
    {"render", kObject, 0, 0, {}, &kRender},
    {"exposure_ev", kNumber, -60, 60},
    {"tone_map", kChoice, 0, 0, "aces|none"},
    {"dither", kChoice, 0, 0, "none|ordered"},
};
constexpr ObjectGrammar kScene{"scene", kSceneFields};

}  // namespace

const ObjectGrammar& scene_grammar() {
  return kScene;
}

}  // namespace nepho
