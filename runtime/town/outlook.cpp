#include "runtime/town/outlook.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/town/company.h"
#include "runtime/town/places.h"
#include "runtime/town/town.h"

namespace flaneur {
namespace {

constexpr float kLookEvery_s = 0.4f;
constexpr float kAfter_s[Outlook::kMoments] = {2, 5, 8, 12};
constexpr float kTrace_s = 1.0f;                                     // from point to point of a way that is forecast
constexpr float kFast_mps = 1.6f;                                    // few walk faster
constexpr float kReserve = 0.1f;                                     // share of the limit kept free for surprises
constexpr float kSurer[Outlook::kMoments] = {1, 1.15f, 1.3f, 1.5f};  // times the limit: what is far off may yet change
constexpr float kVisitorsWay_s = 1.5f;
constexpr float kGoesOn_s = 4;                                        // the visitor does as before
constexpr float kPressureGrows_ps = 1.0f, kPressureFades_ps = 0.06f;  // for each limit too many, or too few
constexpr float kAimsAt = 0.82f;                                      // times the limit
constexpr float kLax = 1.0f;            // without pressure so many times the limit more may come
constexpr float kElsewhere = 0.85f;     // a full view matters that much while the visitor looks elsewhere
constexpr float kNeighbourhood = 2.5f;  // times r_high
constexpr float kStays = 0.35f;         // share of usual people beyond the limit who stay for discretion
constexpr float kPressureAtStart = 0.7f, kFillsAtStart = 0.9f, kStartRim_m = 0.5f, kStartBody_m = 0.6f;
constexpr int kEveryCell = 2;
constexpr float kUsual = 0.05f;
constexpr float kWorthFilling = 0.25f;
constexpr float kFarFrom = 1.6f;           // times r_high: farther away people may choose another way in view,
constexpr float kTurnsInView = 0.8f;       // cosine of how far they turn for it
constexpr int kTries = 6, kMostSent = 10;  // destinations; people at once

using Bearing = std::array<int8_t, Outlook::kMoments>;  // sector by moment; -1: out of reach

int8_t BearingAt(const Outlook& o, int moment, Vec2 p) {
  const Vec2 off = p - o.moments[static_cast<size_t>(moment)].visitor;
  return Dot(off, off) < o.reach_m * o.reach_m ? static_cast<int8_t>(SectorOf(off)) : int8_t{-1};
}

// Where somebody will be who walks to the goal of a field; -1: stays.
Bearing Forecast(const Town& town, Vec2 p, int field, float speed_mps) {
  const Outlook& o = town.outlook;
  Bearing bearing;
  float now_s = 0;
  for (int k = 0; k < Outlook::kMoments; ++k) {
    const float until_s = kAfter_s[k];
    while (field >= 0 && now_s < until_s) {
      const FlowField& f = town.crowd.fields[static_cast<size_t>(field)];
      const float step_s = std::min(kTrace_s, until_s - now_s), step_m = step_s * speed_mps;
      const Vec2 left = f.goal - p;
      const float left_m = Length(left);
      now_s += step_s;
      if (left_m <= step_m) p = f.goal;
      else p = p + (IsBuilt(f) ? RoughWayAt(town.walkable, f, p) : left * (1 / left_m)) * step_m;
    }
    bearing[static_cast<size_t>(k)] = BearingAt(o, k, p);
  }
  return bearing;
}

bool IsFar(const Outlook& o, Vec2 p, Vec2 visitor) {
  const Vec2 off = p - visitor;
  const float reach_m = o.reach_m + kAfter_s[Outlook::kMoments - 1] * (kFast_mps + Length(o.velocity));
  return Dot(off, off) > reach_m * reach_m;
}

void Tally(const Bearing& bearing, int count, Outlook* o) {
  for (size_t k = 0; k < Outlook::kMoments; ++k) {
    if (bearing[k] >= 0) o->moments[k].around[static_cast<size_t>(bearing[k])] += count;
  }
}

// Finds where there would be too many, whichever way the visitor looks.
void MeasureRoom(float fov_rad, float limit, Outlook* o) {
  const int width = SectorsTouched(fov_rad);
  o->is_full = false;
  for (size_t k = 0; k < Outlook::kMoments; ++k) {
    Outlook::Moment& m = o->moments[k];
    const int capacity = static_cast<int>(std::lround(kSurer[k] * limit));
    m.too_many = FullestOver(m.around, width);
    for (int& people : m.too_many) people -= capacity;
    if (Fullest(m.around, width) > capacity) o->is_full = true;
  }
}

// added: the person is not counted yet.
float TooMany(const Outlook& o, const Bearing& bearing, int added) {
  float sum = 0;
  for (size_t k = 0; k < Outlook::kMoments; ++k) {
    if (bearing[k] < 0) continue;
    sum += static_cast<float>(std::max(0, o.moments[k].too_many[static_cast<size_t>(bearing[k])] + added));
  }
  return sum;
}

// How much room would be filled.
float Fills(const Outlook& o, const Bearing& bearing) {
  float sum = 0;
  for (size_t k = 0; k < Outlook::kMoments; ++k) {
    if (bearing[k] < 0) continue;
    const int room = -o.moments[k].too_many[static_cast<size_t>(bearing[k])];
    sum += kWorthFilling * static_cast<float>(std::clamp(room - 1, 0, 4));
  }
  return sum;
}

// Most people in a view: where the usual number is beyond the limit, some of them stay for discretion.
float Allowed(int most, float usual, float discretion) {
  const float limit = static_cast<float>(most);
  return limit + kStays * discretion * std::max(0.0f, usual - limit);
}

// The visitor walks on, until a wall.
void ForeseeVisitor(const Viewer& viewer, const Town& town, Outlook* o) {
  Vec2 p = viewer.camera.position;
  float now_s = 0;
  for (int k = 0; k < Outlook::kMoments; ++k) {
    for (; now_s < kAfter_s[k]; now_s += 0.5f) {
      const Vec2 next = p + o->velocity * (0.5f * std::exp(-now_s / kGoesOn_s));
      if (!IsFree(town.walkable, next)) break;
      p = next;
    }
    now_s = kAfter_s[k];
    o->moments[static_cast<size_t>(k)].visitor = p;
    o->moments[static_cast<size_t>(k)].around.fill(0);
  }
}

bool WalksWhereTheyLike(size_t i, const Town& town) {
  const PersonPlan& plan = PlanOf(i, town);
  return town.crowd.field[i] >= 0 && plan.goals.empty() && !plan.stay && !plan.leaves && plan.spot < 0 && plan.work < 0;
}

enum class Sight { kNear, kFar, kNone };

Sight SightOf(const Company& company, const Viewer& viewer, const Town& town) {
  Sight sight = Sight::kNone;
  const float far_m = kFarFrom * viewer.settings.r_high_m;
  for (int k = 0; k < company.size; ++k) {
    const size_t i = company.member[k];
    if (town.crowd.view[i] != ViewClass::kVisible) continue;
    const Vec2 off = town.crowd.position[i] - viewer.camera.position;
    if (Dot(off, off) < far_m * far_m) return Sight::kNear;
    sight = Sight::kFar;
  }
  return sight;
}

Vec2 FirstWay(const Town& town, Vec2 p, int field) {
  const FlowField& f = town.crowd.fields[static_cast<size_t>(field)];
  return IsBuilt(f) ? RoughWayAt(town.walkable, f, p) : Unit(f.goal - p);
}

// Somewhere else where they are less in the way, -1 where nothing is found.
int BetterDestination(size_t i, Sight sight, float now, Town* town) {
  int best = -1;
  float least = now;
  const Crowd& c = town->crowd;
  for (int k = 0; k < kTries; ++k) {
    const int field = AnyDestination(c.position[i], town);
    if (field < 0 || field == c.field[i]) continue;
    if (sight == Sight::kFar && Dot(FirstWay(*town, c.position[i], field), c.way[i]) < kTurnsInView) continue;
    const Bearing bearing = Forecast(*town, c.position[i], field, c.preferred_mps[i]);
    const float then = TooMany(town->outlook, bearing, 1) - Fills(town->outlook, bearing);
    if (then < least) best = field, least = then;
  }
  return best;
}

// Share of the ground of the neighbourhood that lies in the fullest view.
float ShareOfView(const Viewer& viewer, const Town& town, float around_m) {
  const Walkable& w = town.walkable;
  const Vec2 visitor = viewer.camera.position;
  const float step_m = kEveryCell * w.cell_m;
  const int reach = static_cast<int>(around_m / step_m);
  Sectors<float> sectors{};
  float all = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      const Vec2 off = Vec2{static_cast<float>(x), static_cast<float>(y)} * step_m, p = visitor + off;
      const float away2 = Dot(off, off);
      if (away2 > around_m * around_m || !IsFree(w, p)) continue;
      if (town.crowd_area && !Contains(*town.crowd_area, p)) continue;
      all += 1;
      if (away2 < town.outlook.reach_m * town.outlook.reach_m) sectors[static_cast<size_t>(SectorOf(off))] += 1;
    }
  }
  return all > 0 ? Fullest(sectors, SectorsOfView(viewer.camera.fov_rad)) / all : 0;
}

// How full it is now, and how full it would be without any control.
void Watch(const Viewer& viewer, Town* town) {
  Outlook& o = town->outlook;
  const ViewVolumes view = VolumesOf(viewer.camera, 0);
  const float around_m = kNeighbourhood * o.reach_m;
  Sectors<float> sectors{};
  float in_view = 0, all = 0;
  for (size_t i = 0; i < town->crowd.size(); ++i) {
    const Vec2 off = town->crowd.position[i] - viewer.camera.position;
    const float away2 = Dot(off, off);
    if (away2 > around_m * around_m) continue;
    all += 1;
    if (away2 > o.reach_m * o.reach_m) continue;
    sectors[static_cast<size_t>(SectorOf(off))] += 1;
    if (Meets(town->crowd.position[i], town->crowd.view_reach_m[i], view.inner_apex, view)) in_view += 1;
  }
  const float usual = all * ShareOfView(viewer, *town, around_m);
  o.usual += (usual - o.usual) * (o.usual <= 0 ? 1 : kUsual);
  const float aim = kAimsAt * Allowed(viewer.limit, o.usual, viewer.settings.discretion);
  const float held = std::max(in_view, kElsewhere * Fullest(sectors, SectorsOfView(viewer.camera.fov_rad)));
  const float error = aim > 0 ? held / aim - 1 : 1;
  o.pressure =
      std::clamp(o.pressure + error * kLookEvery_s * (error > 0 ? kPressureGrows_ps : kPressureFades_ps), 0.0f, 1.0f);
}

bool CountsAtStart(const Viewer& viewer) { return Adapts(viewer) && viewer.settings.method == LimitMethod::kCount; }

}  // namespace

void BeginOutlook(int people, const Viewer& viewer, Town* town) {
  Outlook& o = town->outlook;
  o.pressure = kPressureAtStart;
  o.reach_m = viewer.settings.r_high_m;
  if (!CountsAtStart(viewer)) return;
  Sectors<float> sectors{};
  const std::vector<int> cells = HomeCells(*town);
  for (const int cell : cells) {
    const Vec2 off = CellCenter(town->walkable, cell) - viewer.camera.position;
    if (Dot(off, off) < o.reach_m * o.reach_m) sectors[static_cast<size_t>(SectorOf(off))] += 1;
  }
  const float share =
      Fullest(sectors, SectorsOfView(viewer.camera.fov_rad)) / std::max(1.0f, static_cast<float>(cells.size()));
  o.usual = share * static_cast<float>(people);
}

bool ShowsTooManyAtStart(const Viewer& viewer, const Town& town, Vec2 p) {
  const ViewVolumes view = VolumesOf(viewer.camera, 0);
  const float reach_m = town.outlook.reach_m + kStartRim_m;
  const auto shows = [&](Vec2 place) {
    const Vec2 off = place - viewer.camera.position;
    return Dot(off, off) < reach_m * reach_m && Meets(place, kStartBody_m + kStartRim_m, view.inner_apex, view);
  };
  if (!CountsAtStart(viewer) || viewer.settings.high_limit <= 0 || !shows(p)) return false;
  const auto& others = town.crowd.position;
  return std::count_if(others.begin(), others.end(), shows) >= viewer.settings.high_limit;
}

bool HasRoomAtStart(const Viewer& viewer, const Town& town, Vec2 p) {
  const Outlook& o = town.outlook;
  const float reach_m = o.reach_m + kStartRim_m;
  const Vec2 visitor = viewer.camera.position, own = p - visitor;
  if (!CountsAtStart(viewer) || Dot(own, own) > reach_m * reach_m) return true;
  Sectors<float> sectors{};
  for (const Vec2 other : town.crowd.position) {
    const Vec2 off = other - visitor;
    if (Dot(off, off) < reach_m * reach_m) sectors[static_cast<size_t>(SectorOf(off))] += 1;
  }
  if (ShowsTooManyAtStart(viewer, town, p)) return false;
  const float most = FullestOver(sectors, SectorsOfView(viewer.camera.fov_rad) + 1)[static_cast<size_t>(SectorOf(own))];
  return most + 1 <= kFillsAtStart * Allowed(viewer.settings.high_limit, o.usual, viewer.settings.discretion);
}

void StepOutlook(const Viewer& viewer, Town* town) {
  Outlook& o = town->outlook;
  const float step_s = Step_s(viewer.settings);
  o.velocity = o.velocity + (viewer.velocity - o.velocity) * std::min(1.0f, step_s / kVisitorsWay_s);
  const int64_t every = std::max<int64_t>(1, std::lround(kLookEvery_s / step_s));
  if (!Adapts(viewer) || town->step % every != 0) return;
  o.reach_m = viewer.settings.r_high_m;
  Watch(viewer, town);
  const float allowed = Allowed(viewer.limit, o.usual, viewer.settings.discretion);
  const float capacity = (1 - kReserve + kLax * (1 - o.pressure)) * allowed;
  ForeseeVisitor(viewer, *town, &o);
  const Crowd& c = town->crowd;
  std::vector<std::pair<size_t, Bearing>>& near = town->outlook_near;
  near.clear();
  for (size_t i = 0; i < c.size(); ++i) {
    if (IsFar(o, c.position[i], viewer.camera.position)) continue;
    const int field = c.activity[i] == Activity::kWalking ? c.field[i] : -1;
    near.push_back({i, Forecast(*town, c.position[i], field, c.preferred_mps[i])});
    Tally(near.back().second, 1, &o);
  }
  MeasureRoom(viewer.camera.fov_rad, capacity, &o);
  if (!o.is_full || near.empty()) return;
  // A different one comes first each time.
  const size_t first = static_cast<size_t>(town->random.Below(static_cast<int>(near.size())));
  int sent = 0;
  for (size_t k = 0; k < near.size() && o.is_full && sent < kMostSent; ++k) {
    const auto& [i, bearing] = near[(first + k) % near.size()];
    const float now = TooMany(o, bearing, 0);
    if (now <= 0 || !WalksWhereTheyLike(i, *town)) continue;
    const Company company = CompanyOf(c, i);
    const Sight sight = SightOf(company, viewer, *town);
    if (sight == Sight::kNear) continue;
    ++sent;
    const int field = BetterDestination(i, sight, now, town);
    if (field < 0) continue;
    Tally(bearing, -company.size, &o);
    SendAll(company, field, town);
    Tally(Forecast(*town, c.position[i], field, c.preferred_mps[i]), company.size, &o);
    MeasureRoom(viewer.camera.fov_rad, capacity, &o);
  }
}

float InTheWay(const Viewer& viewer, const Town& town, Vec2 from, int field, float speed_mps) {
  if (!Adapts(viewer) || !town.outlook.is_full || IsFar(town.outlook, from, viewer.camera.position)) return 0;
  return TooMany(town.outlook, Forecast(town, from, field, speed_mps), 1);
}

bool IsFullAt(const Viewer& viewer, const Town& town, Vec2 p) {
  if (!Adapts(viewer) || !town.outlook.is_full) return false;
  Bearing bearing;
  for (int k = 0; k < Outlook::kMoments; ++k) bearing[static_cast<size_t>(k)] = BearingAt(town.outlook, k, p);
  return TooMany(town.outlook, bearing, 1) > 0;
}

}  // namespace flaneur
