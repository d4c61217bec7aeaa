#include "runtime/control/level_control.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/control/serving_order.h"
#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

using Memory = LevelState::Memory;

constexpr float kFall_mps = 10.0f;  // r_high moves in soon
constexpr float kRise_mps = 0.1f;   // and comes back slowly: whoever it passes over switches in view
// A newly chosen level serves at so many times the pixels, at most, and at least where the limit is a number of people,
// or what the budget affords of people served well.
constexpr float kMostHeadroom = 8.0f, kLeastHeadroom = 0.05f, kLeastHeadroomOfTime = 1.0f;
constexpr float kKeeps = 4.0f;      // a level is kept while it serves at so much less than that,
constexpr float kKeepsFine = 4.0f;  // or is so much finer than it need be
constexpr float kHeadroomFalls = 0.9f, kHeadroomRises = 1.01f;  // a step
constexpr float kBudgetIsAmple = 0.8f;                          // this share of it in use
constexpr float kReserve = 0.2f;                       // of limit and budget, kept for those who come into view near
constexpr float kFallGain = 0.08f, kRiseGain = 0.02f;  // a step, of the relative error of the frame time (method 2)
constexpr float kBudgetInUse = 0.8f;                   // share of the budget from which on it is in use
constexpr float kPropShare = 0.1f;                     // of the budget, that props may take,
constexpr float kShadowShare = 0.2f;                   // and shadows,
constexpr float kShadowRim_m = 1.0f;                   // even of those who stand so near the view
constexpr float kBetween_m = 0.25f;  // people and camera are so much elsewhere, at most, between two steps
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
  if (state->meshes > 0) {
    const int64_t besides =
        state->fading_triangles + state->props.triangles + int64_t{kImpostorTriangles} * state->impostors;
    const float meshes = static_cast<float>(state->triangles - besides);
    state->triangles_a_person += kSmoothing * (meshes / static_cast<float>(state->meshes) - state->triangles_a_person);
  } else if (state->triangles_a_person <= 0) {
    for (const AvatarCosts& avatar : avatars) {
      state->triangles_a_person =
          std::max(state->triangles_a_person, static_cast<float>(avatar.levels.front().triangles));
    }
  }
  // As many shadows as of late, so that the limit does not sway with whose is in view.
  state->shadow_triangles += kSmoothing * (static_cast<float>(state->shadows.triangles) - state->shadow_triangles);
  const float impostors = static_cast<float>(kImpostorTriangles) * static_cast<float>(state->in_sight.size());
  const float left = state->budget_triangles - state->shadow_triangles - impostors;
  return std::max(1, static_cast<int>(left / std::max(state->triangles_a_person, 1.0f)));
}

// Who comes near starts with the level that serves until half the distance, and keeps it until it is far too fine:
// every switch is one that could be seen.
int WantedMesh(const AvatarCosts& avatar, float px, float headroom, Level last) {
  const int coarsest = CoarsestAt(avatar, px * std::min(headroom / kKeeps, 1.0f));
  if (!IsMesh(last) || last.mesh > coarsest) return CoarsestAt(avatar, px * headroom);
  return std::clamp(last.mesh, CoarsestAt(avatar, px * headroom * kKeepsFine), coarsest);
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

Level LastSeen(const Memory& m) { return m.in_sight ? m.level.level : kNotDrawn; }

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

// Views that pictures until the next step can show besides the present one: between the step before and this one, and
// as the hand turns the view on.
std::array<ViewVolumes, 2> ViewsBeside(const LevelQuery& query, float step_s, const LevelState& state) {
  ViewCamera next = query.camera;
  next.yaw_rad = WrapAngle(next.yaw_rad + query.motion.yaw_rate_radps * step_s);
  return {VolumesOf(state.started ? state.camera : query.camera, 0), VolumesOf(next, 0)};
}

// Who may be in a picture until the next step and is near enough to be drawn.
void ListPeople(const Crowd& crowd, const LevelQuery& query, const ControlSettings& s, LevelState* state) {
  state->in_sight.clear();
  state->too_far.clear();
  const ViewEdges edges = EdgesOf(query.camera);
  const auto beside = ViewsBeside(query, Step_s(s), *state);
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] == ViewClass::kOutside) continue;
    const bool in_view = crowd.view[i] == ViewClass::kVisible;
    const float reach_m = crowd.view_reach_m[i] + kBetween_m;
    const auto shows = [&](const ViewVolumes& v) { return Meets(crowd.position[i], reach_m, v.inner_apex, v); };
    if (!in_view && std::none_of(beside.begin(), beside.end(), shows)) continue;
    const Vec2 off = crowd.position[i] - query.camera.position;
    const bool near = Dot(off, off) <= s.r_far_m * s.r_far_m;
    Memory& m = EntryOf(crowd.slot[i], crowd.id[i], &state->memory);
    m.here = near || (in_view && IsDrawn(m.level));
    const Level last = LastSeen(m);
    if (near) state->in_sight.push_back(InOrder(crowd, i, off, last, edges, crowd.id[i] == query.first_id, s, *state));
    else if (m.here) state->too_far.push_back(static_cast<int>(i));
  }
}

// Who was drawn and has left the town, or the picture with all they are.
void ListGone(const Crowd& crowd, LevelState* state) {
  state->gone.clear();
  for (int slot : state->drawn_before) {
    Memory& m = state->memory[static_cast<size_t>(slot)];
    if (m.here) continue;
    const bool left_town = crowd.slots.owner[static_cast<size_t>(slot)] != m.id;
    if (!left_town || !m.in_sight) {
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
  for (const LevelState::InSight& v : state->in_sight) {
    const auto i = static_cast<size_t>(v.person);
    const AvatarCosts& avatar = avatars[static_cast<size_t>(crowd.avatar[i])];
    if (avatar.props.empty() || v.distance_m >= kPropReach_m) continue;
    const auto doing = static_cast<size_t>(crowd.doing[i]);
    state->props.bearers.push_back({crowd.slot[i], v.id, &avatar.props, v.distance_m,
                                    doing < avatar.other_clips.size() ? &avatar.other_clips[doing] : nullptr});
  }
}

// Who is in view, or so near it that their shadow may be.
void ListShadowCasters(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ViewCamera& camera,
                       LevelState* state) {
  state->shadows.casters.clear();
  state->casts_shadow.assign(crowd.size(), 0);
  const ViewVolumes view = VolumesOf(camera, 0);
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] == ViewClass::kOutside) continue;
    const Vec2 off = crowd.position[i] - camera.position;
    const float reach_m = std::max(kShadowRim_m, crowd.view_reach_m[i]);
    if (Dot(off, off) >= kShadowReach_m * kShadowReach_m || !Meets(crowd.position[i], reach_m, view.inner_apex, view))
      continue;
    state->casts_shadow[i] = 1;
    state->shadows.casters.push_back({Length(off), avatars[static_cast<size_t>(crowd.avatar[i])].shadow});
  }
}

// r_high moves towards the distance that leaves `limit` people inside, those counted who are meshes and stay it: soon
// where there are more, slowly where there are fewer.
void MoveBoundary(const ControlSettings& s, LevelState* state) {
  float wanted_m = s.r_high_m;
  state->nearest.clear();
  for (const LevelState::InSight& v : state->in_sight) {
    const float from_m = v.priority == kAppears ? v.distance_m : v.key_m;
    if (from_m < wanted_m) state->nearest.push_back(from_m);
  }
  if (static_cast<size_t>(state->limit) < state->nearest.size()) {
    const auto next = state->nearest.begin() + state->limit;
    std::nth_element(state->nearest.begin(), next, state->nearest.end());
    wanted_m = *next;
  }
  state->r_high_m += std::clamp(wanted_m - state->r_high_m, -kFall_mps * Step_s(s), kRise_mps * Step_s(s));
}

// Only those who may become meshes need to stand in order; and all, where not even impostors fit.
void PutInOrder(int64_t drawable, std::vector<LevelState::InSight>* people) {
  auto end = std::partition(people->begin(), people->end(), [](const auto& v) { return v.priority < kStays; });
  if (static_cast<int64_t>(people->size()) > drawable) end = people->end();
  std::sort(people->begin(), end, IsServedBefore);
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
  bool packed = false;               // more are near than there may be meshes, or nearly so
};

bool IsPacked(const LevelState& state) {
  const auto is_near = [](const LevelState::InSight& v) { return v.distance_m < kNear_m; };
  const auto near = std::count_if(state.in_sight.begin(), state.in_sight.end(), is_near);
  return static_cast<float>(near) > std::ceil((1 - kReserve) * static_cast<float>(state.limit));
}

// Of limit and budget, for this person: the reserve is for those who come into view near, where it is packed within
// r_high in force.
float ShareFor(const LevelState::InSight& v, const Serving& serving, const LevelState& state) {
  if (v.priority != kAppears) return 1;
  return v.key_m < (serving.packed ? std::min(kNear_m, state.r_high_m) : kNear_m) ? 1.0f : 1 - kReserve;
}

// Where it is packed, nobody who is in view already is switched for a place that comes free: whoever comes next needs
// it, and nobody sees them change.
bool HasPlace(const LevelState::InSight& v, int meshes, const Serving& serving, const LevelState& state) {
  if (v.priority == kStays || (v.priority == kWhereRoom && serving.packed)) return false;
  return static_cast<float>(meshes) < ShareFor(v, serving, state) * static_cast<float>(state.limit);
}

float PixelsHigh(const LevelState::InSight& v, const AvatarCosts& avatar, const LevelQuery& query) {
  return PixelsHigh(avatar.height_m, v.distance_m, query.camera, query.screen_width_px);
}

// Triangles beyond an impostor's that all meshes would take.
int64_t TrianglesWanted(float headroom, const Serving& serving, const LevelState& state) {
  int64_t triangles = 0;
  int meshes = 0;
  for (const LevelState::InSight& v : state.in_sight) {
    if (meshes >= state.limit) break;
    if (!HasPlace(v, meshes, serving, state)) continue;
    const auto i = static_cast<size_t>(v.person);
    const AvatarCosts& avatar = serving.avatars[static_cast<size_t>(serving.crowd.avatar[i])];
    const Level last = LastSeen(state.memory[static_cast<size_t>(serving.crowd.slot[i])]);
    const int mesh = WantedMesh(avatar, PixelsHigh(v, avatar, serving.query), headroom, last);
    triangles += avatar.levels[static_cast<size_t>(mesh)].triangles - kImpostorTriangles;
    ++meshes;
  }
  return triangles;
}

void FitHeadroom(const ControlSettings& s, const Serving& serving, LevelState* state) {
  const float least = s.method == LimitMethod::kFrameTime ? kLeastHeadroomOfTime : kLeastHeadroom;
  if (state->headroom <= 0) state->headroom = kMostHeadroom;
  const auto fits = [&](float share, float headroom) {
    const auto taken = state->triangles - state->fading_triangles + TrianglesWanted(headroom, serving, *state);
    return static_cast<float>(taken) <= share * static_cast<float>(serving.budget);
  };
  const float more = std::min(state->headroom * kHeadroomRises, kMostHeadroom);
  if (more > state->headroom && fits(kBudgetIsAmple, more)) state->headroom = more;
  while (state->headroom > least && !fits(1, state->headroom))
    state->headroom = std::max(state->headroom * kHeadroomFalls, least);
}

Level LevelFor(const LevelState::InSight& v, const AvatarCosts& avatar, float px, Level last, const Serving& serving,
               const LevelState& state) {
  if (!HasPlace(v, state.meshes, serving, state)) return kImpostor;
  const auto budget = static_cast<int64_t>(ShareFor(v, serving, state) * static_cast<float>(serving.budget));
  return AffordableLevel(avatar, WantedMesh(avatar, px, state.headroom, last), budget, state.triangles);
}

// state->triangles holds an impostor for everybody who fits, and what fades.
void Serve(const LevelState::InSight& v, bool fits, const Serving& serving, LevelState* state) {
  const Crowd& crowd = serving.crowd;
  const auto i = static_cast<size_t>(v.person);
  Memory& m = state->memory[static_cast<size_t>(crowd.slot[i])];
  const AvatarCosts& avatar = serving.avatars[static_cast<size_t>(crowd.avatar[i])];
  const Level last = LastSeen(m);
  const bool in_view = crowd.view[i] == ViewClass::kVisible;
  // Who comes into the picture with the view's edge needs no fading, nor who is beside it.
  const bool was_in_view = state->started && crowd.was_visible[i] != 0;
  const bool fades = was_in_view || (in_view && IsDrawn(m.level));
  Level level = kNotDrawn;
  if (fits) {
    const float px = PixelsHigh(v, avatar, serving.query);
    level = LevelFor(v, avatar, px, last, serving, *state);
    state->triangles += TrianglesOf(level, avatar) - kImpostorTriangles;
    ++(IsMesh(level) ? state->meshes : state->impostors);
    if (in_view) ++(IsMesh(level) ? state->high : state->low);
    if (in_view && level == kImpostor && px > avatar.impostor_px) ++state->shortfalls;
    if (in_view && IsDrawn(last) && last != level) ++state->switches_in_view;
  }
  Change(level, TrianglesOf(level, avatar), fades, serving.budget, &m, state);
  m.in_sight = true;
  Keep(crowd, i, m, state);
}

void LetGo(const Serving& serving, LevelState* state) {
  for (int person : state->too_far) {
    const auto i = static_cast<size_t>(person);
    Memory& m = state->memory[static_cast<size_t>(serving.crowd.slot[i])];
    Change(kNotDrawn, 0, true, serving.budget, &m, state);
    Keep(serving.crowd, i, m, state);
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
  ListPeople(crowd, query, s, state);
  ListGone(crowd, state);

  ListShadowCasters(crowd, avatars, query.camera, state);
  const int64_t all = std::max<int64_t>(0, static_cast<int64_t>(state->budget_triangles) - query.taken_triangles);
  const int64_t as_impostors = kImpostorTriangles * static_cast<int64_t>(state->in_sight.size());
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
  PutInOrder(drawable, &state->in_sight);

  state->people.assign(crowd.size(), {});
  state->triangles =
      std::min<int64_t>(static_cast<int64_t>(state->in_sight.size()), drawable) * kImpostorTriangles + besides;
  state->high = state->low = state->meshes = state->impostors = state->shortfalls = state->switches_in_view = 0;
  const Serving serving{crowd, avatars, query, budget, drawable, IsPacked(*state)};
  FitHeadroom(s, serving, state);
  int64_t rank = 0;
  for (const LevelState::InSight& v : state->in_sight) Serve(v, rank++ < drawable, serving, state);
  LetGo(serving, state);
  for (const LevelState::Gone& gone : state->gone) state->drawn.push_back(gone.slot);
  const auto within_nominal = [&](const LevelState::InSight& v) {
    return v.distance_m < s.r_high_m && crowd.view[static_cast<size_t>(v.person)] == ViewClass::kVisible;
  };
  state->exceeded = std::count_if(state->in_sight.begin(), state->in_sight.end(), within_nominal) > state->limit;
  state->camera = query.camera;
  state->started = true;
}

}  // namespace flaneur
