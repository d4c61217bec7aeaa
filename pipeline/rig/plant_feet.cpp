#include "pipeline/rig/plant_feet.h"

#include <algorithm>
#include <utility>

#include "pipeline/rig/clip_loop.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kSlides = 0.15f;  // of the walking speed: what soles may slide before feet are set anew
constexpr float kPlanted = 0.5f;  // of the slide before, that may be left then
// Legs, hips, what they hang on, and limbs that hang on neither: the joints that PlantFeet moves.
std::vector<bool> SteppingJoints(const Rig& rig) {
  std::vector<bool> above_legs(rig.joints.size(), false), on_hips(rig.joints.size(), false);
  for (const RigLeg& leg : rig.legs) {
    for (const int from : {leg.upper, leg.lower, leg.foot, leg.toes}) {
      for (int a = from; a >= 0; a = At(rig.joints, a).parent) At(above_legs, a) = true;
    }
  }
  for (size_t j = 0; j < on_hips.size(); ++j) {
    const int parent = rig.joints[j].parent;
    on_hips[j] = parent >= 0 && (parent == rig.humanoid.hips || At(on_hips, parent));
  }
  std::vector<bool> stepping(rig.joints.size());
  for (size_t j = 0; j < stepping.size(); ++j) stepping[j] = above_legs[j] || !on_hips[j];
  return stepping;
}

}  // namespace

float SlideOfWalk(const Rig& rig, const Clip& walk) { return Retarget(rig, walk, rig, {.walks = true}).source_slide; }

bool GoesBackwards(const Rig& rig, const Clip& walk) {
  return !rig.humanoid.by_shape && walk.keys >= 3 && Retarget(rig, walk, rig, {.walks = true}).walk_speed_mps < 0;
}

bool PlantFeet(const Rig& rig, Retargeted* walk) {
  if (rig.humanoid.by_shape || !BendsKnees(rig) || walk->clip.keys < 3) return false;
  Retargeted planted = Retarget(rig, walk->clip, rig, {.walks = true});
  if (planted.source_slide < kSlides || !(planted.walk_speed_mps > 0)) return false;
  if (SlideOfWalk(rig, planted.clip) > kPlanted * planted.source_slide) return false;
  const std::vector<bool> stepping = SteppingJoints(rig);
  for (size_t i = 0; i < planted.clip.transforms.size(); ++i) {
    const size_t joint = i % rig.joints.size(), key = i / rig.joints.size();
    const size_t last = static_cast<size_t>(walk->clip.keys) - 1;
    if (!stepping[joint])
      planted.clip.transforms[i] = walk->clip.transforms[std::min(key, last) * rig.joints.size() + joint];
  }
  TurnClip(HeadingOf(rig, walk->clip), rig.joints, &planted.clip);
  planted.clip.name = walk->clip.name;
  *walk = std::move(planted);
  return true;
}

}  // namespace flaneur
