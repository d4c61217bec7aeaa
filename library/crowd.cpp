#include "flaneur/crowd.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "library/boundary.h"
#include "library/id_pool.h"
#include "runtime/base/random.h"
#include "runtime/control/control.h"
#include "runtime/control/crowd_influence.h"
#include "runtime/crowd/constants.h"
#include "runtime/crowd/field_builder.h"
#include "runtime/crowd/walls.h"

namespace {

using namespace flaneur;

constexpr int kCrowdCookie = 0x43524f57, kPersonCookie = 0x50455253;  // "CROW", "PERS"
constexpr double kFarthest_m = 1e8, kReach_m = 1e5;
constexpr double kMaxGround_m = 2000, kMinGround_m = 2;
constexpr size_t kMaxPeople = 200'000;
constexpr int kMaxFigures = 10'000, kMaxLevels = 16;
constexpr float kGroundCell_m = 0.5f;
constexpr float kJump_m = 10;
constexpr float kWholeTown_m = 1e9f;

// Goals that people have, each a field of the crowd. A field that nobody goes to any more is given to the next new
// goal.
struct Goals {
  std::map<std::pair<float, float>, int> field_of;
  std::vector<int> users;     // by field
  std::vector<int> deserted;  // fields without users, as they became it; some may have got users again
};

struct LibraryCrowd {
  std::unique_ptr<Jobs> jobs;  // outlives whoever works with them; none: no threads
  FlaneurPoint origin_m{};     // of the coordinates inside: floats stay fine on any map
  Walkable walkable;
  Crowd crowd;
  FieldBuilder field_builder;
  CrowdScratch scratch;
  Control control;
  Goals goals;
  Random random;
  float largest_radius_m = 0, preferred_mps = 0, spread_mps = 0, top_mps = 0;
  std::vector<MovingObstacle> moving;
  std::vector<int> index_of_slot;  // in crowd; -1: nobody
  ViewCamera camera;               // of the last step
  bool has_camera = false;
  std::vector<FlaneurPerson> people;
  std::vector<float> reach_m;  // by figure
};

IdPool<FlaneurCrowdId, LibraryCrowd>& Crowds() {
  static auto* crowds = new IdPool<FlaneurCrowdId, LibraryCrowd>;  // outlives whatever the program does at its end
  return *crowds;
}

LastError& Last() {
  static thread_local LastError last;
  return last;
}

Vec2 Inside(const LibraryCrowd& c, FlaneurPoint p) {
  return {static_cast<float>(p.x - c.origin_m.x), static_cast<float>(p.y - c.origin_m.y)};
}
FlaneurPoint Outside(const LibraryCrowd& c, Vec2 p) {
  return {static_cast<double>(p.x) + c.origin_m.x, static_cast<double>(p.y) + c.origin_m.y};
}
// Into -pi ... pi, whatever it was.
float Wrapped(float angle_rad) { return std::remainder(angle_rad, 2 * kPi); }

bool IsWithin(FlaneurPoint p, double reach_m, FlaneurPoint of = {0, 0}) {
  return std::abs(p.x - of.x) <= reach_m && std::abs(p.y - of.y) <= reach_m;
}

// The definition.

// Compares with the ranges that tours have.
struct RangeCheck {
  Failure failure = {};
  template <typename T>
  void Number(const char* name, T* value, double least, double most) {
    if (!failure) failure = CheckRanges(std::array{Range{name, static_cast<double>(*value), least, most}});
  }
  void Angle(const char*, float*, double, double) {}
  void Choice(const char*, std::string*, std::initializer_list<const char*>) {}
};

Failure TakeControl(const FlaneurCrowdDef& def, ControlSettings* s) {
  if (def.adaptation < FLANEUR_ADAPTATION_OFF || def.adaptation > FLANEUR_ADAPTATION_FULL)
    return OutOfRange("adaptation", "a FlaneurAdaptation");
  if (def.method < FLANEUR_LIMIT_COUNT || def.method > FLANEUR_LIMIT_FRAME_TIME)
    return OutOfRange("method", "a FlaneurLimitMethod");
  s->adaptation = static_cast<Adaptation>(def.adaptation), s->method = static_cast<LimitMethod>(def.method);
  s->discretion = def.discretion;
  s->high_limit = def.high_limit, s->target_ms = def.target_ms, s->budget_triangles = def.budget_triangles;
  s->r_personal_m = def.r_personal_m, s->r_high_m = def.r_high_m;
  s->r_unimportant_m = def.r_unimportant_m, s->r_far_m = def.r_far_m;
  s->step_hz = def.step_hz, s->max_yaw_rate_dps = def.max_yaw_rate_dps;
  RangeCheck check;
  VisitFields(check, s);
  if (check.failure) return check.failure;
  if (s->r_high_m > 0 && s->r_high_m <= s->r_personal_m)
    return {FLANEUR_ERROR_INPUT, "contradictory limits: r_personal_m must be below r_high_m"};
  if (s->r_high_m >= s->r_far_m) return {FLANEUR_ERROR_INPUT, "contradictory limits: r_high_m must be below r_far_m"};
  return {};
}

Failure TakeFigures(const FlaneurCrowdDef& def, std::vector<AvatarCosts>* figures, std::vector<float>* reach_m) {
  if (!def.figures && def.figure_count == 0) {
    *figures = {{{{6000, 60}, {1500, 0}}, 1.75f, 128}};
    *reach_m = {0};
    return {};
  }
  if (!def.figures) return NullPointer("figures");
  if (def.figure_count < 1 || def.figure_count > kMaxFigures) return OutOfRange("figure_count", "1 to 10000");
  for (int i = 0; i < def.figure_count; ++i) {
    const FlaneurFigure& figure = def.figures[i];
    if (!figure.levels) return NullPointer("levels");
    if (figure.level_count < 1 || figure.level_count > kMaxLevels) return OutOfRange("level_count", "1 to 16");
    const std::array ranges{Range{"height_m", figure.height_m, 0.1, 10},
                            Range{"impostor_px", figure.impostor_px, 0, 1e6, true},
                            Range{"reach_m", figure.reach_m, 0, 10}};
    if (Failure failure = CheckRanges(ranges)) return failure;
    AvatarCosts costs;
    costs.height_m = figure.height_m, costs.impostor_px = figure.impostor_px;
    for (int k = 0; k < figure.level_count; ++k) {
      const FlaneurLevelCost& level = figure.levels[k];
      const std::array numbers{Range{"triangles", static_cast<double>(level.triangles), 1, 1e8},
                               Range{"switch_px", level.switch_px, 0, 1e6}};
      if (Failure failure = CheckRanges(numbers)) return failure;
      costs.levels.push_back({level.triangles, level.switch_px});
    }
    figures->push_back(std::move(costs));
    reach_m->push_back(figure.reach_m);
  }
  return {};
}

Failure TakeRing(const FlaneurRing& ring, const LibraryCrowd& c, std::vector<Vec2>* out) {
  if (ring.count < 3) return OutOfRange("count of a polygon's ring", "at least 3");
  if (!ring.points) return NullPointer("points of a polygon's ring");
  for (int i = 0; i < ring.count; ++i) {
    if (!IsWithin(ring.points[i], kReach_m, c.origin_m))
      return OutOfRange("each point of a polygon", "within 100 km of the ground");
    out->push_back(Inside(c, ring.points[i]));
  }
  return {};
}

Failure TakeObstacles(const FlaneurCrowdDef& def, LibraryCrowd* c) {
  if (def.polygon_count < 0 || def.circle_count < 0) return OutOfRange("polygon_count and circle_count", "at least 0");
  if (def.polygon_count > 0 && !def.polygons) return NullPointer("polygons");
  if (def.circle_count > 0 && !def.circles) return NullPointer("circles");
  for (int i = 0; i < def.polygon_count; ++i) {
    const FlaneurPolygon& polygon = def.polygons[i];
    PolygonObstacle& out = c->walkable.polygons.emplace_back();
    if (Failure failure = TakeRing(polygon.outer, *c, &out.outer)) return failure;
    if (polygon.hole_count < 0) return OutOfRange("hole_count", "at least 0");
    if (polygon.hole_count > 0 && !polygon.holes) return NullPointer("holes");
    for (int k = 0; k < polygon.hole_count; ++k)
      if (Failure failure = TakeRing(polygon.holes[k], *c, &out.holes.emplace_back())) return failure;
  }
  for (int i = 0; i < def.circle_count; ++i) {
    const FlaneurCircle& circle = def.circles[i];
    if (Failure failure = CheckRanges(std::array{Range{"radius_m of a circle", circle.radius_m, 0, kReach_m, true}}))
      return failure;
    if (!IsWithin(circle.center_m, kReach_m, c->origin_m))
      return OutOfRange("center_m of a circle", "within 100 km of the ground");
    c->walkable.circles.push_back({Inside(*c, circle.center_m), static_cast<float>(circle.radius_m)});
  }
  return {};
}

Failure TakeGround(const FlaneurCrowdDef& def, LibraryCrowd* c) {
  if (!IsWithin(def.ground_min_m, kFarthest_m) || !IsWithin(def.ground_max_m, kFarthest_m))
    return OutOfRange("ground_min_m and ground_max_m", "within 100,000 km");
  const double width_m = def.ground_max_m.x - def.ground_min_m.x, depth_m = def.ground_max_m.y - def.ground_min_m.y;
  const std::array ranges{Range{"the ground's width in metres", width_m, kMinGround_m, kMaxGround_m},
                          Range{"the ground's depth in metres", depth_m, kMinGround_m, kMaxGround_m}};
  if (Failure failure = CheckRanges(ranges)) return failure;
  c->origin_m = def.ground_min_m;
  GroundRaster ground;
  ground.cell_m = kGroundCell_m;
  ground.columns = static_cast<int>(width_m / kGroundCell_m), ground.rows = static_cast<int>(depth_m / kGroundCell_m);
  const auto cells = static_cast<size_t>(ground.columns) * static_cast<size_t>(ground.rows);
  ground.height_m.assign(cells, 0), ground.kind.assign(cells, 3);
  c->walkable.ground = Share(std::move(ground));
  return {};
}

Failure TakeSpeeds(const FlaneurCrowdDef& def, LibraryCrowd* c) {
  const std::array ranges{Range{"largest_radius_m", def.largest_radius_m, 0.1f, 0.5},
                          Range{"preferred_speed_mps", def.preferred_speed_mps, 0.1f, 5},
                          Range{"speed_spread_mps", def.speed_spread_mps, 0, 2},
                          Range{"top_speed_mps", def.top_speed_mps, 0.1f, 10}};
  if (Failure failure = CheckRanges(ranges)) return failure;
  c->random.state = def.seed;
  c->largest_radius_m = def.largest_radius_m;
  c->preferred_mps = def.preferred_speed_mps, c->spread_mps = def.speed_spread_mps, c->top_mps = def.top_speed_mps;
  return {};
}

Failure Create(const FlaneurCrowdDef& def, FlaneurCrowdId* id) {
  auto c = std::make_shared<LibraryCrowd>();
  if (Failure failure = TakeSpeeds(def, c.get())) return failure;
  if (Failure failure = TakeControl(def, &c->control.settings)) return failure;
  if (Failure failure = TakeFigures(def, &c->control.avatars, &c->reach_m)) return failure;
  if (Failure failure = TakeGround(def, c.get())) return failure;
  if (Failure failure = TakeObstacles(def, c.get())) return failure;
  BuildWalkable(c->largest_radius_m + kByChoice_m, &c->walkable, c->largest_radius_m);
  const std::vector<float>& cost = c->walkable.cost;
  if (std::none_of(cost.begin(), cost.end(), [](float metre) { return metre > 0; }))
    return {FLANEUR_ERROR_INPUT, "obstacles leave no ground to walk on"};
  c->crowd.fields_come_later = true;
  *id = Crowds().Add(std::move(c));
  return {};
}

// People and their goals.

constexpr size_t kNobody = std::numeric_limits<size_t>::max();

FlaneurPersonId IdOf(const Crowd& crowd, size_t i) {
  return {static_cast<uint32_t>(crowd.slot[i]) + 1, static_cast<uint32_t>(crowd.id[i]) + 1};
}

// kNobody where there is none.
size_t IndexOf(const LibraryCrowd& c, FlaneurPersonId id) {
  if (id.index1 == 0 || id.index1 > c.index_of_slot.size()) return kNobody;
  const int index = c.index_of_slot[id.index1 - 1];
  if (index < 0) return kNobody;
  const FlaneurPersonId is = IdOf(c.crowd, static_cast<size_t>(index));
  return is.index1 == id.index1 && is.generation == id.generation ? static_cast<size_t>(index) : kNobody;
}

void Renumber(LibraryCrowd* c) {
  for (size_t i = 0; i < c->crowd.size(); ++i)
    c->index_of_slot[static_cast<size_t>(c->crowd.slot[i])] = static_cast<int>(i);
}

// A field that nobody goes to any more and nobody builds; -1: none.
int TakeDesertedField(LibraryCrowd* c) {
  Goals& goals = c->goals;
  for (size_t k = goals.deserted.size(); k-- > 0;) {
    const int field = goals.deserted[k];
    const FlowField& f = c->crowd.fields[static_cast<size_t>(field)];
    const bool is_used = goals.users[static_cast<size_t>(field)] > 0;
    if (!is_used && !IsBuilt(f) && f.questions >= kSharedGoal) continue;
    goals.deserted.erase(goals.deserted.begin() + static_cast<long>(k));
    if (is_used) continue;
    goals.field_of.erase({f.goal.x, f.goal.y});
    return field;
  }
  return -1;
}

int FieldOf(Vec2 goal, LibraryCrowd* c) {
  const auto [entry, is_new] = c->goals.field_of.try_emplace({goal.x, goal.y}, -1);
  if (!is_new) return entry->second;
  const int deserted = TakeDesertedField(c);
  const int field = deserted >= 0 ? deserted : static_cast<int>(c->crowd.fields.size());
  if (deserted < 0) {
    c->crowd.fields.emplace_back();
    c->goals.users.push_back(0);
  }
  c->crowd.fields[static_cast<size_t>(field)] = FlowField{goal, {}};
  return entry->second = field;
}

void SendTo(int field, size_t i, LibraryCrowd* c) {
  const int before = c->crowd.field[i];
  if (field >= 0) ++c->goals.users[static_cast<size_t>(field)];
  if (before >= 0 && --c->goals.users[static_cast<size_t>(before)] == 0) c->goals.deserted.push_back(before);
  SetGoal(i, field, &c->crowd);
}

Failure SetGoalOf(size_t i, FlaneurPoint goal_m, LibraryCrowd* c) {
  if (!IsWithin(goal_m, kReach_m, c->origin_m)) return OutOfRange("goal_m", "within 100 km of the ground");
  const Vec2 goal = Inside(*c, goal_m);
  if (FreeCellFor(c->walkable, goal) < 0)
    return {FLANEUR_ERROR_INPUT, "there is no ground to walk on within 3 m of the goal"};
  if (!Reachable(c->walkable, FlowField{goal, {}, 0}, c->crowd.position[i]))
    return {FLANEUR_ERROR_INPUT, "no way leads from the person to the goal"};
  SendTo(FieldOf(goal, c), i, c);
  return {};
}

Failure Add(const FlaneurPersonDef& def, LibraryCrowd* c, FlaneurPersonId* id) {
  if (!IsWithin(def.position_m, kReach_m, c->origin_m)) return OutOfRange("position_m", "within 100 km of the ground");
  constexpr double kManyTurns_rad = 1e6;
  const std::array ranges{
      Range{"heading_rad", def.heading_rad, -kManyTurns_rad, kManyTurns_rad},
      Range{"figure", static_cast<double>(def.figure), 0, static_cast<double>(c->control.avatars.size()) - 1},
      Range{"radius_m", def.radius_m, 0.1f, c->largest_radius_m},
      Range{"preferred_speed_mps", def.preferred_speed_mps, 0, 10}};
  if (Failure failure = CheckRanges(ranges)) return failure;
  if (c->crowd.size() >= kMaxPeople || c->crowd.next_id == std::numeric_limits<int>::max())
    return OutOfRange("the number of people", "at most 200,000");
  Person person;
  person.position = Inside(*c, def.position_m);
  const int cell = CellAt(c->walkable, person.position);
  if (cell < 0 || !OnGround(c->walkable, person.position)) return {FLANEUR_ERROR_INPUT, "position_m is off the ground"};
  if (InsideObstacle(c->walkable, person.position) || Clearance(c->walkable, cell, person.position) < def.radius_m)
    return {FLANEUR_ERROR_INPUT, "position_m is inside an obstacle, or too near to one"};
  person.avatar = def.figure, person.heading_rad = Wrapped(def.heading_rad), person.radius_m = def.radius_m;
  // Of a sum of three the spread is the standard deviation. Drawn in any case, so that those of others do not depend on
  // it.
  const float drawn = c->random.Uniform(-1, 1) + c->random.Uniform(-1, 1) + c->random.Uniform(-1, 1);
  const float drawn_mps = c->preferred_mps + c->spread_mps * drawn;
  person.preferred_mps =
      std::clamp(def.preferred_speed_mps > 0 ? def.preferred_speed_mps : drawn_mps, 0.1f, c->top_mps);
  person.top_mps = c->top_mps;
  person.reach_m = c->reach_m[static_cast<size_t>(def.figure)];
  c->index_of_slot.reserve(c->crowd.slots.owner.size() + 1);
  AddPerson(person, &c->crowd);
  const size_t i = c->crowd.size() - 1;
  c->index_of_slot.resize(c->crowd.slots.owner.size(), -1);
  c->index_of_slot[static_cast<size_t>(c->crowd.slot[i])] = static_cast<int>(i);
  *id = IdOf(c->crowd, i);
  return {};
}

void Remove(size_t i, LibraryCrowd* c) {
  SendTo(-1, i, c);
  c->index_of_slot[static_cast<size_t>(c->crowd.slot[i])] = -1;
  RemovePerson(i, &c->crowd);
  if (i < c->crowd.size()) c->index_of_slot[static_cast<size_t>(c->crowd.slot[i])] = static_cast<int>(i);
}

// The step.

Failure TakeCamera(const FlaneurCamera& camera, const LibraryCrowd& c, ViewCamera* view) {
  if (!IsWithin(camera.position_m, kReach_m, c.origin_m))
    return OutOfRange("the camera's position_m", "within 100 km of the ground");
  constexpr double kManyTurns_rad = 1e6;
  const std::array ranges{Range{"yaw_rad", camera.yaw_rad, -kManyTurns_rad, kManyTurns_rad},
                          Range{"fov_rad", camera.fov_rad, 10 * kPi / 180, 150 * kPi / 180},
                          Range{"screen_width_px", static_cast<double>(camera.screen_width_px), 1, 65536}};
  if (Failure failure = CheckRanges(ranges)) return failure;
  *view = {Inside(c, camera.position_m), Wrapped(camera.yaw_rad), camera.fov_rad};
  return {};
}

float OuterApexBack_m(const LibraryCrowd& c, float fov_rad) {
  MotionLimits limits;
  limits.step_s = Step_s(c.control.settings);
  limits.reach_m =
      Length(Vec2{static_cast<float>(c.walkable.columns), static_cast<float>(c.walkable.rows)} * c.walkable.cell_m);
  limits.yaw_rate_radps = MaxYawRate_radps(c.control.settings);
  limits.person_speed_mps = c.top_mps;
  return flaneur::OuterApexBack_m(limits, fov_rad);
}

ViewMotion MotionSinceLastStep(const LibraryCrowd& c, const ViewCamera& now) {
  const Vec2 way = now.position - c.camera.position;
  if (!c.has_camera || Length(way) > kJump_m) return {};
  const float step_s = Step_s(c.control.settings);
  return {way * (1 / step_s), Wrapped(now.yaw_rad - c.camera.yaw_rad) / step_s};
}

void ClassifyAll(const ViewVolumes* volumes, Crowd* crowd) {
  for (size_t i = 0; i < crowd->size(); ++i) {
    crowd->was_visible[i] = crowd->view[i] == ViewClass::kVisible ? 1 : 0;
    crowd->view[i] = volumes ? Classify(crowd->position[i], crowd->reach_m[i], *volumes) : ViewClass::kVisible;
  }
}

// Nobody is put into view, nor where they would come too near to the visitor.
bool IsKeptFree(Vec2 p, float reach_m, const void* crowd) {
  const LibraryCrowd& c = *static_cast<const LibraryCrowd*>(crowd);
  return Classify(p, reach_m, c.camera, 0) != ViewClass::kOutside ||
         Length(p - c.camera.position) < 2 * c.control.settings.r_personal_m;
}

int LevelNumber(Level level) {
  return IsMesh(level) ? level.mesh : IsDrawn(level) ? FLANEUR_LEVEL_IMPOSTOR : FLANEUR_LEVEL_NOT_DRAWN;
}

void FillPeople(LibraryCrowd* c) {
  const Crowd& crowd = c->crowd;
  c->people.clear();
  for (size_t i = 0; i < crowd.size(); ++i) {
    const PersonLevel level = c->has_camera ? c->control.levels.people[i] : PersonLevel{};
    FlaneurPerson p{};
    p.id = IdOf(crowd, i);
    p.position_m = Outside(*c, crowd.position[i]);
    p.heading_rad = crowd.heading_rad[i], p.speed_mps = Length(crowd.velocity[i]), p.walked_m = crowd.walked_m[i];
    p.figure = crowd.avatar[i];
    p.level = LevelNumber(level.level), p.from_level = LevelNumber(level.from);
    p.fade = ShareOf(level, 0), p.age_s = std::min(level.age_s, kFade_s);
    p.arrival = static_cast<int>(crowd.arrived[i]);
    p.is_in_view = c->has_camera && crowd.view[i] == ViewClass::kVisible;
    c->people.push_back(p);
  }
}

void StopWhoIsThere(LibraryCrowd* c) {
  for (size_t i = 0; i < c->crowd.size(); ++i)
    if (c->crowd.field[i] >= 0 && c->crowd.arrived[i] == Arrival::kThere) SendTo(-1, i, c);
}

// In the order of a tour's step.
void Step(const FlaneurCamera* camera, const ViewCamera& view, float frame_ms, LibraryCrowd* c) {
  Crowd& crowd = c->crowd;
  Control& control = c->control;
  const ControlSettings& settings = control.settings;
  const ViewMotion motion = camera ? MotionSinceLastStep(*c, view) : ViewMotion{};
  crowd.viewer = view.position;
  crowd.r_unimportant_m = camera ? settings.r_unimportant_m : kWholeTown_m;
  crowd.r_far_m = camera ? settings.r_far_m : kWholeTown_m;
  if (crowd.step % kSortEvery_steps == 0) {
    SortBySpace(&c->scratch, &crowd);
    Renumber(c);
  }
  c->field_builder.Step(c->walkable, nullptr, &crowd);
  StepCrowd(c->walkable, c->moving, Step_s(settings), &c->scratch, &crowd, c->jobs.get());
  c->camera = view, c->has_camera = camera != nullptr;
  c->moving.clear();
  if (camera) {
    control.outer_apex_back_m = OuterApexBack_m(*c, view.fov_rad);
    const ViewVolumes volumes = VolumesOf(view, control.outer_apex_back_m);
    ClassifyAll(&volumes, &crowd);
    SeparateBoundary(c->walkable, IsKeptFree, c, &c->scratch, &crowd);
    for (int who : c->scratch.displaced.people) {
      const auto i = static_cast<size_t>(who);
      crowd.view[i] = Classify(crowd.position[i], crowd.reach_m[i], volumes);
    }
    ChooseLevels(crowd, control.avatars, settings, {view, motion, frame_ms, camera->screen_width_px, -1},
                 &control.levels);
    c->moving.push_back({view.position, settings.r_personal_m, true, motion.velocity});
    InfluenceCrowd(view, motion, control.levels, c->walkable, settings, &crowd, &c->moving, &control.foresight);
  } else {
    ClassifyAll(nullptr, &crowd);
  }
  FillPeople(c);
  StopWhoIsThere(c);
}

// Calls `call(crowd)` for the crowd with this id.
template <typename Call>
FlaneurStatus WithCrowd(FlaneurCrowdId id, const Call& call) {
  return AtBoundary(&Last(), [&]() -> Failure {
    const std::shared_ptr<LibraryCrowd> c = Crowds().Find(id);
    return c ? call(c.get()) : NoSuchId("crowd");
  });
}
// Calls `call(crowd, index)` for the person with this id.
template <typename Call>
FlaneurStatus WithPerson(FlaneurCrowdId id, FlaneurPersonId person, const Call& call) {
  return WithCrowd(id, [&](LibraryCrowd* c) -> Failure {
    const size_t i = IndexOf(*c, person);
    return i != kNobody ? call(c, i) : NoSuchId("person");
  });
}

}  // namespace

FlaneurCrowdDef flaneur_default_crowd_def(void) {
  const ControlSettings control;
  const CrowdSettings crowd;
  FlaneurCrowdDef def{};
  def.seed = crowd.seed;
  def.largest_radius_m = 0.25f;
  def.preferred_speed_mps = crowd.preferred_speed_mps, def.speed_spread_mps = crowd.speed_spread_mps;
  def.top_speed_mps = crowd.top_speed_mps;
  def.adaptation = static_cast<int>(control.adaptation), def.method = static_cast<int>(control.method);
  def.discretion = control.discretion;
  def.high_limit = control.high_limit, def.target_ms = control.target_ms,
  def.budget_triangles = control.budget_triangles;
  def.r_personal_m = control.r_personal_m, def.r_high_m = control.r_high_m;
  def.r_unimportant_m = control.r_unimportant_m, def.r_far_m = control.r_far_m;
  def.step_hz = control.step_hz, def.max_yaw_rate_dps = control.max_yaw_rate_dps;
  def.internal_value = kCrowdCookie;
  return def;
}

FlaneurPersonDef flaneur_default_person_def(void) {
  FlaneurPersonDef def{};
  def.radius_m = 0.25f;
  def.internal_value = kPersonCookie;
  return def;
}

FlaneurStatus flaneur_create_crowd(const FlaneurCrowdDef* def, FlaneurCrowdId* id) {
  return AtBoundary(&Last(), [&]() -> Failure {
    if (!def || !id) return NullPointer(def ? "id" : "def");
    if (def->internal_value != kCrowdCookie) return NoDefinition("flaneur_default_crowd_def");
    return Create(*def, id);
  });
}

FlaneurStatus flaneur_destroy_crowd(FlaneurCrowdId crowd) {
  return AtBoundary(&Last(), [&]() -> Failure { return Crowds().Remove(crowd) ? Failure{} : NoSuchId("crowd"); });
}

bool flaneur_crowd_is_valid(FlaneurCrowdId crowd) { return Crowds().Find(crowd) != nullptr; }

FlaneurStatus flaneur_crowd_add_person(FlaneurCrowdId crowd, const FlaneurPersonDef* def, FlaneurPersonId* id) {
  return WithCrowd(crowd, [&](LibraryCrowd* c) -> Failure {
    if (!def || !id) return NullPointer(def ? "id" : "def");
    if (def->internal_value != kPersonCookie) return NoDefinition("flaneur_default_person_def");
    return Add(*def, c, id);
  });
}

FlaneurStatus flaneur_crowd_remove_person(FlaneurCrowdId crowd, FlaneurPersonId person) {
  return WithPerson(crowd, person, [](LibraryCrowd* c, size_t i) {
    Remove(i, c);
    return Failure{};
  });
}

bool flaneur_crowd_has_person(FlaneurCrowdId crowd, FlaneurPersonId person) {
  const std::shared_ptr<LibraryCrowd> c = Crowds().Find(crowd);
  return c && IndexOf(*c, person) != kNobody;
}

FlaneurStatus flaneur_crowd_set_goal(FlaneurCrowdId crowd, FlaneurPersonId person, FlaneurPoint goal_m) {
  return WithPerson(crowd, person, [&](LibraryCrowd* c, size_t i) { return SetGoalOf(i, goal_m, c); });
}

FlaneurStatus flaneur_crowd_clear_goal(FlaneurCrowdId crowd, FlaneurPersonId person) {
  return WithPerson(crowd, person, [](LibraryCrowd* c, size_t i) {
    SendTo(-1, i, c);
    return Failure{};
  });
}

FlaneurStatus flaneur_crowd_step(FlaneurCrowdId crowd, const FlaneurCamera* camera, float frame_ms) {
  return WithCrowd(crowd, [&](LibraryCrowd* c) -> Failure {
    ViewCamera view;
    if (camera)
      if (Failure failure = TakeCamera(*camera, *c, &view)) return failure;
    if (Failure failure = CheckRanges(std::array{Range{"frame_ms", frame_ms, 0, 10'000}})) return failure;
    Step(camera, view, frame_ms, c);
    return {};
  });
}

FlaneurStatus flaneur_crowd_set_threads(FlaneurCrowdId crowd, int threads) {
  return WithCrowd(crowd, [&](LibraryCrowd* c) -> Failure {
    if (Failure failure = CheckRanges(std::array{Range{"threads", static_cast<double>(threads), 0, 64}}))
      return failure;
    c->jobs = threads > 0 ? std::make_unique<Jobs>(static_cast<size_t>(threads)) : nullptr;
    return {};
  });
}

FlaneurStatus flaneur_crowd_people(FlaneurCrowdId crowd, FlaneurPersonSpan* people) {
  return WithCrowd(crowd, [&](LibraryCrowd* c) -> Failure {
    if (!people) return NullPointer("people");
    *people = {c->people.data(), static_cast<int>(c->people.size())};
    return {};
  });
}

FlaneurStatus flaneur_crowd_figures(FlaneurCrowdId crowd, FlaneurCrowdFigures* figures) {
  return WithCrowd(crowd, [&](LibraryCrowd* c) -> Failure {
    if (!figures) return NullPointer("figures");
    const LevelState none, &levels = c->has_camera ? c->control.levels : none;
    *figures = {
        static_cast<int>(c->crowd.size()), levels.high, levels.low, levels.limit, levels.triangles, c->crowd.step,
        Step_s(c->control.settings)};
    return {};
  });
}

const char* flaneur_crowd_last_error(void) { return Last().text; }

FlaneurVersion flaneur_crowd_version(void) {
  return {FLANEUR_VERSION_MAJOR, FLANEUR_VERSION_MINOR, FLANEUR_VERSION_PATCH};
}
