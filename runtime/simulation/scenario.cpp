#include "runtime/simulation/scenario.h"

#include <cmath>

#include "runtime/base/limits.h"
#include "runtime/base/toml_table.h"
#include "runtime/walk/wander.h"

namespace flaneur {
namespace {

CameraLeg ReadLeg(TomlTable t) {
  CameraLeg leg;
  t.Point("walk_to_m", &leg.to_m);
  t.Number("turn_by_deg", &leg.turn_deg, -36000, 36000);
  t.Number("wait_s", &leg.wait_s, 0, 36000);
  t.Number("speed_mps", &leg.speed_mps, 0.01, 20);
  t.Number("rate_dps", &leg.rate_dps, 0.1, 720);
  t.Number("facing_deg", &leg.facing_deg, -180, 180);
  t.Number("look_about_deg", &leg.look_about_deg, 0, 180);
  t.Number("follow_s", &leg.follow_s, 0, 36000);
  t.Number("behind_m", &leg.behind_m, 0.5, 100);
  t.Number("wander_s", &leg.wander_s, 0, 36000);
  t.Number("seed", &leg.seed, 0, 4294967295.0);
  t.Finish();
  const bool walk = t.Has("walk_to_m"), turn = t.Has("turn_by_deg"), wait = t.Has("wait_s"), follow = t.Has("follow_s"),
             wander = t.Has("wander_s");
  if (walk + turn + wait + follow + wander != 1)
    t.Refuse("a camera.leg needs exactly one of walk_to_m, turn_by_deg, wait_s, follow_s and wander_s");
  if (t.Has("facing_deg") && !walk) t.Refuse("facing_deg belongs to a camera.leg with walk_to_m");
  if (t.Has("look_about_deg") && !wait) t.Refuse("look_about_deg belongs to a camera.leg with wait_s");
  if (t.Has("behind_m") && !follow) t.Refuse("behind_m belongs to a camera.leg with follow_s");
  if (t.Has("seed") && !wander) t.Refuse("seed belongs to a camera.leg with wander_s");
  if (wander && (t.Has("speed_mps") || t.Has("rate_dps")))
    t.Refuse("a camera.leg with wander_s draws its own speeds; leave out speed_mps and rate_dps");
  if (wander) leg.speed_mps = kWanderMost_mps, leg.rate_dps = kWanderMost_dps;
  using Kind = CameraLeg::Kind;
  leg.kind = walk ? Kind::kWalk : turn ? Kind::kTurn : wait ? Kind::kWait : follow ? Kind::kFollow : Kind::kWander;
  return leg;
}

void ReadCamera(TomlTable t, Scenario* s) {
  s->has_camera = true;
  t.Point("position_m", &s->camera_position_m);
  t.Number("yaw_deg", &s->camera_yaw_deg, -36000, 36000);
  t.Angle("fov", &s->control.fov_rad, 10, 150);
  t.Number("r_high_m", &s->control.r_high_m, 0, 1000);
  t.Number("eye_height_m", &s->eye_height_m, 0.1, 200);
  t.Number("pitch_deg", &s->pitch_deg, -89, 89);
  for (TomlTable& leg : t.Tables("leg", kMostStops)) s->legs.push_back(ReadLeg(leg));
  t.Finish();
}

void ReadTourCut(TomlTable t, Scenario* s) {
  t.Numbers("stops", &s->tour.stops, 1, 10000);
  t.Number("most_rest_s", &s->tour.most_rest_s, 0, 36000);
  t.Number("approach_m", &s->tour.approach_m, 0, 1e5);
  t.Finish();
  for (const float number : s->tour.stops) {
    if (number != std::floor(number)) t.Refuse("tour.stops are whole numbers, as the tour counts them from 1");
  }
  if (!s->legs.empty()) t.Refuse("[tour] is for runs that follow the guided tour; leave out the [[camera.leg]]s");
}

void ReadPerson(TomlTable t, Scenario* s) {
  ScenarioPerson person;
  t.Point("position_m", &person.position_m);
  if (!t.Has("position_m")) t.Refuse("a [[person]] needs position_m = [x, y]");
  t.Points("goals_m", &person.goals_m);
  t.Flag("stay", &person.stay);
  t.Text("avatar", &person.avatar);
  t.Text("group", &person.group);
  t.Number("speed_mps", &person.speed_mps, 0.05, 10);
  t.Number("top_speed_mps", &person.top_speed_mps, 0.05, 10);
  t.Number("radius_m", &person.radius_m, 0.05, 2);
  t.Finish();
  s->persons.push_back(person);
}

void ReadObstacle(TomlTable t, Scenario* s) {
  PolygonObstacle polygon;
  CircleObstacle circle;
  t.Points("polygon_m", &polygon.outer);
  t.Point("center_m", &circle.center);
  t.Number("radius_m", &circle.radius_m, 0.01, 1e5);
  t.Finish();
  const bool is_polygon = t.Has("polygon_m"), is_circle = t.Has("center_m") && t.Has("radius_m");
  if (is_polygon == is_circle || (is_polygon && polygon.outer.size() < 3)) {
    t.Refuse("an [[obstacle]] needs polygon_m of at least 3 points, or center_m and radius_m");
  }
  if (is_polygon) s->obstacles.polygons.push_back(std::move(polygon));
  else s->obstacles.circles.push_back(circle);
}

void ReadLimit(TomlTable t, Scenario* s) {
  VisitChoice(t, "method", kLimitMethodNames, &s->control.method);
  t.Number("high", &s->control.high_limit, 0, 100000);
  t.Number("target_ms", &s->control.target_ms, 1, 1000);
  t.Number("budget_triangles", &s->control.budget_triangles, 1, 1e9);
  t.Number("draw_base_ms", &s->drawing.base_ms, 0, 1000);
  t.Number("draw_ms_per_million_triangles", &s->drawing.ms_per_million_triangles, 0, 1e6);
  t.Finish();
}

void ReadGround(TomlTable t, Scenario* s) {
  s->has_ground = true;
  t.Point("min_m", &s->ground_min_m);
  t.Point("max_m", &s->ground_max_m);
  t.Finish();
  const Vec2 size = s->ground_max_m - s->ground_min_m;
  const auto most_m = static_cast<float>(kMostSide_m);
  if (!(size.x >= 1 && size.y >= 1 && size.x <= most_m && size.y <= most_m && size.x * size.y <= 4e6f)) {
    t.Refuse("ground must have min_m below max_m, 1 m to 20 km of each, and at most 4 square kilometres");
  }
}

void ReadCrowdArea(TomlTable t, Scenario* s) {
  Area area;
  t.Point("min_m", &area.min_m);
  t.Point("max_m", &area.max_m);
  t.Finish();
  const bool whole = t.Has("min_m") && t.Has("max_m");
  if (!whole || !(area.max_m.x > area.min_m.x && area.max_m.y > area.min_m.y)) {
    t.Refuse("crowd_area needs min_m and max_m, min_m below max_m");
  }
  s->crowd_area = area;
}

void ReadAll(TomlTable root, Scenario* s) {
  root.Text("name", &s->name);
  if (root.Has("ground")) s->crowd.people = 0;  // who lives in the pack's town does not live here
  root.Number("people", &s->crowd.people, 0, 1000000);
  root.Number("seed", &s->crowd.seed, 0, 4294967295.0);
  root.Number("group_share", &s->crowd.group_share, 0, 1);
  root.Number("step_hz", &s->control.step_hz, 10, 240);
  root.Number("seconds", &s->seconds, 0, 1e6);
  root.Number("hour", &s->hour, 0, 24);
  VisitChoice(root, "adaptation", kAdaptationNames, &s->control.adaptation);
  root.Number("discretion", &s->control.discretion, 0, 1);
  ReadLimit(root.Table("limit"), s);
  // These mean something by being there.
  TomlTable camera = root.Table("camera"), ground = root.Table("ground"), area = root.Table("crowd_area");
  if (root.Has("camera")) ReadCamera(camera, s);
  if (TomlTable tour = root.Table("tour"); root.Has("tour")) ReadTourCut(tour, s);
  if (root.Has("ground")) ReadGround(ground, s);
  if (root.Has("crowd_area")) ReadCrowdArea(area, s);
  for (TomlTable& person : root.Tables("person", kMostPeople)) ReadPerson(person, s);
  for (TomlTable& obstacle : root.Tables("obstacle", kMostObstacles)) ReadObstacle(obstacle, s);
  root.Finish();
}

}  // namespace

Scenario ScenarioOf(const TourPack& pack) {
  Scenario scenario;
  scenario.crowd = pack.crowd;
  scenario.control = pack.control;
  return scenario;
}

Error ReadScenario(const std::filesystem::path& path, Scenario* scenario) {
  toml::table root;
  if (Error e = ReadToml(path, &root)) return e;
  TomlContext context{path, {}, {}, {}};
  Scenario read = *scenario;
  ReadAll(TomlTable(&context, &root, ""), &read);
  if (context.error) return context.error;
  *scenario = std::move(read);
  return Ok();
}

}  // namespace flaneur
