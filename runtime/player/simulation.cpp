#include "runtime/player/simulation.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/clock.h"
#include "runtime/crowd/constants.h"
#include "runtime/player/camera_walk.h"
#include "runtime/player/check_limits.h"
#include "runtime/player/coming_and_going.h"
#include "runtime/player/places.h"
#include "runtime/player/population.h"
#include "runtime/render/frame.h"

namespace flaneur {
namespace {

constexpr float kFlatCell_m = 0.5f;
constexpr float kFarthestView_m = 60;

Adaptation AdaptationNamed(const std::string& name) {
  return name == "off" ? Adaptation::kOff : name == "paper" ? Adaptation::kPaper : Adaptation::kFull;
}

void TakeObstacles(const std::vector<PackObstacle>& obstacles, Walkable* w) {
  for (const PackObstacle& o : obstacles) {
    if (o.radius_m > 0) w->circles.push_back({o.center, o.radius_m});
    else w->polygons.push_back({o.outer, o.holes});
  }
}

std::vector<PropCost> CostsOf(const std::vector<PackProp>& props) {
  std::vector<PropCost> costs;
  for (size_t k = 0; k < props.size(); ++k) {
    const auto same = [&](const PackProp& other) { return !props[k].slot.empty() && other.slot == props[k].slot; };
    const auto first = std::find_if(props.begin(), props.begin() + static_cast<std::ptrdiff_t>(k), same);
    costs.push_back({props[k].triangles, props[k].share, static_cast<int>(first - props.begin())});
  }
  return costs;
}

// What the renderer draws at most.
ShadowCost ShadowCostOf(const PackAvatar& avatar) {
  const int coarsest = avatar.levels.back().triangles;
  return {std::min(coarsest, kMostShadowTriangles[0]), std::min(coarsest, kMostShadowTriangles[1])};
}

void TakePack(const TourPack& pack, Simulation* s) {
  for (const PackAvatar& avatar : pack.avatars) {
    AvatarCosts costs;
    for (const PackLevel& level : avatar.levels) costs.levels.push_back({level.triangles, level.switch_px});
    costs.height_m = avatar.height_m;
    costs.impostor_px = avatar.height_m / avatar.impostor.texel_m;
    costs.props = CostsOf(avatar.props);
    costs.shadow = ShadowCostOf(avatar);
    s->avatar_names.push_back(avatar.name);
    s->avatar_costs.push_back(costs);
    s->avatar_share.push_back(avatar.share);
    s->avatar_radius_m.push_back(avatar.radius_m);
  }
  s->crowd_settings = pack.crowd;
  const ControlSettings& c = pack.control;
  s->level_settings = {c.method == "frame_time", c.high_limit, c.target_ms, c.budget_triangles, c.r_high_m, c.r_far_m, 1280};
  s->influence.r_unimportant_m = c.r_unimportant_m;
  s->influence.adaptation = AdaptationNamed(c.adaptation);
  s->r_personal_m = c.r_personal_m;
  s->step_s = 1 / c.step_hz;
  s->max_yaw_rate_radps = c.max_yaw_rate_dps * kPi / 180;
  s->camera.view.fov_rad = c.fov_rad;
  s->places = pack.places;
  s->painting = pack.painting;
  TakeTour(pack.path, pack.language, &s->tour);
  for (size_t k = 0; !pack.guide.empty() && k < pack.avatars.size(); ++k) {
    if (pack.avatars[k].name == pack.guide) s->guide.avatar = static_cast<int>(k);
  }
  s->walkable.ground = {pack.ground.min_m, pack.ground.cell_m, pack.ground.columns, pack.ground.rows,
                        pack.ground.height_m, pack.ground.kind};
  TakeObstacles(pack.obstacles, &s->walkable);
}

void TakeGround(const Scenario& scenario, Simulation* s) {
  GroundGrid& g = s->walkable.ground;
  const Vec2 size = scenario.ground_max_m - scenario.ground_min_m;
  g.min_m = scenario.ground_min_m;
  g.cell_m = kFlatCell_m;
  g.columns = static_cast<int>(size.x / kFlatCell_m);
  g.rows = static_cast<int>(size.y / kFlatCell_m);
  g.height_m.assign(static_cast<size_t>(g.columns) * static_cast<size_t>(g.rows), 0);
  g.kind.assign(g.height_m.size(), 3);
  s->walkable.circles.clear();
  s->walkable.polygons.clear();
  s->places.clear();
  s->painting = {};
  s->tour.stops.clear();
}

void TakeScenario(const Scenario& scenario, bool has_pack, Simulation* s) {
  if (scenario.has_ground) TakeGround(scenario, s);
  TakeObstacles(scenario.obstacles, &s->walkable);
  if (s->avatar_names.empty()) {  // without a pack: one plain figure
    s->avatar_names = {kPlainFigure};
    s->avatar_costs = {{{{6000, 60}, {1500, 0}}, 1.75f, 128}};
    s->avatar_share = {1};
    s->avatar_radius_m = {0.25f};
    s->crowd_settings.people = 0;
    s->crowd_settings.group_share = 0;
  }
  s->crowd_settings.people = scenario.people.value_or(scenario.has_ground ? 0 : s->crowd_settings.people);
  s->crowd_settings.seed = scenario.seed.value_or(s->crowd_settings.seed);
  s->crowd_settings.group_share = scenario.group_share.value_or(s->crowd_settings.group_share);
  if (scenario.step_hz) s->step_s = 1 / *scenario.step_hz;
  if (scenario.method) s->level_settings.by_frame_time = *scenario.method == "frame_time";
  s->level_settings.high_limit = scenario.high_limit.value_or(s->level_settings.high_limit);
  s->level_settings.budget_triangles = scenario.budget_triangles.value_or(s->level_settings.budget_triangles);
  s->level_settings.target_ms = scenario.target_ms.value_or(s->level_settings.target_ms);
  s->draw_base_ms = scenario.draw_base_ms.value_or(0);
  s->draw_ms_per_million_triangles = scenario.draw_ms_per_million_triangles.value_or(0);
  s->level_settings.r_high_m = scenario.r_high_m.value_or(s->level_settings.r_high_m);
  if (scenario.adaptation) s->influence.adaptation = AdaptationNamed(*scenario.adaptation);
  s->influence.r_high_m = s->level_settings.r_high_m;
  s->influence.r_personal_m = s->r_personal_m;
  s->influence.step_s = s->step_s;
  if (scenario.fov_deg) s->camera.view.fov_rad = *scenario.fov_deg * kPi / 180;
  s->camera.eye_height_m = scenario.eye_height_m.value_or(kEyeHeight_m);
  s->camera.pitch_rad = scenario.pitch_deg.value_or(0) * kPi / 180;
  s->camera.present = scenario.has_camera || (has_pack && !scenario.has_ground);
  s->legs = scenario.legs;
  if (!s->legs.empty()) s->tour.stops.clear();
  s->crowd_area = scenario.crowd_area;
  s->hour = scenario.hour;
}

// The direction in which one sees farthest at walking height.
float OpenestView_rad(const Walkable& w, Vec2 p) {
  constexpr int kDirections = 32;
  float best_rad = 0, best_m = 0;
  for (int k = 0; k < kDirections; ++k) {
    const float yaw_rad = 2 * kPi * static_cast<float>(k) / kDirections;
    float far_m = 0;
    while (far_m < kFarthestView_m && IsFree(w, p + Vec2{std::cos(yaw_rad), std::sin(yaw_rad)} * far_m)) far_m += w.cell_m;
    if (far_m > best_m) best_rad = yaw_rad, best_m = far_m;
  }
  return best_rad;
}

void PlaceCamera(const Scenario& scenario, Simulation* s) {
  if (scenario.has_camera) {
    s->camera.view.position = scenario.camera_position_m;
    s->camera.view.yaw_rad = scenario.camera_yaw_deg * kPi / 180;
  } else if (const std::vector<TourStop>& stops = s->tour.stops; !stops.empty()) {
    s->camera.view.position = stops.front().position_m;
    s->camera.view.yaw_rad = LookAt_rad(s->tour, 0);
  } else if (const int cell = BestFreeCell(s->walkable); cell >= 0) {
    s->camera.view.position = CellCenter(s->walkable, cell);
    s->camera.view.yaw_rad = OpenestView_rad(s->walkable, s->camera.view.position);
  }
}

void ChooseLanguage(const std::string& language, Simulation* s) {
  std::string list;
  for (const std::string& known : s->tour.languages) {
    if (known == language) return SetLanguage(language, &s->tour);
    list += (list.empty() ? "" : ", ") + known;
  }
  if (!s->tour.stops.empty()) s->warnings.push_back("the tour has nothing in the language '" + language + "'; there is: " + list);
}

void DeriveGap(Simulation* s) {
  const Walkable& w = s->walkable;
  const Vec2 size{static_cast<float>(w.columns) * w.cell_m, static_cast<float>(w.rows) * w.cell_m};
  MotionLimits limits;
  limits.step_s = s->step_s;
  limits.reach_m = Length(size);
  limits.yaw_rate_radps = s->max_yaw_rate_radps;
  limits.camera_speed_mps = 3;
  limits.person_speed_mps = s->crowd_settings.top_speed_mps;
  for (const CameraLeg& leg : s->legs) {
    limits.yaw_rate_radps = std::max(limits.yaw_rate_radps, leg.rate_dps * kPi / 180);
    limits.camera_speed_mps = std::max(limits.camera_speed_mps, leg.speed_mps);
  }
  s->outer_apex_back_m = OuterApexBack_m(limits, s->camera.view.fov_rad);
}

void ClassifyAll(Simulation* s) {
  const ViewVolumes volumes = VolumesOf(s->camera.view, s->outer_apex_back_m);
  for (size_t i = 0; i < s->crowd.size(); ++i) {
    s->crowd.was_visible[i] = s->crowd.view[i] == ViewClass::kVisible ? 1 : 0;
    s->crowd.view[i] = s->camera.present ? Classify(s->crowd.position[i], volumes) : ViewClass::kVisible;
  }
}

void ControlCrowd(float frame_ms, Simulation* s) {
  const double start_ms = Now_ms();
  const ViewMotion motion{s->camera.velocity, s->camera.yaw_rate_radps};
  ChooseLevels(s->crowd, s->avatar_costs, s->camera.view, motion, frame_ms, s->level_settings, s->step_s, &s->levels);
  s->influence.high_limit = s->levels.limit;
  s->moving.clear();
  if (s->camera.present) {
    s->moving.push_back({s->camera.view.position, s->r_personal_m, true, s->camera.asked_velocity});
    ShieldGuide(s);
    InfluenceCrowd(s->camera.view, motion, s->levels, s->walkable, s->influence, &s->crowd, &s->moving, &s->foresight);
    UnshieldGuide(s);
  }
  s->control_ms = Now_ms() - start_ms;
}

// Nobody is put into view, nor where they would come too near to the visitor.
bool IsKeptFree(Vec2 p, const void* simulation) {
  const Simulation& s = *static_cast<const Simulation*>(simulation);
  const ViewCamera& view = s.camera.view;
  return InWedge(p, view.position, view.yaw_rad, view.fov_rad) || Length(p - view.position) < 2 * s.r_personal_m;
}

}  // namespace

Error StartSimulation(const TourPack* pack, const Scenario& scenario, Simulation* out) {
  Simulation s;
  if (pack == nullptr && !scenario.has_ground) return Fail("no pack and no [ground] in the scenario; give one of them");
  if (pack != nullptr) TakePack(*pack, &s);
  TakeScenario(scenario, pack != nullptr, &s);
  BuildWalkable(*std::max_element(s.avatar_radius_m.begin(), s.avatar_radius_m.end()) + 0.05f, &s.walkable);
  if (BestFreeCell(s.walkable) < 0) return Fail("there is no walkable ground");
  if (Error e = CheckLimits(scenario, &s)) return e;
  if (s.camera.present) {
    s.crowd.r_unimportant_m = s.influence.r_unimportant_m;
    s.crowd.r_far_m = s.level_settings.r_far_m;
  }
  s.crowd.fields_come_later = true;
  s.random.state = s.crowd_settings.seed;
  SettleTour(&s);
  if (scenario.language) ChooseLanguage(*scenario.language, &s);
  PlaceCamera(scenario, &s);
  if (s.camera.present && InsideObstacle(s.walkable, s.camera.view.position)) {
    s.warnings.push_back("the camera starts inside an obstacle");
  }
  if (Error e = PlaceScenarioPeople(scenario, &s)) return e;
  BeginTour(&s);
  PlaceGuide(&s);
  DeriveGap(&s);
  PlaceCrowd(&s);
  ClassifyAll(&s);
  ControlCrowd(0, &s);
  *out = std::move(s);
  return Ok();
}

void SetFieldOfView(float fov_rad, Simulation* s) {
  s->camera.view.fov_rad = fov_rad;
  DeriveGap(s);
}

float FrameTimeByModel_ms(const Simulation& s) {
  return s.draw_base_ms + 1e-6f * s.draw_ms_per_million_triangles * static_cast<float>(s.levels.triangles);
}

void StepSimulation(const CameraInput& input, float frame_ms, Simulation* s) {
  const double start_ms = Now_ms();
  if (s->camera.present) StepTour(input.tour, !input.active, s);
  MoveCamera(input, s);
  LeadOn(s);
  s->crowd.viewer = s->camera.view.position;
  if (s->frame % kSortEvery_steps == 0) SortBySpace(&s->crowd);
  s->field_builder.Step(s->walkable, &s->crowd);
  StepCrowd(s->walkable, s->moving, s->step_s, &s->crowd);
  LeaveAndArrive(s);
  ClassifyAll(s);
  if (s->camera.present) SeparateBoundary(s->walkable, IsKeptFree, s, &s->crowd);
  ControlCrowd(frame_ms, s);
  ++s->frame;
  s->step_ms = Now_ms() - start_ms;
}

}  // namespace flaneur
