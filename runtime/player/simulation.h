// The tour as it lives: crowd, camera and control, one fixed step at a time. Knows nothing of drawing.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/control/crowd_influence.h"
#include "runtime/control/enclosure.h"
#include "runtime/control/level_control.h"
#include "runtime/control/view_volumes.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/density_map.h"
#include "runtime/crowd/field_builder.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/player/guide.h"
#include "runtime/player/point_walk.h"
#include "runtime/player/scenario.h"
#include "runtime/player/tour.h"

namespace flaneur {

inline constexpr float kEyeHeight_m = 1.65f;
inline constexpr float kCameraRadius_m = 0.3f;
inline constexpr const char* kPlainFigure = "person";  // everybody's avatar where there is no pack

struct CameraInput {
  bool active = false;      // false: scenario or guided tour moves the camera
  Vec2 direction;           // asked way, unit or zero
  float speed_mps = 0, yaw_rate_radps = 0;
  std::optional<Vec2> walk_to;  // sets out for there; a direction ends it
  float walk_to_mps = 1.4f;
  std::optional<float> pitch_rad;
  TourWish tour;            // active or not
};

struct CameraState {
  ViewCamera view;
  float pitch_rad = 0, eye_height_m = kEyeHeight_m;
  Vec2 velocity;
  Vec2 asked_velocity;  // what the visitor wants: who holds them up sees it
  float yaw_rate_radps = 0, asked_mps = 0, actual_mps = 0;
  bool present = true;      // false: everybody counts as visible
};

struct PersonPlan {         // of one person, by id
  std::vector<Vec2> goals;  // after the present one, next first
  bool stay = false, leaves = true;
  bool loiters = false;     // on the way to a loiter place, or there
  int spot = -1;            // index into Simulation::loiter_spots, of the one that is theirs
};

struct LoiterSpot {         // where one person can stand at a loiter place
  Vec2 position_m, look;    // look: unit vector to what there is to see
  int place = 0;            // index into Simulation::places
  bool taken = false, there = false;
  int partner = -1;         // index of the spot whose occupant they talk with
};

struct PlaceLists {         // indices into Simulation::places
  std::vector<int> gates, goals, loiters, spawns, destinations, all;
};

struct Simulation {
  std::vector<std::string> avatar_names;
  std::vector<AvatarCosts> avatar_costs;
  std::vector<float> avatar_share, avatar_radius_m;
  CrowdSettings crowd_settings;
  LevelSettings level_settings;
  InfluenceSettings influence;
  float step_s = 1.0f / 30, r_personal_m = 0.6f;
  float draw_base_ms = 0, draw_ms_per_million_triangles = 0;
  std::optional<float> hour;       // of the day at the start; none: the light of the pack
  float outer_apex_back_m = 0, max_yaw_rate_radps = 2.1f;

  Walkable walkable;
  std::vector<PackPlace> places;
  PackPainting painting;
  PlaceLists place_lists;
  std::vector<LoiterSpot> loiter_spots;  // by place
  std::vector<int> place_of_field;       // by index into crowd.fields, -1: no place; see PlaceOfField
  int loiterers = 0;                     // people whose plan is to loiter
  Tour tour;
  Guide guide;
  PointWalk point_walk;
  float looks_about_s = 0;         // left until the tour turns the view again
  bool gentle = false;             // the tour turns the view slowly, and walks slowly
  std::vector<CameraLeg> legs;     // of the scenario; empty: the guided tour
  std::optional<Area> crowd_area;  // of the scenario
  int target_people = 0;           // kept up by people who appear out of sight
  int next_company = 0;            // how many come together next, once there is room for them; 0: not drawn yet

  Crowd crowd;
  FieldBuilder field_builder;
  std::vector<PersonPlan> plans;   // by id
  CameraState camera;
  LevelState levels;
  std::vector<MovingObstacle> moving;
  ForesightState foresight;
  Enclosure enclosure;
  DensityMap density;              // of everybody, once a second
  Random random;
  int64_t frame = 0;
  size_t leg = 0;
  float leg_done = 0;              // seconds waited, or radians turned
  float stuck_s = 0;               // since the camera got away from stuck_at
  Vec2 stuck_at;
  bool finished = false;           // the last leg is over
  double step_ms = 0, control_ms = 0;
  std::vector<std::string> warnings;
};

// `pack` may be null where the scenario has its own ground. Errors: no walkable ground, a scenario's person inside an obstacle or
// with a goal nobody can reach, an unknown avatar, no ground at all; each names the person. More people than fit: as many as do,
// and a warning. `simulation` stays where it is from the first step on.
Error StartSimulation(const TourPack* pack, const Scenario& scenario, Simulation* simulation);

// Horizontal; the outer volume follows.
void SetFieldOfView(float fov_rad, Simulation* simulation);

// What drawing this frame takes by the scenario's model of a machine, for runs that draw nothing; 0 without one.
float FrameTimeByModel_ms(const Simulation& simulation);

// frame_ms: what the last frame took, for the frame-time method; 0: unknown.
void StepSimulation(const CameraInput& input, float frame_ms, Simulation* simulation);

}  // namespace flaneur
