#include "runtime/simulation/simulation.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/clock.h"
#include "runtime/control/crowd_influence.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/fast_math.h"
#include "runtime/simulation/check_limits.h"
#include "runtime/simulation/check_world.h"
#include "runtime/town/coming_and_going.h"
#include "runtime/town/places.h"
#include "runtime/town/play.h"
#include "runtime/town/population.h"
#include "runtime/walk/camera_walk.h"
#include "runtime/walk/start.h"

namespace flaneur {
namespace {

constexpr float kFlatCell_m = 0.5f;
constexpr float kVisitorRoom_m = 0.55f, kBeforeFace_m = 0.55f;
constexpr float kTallest_m = 3;  // of people, with what they carry

// What the renderer draws at most.
ShadowCost ShadowCostOf(const PackAvatar& avatar) {
  const int coarsest = avatar.levels.back().triangles;
  return {std::min(coarsest, kMaxShadowTriangles[0]), std::min(coarsest, kMaxShadowTriangles[1])};
}

void TakeAvatar(const PackAvatar& avatar, Simulation* s) {
  AvatarCosts costs;
  for (const PackLevel& level : avatar.levels) costs.levels.push_back({level.triangles, level.switch_px});
  costs.height_m = avatar.height_m;
  costs.impostor_px = avatar.height_m / avatar.impostor.texel_m;
  costs.props.assign(avatar.props.begin(), avatar.props.end());
  costs.shadow = ShadowCostOf(avatar);
  Resident resident{avatar.name, avatar.share, avatar.radius_m, avatar.reach_m};
  for (const PackOtherClip& clip : avatar.other_clips) {
    resident.other_clips.push_back(clip.name);
    resident.clip_mps.push_back(clip.speed_mps);
    resident.clip_sits.push_back(clip.seat_m > 0);
  }
  costs.other_clips = resident.other_clips;
  s->town.residents.push_back(std::move(resident));
  s->control.avatars.push_back(std::move(costs));
}

void TakePack(const TourPack& pack, Simulation* s) {
  for (const PackAvatar& avatar : pack.avatars) TakeAvatar(avatar, s);
  TakeStops(pack.path, pack.language, &s->visitor.tour);
  for (size_t k = 0; !pack.guide.empty() && k < pack.avatars.size(); ++k) {
    if (pack.avatars[k].name != pack.guide) continue;
    s->town.residents[k].leads = s->visitor.guide.avatar >= 0;  // a figure beside the avatar of that name
    s->visitor.guide.avatar = static_cast<int>(k);
  }
  s->town.places = pack.places;
  s->town.painting = pack.painting;
  s->town.walkable.ground = pack.ground;
  static_cast<Obstacles&>(s->town.walkable) = pack.obstacles;
}

void TakeGround(const Scenario& scenario, Simulation* s) {
  GroundRaster g;
  const Vec2 size = scenario.ground_max_m - scenario.ground_min_m;
  g.min_m = scenario.ground_min_m;
  g.cell_m = kFlatCell_m;
  g.columns = static_cast<int>(size.x / kFlatCell_m);
  g.rows = static_cast<int>(size.y / kFlatCell_m);
  g.height_m.assign(static_cast<size_t>(g.columns) * static_cast<size_t>(g.rows), 0);
  g.kind.assign(g.height_m.size(), 3);
  s->town.walkable.ground = Share(std::move(g));
  static_cast<Obstacles&>(s->town.walkable) = {};
  s->town.places.clear();
  s->town.painting = {};
  s->visitor.tour.stops.clear();
}

void AddObstacles(const Obstacles& more, Obstacles* obstacles) {
  obstacles->circles.insert(obstacles->circles.end(), more.circles.begin(), more.circles.end());
  obstacles->polygons.insert(obstacles->polygons.end(), more.polygons.begin(), more.polygons.end());
}

void TakeScenario(const Scenario& scenario, bool has_pack, Simulation* s) {
  if (scenario.has_ground) TakeGround(scenario, s);
  AddObstacles(scenario.obstacles, &s->town.walkable);
  if (!has_pack) {  // one plain figure
    s->control.avatars = {{{{6000, 60}, {1500, 0}}, 1.75f, 128}};
    s->town.residents = {{kPlainFigure}};
  }
  s->town.settings = scenario.crowd;
  s->control.settings = scenario.control;
  s->drawing = scenario.drawing;
  s->screen_width_px = scenario.screen_width_px;
  s->screen_height_px = scenario.screen_height_px;
  CameraState& camera = s->visitor.camera;
  camera.view.fov_rad = scenario.control.fov_rad;
  camera.eye_height_m = scenario.eye_height_m;
  camera.aspect = static_cast<float>(scenario.screen_width_px) / static_cast<float>(scenario.screen_height_px);
  camera.pitch_rad = scenario.pitch_deg * kPi / 180;
  camera.present = scenario.has_camera || (has_pack && !scenario.has_ground);
  s->visitor.legs = scenario.legs;
  if (!scenario.legs.empty()) s->visitor.tour.stops.clear();
  s->town.crowd_area = scenario.crowd_area;
  s->hour = scenario.hour;
}

// Of those who will be there, on ground of the scenario's own.
float LargestRadius_m(const Scenario& scenario, float residents_m) {
  const bool only_named = scenario.crowd.people == 0 && !scenario.persons.empty();
  float most_m = only_named ? 0 : residents_m;
  for (const ScenarioPerson& p : scenario.persons) most_m = std::max(most_m, p.radius_m > 0 ? p.radius_m : residents_m);
  return most_m;
}

void PlaceCamera(const Scenario& scenario, Simulation* s) {
  if (scenario.has_camera) {
    s->visitor.camera.view.position = scenario.camera_position_m;
    s->visitor.camera.view.yaw_rad = scenario.camera_yaw_deg * kPi / 180;
  } else if (const std::vector<TourStop>& stops = s->visitor.tour.stops; !stops.empty()) {
    s->visitor.camera.view.position = stops.front().position_m;
    s->visitor.camera.view.yaw_rad = LookAt_rad(s->visitor.tour, 0);
  } else if (const int cell = BestFreeCell(s->town.walkable); cell >= 0) {
    s->visitor.camera.view.position = CellCenter(s->town.walkable, cell);
    s->visitor.camera.view.yaw_rad = BestView_rad(s->town.walkable, s->visitor.camera.view.position);
  }
}

void ChooseLanguage(const std::string& language, Simulation* s) {
  std::string list;
  for (const std::string& known : s->visitor.tour.languages) {
    if (known == language) return SetLanguage(language, &s->visitor.tour);
    list += (list.empty() ? "" : ", ") + known;
  }
  if (!s->visitor.tour.stops.empty())
    s->town.warnings.push_back("the tour has nothing in the language '" + language + "'; there is: " + list);
}

float Aspect(const Simulation& s) {
  return static_cast<float>(std::max(1, s.screen_width_px)) / static_cast<float>(std::max(1, s.screen_height_px));
}

float Relief_m(const Walkable& w) {
  float lowest_m = 1e9f, highest_m = -1e9f;
  for (int cell = 0; cell < static_cast<int>(w.cost.size()); ++cell) {
    if (w.cost[static_cast<size_t>(cell)] <= 0) continue;
    const float height_m = HeightAt(w, CellCenter(w, cell));
    lowest_m = std::min(lowest_m, height_m), highest_m = std::max(highest_m, height_m);
  }
  return std::max(0.0f, highest_m - lowest_m);
}

void DeriveGap(Simulation* s) {
  const Walkable& w = s->town.walkable;
  const Vec2 size{static_cast<float>(w.columns) * w.cell_m, static_cast<float>(w.rows) * w.cell_m};
  MotionLimits limits;
  limits.step_s = Step_s(*s);
  limits.reach_m = Length(size);
  limits.yaw_rate_radps = MaxYawRate_radps(s->control.settings);
  limits.camera_speed_mps = 3;
  limits.person_speed_mps = std::max(s->town.settings.top_speed_mps, FastestPlay_mps(s->town));
  limits.reach_grows_m = MostTilt(s->visitor.camera.view.fov_rad, Aspect(*s)) *
                         (s->relief_m + std::max(s->visitor.camera.eye_height_m, kTallest_m));
  for (const CameraLeg& leg : s->visitor.legs) {
    limits.yaw_rate_radps = std::max(limits.yaw_rate_radps, leg.rate_dps * kPi / 180);
    limits.camera_speed_mps = std::max(limits.camera_speed_mps, leg.speed_mps);
  }
  s->control.outer_apex_back_m = OuterApexBack_m(limits, s->visitor.camera.view.fov_rad);
}

// What people are classed by in one step.
struct ViewOfStep {
  ViewVolumes volumes;
  ViewTilt tilt;
  bool tilted = false;
  float eye_m = 0;  // height above the sea
};

ViewOfStep ViewNow(const Simulation& s) {
  const CameraState& camera = s.visitor.camera;
  ViewOfStep view{VolumesOf(camera.view, s.control.outer_apex_back_m), {}, camera.pitch_rad != 0, 0};
  if (!view.tilted) return view;
  view.tilt = TiltOf(camera.pitch_rad, camera.view.fov_rad, Aspect(s));
  view.eye_m = HeightAt(s.town.walkable, camera.view.position) + camera.eye_height_m;
  return view;
}

// How far somebody at p reaches into a view that may be tilted.
float ReachIntoView_m(Vec2 p, float reach_m, const ViewOfStep& view, const Walkable& w) {
  if (!view.tilted) return reach_m;
  const float feet_m = HeightAt(w, p) - view.eye_m;
  return reach_m + TiltReach_m(view.tilt, feet_m, feet_m + kTallest_m);
}

void ClassifyOne(size_t i, const ViewOfStep& view, const Walkable& w, Crowd* c) {
  c->view_reach_m[i] = ReachIntoView_m(c->position[i], c->reach_m[i], view, w);
  c->view[i] = Classify(c->position[i], c->view_reach_m[i], view.volumes);
}

void ClassifyAll(Simulation* s) {
  const ViewOfStep view = ViewNow(*s);
  Crowd& c = s->town.crowd;
  c.view_reach_m.resize(c.size());
  for (size_t i = 0; i < c.size(); ++i) {
    c.was_visible[i] = c.view[i] == ViewClass::kVisible ? 1 : 0;
    ClassifyOne(i, view, s->town.walkable, &c);
    if (!s->visitor.camera.present) c.view[i] = ViewClass::kVisible;
  }
}

Viewer ViewerOf(const Simulation& s) {
  const LevelState& levels = s.control.levels;
  const bool counted = levels.r_high_m > 0;  // not before the first step: nothing is full then
  return {s.control.settings,
          s.visitor.camera.present,
          s.visitor.camera.view,
          s.visitor.camera.velocity,
          s.control.outer_apex_back_m,
          levels.high,
          counted ? levels.limit : std::numeric_limits<int>::max()};
}

// People pass farther from the visitor's face than from the back, where they have the choice (the space before somebody
// is the most private: Hayduk 1983).
MovingObstacle VisitorDisc(const Simulation& s) {
  const CameraState& camera = s.visitor.camera;
  return {camera.view.position,
          s.control.settings.r_personal_m,
          true,
          camera.asked_velocity,
          kVisitorRoom_m,
          DirectionOf(camera.view.yaw_rad) * kBeforeFace_m};
}

void ControlCrowd(float frame_ms, Simulation* s) {
  const double start_ms = Now_ms();
  const CameraState& camera = s->visitor.camera;
  Control& control = s->control;
  const ViewMotion motion{camera.velocity, camera.yaw_rate_radps};
  LevelQuery query{camera.view, motion, frame_ms, s->screen_width_px, 0, s->visitor.guide.id};
  const float budget = control.levels.budget_triangles > 0 ? control.levels.budget_triangles
                                                           : static_cast<float>(control.settings.budget_triangles);
  ChooseBirds(s->town, control.avatars, query, camera.eye_height_m, budget, Step_s(*s), &s->birds);
  query.taken_triangles = s->birds.triangles;
  ChooseLevels(s->town.crowd, control.avatars, control.settings, query, &control.levels);
  s->moving.clear();
  if (camera.present) {
    s->moving.push_back(VisitorDisc(*s));
    ShieldGuide(InTown(s), &s->moving);
    InfluenceCrowd(camera.view, motion, control.levels, s->town.walkable, control.settings, &s->town.crowd, &s->moving,
                   &control.foresight);
    UnshieldGuide(InTown(s));
  }
  s->control_ms = Now_ms() - start_ms;
}

// Nobody is put into view, nor where they would come too near to the visitor.
bool IsKeptFree(Vec2 p, float reach_m, const void* simulation) {
  const Simulation& s = *static_cast<const Simulation*>(simulation);
  const ViewCamera& camera = s.visitor.camera.view;
  const ViewOfStep view = ViewNow(s);
  return Meets(p, ReachIntoView_m(p, reach_m, view, s.town.walkable), view.volumes.inner_apex, view.volumes) ||
         Length(p - camera.position) < 2 * s.control.settings.r_personal_m;
}

// Whoever was moved apart may be in another class where they are now, but not in view.
void SeparateUnseen(Simulation* s) {
  Town& town = s->town;
  SeparateBoundary(town.walkable, IsKeptFree, s, &town.scratch, &town.crowd);
  const ViewOfStep view = ViewNow(*s);
  for (int who : town.scratch.displaced.people) ClassifyOne(static_cast<size_t>(who), view, town.walkable, &town.crowd);
}

}  // namespace

Error StartSimulation(const TourPack* pack, const Scenario& scenario, Simulation* out, Jobs* jobs) {
  Simulation s;
  if (pack == nullptr && !scenario.has_ground) return Fail("no pack and no [ground] in the scenario; give one of them");
  if (pack != nullptr) TakePack(*pack, &s);
  TakeScenario(scenario, pack != nullptr, &s);
  Town& town = s.town;
  float max_radius_m = 0;
  for (const Resident& resident : town.residents) max_radius_m = std::max(max_radius_m, resident.radius_m);
  if (pack == nullptr) max_radius_m = LargestRadius_m(scenario, max_radius_m);
  if (Error e = CheckWorld(town.walkable, std::max(max_radius_m + kByChoice_m, 0.5f))) return e;
  BuildWalkable(max_radius_m + kByChoice_m, &town.walkable, std::max(max_radius_m, 0.5f));
  if (BestFreeCell(town.walkable) < 0) return Fail("there is no walkable ground");
  s.relief_m = Relief_m(town.walkable);
  if (Error e = CheckLimits(&s)) return e;
  if (s.visitor.camera.present) {
    town.crowd.r_unimportant_m = s.control.settings.r_unimportant_m;
    town.crowd.r_far_m = s.control.settings.r_far_m;
  }
  town.crowd.fields_come_later = true;
  town.random.state = town.settings.seed;
  if (Error e = CutTour(scenario.tour, &s.visitor.tour)) return e;
  PlaceStops(InTown(&s));
  if (scenario.language) ChooseLanguage(*scenario.language, &s);
  PlaceCamera(scenario, &s);
  if (s.visitor.camera.present && InsideObstacle(town.walkable, s.visitor.camera.view.position)) {
    town.warnings.push_back("the camera starts inside an obstacle");
  }
  if (Error e = PlaceScenarioPeople(scenario.persons, &town)) return e;
  RememberStart(InTown(&s));
  BeginTour(InTown(&s));
  PlaceGuide(InTown(&s));
  DeriveGap(&s);
  PlaceCrowd(town.settings.people - (s.visitor.guide.id >= 0 ? 1 : 0), ViewerOf(s), &town);  // the guide is one of them
  DeriveGap(&s);                                                                             // some may run
  if (pack != nullptr && !scenario.has_ground) PlaceFlocks(pack->flocks, &town);
  ClassifyAll(&s);
  ControlCrowd(0, &s);
  town.jobs = jobs;
  out->town.field_builder = {};  // of a simulation before may still look at its ground
  *out = std::move(s);
  return Ok();
}

void SetFieldOfView(float fov_rad, Simulation* s) {
  s->visitor.camera.view.fov_rad = fov_rad;
  DeriveGap(s);
}

void SetPictureSize(int width_px, int height_px, Simulation* s) {
  if (width_px == s->screen_width_px && height_px == s->screen_height_px) return;
  s->screen_width_px = width_px;
  s->screen_height_px = height_px;
  s->visitor.camera.aspect = static_cast<float>(width_px) / static_cast<float>(height_px);
  DeriveGap(s);
}

float FrameTimeByModel_ms(const Simulation& s) {
  return s.drawing.base_ms +
         1e-6f * s.drawing.ms_per_million_triangles * static_cast<float>(s.control.levels.triangles);
}

void StepSimulation(const CameraInput& input, float frame_ms, Simulation* s) {
  const double start_ms = Now_ms();
  Town& town = s->town;
  const CameraState& camera = s->visitor.camera;
  if (camera.present) StepTour(input.tour, !input.active, InTown(s));
  MoveCamera(input, InTown(s));
  LeadOn(InTown(s));
  town.crowd.viewer = camera.view.position;
  if (town.step % kSortEvery_steps == 0) SortBySpace(&town.scratch, &town.crowd);
  town.field_builder.Step(town.walkable, town.jobs, &town.crowd);
  StepCrowd(town.walkable, s->moving, Step_s(*s), &town.scratch, &town.crowd, town.jobs);
  LeaveAndArrive(ViewerOf(*s), &town);
  StepFlocks(camera.view.position, camera.present, Step_s(*s), &town);
  ClassifyAll(s);
  if (camera.present) SeparateUnseen(s);
  ControlCrowd(frame_ms, s);
  ++town.step;
  s->step_ms = Now_ms() - start_ms;
}

}  // namespace flaneur
