#include "runtime/player/scenario.h"

#include "runtime/base/toml_table.h"

namespace flaneur {
namespace {

CameraLeg ReadLeg(TomlTable t) {
  CameraLeg leg;
  t.Point("walk_to_m", &leg.to_m);
  t.Number("turn_by_deg", &leg.turn_deg, -36000, 36000);
  t.Number("wait_s", &leg.wait_s, 0, 36000);
  t.Number("speed_mps", &leg.speed_mps, 0.01, 20);
  t.Number("rate_dps", &leg.rate_dps, 0.1, 720);
  t.Finish();
  const bool walk = t.Has("walk_to_m"), turn = t.Has("turn_by_deg"), wait = t.Has("wait_s");
  if (walk + turn + wait != 1) t.Refuse("a camera.leg needs exactly one of walk_to_m, turn_by_deg and wait_s");
  leg.kind = walk ? CameraLeg::Kind::kWalk : turn ? CameraLeg::Kind::kTurn : CameraLeg::Kind::kWait;
  return leg;
}

void ReadCamera(TomlTable t, Scenario* s) {
  s->has_camera = true;
  t.Point("position_m", &s->camera_position_m);
  t.Number("yaw_deg", &s->camera_yaw_deg, -36000, 36000);
  t.Number("fov_deg", &s->fov_deg, 10, 150);
  t.Number("r_high_m", &s->r_high_m, 0, 1000);
  t.Number("eye_height_m", &s->eye_height_m, 0.1, 200);
  t.Number("pitch_deg", &s->pitch_deg, -89, 89);
  for (TomlTable& leg : t.Tables("leg")) s->legs.push_back(ReadLeg(leg));
  t.Finish();
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
  PackObstacle obstacle;
  t.Points("polygon_m", &obstacle.outer);
  t.Point("center_m", &obstacle.center);
  t.Number("radius_m", &obstacle.radius_m, 0.01, 1e5);
  t.Finish();
  const bool polygon = t.Has("polygon_m"), circle = t.Has("center_m") && t.Has("radius_m");
  if (polygon == circle || (polygon && obstacle.outer.size() < 3)) {
    t.Refuse("an [[obstacle]] needs polygon_m of at least 3 points, or center_m and radius_m");
  }
  obstacle.name = "obstacle_" + std::to_string(s->obstacles.size() + 1);
  s->obstacles.push_back(obstacle);
}

void ReadLimit(TomlTable t, Scenario* s) {
  t.Choice("method", &s->method, {"count", "frame_time"});
  t.Number("high", &s->high_limit, 0, 100000);
  t.Number("target_ms", &s->target_ms, 1, 1000);
  t.Number("budget_triangles", &s->budget_triangles, 0, 1e9);
  t.Number("draw_base_ms", &s->draw_base_ms, 0, 1000);
  t.Number("draw_ms_per_million_triangles", &s->draw_ms_per_million_triangles, 0, 1e6);
  t.Finish();
}

void ReadGround(TomlTable t, Scenario* s) {
  s->has_ground = true;
  t.Point("min_m", &s->ground_min_m);
  t.Point("max_m", &s->ground_max_m);
  t.Finish();
  const Vec2 size = s->ground_max_m - s->ground_min_m;
  if (!(size.x >= 1 && size.y >= 1 && size.x * size.y <= 4e6f)) {
    t.Refuse("ground must have min_m below max_m, at least 1 m and at most 4 square kilometres");
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
  root.Number("people", &s->people, 0, 1000000);
  root.Number("seed", &s->seed, 0, 4294967295.0);
  root.Number("group_share", &s->group_share, 0, 1);
  root.Number("step_hz", &s->step_hz, 10, 240);
  root.Number("seconds", &s->seconds, 0, 1e6);
  root.Number("hour", &s->hour, 0, 24);
  root.Choice("adaptation", &s->adaptation, {"off", "paper", "full"});
  ReadLimit(root.Table("limit"), s);
  // These mean something by being there.
  TomlTable camera = root.Table("camera"), ground = root.Table("ground"), area = root.Table("crowd_area");
  if (root.Has("camera")) ReadCamera(camera, s);
  if (root.Has("ground")) ReadGround(ground, s);
  if (root.Has("crowd_area")) ReadCrowdArea(area, s);
  for (TomlTable& person : root.Tables("person")) ReadPerson(person, s);
  for (TomlTable& obstacle : root.Tables("obstacle")) ReadObstacle(obstacle, s);
  root.Finish();
}

}  // namespace

Error ReadScenario(const std::filesystem::path& path, Scenario* scenario) {
  toml::table root;
  if (Error e = ReadToml(path, &root)) return e;
  TomlContext context{path, {}, {}};
  Scenario read;
  ReadAll(TomlTable(&context, &root, ""), &read);
  if (context.error) return context.error;
  *scenario = std::move(read);
  return Ok();
}

}  // namespace flaneur
