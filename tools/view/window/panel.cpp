#include "view/window/panel.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace nepho {
namespace {

constexpr float kWidth = 360, kMargin = 8, kLabel = 120;
// In a smaller window the panel begins as its title bar.
constexpr float kRoomAcross = 560, kRoomDown = 320;
// In one less high, what is seldom touched begins closed.
constexpr float kRoomForAll = 660;
const ImVec4 kErrorColour{1.0f, 0.6f, 0.4f, 1.0f};
constexpr const char* kKeys =
    "W S A D: ahead, back, left, right\n"
    "E Q: up, down; shift faster, control slower\n"
    "drag: turn (orbit: around what is looked at)\n"
    "wheel: a step ahead (orbit: nearer)\n"
    "M: free, orbit, first person (on the ground)\n"
    "R: back to the start, H: hide this panel\n"
    "F12: picture at full quality, with its scene\n"
    "Esc: end; drop files or a picture to open them";

bool slider(const char* name, double& value, double low, double high, const char* format,
            bool logarithmic = false) {
  return ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format,
                             logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
}

bool draw_sun(Panel& panel) {
  bool changed = false;
  if (panel.planet) {
    int kind = panel.sun_dated ? 0 : 1;
    if (ImGui::Combo("sun", &kind, "as at a date\0free\0")) {
      panel.sun_dated = kind == 0;
      changed = true;
    }
  }
  if (!panel.sun_dated) {
    changed |= slider("sun azimuth", panel.sun_azimuth_deg, 0, 360, "%.1f deg");
    changed |= slider("sun elevation", panel.sun_elevation_deg, -20, 90, "%.1f deg");
    return changed;
  }
  // It counts when it is left: by Enter, Tab or a click elsewhere.
  ImGui::InputText("UTC", panel.sun_utc.data(), panel.sun_utc.size(),
                   ImGuiInputTextFlags_AutoSelectAll);
  panel.sun_utc_edited = ImGui::IsItemActive();
  panel.sun_utc_typed = ImGui::IsItemDeactivatedAfterEdit();
  changed |= panel.sun_utc_typed;
  changed |= slider("hour", panel.sun_hour, 0, 23.99, "%.2f h");
  ImGui::Text("%.1f deg high, azimuth %.1f deg", panel.sun_elevation_deg, panel.sun_azimuth_deg);
  return changed;
}

bool draw_light(Panel& panel) {
  const bool changed = slider("exposure", panel.exposure_ev, -8, 8, "%+.2f EV");
  return draw_sun(panel) || changed;
}

// A new budget begins anew: it counts when the mouse lets go of it.
bool draw_budget(Panel& panel) {
  slider("memory", panel.dragged_budget_mib, 16, 8192, "%.0f MiB", true);
  if (ImGui::IsItemDeactivatedAfterEdit()) {
    panel.budget_mib = std::round(panel.dragged_budget_mib);
    return true;
  }
  if (!ImGui::IsItemActive()) panel.dragged_budget_mib = panel.budget_mib;
  return false;
}

bool draw_quality(Panel& panel) {
  bool changed = ImGui::Checkbox("fixed step", &panel.fixed_step);
  if (panel.fixed_step)
    changed |= slider("step", panel.step_voxels, 0.25, 8, "%.2f voxels", true);
  else
    changed |= slider("tolerance", panel.tolerance, 1e-3, 0.1, "%.4f", true);
  changed |= slider("pixels a voxel", panel.pixels_per_voxel, 0.5, 16, "%.2f", true);
  return draw_budget(panel) || changed;
}

bool draw_places(Panel& panel) {
  ImGui::Text("at %.4f, %.4f", panel.place.latitude_deg, panel.place.longitude_deg);
  if (!panel.go_to) panel.go_to = panel.place;
  ImGui::InputDouble("latitude", &panel.go_to->latitude_deg, 0, 0, "%.5f deg");
  ImGui::InputDouble("longitude", &panel.go_to->longitude_deg, 0, 0, "%.5f deg");
  ImGui::InputDouble("over ground", &panel.go_to->height_m, 0, 0, "%.1f m");
  panel.go = ImGui::Button("go there");
  ImGui::SameLine();
  if (ImGui::Button("here")) panel.go_to = panel.place;
  return panel.go;
}

bool draw_volumes(Panel& panel) {
  bool changed = false;
  int number = 0;
  for (Panel::Volume& volume : panel.volumes) {
    ImGui::PushID(number++);
    changed |= ImGui::Checkbox("##shown", &volume.shown);
    ImGui::SameLine();
    ImGui::TextUnformatted(volume.name.c_str());  // "####" of a sequence is no label
    ImGui::PopID();
  }
  return changed;
}

// Always there, whatever becomes of the panel. Returns the height that it takes.
float draw_message(const Panel& panel) {
  if (panel.message.empty()) return 0;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::max(size.x - 2 * kMargin, 40.0f);
  ImGui::SetNextWindowPos({kMargin, size.y - kMargin}, ImGuiCond_Always, {0, 1});
  ImGui::SetNextWindowSizeConstraints({0, 0}, {width, size.y - 2 * kMargin});
  ImGui::SetNextWindowBgAlpha(0.85f);
  ImGui::Begin("message", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushTextWrapPos(width - 2 * kMargin);
  if (panel.message_is_error) ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
  ImGui::TextUnformatted(panel.message.c_str());
  if (panel.message_is_error) ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  const float height = ImGui::GetWindowHeight() + kMargin;
  ImGui::End();
  return height;
}

}  // namespace

void draw_panel(Panel& panel) {
  const float taken = draw_message(panel);
  if (panel.hidden) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float width = std::min(kWidth, size.x - 2 * kMargin);
  ImGui::SetNextWindowPos({kMargin, kMargin}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowCollapsed(size.x < kRoomAcross || size.y < kRoomDown, ImGuiCond_FirstUseEver);
  const float room = std::max(size.y - 2 * kMargin - taken, 40.0f);
  ImGui::SetNextWindowSizeConstraints({width, 0}, {width, room});
  if (!ImGui::Begin("Nephoscope", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) return ImGui::End();
  ImGui::PushItemWidth(-kLabel);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(panel.scene.c_str());
  bool changed = ImGui::Combo("flight", &panel.mode, "free\0orbit\0first person\0");
  if (panel.times > 1)
    changed |= ImGui::SliderInt("time", &panel.time, 0, panel.times - 1, panel.time_text.c_str());
  if (ImGui::CollapsingHeader("light", ImGuiTreeNodeFlags_DefaultOpen))
    changed |= draw_light(panel);
  if (ImGui::CollapsingHeader("quality", size.y < kRoomForAll ? 0 : ImGuiTreeNodeFlags_DefaultOpen))
    changed |= draw_quality(panel);
  if (ImGui::CollapsingHeader("layers", ImGuiTreeNodeFlags_DefaultOpen))
    changed |= draw_volumes(panel);
  if (panel.planet && ImGui::CollapsingHeader("places")) changed |= draw_places(panel);
  if (ImGui::CollapsingHeader("frames", ImGuiTreeNodeFlags_DefaultOpen)) {
    ImGui::TextUnformatted(panel.busy ? "bricks, light or pixels are still to come" : "at rest");
    ImGui::TextUnformatted(panel.error_line.c_str());
    for (const std::string& line : panel.lines) ImGui::TextUnformatted(line.c_str());
  }
  if (ImGui::CollapsingHeader("keys and mouse")) ImGui::TextUnformatted(kKeys);
  panel.changed = changed;
  ImGui::PopTextWrapPos();
  ImGui::PopItemWidth();
  ImGui::End();
}

}  // namespace nepho
