#include "runtime/visit/developer_views.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flaneur {
namespace {

constexpr ImU32 kHouse = IM_COL32(92, 84, 76, 255), kInner = IM_COL32(255, 214, 90, 255),
                kOuter = IM_COL32(120, 190, 255, 255);
constexpr ImU32 kZone = IM_COL32(255, 255, 255, 90), kCameraObstacle = IM_COL32(255, 90, 200, 200);
constexpr ImU32 kHigh = IM_COL32(255, 72, 60, 255), kLow = IM_COL32(255, 190, 80, 255),
                kBoundary = IM_COL32(90, 170, 255, 255), kOutside = IM_COL32(150, 150, 150, 255);
constexpr const char* kAdaptations[] = {"off", "paper", "full"};

// Metres to pixels; north is up, the visitor in the middle.
struct Plan {
  ImDrawList* list;
  ImVec2 middle;
  Vec2 center;
  float pixels_per_m;
  ImVec2 operator()(Vec2 p) const {
    return {middle.x + (p.x - center.x) * pixels_per_m, middle.y - (p.y - center.y) * pixels_per_m};
  }
};

void DrawRing(const Plan& plan, const std::vector<Vec2>& ring) {
  for (const Vec2& p : ring) plan.list->PathLineTo(plan(p));
  plan.list->PathStroke(kHouse, ImDrawFlags_Closed, 1.5f);
}

void DrawTown(const Plan& plan, const Walkable& walkable) {
  for (const PolygonObstacle& o : walkable.polygons) {
    DrawRing(plan, o.outer);
    for (const auto& hole : o.holes) DrawRing(plan, hole);
  }
  for (const CircleObstacle& o : walkable.circles) {
    plan.list->AddCircle(plan(o.center), std::max(1.0f, o.radius_m * plan.pixels_per_m), kHouse);
  }
}

void DrawWedge(const Plan& plan, Vec2 apex, const ViewCamera& camera, ImU32 color) {
  constexpr float kFar_m = 400;
  for (float side : {-0.5f, 0.5f}) {
    const float a = camera.yaw_rad + side * camera.fov_rad;
    plan.list->AddLine(plan(apex), plan(apex + Vec2{std::cos(a), std::sin(a)} * kFar_m), color, 1.5f);
  }
}

void DrawVolumes(const Plan& plan, const Simulation& s) {
  const ViewCamera& c = s.visitor.camera.view;
  const Vec2 ahead{std::cos(c.yaw_rad), std::sin(c.yaw_rad)};
  for (float radius_m :
       {s.control.settings.r_personal_m, s.control.levels.r_high_m, s.control.settings.r_unimportant_m}) {
    plan.list->AddCircle(plan(c.position), radius_m * plan.pixels_per_m, kZone, 0, 1.5f);
  }
  DrawWedge(plan, c.position - ahead * s.control.outer_apex_back_m, c, kOuter);
  DrawWedge(plan, c.position, c, kInner);
  for (const MovingObstacle& o : s.moving) {
    if (!o.everyone) plan.list->AddCircle(plan(o.center), o.radius_m * plan.pixels_per_m, kCameraObstacle, 0, 2);
  }
}

ImU32 ColorOf(const Simulation& s, size_t i) {
  if (s.town.crowd.view[i] == ViewClass::kBoundary) return kBoundary;
  if (s.town.crowd.view[i] == ViewClass::kOutside) return kOutside;
  return IsMesh(s.control.levels.people[i].level) ? kHigh : kLow;
}

void DrawPeople(const Plan& plan, const Simulation& s) {
  for (size_t i = 0; i < s.town.crowd.size(); ++i) {
    const float radius_px = std::max(1.5f, s.town.crowd.radius_m[i] * plan.pixels_per_m);
    plan.list->AddCircleFilled(plan(s.town.crowd.position[i]), radius_px, ColorOf(s, i), 8);
  }
  plan.list->AddCircleFilled(plan(s.visitor.camera.view.position), 4, kInner);
}

void Legend(ImU32 color, const char* text) {
  ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(color), "%s", text);
  ImGui::SameLine();
}

void ShowPlan(float size_px, DeveloperViews* views, const Simulation& s) {
  ImGui::SetNextWindowPos({8, 8}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({size_px, size_px + 66}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.92f);
  if (ImGui::Begin("plan")) {
    Legend(kHigh, "mesh");
    Legend(kLow, "impostor");
    Legend(kBoundary, "boundary");
    Legend(kOutside, "outside");
    ImGui::NewLine();
    const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
    const float height_px = std::max(32.0f, room.y - 24);
    const Plan plan{ImGui::GetWindowDrawList(),
                    {low.x + room.x / 2, low.y + height_px / 2},
                    s.visitor.camera.view.position,
                    std::min(room.x, height_px) / (2 * views->half_width_m)};
    plan.list->PushClipRect(low, {low.x + room.x, low.y + height_px}, true);
    DrawTown(plan, s.town.walkable);
    DrawVolumes(plan, s);
    DrawPeople(plan, s);
    plan.list->PopClipRect();
    ImGui::Dummy({room.x, height_px});
    ImGui::SetNextItemWidth(-60);
    ImGui::SliderFloat("m around", &views->half_width_m, 10, 300, "%.0f", ImGuiSliderFlags_Logarithmic);
  }
  ImGui::End();
}

void Graph(const char* name, const std::array<float, ViewsHistory::kFrames>& values, size_t next, float least_top) {
  const float top = std::max(least_top, 1.1f * *std::max_element(values.begin(), values.end()));
  const float last = values[(next + ViewsHistory::kFrames - 1) % ViewsHistory::kFrames];
  char text[64];
  std::snprintf(text, sizeof text, "%s: %.*f", name, last < 100 ? 1 : 0, static_cast<double>(last));
  ImGui::PushID(name);
  ImGui::SetNextItemWidth(-1);
  ImGui::PlotLines("##values", values.data(), static_cast<int>(values.size()), static_cast<int>(next), text, 0, top,
                   {0, 48});
  ImGui::PopID();
}

void ShowGraphs(const FrameStatistics& statistics, int width_px, const ViewsHistory& h, Simulation* s) {
  constexpr float kWidth_px = 290;
  ImGui::SetNextWindowPos({static_cast<float>(width_px) - kWidth_px - 8, 8}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kWidth_px, 347}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowBgAlpha(0.92f);
  if (ImGui::Begin("figures")) {
    Graph("people as meshes", h.high, h.next, static_cast<float>(s->control.levels.limit) * 1.3f);
    Graph("people's triangles", h.triangles, h.next, s->control.levels.budget_triangles);
    Graph("frame time, ms", h.frame_ms, h.next, 17);
    ImGui::Text("limit %d, budget %.0f triangles", s->control.levels.limit,
                static_cast<double>(s->control.levels.budget_triangles));
    ImGui::Text("%zu people, %d drawn, %d hidden", s->town.crowd.size(), statistics.people_drawn,
                statistics.people_hidden);
    if (statistics.people_not_loaded > 0)
      ImGui::Text("%d drawn otherwise: not loaded yet", statistics.people_not_loaded);
    ImGui::Text("%d draw calls, town %lld triangles", statistics.draw_calls,
                static_cast<long long>(statistics.town_triangles));
    ImGui::Text("drawn at %.0f %% of width and height", 100 * static_cast<double>(statistics.resolution_scale));
    ImGui::Text("adaptation (F2)");
    for (int k = 0; k < 3; ++k) {
      if (k > 0) ImGui::SameLine();
      const auto value = static_cast<Adaptation>(k);
      if (ImGui::RadioButton(kAdaptations[k], s->control.settings.adaptation == value))
        s->control.settings.adaptation = value;
    }
  }
  ImGui::End();
}

}  // namespace

void RememberFrame(const Simulation& s, const FrameStatistics& statistics, float frame_ms, ViewsHistory* h) {
  h->high[h->next] = static_cast<float>(s.control.levels.high);
  h->triangles[h->next] = static_cast<float>(statistics.people_triangles);
  h->frame_ms[h->next] = frame_ms;
  h->next = (h->next + 1) % ViewsHistory::kFrames;
}

void SwitchAdaptation(Simulation* s) {
  s->control.settings.adaptation = static_cast<Adaptation>((static_cast<int>(s->control.settings.adaptation) + 1) % 3);
}

void ShowViews(const FrameStatistics& statistics, int width_px, int height_px, DeveloperViews* views,
               Simulation* simulation) {
  ShowPlan(std::min(static_cast<float>(width_px) * 0.42f, static_cast<float>(height_px) * 0.72f), views, *simulation);
  ShowGraphs(statistics, width_px, views->history, simulation);
}

}  // namespace flaneur
