#include "runtime/control/level_control.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"

namespace flaneur {
namespace {

constexpr float kFall_mps = 2.0f;            // r_high moves no faster than people walk,
constexpr float kRise_mps = 0.5f;            // and comes back slowly: whoever it passes over switches in view
constexpr float kHysteresis_m = 2.0f;        // a mesh stays one until this far beyond r_high
constexpr float kHeadroom = 8.0f;            // of a newly chosen level: serves up to so many times the pixels
constexpr float kReserve = 0.2f;             // of limit and budget, kept for those who come into view near
constexpr float kWorthwhile_s = 4.0f;         // who leaves the view sooner is not worth a switch any more,
constexpr float kPasses_m = 1.8f;             // but for those who pass so near
constexpr float kSoon_s = 8.0f;               // who comes near by then is served first when they come into view
constexpr float kLong_s = 1e3f;
constexpr float kFallGain = 0.08f, kRiseGain = 0.02f;  // a step, of the relative error of the frame time (method 2)
constexpr float kUsed = 0.8f;                // share of the budget from which on it is in use
constexpr float kPropShare = 0.1f;            // of the budget, that props may take,
constexpr float kShadowShare = 0.2f;          // and shadows,
constexpr float kShadowEdge_m = 1.0f;         // even of those who stand so near the view
constexpr float kSettles = 0.03f;             // a step, of what a person in high resolution and all shadows cost
constexpr float kLeastBudget = 1000;
constexpr float kFastCamera_mps = 2.0f;      // above it fidelity may fall,
constexpr float kFastShare = 0.85f;          // to so much of the target

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
  if (error > 0 && static_cast<float>(state->triangles + state->shadows.triangles) < kUsed * state->budget_triangles) return;
  state->budget_triangles = std::clamp(state->budget_triangles * (1 + (error < 0 ? kFallGain : kRiseGain) * error), std::min(kLeastBudget, most), most);
}

// The coarsest level that serves at `px`.
int CoarsestAt(const AvatarCosts& avatar, float px) {
  for (size_t k = 0; k + 1 < avatar.levels.size(); ++k) {
    if (px >= avatar.levels[k].switch_px) return static_cast<int>(k);
  }
  return static_cast<int>(avatar.levels.size()) - 1;
}

// How many people in high resolution the budget affords, all others in view as impostors: each costs what they did of late.
int PeopleAfforded(const std::vector<AvatarCosts>& avatars, LevelState* state) {
  if (state->high > 0) {
    const int64_t besides = state->fades.triangles + state->props.triangles + int64_t{kImpostorTriangles} * state->low;
    const float meshes = static_cast<float>(state->triangles - besides);
    state->triangles_a_person += kSettles * (meshes / static_cast<float>(state->high) - state->triangles_a_person);
  } else if (state->triangles_a_person <= 0) {
    for (const AvatarCosts& avatar : avatars) {
      state->triangles_a_person = std::max(state->triangles_a_person, static_cast<float>(avatar.levels.front().triangles));
    }
  }
  // As many shadows as of late, so that the limit does not sway with whose is in view.
  state->shadow_triangles += kSettles * (static_cast<float>(state->shadows.triangles) - state->shadow_triangles);
  const float left = state->budget_triangles - state->shadow_triangles - static_cast<float>(kImpostorTriangles) * static_cast<float>(state->visible.size());
  return std::max(1, static_cast<int>(left / std::max(state->triangles_a_person, 1.0f)));
}

// Who comes near starts with the level that serves until half the distance, and keeps it until it is far too fine: every switch
// is one that could be seen.
int WantedLevel(const AvatarCosts& avatar, float px, int last) {
  const int coarsest = CoarsestAt(avatar, px);
  const int finest = CoarsestAt(avatar, px * kHeadroom);
  return last < 0 || last > coarsest ? finest : std::clamp(last, finest, coarsest);
}

// Where the view's two edges have people on their inner side.
struct View { Vec2 inward[2]; };

View ViewOf(const ViewCamera& camera) {
  const float half_rad = camera.fov_rad / 2;
  const Vec2 left = DirectionOf(camera.yaw_rad + half_rad), right = DirectionOf(camera.yaw_rad - half_rad);
  return {{{left.y, -left.x}, {-right.y, right.x}}};
}

// In which order people are served. Within r_high in force by distance, and who is a mesh keeps being one until somebody is nearer by
// kHysteresis_m; then who is a mesh anyway, as long as nobody else needs the place; then who comes into view, since nobody sees them
// change, by how near they will come. Whoever was seen as an impostor stays one until r_high reaches them, and beyond that where they
// leave the view soon and do not pass close.
enum Turn : uint8_t { kWithin, kHolds, kAppears, kStays };

// How long somebody stays in view if the camera and they go on as they do.
float StaysInView_s(Vec2 off, Vec2 velocity, const ViewMotion& motion, const View& view) {
  const Vec2 drift = velocity - motion.velocity + Vec2{off.y, -off.x} * motion.yaw_rate_radps;  // as seen from a camera that turns
  float stays_s = kLong_s;
  for (const Vec2 inward : view.inward) {
    const float outward_mps = -Dot(inward, drift);
    if (outward_mps > 0) stays_s = std::min(stays_s, std::max(Dot(inward, off), 0.0f) / outward_mps);
  }
  return stays_s;
}

// How near somebody comes within kSoon_s, walking on as they mean to.
float ComesWithin_m(const Crowd& c, size_t i, Vec2 off, const ViewMotion& motion) {
  Vec2 way;
  if (c.activity[i] == Activity::kWalking && c.field[i] >= 0) {
    const bool known = c.way[i].x != 0 || c.way[i].y != 0;  // not before the first step
    way = known ? c.way[i] : Unit(c.fields[static_cast<size_t>(c.field[i])].goal - c.position[i]);
  }
  const Vec2 drift = way * c.preferred_mps[i] - motion.velocity;
  const float speed2 = Dot(drift, drift);
  const float nearest_s = speed2 > 1e-4f ? std::clamp(-Dot(off, drift) / speed2, 0.0f, kSoon_s) : 0;
  return Length(off + drift * nearest_s);
}

LevelState::Visible Seen(const Crowd& crowd, size_t i, Vec2 off, const View& view, bool first, const LevelState& state) {
  const int last = state.last_level[static_cast<size_t>(crowd.id[i])];
  const float distance_m = Length(off);
  float key_m = distance_m - (last >= 0 ? kHysteresis_m : 0);
  if (first) return {distance_m, -1e9f, static_cast<int>(i), crowd.id[i], kWithin};
  Turn turn = key_m < state.r_high_m ? kWithin : last >= 0 ? kHolds : last == kNotDrawn ? kAppears : kStays;
  if (turn == kWithin && last == kImpostor) {
    const float stays_s = StaysInView_s(off, crowd.velocity[i], state.motion, view);
    const Vec2 leaves = off + (crowd.velocity[i] - state.motion.velocity) * stays_s;
    if (stays_s < kWorthwhile_s && Length(leaves) > kPasses_m) turn = kStays;
  }
  if (turn == kAppears) key_m = ComesWithin_m(crowd, i, off, state.motion);
  return {distance_m, key_m, static_cast<int>(i), crowd.id[i], turn};
}

// Who is in view and near enough to be drawn; those within r_high stand in `nearest` by distance.
void ListVisible(const Crowd& crowd, const ViewCamera& camera, float r_far_m, int first_id, LevelState* state) {
  state->visible.clear();
  state->last_level.resize(static_cast<size_t>(crowd.next_id), kNotDrawn);
  const View view = ViewOf(camera);
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] != ViewClass::kVisible) continue;
    const Vec2 off = crowd.position[i] - camera.position;
    const float distance2 = Dot(off, off);
    if (distance2 > r_far_m * r_far_m) continue;
    state->visible.push_back(Seen(crowd, i, off, view, crowd.id[i] == first_id, *state));
  }
}

void ListPropBearers(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, LevelState* state) {
  state->props.bearers.clear();
  for (const LevelState::Visible& v : state->visible) {
    const std::vector<PropCost>& props = avatars[static_cast<size_t>(crowd.avatar[static_cast<size_t>(v.person)])].props;
    if (!props.empty() && v.distance_m < kPropReach_m) state->props.bearers.push_back({v.id, &props, v.distance_m});
  }
}

// Who is in view, or so near it that their shadow may be.
void ListShadowCasters(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ViewCamera& camera, LevelState* state) {
  state->shadows.casters.clear();
  state->casts_shadow.assign(crowd.size(), 0);
  const ViewVolumes around = VolumesOf(camera, kShadowEdge_m / std::max(0.1f, std::sin(camera.fov_rad / 2)));
  for (size_t i = 0; i < crowd.size(); ++i) {
    if (crowd.view[i] == ViewClass::kOutside) continue;
    const Vec2 off = crowd.position[i] - camera.position;
    if (Dot(off, off) >= kShadowReach_m * kShadowReach_m || Classify(crowd.position[i], around) == ViewClass::kOutside) continue;
    state->casts_shadow[i] = 1;
    state->shadows.casters.push_back({Length(off), avatars[static_cast<size_t>(crowd.avatar[i])].shadow});
  }
}

// r_high moves towards the distance that leaves `limit` people inside: soon where there are more, slowly where there are fewer.
void MoveBoundary(const ControlSettings& s, int limit, float step_s, LevelState* state) {
  float wanted_m = s.r_high_m;
  state->nearest.clear();
  for (const LevelState::Visible& v : state->visible) {
    if (v.distance_m < wanted_m) state->nearest.push_back(v.distance_m);
  }
  if (static_cast<size_t>(limit) < state->nearest.size()) {
    const auto next = state->nearest.begin() + limit;
    std::nth_element(state->nearest.begin(), next, state->nearest.end());
    wanted_m = *next;
  }
  state->r_high_m += std::clamp(wanted_m - state->r_high_m, -kFall_mps * step_s, kRise_mps * step_s);
}

bool Before(const LevelState::Visible& a, const LevelState::Visible& b) {
  if (a.turn != b.turn) return a.turn < b.turn;
  return a.key_m != b.key_m ? a.key_m < b.key_m : a.id < b.id;
}

// A level for somebody within r_high that still fits the budget, else kImpostor.
int AffordableLevel(const AvatarCosts& avatar, int wanted, int64_t budget, int64_t spent) {
  for (int k = wanted; k < static_cast<int>(avatar.levels.size()); ++k) {
    if (spent + avatar.levels[static_cast<size_t>(k)].triangles - kImpostorTriangles <= budget) return k;
  }
  return kImpostor;
}

}  // namespace

void ChooseLevels(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ControlSettings& s,
                  const LevelQuery& query, LevelState* state) {
  const ViewCamera& camera = query.camera;
  const float step_s = Step_s(s);
  FollowFrameTime(query.frame_ms, Length(query.motion.velocity), s, state);
  Smooth(query.motion, step_s, &state->motion);
  if (state->r_high_m <= 0) state->r_high_m = s.r_high_m;
  ListVisible(crowd, camera, s.r_far_m, query.first_id, state);
  ListShadowCasters(crowd, avatars, camera, state);
  const int64_t all = static_cast<int64_t>(state->budget_triangles);
  const int64_t as_impostors = kImpostorTriangles * static_cast<int64_t>(state->visible.size());
  ChooseShadows(std::clamp<int64_t>(all - as_impostors, 0, static_cast<int64_t>(kShadowShare * state->budget_triangles)), step_s, &state->shadows);
  const int limit = state->limit = s.method == LimitMethod::kFrameTime ? PeopleAfforded(avatars, state) : s.high_limit;
  MoveBoundary(s, limit, step_s, state);

  // Only those who may become meshes need to stand in order; and all, where not even impostors fit.
  const int64_t budget = all - state->shadows.triangles;
  PassFades(step_s, budget, crowd.next_id, &state->fades);
  ListPropBearers(crowd, avatars, state);
  ChooseProps(static_cast<int64_t>(kPropShare * state->budget_triangles), crowd.next_id, &state->props);
  const int64_t besides = state->fades.triangles + state->props.triangles;
  const int64_t drawable = std::max<int64_t>(0, budget - besides) / kImpostorTriangles;
  auto& visible = state->visible;
  auto far = std::partition(visible.begin(), visible.end(), [](const auto& v) { return v.turn < kStays; });
  if (static_cast<int64_t>(visible.size()) > drawable) far = visible.end();
  std::sort(visible.begin(), far, Before);

  state->level.assign(crowd.size(), kNotDrawn);
  state->triangles = std::min<int64_t>(static_cast<int64_t>(visible.size()), drawable) * kImpostorTriangles + besides;
  state->high = state->low = state->shortfalls = state->switches_in_view = 0;
  int within_nominal = 0;
  for (size_t rank = 0; rank < visible.size(); ++rank) {
    const auto& [distance_m, key_m, person, id, turn] = visible[rank];
    const size_t i = static_cast<size_t>(person);
    if (distance_m < s.r_high_m) ++within_nominal;
    if (static_cast<int64_t>(rank) >= drawable) continue;
    const AvatarCosts& avatar = avatars[static_cast<size_t>(crowd.avatar[i])];
    const float px = PixelsHigh(avatar.height_m, distance_m, camera, query.screen_width_px);
    const int last = state->last_level[static_cast<size_t>(id)];
    const float share = turn == kAppears ? 1 - kReserve : 1.0f;
    int level = kImpostor;
    if (turn < kStays && static_cast<float>(state->high) < share * static_cast<float>(limit)) {
      level = AffordableLevel(avatar, WantedLevel(avatar, px, last), static_cast<int64_t>(share * static_cast<float>(budget)), state->triangles);
    }
    if (level >= 0) state->triangles += avatar.levels[static_cast<size_t>(level)].triangles - kImpostorTriangles;
    state->level[i] = level;
    ++(level >= 0 ? state->high : state->low);
    if (level == kImpostor && px > avatar.impostor_px) ++state->shortfalls;
    if (last == kNotDrawn || last == level) continue;
    ++state->switches_in_view;
    const int before = last >= 0 ? avatar.levels[static_cast<size_t>(last)].triangles : kImpostorTriangles;
    state->triangles += BeginFade(id, before, budget - state->triangles, &state->fades);
  }
  for (size_t i = 0; i < crowd.size(); ++i) state->last_level[static_cast<size_t>(crowd.id[i])] = state->level[i];
  state->exceeded = within_nominal > limit;
}

}  // namespace flaneur
