#include "runtime/simulation/records.h"

#include <cstdarg>
#include <cstdio>

#include "runtime/base/file.h"

namespace flaneur {
namespace {

constexpr const char* kMetricsHeader =
    "frame,time_s,camera_x_m,camera_y_m,camera_yaw_rad,camera_fov_rad,outer_apex_back_m,asked_speed_mps,actual_speed_"
    "mps,"
    "people,visible,boundary,outside,high,low,limit,r_personal_m,r_high_m,r_unimportant_m,exceeded,shortfalls,"
    "triangles_people,triangles_town,budget_triangles,level_switches_in_view,step_ms,control_ms,draw_ms,triangles_"
    "shadows,"
    "triangles_people_shadows\n";
constexpr const char* kTrajectoriesHeader =
    "frame,id,avatar,x_m,y_m,z_m,heading_rad,radius_m,view,level,reach_m,fading_level\n";
constexpr const char* kViewNames[] = {"outside", "boundary", "visible"};

__attribute__((format(printf, 2, 3))) void Append(std::string* text, const char* format, ...) {
  char line[512];
  va_list args;
  va_start(args, format);
  std::vsnprintf(line, sizeof line, format, args);
  va_end(args);
  *text += line;
}

double D(float value) { return static_cast<double>(value); }

void RecordMetrics(const Simulation& s, const FrameCosts& costs, std::string* text) {
  int count[3] = {0, 0, 0};
  for (ViewClass view : s.town.crowd.view) ++count[static_cast<size_t>(view)];
  const CameraState& c = s.visitor.camera;
  Append(text, "%lld,%.6f,%.4f,%.4f,%.6f,%.6f,%.4f,%.4f,%.4f,", static_cast<long long>(s.town.step),
         static_cast<double>(s.town.step) * D(Step_s(s)), D(c.view.position.x), D(c.view.position.y), D(c.view.yaw_rad),
         D(c.view.fov_rad), D(s.control.outer_apex_back_m), D(c.asked_mps), D(c.actual_mps));
  Append(text, "%zu,%d,%d,%d,%d,%d,%d,%.4f,%.4f,%.4f,%d,%d,", s.town.crowd.size(), count[2], count[1], count[0],
         s.control.levels.high, s.control.levels.low, s.control.levels.limit, D(s.control.settings.r_personal_m),
         D(s.control.levels.r_high_m), D(s.control.settings.r_unimportant_m), s.control.levels.exceeded ? 1 : 0,
         s.control.levels.shortfalls);
  Append(text, "%lld,%lld,%.0f,%d,%.4f,%.4f,%.4f,%lld,%lld\n", static_cast<long long>(s.control.levels.triangles),
         static_cast<long long>(costs.town_triangles), D(s.control.levels.budget_triangles),
         s.control.levels.switches_in_view, s.step_ms, s.control_ms, costs.draw_ms,
         static_cast<long long>(costs.shadow_triangles), static_cast<long long>(s.control.levels.shadows.triangles));
}

std::string NameOf(Level level) {
  return IsMesh(level) ? std::to_string(level.mesh) : IsDrawn(level) ? "impostor" : "none";
}

// What the person in view is drawn with besides their level, while the one fades into the other.
Level FadingInView(const Simulation& s, size_t i) {
  const PersonLevel& level = s.control.levels.people[i];
  return s.town.crowd.view[i] == ViewClass::kVisible && ShareOf(level, 0) < 1 ? level.from : kNotDrawn;
}

void RecordTrajectories(const Simulation& s, std::string* text) {
  for (size_t i = 0; i < s.town.crowd.size(); ++i) {
    const Vec2 p = s.town.crowd.position[i];
    const std::string level = NameOf(LevelInView(s.town.crowd, s.control.levels, i));
    Append(text, "%lld,%d,%s,%.5f,%.5f,%.4f,%.5f,%.4f,%s,%s,%.4f,%s\n", static_cast<long long>(s.town.step),
           s.town.crowd.id[i], s.town.residents[static_cast<size_t>(s.town.crowd.avatar[i])].avatar.c_str(), D(p.x),
           D(p.y), D(HeightAt(s.town.walkable, p)), D(s.town.crowd.heading_rad[i]), D(s.town.crowd.radius_m[i]),
           kViewNames[static_cast<size_t>(s.town.crowd.view[i])], level.c_str(), D(s.town.crowd.view_reach_m[i]),
           NameOf(FadingInView(s, i)).c_str());
  }
}

}  // namespace

void Record(const Simulation& s, const FrameCosts& costs, Records* records) {
  if (records->keep_metrics) {
    if (records->metrics.empty()) records->metrics = kMetricsHeader;
    RecordMetrics(s, costs, &records->metrics);
  }
  if (records->keep_trajectories) {
    if (records->trajectories.empty()) records->trajectories = kTrajectoriesHeader;
    RecordTrajectories(s, &records->trajectories);
  }
}

Error WriteRecords(const Records& records, const std::filesystem::path& metrics,
                   const std::filesystem::path& trajectories) {
  if (records.keep_metrics) {
    if (Error e = WriteTextFile(metrics, records.metrics)) return e;
  }
  if (records.keep_trajectories) return WriteTextFile(trajectories, records.trajectories);
  return Ok();
}

}  // namespace flaneur
