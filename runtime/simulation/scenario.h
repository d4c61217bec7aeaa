// A scenario: what is simulated, and how the camera moves. Written as TOML, used by demo, tests and benchmarks.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/control/level_control.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/town/town.h"
#include "runtime/walk/visitor.h"

namespace flaneur {

// What drawing takes by a model of a machine, for runs that draw nothing.
struct DrawingModel {
  float base_ms = 0, ms_per_million_triangles = 0;
};

// Where there is no pack: nobody but whom the scenario names, and the usual control.
inline constexpr CrowdSettings kEmptyTown{.people = 0, .group_share = 0};
inline constexpr ControlSettings kPlainControl{.fov_rad = 1.0472f,
                                               .max_yaw_rate_dps = 120.321129f};  // 2.1 radians a second

struct Scenario {
  std::string name;
  // A pack's, which the scenario's own lay themselves over.
  CrowdSettings crowd = kEmptyTown;
  ControlSettings control = kPlainControl;
  DrawingModel drawing;
  int screen_width_px = kUsualWidth_px, screen_height_px = kUsualHeight_px;  // of the pictures; not from the file
  std::optional<float> seconds;
  std::optional<float> hour;            // of the day, at the start, 0 to 24; none: the light of the pack
  std::optional<std::string> language;  // of the guided tour; not from the file
  bool has_camera = false;
  Vec2 camera_position_m;
  float camera_yaw_deg = 0;
  float eye_height_m = kEyeHeight_m, pitch_deg = 0;
  std::vector<CameraLeg> legs;
  TourCut tour;
  std::vector<ScenarioPerson> persons;
  std::optional<Area> crowd_area;  // in which the `people` start and walk about; else they live all over town
  bool has_ground = false;
  Vec2 ground_min_m, ground_max_m;
  Obstacles obstacles;
};

// What a pack says by itself: the scenario of a visit without any.
Scenario ScenarioOf(const TourPack& pack);

// Lays what the file says over `scenario`. Errors: unreadable, not TOML, an unknown key (with the nearest known one), a
// wrong type or value; FILE:LINE in front.
Error ReadScenario(const std::filesystem::path& path, Scenario* scenario);

}  // namespace flaneur
