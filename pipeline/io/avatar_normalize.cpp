#include "pipeline/io/avatar_normalize.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "pipeline/core/rotation.h"
#include "pipeline/io/avatar_stance.h"
#include "pipeline/rig/clip_loop.h"
#include "pipeline/rig/steps.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kDefaultHeight_m = 1.75f;
constexpr float kMinHeight_m = 0.5f, kMaxHeight_m = 2.3f;  // kept as they are in between
constexpr float kSmallest_m = 0.8f;                        // who walks by themselves
constexpr float kTallest_m = 2.1f;                         // with a hat
constexpr float kFlat = 0.4f;                              // of its width: a lower figure hardly stands
constexpr float kHangs = 0.02f;                            // of the height: what hangs lower than the soles by more
constexpr float kStrays = 0.1f;                            // of the height: how far who stands is from the walk
constexpr float kElsewhere = 1;                            // the same of who does anything else
constexpr float kDefaultSpeed_mps = 1.3f;                  // of an adult, where nothing tells
constexpr float kMinSpeed_mps = 0.2f;                      // slower is not a walk, of an adult
constexpr float kSole = 0.015f;                            // of the height: how near the ground a standing sole is
constexpr float kAsItFaces_rad = 0.5f;                     // who goes elsewhere by more walks sideways
constexpr size_t kMaxBodyVertices = 16000;                 // at a millimetre or two from one another's height

std::string Metres(float value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", static_cast<double>(value));
  return text;
}

float Median(std::vector<float> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Extent {
  Vec3 min{1e30f, 1e30f, 1e30f}, max{-1e30f, -1e30f, -1e30f};
  void Add(Vec3 p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
};

// Every length of the figure times `scale`, the bind pose also moved. Joint frames keep unit scale.
void ScaleAvatar(float scale, Vec3 bind_offset, Avatar* avatar, Mesh* body) {
  const Mat4 to_new = FromTranslationRotationScale(bind_offset, {}, {scale, scale, scale});
  const Mat4 to_old = Inverse(to_new);
  const Mat4 enlarge = FromTranslationRotationScale({}, {}, {scale, scale, scale});
  const auto move = [&](Mesh* mesh) {
    for (Vec3& p : mesh->positions) p = TransformPoint(to_new, p);
  };
  for (Mesh* mesh : AllMeshes(avatar)) move(mesh);
  move(body);
  for (Joint& joint : avatar->joints) {
    joint.rest.translation = joint.rest.translation * scale;
    if (joint.parent < 0) joint.rest.translation = joint.rest.translation + bind_offset;
    joint.inverse_bind = enlarge * joint.inverse_bind * to_old;
  }
  for (Clip& clip : avatar->clips) {
    for (Transform& t : clip.transforms) t.translation = t.translation * scale;
    ShiftClip(avatar->joints, &clip, bind_offset);
  }
}

std::vector<std::vector<Vec3>> BodyOverClip(const Avatar& avatar, const Clip& clip, const Mesh& body) {
  std::vector<std::vector<Vec3>> keys;
  for (int k = 0; k + 1 < clip.keys; ++k) {
    keys.push_back(SkinnedPositions(body, SkinningMatrices(avatar, clip, TimeOf(clip, k))));
  }
  return keys;
}

float LowestOf(const std::vector<Vec3>& points) {
  float lowest = 1e30f;
  for (const Vec3 p : points) lowest = std::min(lowest, p.y);
  return lowest;
}

// Of the feet over the walk: by how much the lowest of them dips into the ground that the others stand on.
float DipOf(const Rig& rig, const std::vector<std::vector<Vec3>>& feet) {
  if (!BendsKnees(rig)) return 0;
  std::vector<float> lowest;
  for (const auto& positions : feet) lowest.push_back(LowestOf(positions));
  return std::max(0.0f, GroundUnder(lowest, rig.leg_m, true) - *std::min_element(lowest.begin(), lowest.end()));
}

float Lowest(const std::vector<std::vector<Vec3>>& keys) {
  float lowest = 1e30f;
  for (const auto& positions : keys) lowest = std::min(lowest, LowestOf(positions));
  return lowest;
}

// Points of the trunk over the clip: above the hips, below the neck.
std::vector<Vec3> Trunk(const std::vector<std::vector<Vec3>>& keys, float ground, float height) {
  std::vector<Vec3> trunk;
  for (const auto& positions : keys) {
    for (const Vec3 p : positions) {
      const float share = (p.y - ground) / height;
      if (share > 0.5f && share < 0.78f) trunk.push_back(p);
    }
  }
  return trunk;
}

// Of x and of z; y is 0.
Vec3 MedianOf(const std::vector<Vec3>& points) {
  std::vector<float> x, z;
  for (const Vec3 p : points) {
    x.push_back(p.x);
    z.push_back(p.z);
  }
  return {Median(std::move(x)), 0, Median(std::move(z))};
}

Vec3 BetweenThighs(const Humanoid& humanoid, const Pose& pose) {
  return (pose.positions[static_cast<size_t>(humanoid.legs[kLeft].upper)] +
          pose.positions[static_cast<size_t>(humanoid.legs[kRight].upper)]) *
         0.5f;
}

// Where the hips are over the clip, whatever hangs about them: x and z, y is 0.
Vec3 HipsOver(const Humanoid& humanoid, const std::vector<Joint>& joints, const Clip& clip) {
  std::vector<Vec3> hips;
  for (int k = 0; k + 1 < clip.keys; ++k) {
    const Transform* key = clip.transforms.data() + static_cast<size_t>(k) * joints.size();
    hips.push_back(BetweenThighs(humanoid, PoseOf(joints, key)));
  }
  return MedianOf(hips);
}

// Of the bind pose, x and z; that of no human: where it is.
Vec3 HipsAtRest(const Avatar& avatar, const std::vector<NamedBone>& told) {
  const Pose bind = BindPose(avatar.joints);
  Humanoid humanoid;
  std::string why;
  if (!FindHumanoid(avatar.joints, bind.positions, told, &humanoid, &why) || humanoid.quadruped) return {};
  const Vec3 hips = BetweenThighs(humanoid, bind);
  return {hips.x, 0, hips.z};
}

// Vertices that are marked, with their skin.
Mesh Only(const std::vector<bool>& marked, const Mesh& mesh) {
  Mesh out;
  for (size_t v = 0; v < marked.size(); ++v) {
    if (!marked[v]) continue;
    out.positions.push_back(mesh.positions[v]);
    out.joints.push_back(mesh.joints[v]);
    out.weights.push_back(mesh.weights[v]);
  }
  return out;
}

// Feet on the ground, hips over the origin, or the trunk of who has no legs: a sword held out moves nobody. Idle and
// talk keep their place beside the walk unless they stray; what is done besides is lifted as the walk is, and keeps
// its place unless that is elsewhere altogether: who sits has the trunk behind the feet, and a child's feet over the
// ground. Feet are the lowest there is, unless something hangs below them in the walk: then they alone count. Toes and
// heels that dip deep into what the feet stand on in a stylized walk lift nobody off it.
void PlaceClips(const Mesh& whole, const std::vector<NamedBone>& told, Avatar* avatar,
                std::vector<std::string>* warnings) {
  const Clip& walk_clip = *FindClip(*avatar, "walk");
  const auto walk = BodyOverClip(*avatar, walk_clip, whole);
  float walk_ground = Lowest(walk);
  const Mesh feet = Only(OnFeet(*avatar, told, whole), whole);
  const auto steps = BodyOverClip(*avatar, walk_clip, feet);
  const float soles = feet.positions.empty() ? walk_ground : Lowest(steps);
  Rig rig;
  std::string why;
  const bool human = MakeRig(*avatar, told, &rig, &why);
  const float dip = feet.positions.empty() || !human ? 0 : DipOf(rig, steps);
  const bool hangs = soles - walk_ground > kHangs * avatar->height_m;
  if (hangs) {
    warnings->push_back("something hangs " + Metres(soles - walk_ground) +
                        " m below the soles; the soles stand on the ground: hide it, or see flaneur avatar --list");
    walk_ground = soles;
  }
  walk_ground += dip;
  for (Clip& clip : avatar->clips) {
    const bool walks = clip.name == "walk", stands = walks || clip.name == "idle" || clip.name == "talk";
    std::vector<std::vector<Vec3>> keys;  // of the body, where it is asked
    if (!human || (stands && !hangs)) keys = BodyOverClip(*avatar, clip, whole);
    float ground = walk_ground;
    if (stands) ground = (hangs ? Lowest(BodyOverClip(*avatar, clip, feet)) : Lowest(keys)) + (walks ? dip : 0);
    Vec3 center =
        human ? HipsOver(rig.humanoid, avatar->joints, clip) : MedianOf(Trunk(keys, ground, avatar->height_m));
    const bool strays = Length(center) > (stands ? kStrays : kElsewhere) * avatar->height_m;
    if (!walks && !strays) center = {};
    ShiftClip(avatar->joints, &clip, {-center.x, -ground, -center.z});
  }
}

// Half the trunk's width over the walk, arms and all, within what a person takes up.
float TrunkRadius(const Avatar& avatar, const Clip& walk, const Mesh& body) {
  const float usual = 0.25f * avatar.height_m / kDefaultHeight_m;
  std::vector<float> distances;
  for (const Vec3 p : Trunk(BodyOverClip(avatar, walk, body), 0, avatar.height_m)) {
    distances.push_back(std::sqrt(p.x * p.x + p.z * p.z));
  }
  if (distances.empty()) return std::clamp(usual, 0.2f, 0.35f);
  const auto at = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() * 9 / 10);
  std::nth_element(distances.begin(), at, distances.end());
  return std::clamp(*at, 0.2f, 0.35f);
}

bool IsPlausible(float height_m) { return height_m >= kMinHeight_m && height_m <= kMaxHeight_m; }

// As it is where that is a person's height, or that of the person below a tall hat: so people of one pack keep one
// scale. Else in the unit that makes the skeleton a person's, else the usual height.
float HeightByItself(const NormalizeOptions& options, const Avatar& avatar, float height, float bound_lower,
                     std::vector<std::string>* warnings) {
  if (options.scale > 0) return height;
  float skeleton = HeightOfSkeleton(avatar, options.told);
  if (skeleton > 0) skeleton += bound_lower;
  if (IsPlausible(height) || IsPlausible(skeleton)) {
    const char* doubt = height < kSmallest_m  ? "less than a child who walks"
                        : height > kTallest_m ? "taller than people in hats"
                                              : nullptr;
    if (doubt != nullptr && skeleton > 0)
      warnings->push_back("the figure is " + Metres(height) + " m high, " + doubt +
                          "; give its height, or a scale for all people of its pack");
    return height;
  }
  if (const float unit_m = UnitOf(skeleton); skeleton > 0 && unit_m > 0) {
    char unit[24];
    std::snprintf(unit, sizeof unit, "%g", static_cast<double>(unit_m));
    warnings->push_back("the figure is " + Metres(height) + " units high; one is taken to be " + unit +
                        " m: set scale or its height to have it otherwise");
    return height * unit_m;
  }
  warnings->push_back("the figure is " + Metres(height) + " m high and is scaled to " + Metres(kDefaultHeight_m) +
                      " m; give its height to change that");
  return kDefaultHeight_m;
}

Error ScaleToHeight(const NormalizeOptions& options, Avatar* avatar, Mesh* body, float* scale,
                    std::vector<std::string>* warnings) {
  Extent extent;
  for (const Mesh& mesh : avatar->meshes) {
    for (const Vec3 p : mesh.positions) extent.Add(p);
  }
  const float bound_lower = BoundLowerBy(*avatar, options.told);
  const float height = extent.max.y - extent.min.y + bound_lower;
  if (!std::isfinite(height) || !(height > 1e-6f)) return Fail("the figure has no height");
  const float widest = std::max(extent.max.x - extent.min.x, extent.max.z - extent.min.z);
  if (height < kFlat * widest) {
    warnings->push_back(
        "the figure is " + Metres(widest / height) +
        " times as wide as it is high: lying or collapsed; set up and forward, or see flaneur avatar --list");
  }
  const float wanted =
      options.height_m > 0 ? options.height_m : HeightByItself(options, *avatar, height, bound_lower, warnings);
  *scale = wanted / height;
  if (options.height_m <= 0 && options.scale > 0) *scale = options.scale;
  const Vec3 hips = HipsAtRest(*avatar, options.told);
  ScaleAvatar(*scale, Vec3{-hips.x, -extent.min.y, -hips.z} * *scale, avatar, body);
  avatar->height_m = height * *scale;
  return Ok();
}

// Turns the figure about the vertical by the quarter that brings its walk nearest to +Z, or, where `exactly`, by what
// is needed.
void TurnToFace(Vec3 walk, bool exactly, Avatar* avatar, Mesh* body, std::vector<std::string>* warnings) {
  const Vec3 up{0, 1, 0}, way = Normalized(walk);
  const Quat turn = exactly ? TurnToFront(up, way) : QuarterTurn(up, way);
  const float turn_rad = 2 * std::atan2(turn.y, turn.w);
  if (std::abs(turn_rad) < 1e-3f) return;
  TurnFigure(turn, true, avatar, body);
  char degrees[16];
  std::snprintf(degrees, sizeof degrees, "%.0f", static_cast<double>(std::remainder(turn_rad, 2 * kPi) / kPi * 180));
  warnings->push_back("the walk does not go towards +Z; the figure is turned by " + std::string(degrees) + " degrees");
}

// Turns the figure so that it walks towards +Z, and returns how fast it does, m/s. The way is that of the root's
// travel, else of the face, else of the soles, which mistake it where they hop or slide; a face also tells it to the
// degree.
float FaceForward(Vec3 travel_mps, const std::vector<NamedBone>& told, Avatar* avatar, Mesh* body,
                  std::vector<std::string>* warnings) {
  const Clip& walk = *FindClip(*avatar, "walk");
  const bool travels = Length(travel_mps) > 0;
  const Vec3 walk_mps = travels ? travel_mps : MeasureWalk(*avatar, walk, *body);
  const float speed_mps = Length(walk_mps);
  Vec3 face;
  bool by_shape = false;
  const bool faces = FacingInWalk(*avatar, told, walk, &face, &by_shape);
  const bool goes = speed_mps > kMinSpeed_mps;
  if (by_shape && Dot(face, goes ? walk_mps : Vec3{0, 0, 1}) < 0) face = face * -1;
  const bool sure = !travels && !by_shape;
  const bool as_it_faces = faces && (sure || !goes || AngleBetween(face, walk_mps) < kAsItFaces_rad);
  if (as_it_faces || goes) TurnToFace(as_it_faces ? face : walk_mps, as_it_faces, avatar, body, warnings);
  return speed_mps;
}

// The first that is known: told by the source, the root's travel, the soles. `told`: in metres or in the file's unit,
// whichever comes nearer to what the walk looks like.
void SetWalkSpeed(float told, float scale, float measured_mps, Avatar* avatar, std::vector<std::string>* warnings) {
  const bool measured = measured_mps > kMinSpeed_mps * std::min(1.0f, avatar->height_m / kDefaultHeight_m);
  const float likely_mps = measured ? measured_mps : kDefaultSpeed_mps * std::sqrt(avatar->height_m / kDefaultHeight_m);
  avatar->walk_speed_mps = likely_mps;
  if (told > 0) {
    const auto off = [&](float mps) { return std::abs(std::log(mps / likely_mps)); };
    avatar->walk_speed_mps = off(told) < off(told * scale) ? told : told * scale;
  } else if (!measured) {
    warnings->push_back("the walk's speed cannot be told from its soles; " + Metres(likely_mps) + " m/s is taken");
  }
}

// Skin alone, of no more vertices than tell where soles and trunk are.
Mesh Thinned(const Mesh& mesh) {
  const size_t step = 1 + mesh.positions.size() / kMaxBodyVertices;
  Mesh thin;
  for (size_t v = 0; v < mesh.positions.size(); v += step) {
    thin.positions.push_back(mesh.positions[v]);
    thin.joints.push_back(mesh.joints[v]);
    thin.weights.push_back(mesh.weights[v]);
  }
  return thin;
}

}  // namespace

Vec3 MeasureWalk(const Avatar& avatar, const Clip& walk, const Mesh& body) {
  const auto keys = BodyOverClip(avatar, walk, body);
  if (keys.size() < 3) return {};
  const float step_s = walk.duration_s / static_cast<float>(keys.size());
  std::vector<Vec3> votes;  // one a key, so that a moment with a flat sole does not outweigh the rest
  for (size_t k = 0; k < keys.size(); ++k) {
    const auto& now = keys[k];
    const auto& next = keys[(k + 1) % keys.size()];
    const float ground = LowestOf(now), next_ground = LowestOf(next);
    std::vector<Vec3> backward;
    for (size_t i = 0; i < now.size(); ++i) {
      const bool stands =
          now[i].y < ground + kSole * avatar.height_m && next[i].y < next_ground + kSole * avatar.height_m;
      if (stands) backward.push_back((now[i] - next[i]) * (1 / step_s));
    }
    if (!backward.empty()) votes.push_back(MedianOf(backward));
  }
  return MedianOf(votes);
}

Error NormalizeAvatar(const NormalizeOptions& options, const Mesh& whole_body, Avatar* avatar,
                      std::vector<std::string>* warnings) {
  Mesh body = Thinned(whole_body);
  float scale = 1;
  if (Error e = StandUp(options.up, options.forward, options.told, avatar, &body, warnings)) return e;
  if (Error e = ScaleToHeight(options, avatar, &body, &scale, warnings)) return e;
  Vec3 walk_mps;  // as its root travels
  for (Clip& clip : avatar->clips) {
    const Vec3 travel_mps = RemoveTravel(avatar->joints, avatar->height_m, &clip);
    if (clip.name == "walk") walk_mps = travel_mps;
    MakeLoop(avatar->joints, &clip, warnings);
  }
  const float speed_mps = FaceForward(walk_mps, options.told, avatar, &body, warnings);
  PlaceClips(body, options.told, avatar, warnings);
  avatar->radius_m = TrunkRadius(*avatar, *FindClip(*avatar, "walk"), body);
  SetWalkSpeed(options.walk_speed, scale, speed_mps, avatar, warnings);
  return Ok();
}

}  // namespace flaneur
