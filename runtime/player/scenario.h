// A scenario: what is simulated, and how the camera moves. Written as TOML, used by demo, tests and benchmarks.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/pack/tour_pack.h"

namespace flaneur {

struct CameraLeg {
  enum class Kind { kWalk, kTurn, kWait } kind = Kind::kWait;
  Vec2 to_m;
  float speed_mps = 1.4f;
  float turn_deg = 0, rate_dps = 60;
  float wait_s = 0;
};

struct ScenarioPerson {
  Vec2 position_m;
  std::vector<Vec2> goals_m;
  bool stay = false;
  std::string avatar, group;  // who names the same group walks together; empty: alone
  float speed_mps = 0, top_speed_mps = 0, radius_m = 0;  // 0: the pack's
};

struct Area { Vec2 min_m, max_m; };

inline bool Contains(const Area& area, Vec2 p) {
  return p.x >= area.min_m.x && p.y >= area.min_m.y && p.x <= area.max_m.x && p.y <= area.max_m.y;
}

struct Scenario {
  std::string name;
  std::optional<int> people;
  std::optional<uint64_t> seed;
  std::optional<float> group_share;
  std::optional<float> step_hz, seconds;
  std::optional<float> hour;  // of the day, at the start, 0 to 24; none: the light of the pack
  std::optional<std::string> adaptation, method;
  std::optional<std::string> language;  // of the guided tour; not from the file
  std::optional<int> high_limit, budget_triangles;
  std::optional<float> target_ms, draw_base_ms, draw_ms_per_million_triangles;
  bool has_camera = false;
  Vec2 camera_position_m;
  float camera_yaw_deg = 0;
  std::optional<float> fov_deg, r_high_m, eye_height_m, pitch_deg;
  std::vector<CameraLeg> legs;
  std::vector<ScenarioPerson> persons;
  std::optional<Area> crowd_area;  // in which the `people` start and walk about; else they live all over town
  bool has_ground = false;
  Vec2 ground_min_m, ground_max_m;
  std::vector<PackObstacle> obstacles;
};

// Errors: unreadable, not TOML, an unknown key (with the nearest known one), a wrong type or value; FILE:LINE in front.
Error ReadScenario(const std::filesystem::path& path, Scenario* scenario);

}  // namespace flaneur
