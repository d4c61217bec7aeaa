#include "runtime/control/level_control.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/control/serving_order.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

using Memory = LevelState::Memory;

constexpr float kFall_mps = 2.0f;                      // r_high moves no faster than people walk,
constexpr float kRise_mps = 0.5f;                      // and comes back slowly: whoever it passes over switches in view
constexpr float kHeadroom = 8.0f;                      // of a newly chosen level: serves up to so many times the pixels
constexpr float kReserve = 0.2f;                       // of limit and budget, kept for those who come into view near
constexpr float kFallGain = 0.08f, kRiseGain = 0.02f;  // a step, of the relative error of the frame time (method 2)
constexpr float kBudgetInUse = 0.8f;                   // share of the budget from which on it is in use
constexpr float kPropShare = 0.1f;                     // of the budget, that props may take,
constexpr float kShadowShare = 0.2f;                   // and shadows,
constexpr float kShadowRim_m = 1.0f;                   // even of those who stand so near the view
constexpr float kBodyRim_m = 0.8f;   // a body, skirts and shadow reach so far beyond its middle into the view
constexpr float kSmoothing = 0.03f;  // a step, of what a person in high resolution and all shadows cost
constexpr float kMinBudget_triangles = 1000;
constexpr float kFastCamera_mps = 2.0f;  // above it fidelity may fall,
constexpr float kFastShare = 0.85f;      // to so much of the target

float PixelsHigh(float height_m, float distance_m, const ViewCamera& camera, int screen_width_px) {
  const float focal_px = static_cast<float>(screen_width_px) / (2 * std::tan(camera.fov_rad / 2));
  return height_m * focal_px / std::max(distance_m, 0.1f);
}

void FollowFrameTime(float frame_ms, float camera_speed_mps, const ControlSettings& s, LevelState* state) {
  const float most = static_cast<float>(s.budget_triangles);
  if (state->budget_triangles <= 0 || s.method != LimitMethod::kFrameTime) state->budget_triangles = most;
  if (s.method != LimitMethod::kFrameTime || frame_ms <= 0) return;
  const float target_ms = camera_speed_mps > kFastCamera_mps ? s.target_ms * kFastShare : s.target_ms;
  const float error = std::clamp((target_ms - frame_ms) / target_ms, -1.0f, 1.0f);
  // A budget that nobody uses says nothing about the frame time, and must not grow on it.
  if (error > 0 &&
      static_cast<float>(state->triangles + state->shadows.triangles) < kBudgetInUse * state->budget_triangles)
    return;
  state->budget_triangles = std::clamp(state->budget_triangles * (1 + (error < 0 ? kFallGain : kRiseGain) * error),
                                       std::min(kMinBudget_triangles, most), most);
}

// The coarsest level that serves at `px`.
int CoarsestAt(const AvatarCosts& avatar, float px) {
  for (size_t k = 0; k + 1 < avatar.levels.size(); ++k) {
    if (px >= avatar.levels[k].switch_px) return static_cast<int>(k);
  }
  return static_cast<int>(avatar.levels.size()) - 1;
}

// How many people in high resolution the budget affords, all others in view as impostors: each costs what they did of
// late.
int PeopleAfforded(const std::vector<AvatarCosts>& avatars, LevelState* state) {
  if (state->high > 0) {
    const int64_t besides = state->fading_triangles + state->props.triangles + int64_t{kImpostorTriangles} * state->low;
    const float meshes = static_cast<float>(state->triangles - besides);
    state->triangles_a_person += kSmoothing * (meshes / static_cast<float>(state->high) - state->triangles_a_person);
  } else if (state->triangles_a_person <= 0) {
    for (const AvatarCosts& avatar : avatars) {
      state->triangles_a_person =
          std::max(state->triangles_a_person, static_cast<float>(avatar.levels.front().triangles));
    }
  }
  // As many shadows as of late, so that the limit does not sway with whose is in view.
  state->shadow_triangles += kSmoothing * (static_cast<float>(state->shadows.triangles) - state->shadow_triangles);
  const float impostors = static_cast<float>(kImpostorTriangles) * static_cast<float>(state->visible.size());
  const float left = state->budget_triangles - state->shadow_triangles - impostors;
  return std::max(1, static_cast<int>(left / std::max(state->triangles_a_person, 1.0f)));
}

// Who comes near starts with the level that serves until half the distance, and keeps it until it is far too fine:
// every switch is one that could be seen.
int WantedMesh(const AvatarCosts& avatar, float px, Level last) {
  const int coarsest = CoarsestAt(avatar, px);
  const int finest = CoarsestAt(avatar, px * kHeadroom);
  return !IsMesh(last) || last.mesh > coarsest ? finest : std::clamp(last.mesh, finest, coarsest);
}

// A level for somebody within r_high that still fits the budget, else the impostor.
Level AffordableLevel(const AvatarCosts& avatar, int wanted, int64_t budget, int64_t spent) {
  for (int k = wanted; k < static_cast<int>(avatar.levels.size()); ++k) {
    if (spent + avatar.levels[static_cast<size_t>(k)].triangles - kImpostorTriangles <= budget) return MeshLevel(k);
  }
  return kImpostor;
}

int TrianglesOf(Level level, const AvatarCosts& avatar) {
  return IsMesh(level)    ? avatar.levels[static_cast<size_t>(level.mesh)].triangles
         : IsDrawn(level) ? kImpostorTriangles
                          : 0;
}

// The outer view volume with whoever reaches into the view.
ViewVolumes WithRim(const ViewCamera& c, float rim_m) {
  return VolumesOf(c, rim_m / std::max(0.1f, std::sin(c.fov_rad / 2)));
}

void EndChange(Memory* m) {
  m->level.from = kNotDrawn;
  m->level.age_s = kLongAgo_s;
  m->from_triangles = 0;
}

// A step later, for everybody who was drawn.
void GrowOlder(float step_s, LevelState* state) {
  std::swap(state->drawn, state->drawn_before);
  state->drawn.clear();
  for (int slot : state->drawn_before) {
    Memory& m = state->memory[static_cast<size_t>(slot)];
    m.here = false;
    m.level.age_s += step_s;
    if (m.level.age_s >= kFade_s + step_s) EndChange(&m);
  }
}

// Who is in view and near enough to be drawn, and who may reach into it.
void ListPeople(const Crowd& crowd, const LevelQuery& query, float r_far_m, LevelState* state) {
  state->visible.clear();
  state->rim.clear();
  const ViewEdges edges = EdgesOf(query.camera);
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] == ViewClass::kOutside) continue;
    const Vec2 off = crowd.position[i] - query.camera.position;
    const bool in_view = crowd.view[i] == ViewClass::kVisible && Dot(off, off) <= r_far_m * r_far_m;
    Memory& m = EntryOf(crowd.slot[i], crowd.id[i], &state->memory);
    m.here = true;
    if (!in_view) {
      if (Dot(off, off) <= r_far_m * r_far_m || IsDrawn(m.level)) state->rim.push_back(static_cast<int>(i));
      continue;
    }
    const Level last = m.in_view ? m.level.level : kNotDrawn;
    state->visible.push_back(InOrder(crowd, i, off, last, edges, crowd.id[i] == query.first_id, *state));
  }
}

// Who was drawn and has left the town, or the view with all they are.
void ListGone(const Crowd& crowd, LevelState* state) {
  state->gone.clear();
  for (int slot : state->drawn_before) {
    Memory& m = state->memory[static_cast<size_t>(slot)];
    if (m.here) continue;
    const bool left_town = crowd.slots.owner[static_cast<size_t>(slot)] != m.id;
    if (!left_town || !m.in_view) {
      m = {};
    } else {
      if (IsDrawn(m.level.level))
        m.level = {kNotDrawn, m.level.level, 0}, m.from_triangles = m.triangles, m.triangles = 0;
      if (IsDrawn(m.level)) state->gone.push_back({slot, m.id, m.level});
    }
  }
}

// What still fades counts, and where the budget has become smaller than that, nothing fades any more.
void CountFading(int64_t budget, LevelState* state) {
  state->fading_triangles = 0;
  for (int slot : state->drawn_before)
    state->fading_triangles += state->memory[static_cast<size_t>(slot)].from_triangles;
  if (state->fading_triangles <= budget) return;
  for (int slot : state->drawn_before) EndChange(&state->memory[static_cast<size_t>(slot)]);
  state->fading_triangles = 0;
  state->gone.clear();
}

void ListPropBearers(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, LevelState* state) {
  state->props.bearers.clear();
  for (const LevelState::Visible& v : state->visible) {
    const auto i = static_cast<size_t>(v.person);
    const std::vector<Prop>& props = avatars[static_cast<size_t>(crowd.avatar[i])].props;
    if (!props.empty() && v.distance_m < kPropReach_m)
      state->props.bearers.push_back({crowd.slot[i], v.id, &props, v.distance_m});
  }
}

// Who is in view, or so near it that their shadow may be.
void ListShadowCasters(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ViewCamera& camera,
                       LevelState* state) {
  state->shadows.casters.clear();
  state->casts_shadow.assign(crowd.size(), 0);
  const ViewVolumes around = WithRim(camera, kShadowRim_m);
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] == ViewClass::kOutside) continue;
    const Vec2 off = crowd.position[i] - camera.position;
    if (Dot(off, off) >= kShadowReach_m * kShadowReach_m || Classify(crowd.position[i], around) == ViewClass::kOutside)
      continue;
    state->casts_shadow[i] = 1;
    state->shadows.casters.push_back({Length(off), avatars[static_cast<size_t>(crowd.avatar[i])].shadow});
  }
}

// r_high moves towards the distance that leaves `limit` people inside: soon where there are more, slowly where there
// are fewer.
void MoveBoundary(const ControlSettings& s, LevelState* state) {
  float wanted_m = s.r_high_m;
  state->nearest.clear();
  for (const LevelState::Visible& v : state->visible) {
    if (v.distance_m < wanted_m) state->nearest.push_back(v.distance_m);
  }
  if (static_cast<size_t>(state->limit) < state->nearest.size()) {
    const auto next = state->nearest.begin() + state->limit;
    std::nth_element(state->nearest.begin(), next, state->nearest.end());
    wanted_m = *next;
  }
  state->r_high_m += std::clamp(wanted_m - state->r_high_m, -kFall_mps * Step_s(s), kRise_mps * Step_s(s));
}

// Only those who may become meshes need to stand in order; and all, where not even impostors fit.
void PutInOrder(int64_t drawable, std::vector<LevelState::Visible>* visible) {
  auto end = std::partition(visible->begin(), visible->end(), [](const auto& v) { return v.priority < kStays; });
  if (static_cast<int64_t>(visible->size()) > drawable) end = visible->end();
  std::sort(visible->begin(), end, IsServedBefore);
}

// What somebody is drawn with from this step on. fades: where there is room for both, what they were drawn with fades
// out.
void Change(Level level, int triangles, bool fades, int64_t budget, Memory* m, LevelState* state) {
  if (level == m->level.level) return;
  state->triangles -= m->from_triangles;
  state->fading_triangles -= m->from_triangles;
  const Level before = m->level.level;
  const int before_triangles = m->triangles;
  m->level.level = level;
  m->triangles = triangles;
  EndChange(m);
  if (!fades || state->triangles + before_triangles > budget) return;
  m->level.from = before;
  m->level.age_s = 0;
  m->from_triangles = before_triangles;
  state->triangles += before_triangles;
  state->fading_triangles += before_triangles;
}

void Keep(const Crowd& crowd, size_t i, const Memory& m, LevelState* state) {
  state->people[i] = m.level;
  if (IsDrawn(m.level)) state->drawn.push_back(crowd.slot[i]);
}

// What holds for everybody who is served in one step.
struct Serving {
  const Crowd& crowd;
  const std::vector<AvatarCosts>& avatars;
  const LevelQuery& query;
  int64_t budget = 0, drawable = 0;  // triangles without shadows; people who fit as impostors
};

Level LevelFor(const LevelState::Visible& v, const AvatarCosts& avatar, float px, Level last, const Serving& serving,
               const LevelState& state) {
  const float share = v.priority == kAppears ? 1 - kReserve : 1.0f;
  if (v.priority == kStays || static_cast<float>(state.high) >= share * static_cast<float>(state.limit))
    return kImpostor;
  const auto budget = static_cast<int64_t>(share * static_cast<float>(serving.budget));
  return AffordableLevel(avatar, WantedMesh(avatar, px, last), budget, state.triangles);
}

// state->triangles holds an impostor for everybody who fits, and what fades.
void Serve(const LevelState::Visible& v, bool fits, const Serving& serving, LevelState* state) {
  const Crowd& crowd = serving.crowd;
  const auto i = static_cast<size_t>(v.person);
  Memory& m = state->memory[static_cast<size_t>(crowd.slot[i])];
  const AvatarCosts& avatar = serving.avatars[static_cast<size_t>(crowd.avatar[i])];
  const Level last = m.in_view ? m.level.level : kNotDrawn;
  // Who comes into the picture with the view's edge needs no fading.
  const bool fades = IsDrawn(m.level) || (state->started && crowd.was_visible[i] != 0);
  Level level = kNotDrawn;
  if (fits) {
    const float px = PixelsHigh(avatar.height_m, v.distance_m, serving.query.camera, serving.query.screen_width_px);
    level = LevelFor(v, avatar, px, last, serving, *state);
    state->triangles += TrianglesOf(level, avatar) - kImpostorTriangles;
    ++(IsMesh(level) ? state->high : state->low);
    if (level == kImpostor && px > avatar.impostor_px) ++state->shortfalls;
    if (IsDrawn(last) && last != level) ++state->switches_in_view;
  }
  Change(level, TrianglesOf(level, avatar), fades, serving.budget, &m, state);
  m.in_view = true;
  Keep(crowd, i, m, state);
}

// What pictures until the next step can show: between the step before and this one, and as the hand turns the view on.
std::array<ViewVolumes, 3> VolumesUntilNextStep(const LevelQuery& query, float step_s, const LevelState& state) {
  ViewCamera next = query.camera;
  next.yaw_rad = WrapAngle(next.yaw_rad + query.motion.yaw_rate_radps * step_s);
  return {WithRim(query.camera, kBodyRim_m), WithRim(state.started ? state.camera : query.camera, kBodyRim_m),
          WithRim(next, kBodyRim_m)};
}

// Whose middle is outside the view but not all of them, and who is in view but too far away.
void ServeRim(const Serving& serving, float step_s, LevelState* state) {
  const auto volumes = VolumesUntilNextStep(serving.query, step_s, *state);
  const Crowd& crowd = serving.crowd;
  for (int person : state->rim) {
    const auto i = static_cast<size_t>(person);
    Memory& m = state->memory[static_cast<size_t>(crowd.slot[i])];
    const bool in_view = crowd.view[i] == ViewClass::kVisible;
    const auto shows = [&](const ViewVolumes& view) {
      return Classify(crowd.position[i], view) != ViewClass::kOutside;
    };
    Level level = kNotDrawn;
    if (!in_view && std::any_of(volumes.begin(), volumes.end(), shows))
      level = IsDrawn(m.level.level) ? m.level.level : kImpostor;
    Change(level, TrianglesOf(level, serving.avatars[static_cast<size_t>(crowd.avatar[i])]), in_view, serving.budget,
           &m, state);
    m.in_view = in_view;
    Keep(crowd, i, m, state);
  }
}

}  // namespace

void ChooseLevels(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ControlSettings& s,
                  const LevelQuery& query, LevelState* state) {
  const float step_s = Step_s(s);
  FollowFrameTime(query.frame_ms, Length(query.motion.velocity), s, state);
  Smooth(query.motion, step_s, &state->motion);
  if (state->r_high_m <= 0) state->r_high_m = s.r_high_m;
  GrowOlder(step_s, state);
  ListPeople(crowd, query, s.r_far_m, state);
  ListGone(crowd, state);

  ListShadowCasters(crowd, avatars, query.camera, state);
  const int64_t all = static_cast<int64_t>(state->budget_triangles);
  const int64_t as_impostors = kImpostorTriangles * static_cast<int64_t>(state->visible.size());
  const auto most_for_shadows = static_cast<int64_t>(kShadowShare * state->budget_triangles);
  ChooseShadows(std::clamp<int64_t>(all - as_impostors, 0, most_for_shadows), step_s, &state->shadows);
  state->limit = s.method == LimitMethod::kFrameTime ? PeopleAfforded(avatars, state) : s.high_limit;
  MoveBoundary(s, state);

  const int64_t budget = all - state->shadows.triangles;
  CountFading(budget, state);
  ListPropBearers(crowd, avatars, state);
  ChooseProps(static_cast<int64_t>(kPropShare * state->budget_triangles), &state->props);
  const int64_t besides = state->fading_triangles + state->props.triangles;
  const int64_t drawable = std::max<int64_t>(0, budget - besides) / kImpostorTriangles;
  PutInOrder(drawable, &state->visible);

  state->people.assign(crowd.size(), {});
  state->triangles =
      std::min<int64_t>(static_cast<int64_t>(state->visible.size()), drawable) * kImpostorTriangles + besides;
  state->high = state->low = state->shortfalls = state->switches_in_view = 0;
  const Serving serving{crowd, avatars, query, budget, drawable};
  int64_t rank = 0;
  for (const LevelState::Visible& v : state->visible) Serve(v, rank++ < drawable, serving, state);
  ServeRim(serving, step_s, state);
  for (const LevelState::Gone& gone : state->gone) state->drawn.push_back(gone.slot);
  const auto within_nominal = [&](const LevelState::Visible& v) { return v.distance_m < s.r_high_m; };
  state->exceeded = std::count_if(state->visible.begin(), state->visible.end(), within_nominal) > state->limit;
  state->camera = query.camera;
  state->started = true;
}

}  // namespace flaneur
