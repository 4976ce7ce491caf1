#include "view/window/panel.h"

#include <imgui.h>

#include <cmath>

namespace nepho {
namespace {

bool slider(const char* name, double& value, double low, double high, const char* format,
            bool logarithmic = false) {
  return ImGui::SliderScalar(name, ImGuiDataType_Double, &value, &low, &high, format,
                             logarithmic ? ImGuiSliderFlags_Logarithmic : 0);
}

bool draw_light(Panel& panel) {
  bool changed = slider("exposure", panel.exposure_ev, -8, 8, "%+.2f EV");
  changed |= slider("sun azimuth", panel.sun_azimuth_deg, 0, 360, "%.1f deg");
  changed |= slider("sun elevation", panel.sun_elevation_deg, -20, 90, "%.1f deg");
  return changed;
}

bool draw_quality(Panel& panel) {
  bool changed = ImGui::Checkbox("fixed step", &panel.fixed_step);
  if (panel.fixed_step)
    changed |= slider("step", panel.step_voxels, 0.25, 8, "%.2f voxels", true);
  else
    changed |= slider("tolerance", panel.tolerance, 1e-3, 0.1, "%.4f", true);
  changed |= slider("pixels a voxel", panel.pixels_per_voxel, 0.5, 16, "%.2f", true);
  return changed;
}

}  // namespace

void draw_panel(Panel& panel) {
  ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSizeConstraints({330, 0}, {480, ImGui::GetIO().DisplaySize.y - 16});
  ImGui::Begin("Nephoscope", nullptr, ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushTextWrapPos(310);
  ImGui::TextUnformatted(panel.scene.c_str());
  if (!panel.message.empty()) {
    if (panel.message_is_error) ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.6f, 0.4f, 1.0f});
    ImGui::TextWrapped("%s", panel.message.c_str());
    if (panel.message_is_error) ImGui::PopStyleColor();
  }
  ImGui::Separator();
  bool changed = ImGui::Combo("flight", &panel.mode, "free\0orbit\0first person\0");
  changed |= draw_light(panel);
  changed |= draw_quality(panel);
  for (Panel::Volume& volume : panel.volumes)
    changed |= ImGui::Checkbox(volume.name.c_str(), &volume.shown);
  if (panel.times > 1)
    changed |= ImGui::SliderInt("time", &panel.time, 0, panel.times - 1, panel.time_text.c_str());
  panel.changed = changed;
  ImGui::Separator();
  ImGui::TextUnformatted(panel.busy ? "finer bricks and light are on the way" : "at rest");
  for (const std::string& line : panel.lines) ImGui::TextUnformatted(line.c_str());
  ImGui::Separator();
  ImGui::TextWrapped(
      "W A S D Q E move, shift faster, control slower; drag turns, wheel: height's speed or "
      "distance; M mode, R back to the start, F12 picture at full quality; drop files to open "
      "them");
  ImGui::PopTextWrapPos();
  ImGui::End();
}

}  // namespace nepho
