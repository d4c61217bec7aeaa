#include "runtime/show/birds.h"

#include <algorithm>
#include <cmath>

#include "runtime/crowd/fast_math.h"
#include "runtime/show/looks.h"

namespace flaneur {
namespace {

constexpr float kMixBird_s = 0.15f;  // from one clip to the next

// before_s: how long before the last step. Each bird is at its own moment of the clip.
ClipMoment MomentOf(const PackAvatar& avatar, const Flock& flock, const Bird& bird, BirdState state, int number,
                    float time_s) {
  const float own = 0.37f * static_cast<float>(number % 97);
  if (state == BirdState::kWalks) {
    const float cycle_m = avatar.walk_speed_mps * std::max(avatar.walk.duration_s, 0.1f);
    return {ClipKind::kWalk, Fraction(own + bird.walked_m / cycle_m)};
  }
  if (!InTheAir(state)) return {ClipKind::kIdle, Fraction(own + time_s / std::max(avatar.idle.duration_s, 0.1f))};
  for (size_t k = 0; k < avatar.other_clips.size(); ++k) {
    if (avatar.other_clips[k].name != flock.clip) continue;
    const float duration_s = std::max(avatar.other_clips[k].clip.duration_s, 0.1f);
    return {OtherClip(static_cast<int>(k)), Fraction(own + time_s / duration_s)};
  }
  return {ClipKind::kIdle, 0};
}

}  // namespace

void AddBirds(const TourPack& pack, const Simulation& s, float share, FrameInput* frame) {
  const float before_s = (1 - share) * Step_s(s), time_s = Time_s(s) - before_s;
  for (const ShownBird& shown : s.birds.shown) {
    const FlockState& flock = s.town.flocks[static_cast<size_t>(shown.flock)];
    const Bird& bird = flock.birds[static_cast<size_t>(shown.bird)];
    const PackAvatar& avatar = pack.avatars[static_cast<size_t>(flock.avatar)];
    const int number = 1 + shown.bird + 101 * shown.flock;
    DrawnPerson drawn;
    drawn.avatar = flock.avatar;
    drawn.tints = TintsOf(avatar, number);
    drawn.size = SizeOf(avatar, number);
    drawn.breadth = BreadthOf(avatar, number);
    drawn.moment = MomentOf(avatar, flock.place, bird, bird.state, number, time_s);
    drawn.other = MomentOf(avatar, flock.place, bird, bird.last, number, time_s);
    if (drawn.other.clip != drawn.moment.clip)
      drawn.other_share = std::clamp(1 - (bird.since_s - before_s) / kMixBird_s, 0.0f, 1.0f);
    drawn.position = bird.before + (bird.position - bird.before) * share;
    drawn.heading_rad =
        WrapAngle(bird.heading_before_rad + share * WrapAngle(bird.heading_rad - bird.heading_before_rad));
    const float ground_m = HeightAt(s.town.walkable, {drawn.position.x, drawn.position.y});
    drawn.lift_m = std::max(0.0f, drawn.position.z - ground_m);
    drawn.casts_shadow = shown.casts_shadow;
    drawn.level = MeshLevel(shown.mesh);
    drawn.share_to = shown.share * shown.finer;
    if (drawn.share_to > 0) frame->people.push_back(drawn);
    if (shown.finer >= 1) continue;
    drawn.level = MeshLevel(shown.mesh + 1);
    drawn.share_from = drawn.share_to;
    drawn.share_to = shown.share;
    frame->people.push_back(drawn);
  }
}

}  // namespace flaneur
