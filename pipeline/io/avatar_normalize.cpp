#include "pipeline/io/avatar_normalize.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kDefaultHeight_m = 1.75f;
constexpr float kMinHeight_m = 0.5f, kMaxHeight_m = 2.3f;  // kept as they are in between
constexpr float kDefaultSpeed_mps = 1.3f;                  // of an adult, where nothing tells
constexpr float kMinSpeed_mps = 0.2f;                      // slower is not a walk
constexpr float kTravel = 0.05f;                           // of the height: more than sway, so the root travels
constexpr float kSole = 0.015f;                            // of the height: how near the ground a standing sole is
constexpr size_t kMaxBodyVertices = 16000;                 // at a millimetre or two from one another's height
constexpr float kBlendedShare = 0.25f;                     // of a clip that does not loop

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

float TimeOf(const Clip& clip, int key) {
  return clip.keys < 2 ? 0 : clip.duration_s * static_cast<float>(key) / static_cast<float>(clip.keys - 1);
}

// Unlike SkinningMatrices at a time, this does not wrap the last key to the first.
std::vector<Vec3> JointPositions(const Avatar& avatar, const Clip& clip, int key) {
  const size_t joints = avatar.joints.size();
  std::vector<Mat4> world(joints);
  std::vector<Vec3> positions(joints);
  for (size_t j = 0; j < joints; ++j) {
    const Transform& t = clip.transforms[static_cast<size_t>(key) * joints + j];
    const Mat4 local = FromTranslationRotationScale(t.translation, t.rotation, t.scale);
    const int parent = avatar.joints[j].parent;
    world[j] = parent < 0 ? local : At(world, parent) * local;
    positions[j] = TransformPoint(world[j], {});
  }
  return positions;
}

Vec3 Mean(const std::vector<Vec3>& points) {
  Vec3 sum;
  for (const Vec3 p : points) sum = sum + p;
  return sum * (1 / static_cast<float>(points.size()));
}

float MeanDistance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  float sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += Length(a[i] - b[i]);
  return sum / static_cast<float>(a.size());
}

// Moves the whole figure in one key.
void Shift(const Avatar& avatar, Clip* clip, int key, Vec3 by) {
  const size_t joints = avatar.joints.size();
  for (size_t j = 0; j < joints; ++j) {
    if (avatar.joints[j].parent >= 0) continue;
    Vec3& t = clip->transforms[static_cast<size_t>(key) * joints + j].translation;
    t = t + by;
  }
}

void Shift(const Avatar& avatar, Clip* clip, Vec3 by) {
  for (int k = 0; k < clip->keys; ++k) Shift(avatar, clip, k, by);
}

// Takes even horizontal travel out of the clip; returns its velocity.
Vec3 RemoveTravel(const Avatar& avatar, float height, Clip* clip) {
  Vec3 travel = Mean(JointPositions(avatar, *clip, clip->keys - 1)) - Mean(JointPositions(avatar, *clip, 0));
  travel.y = 0;
  if (Length(travel) < kTravel * height) return {};
  const Vec3 velocity = travel * (1 / clip->duration_s);
  for (int k = 0; k < clip->keys; ++k) {
    Shift(avatar, clip, k, velocity * -TimeOf(*clip, k));
  }
  return velocity;
}

Transform Mix(const Transform& a, const Transform& b, float t) {
  return {a.translation * (1 - t) + b.translation * t, Slerp(a.rotation, b.rotation, t),
          a.scale * (1 - t) + b.scale * t};
}

// Makes the last key equal the first: exactly where it nearly does, by one more key where just that
// is missing, else by blending the clip's end into its first pose.
void MakeLoop(const Avatar& avatar, Clip* clip, std::vector<std::string>* warnings) {
  const size_t joints = avatar.joints.size();
  const std::vector<Vec3> first = JointPositions(avatar, *clip, 0);
  float step = 0;
  std::vector<Vec3> previous = first;
  for (int k = 1; k < clip->keys; ++k) {
    std::vector<Vec3> next = JointPositions(avatar, *clip, k);
    step += MeanDistance(previous, next) / static_cast<float>(clip->keys - 1);
    previous = std::move(next);
  }
  const float gap = MeanDistance(previous, first);
  const auto key = [&](int k) { return clip->transforms.begin() + static_cast<std::ptrdiff_t>(joints) * k; };
  if (gap > 0.5f * step && gap <= 2 * step) {
    clip->duration_s *= static_cast<float>(clip->keys) / static_cast<float>(clip->keys - 1);
    ++clip->keys;
    clip->transforms.resize(clip->transforms.size() + joints);
  } else if (gap > 2 * step) {
    if (clip->name == "walk") {
      warnings->push_back("the walk clip does not loop; its end is blended into its start");
    }
    const int blended = std::max(1, static_cast<int>(kBlendedShare * static_cast<float>(clip->keys)));
    for (int k = clip->keys - blended; k < clip->keys; ++k) {
      const float t = static_cast<float>(k - (clip->keys - blended) + 1) / static_cast<float>(blended);
      for (size_t j = 0; j < joints; ++j) {
        Transform& own = *(key(k) + static_cast<std::ptrdiff_t>(j));
        own = Mix(own, clip->transforms[j], t * t * (3 - 2 * t));
      }
    }
  }
  std::copy(key(0), key(1), key(clip->keys - 1));
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
    Shift(*avatar, &clip, bind_offset);
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

// Feet on the ground, trunk over the origin. Idle and talk keep their place beside the walk unless they stray; what is
// done besides is moved as the walk is: who sits has the trunk behind the feet, and a child's feet over the ground.
void PlaceClips(const Mesh& body, Avatar* avatar) {
  const auto walk = BodyOverClip(*avatar, *FindClip(*avatar, "walk"), body);
  const float walk_ground = Lowest(walk);
  for (Clip& clip : avatar->clips) {
    if (clip.name != "walk" && clip.name != "idle" && clip.name != "talk") {
      Shift(*avatar, &clip, {0, -walk_ground, 0});
      continue;
    }
    const auto keys = BodyOverClip(*avatar, clip, body);
    const float ground = Lowest(keys);
    Vec3 center = MedianOf(Trunk(keys, ground, avatar->height_m));
    const bool strays = Length(center) > 0.1f * avatar->height_m;
    if (clip.name != "walk" && !strays) center = {};
    Shift(*avatar, &clip, {-center.x, -ground, -center.z});
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

Error ScaleToHeight(const NormalizeOptions& options, Avatar* avatar, Mesh* body, float* scale,
                    std::vector<std::string>* warnings) {
  Extent extent;
  for (const Mesh& mesh : avatar->meshes) {
    for (const Vec3 p : mesh.positions) extent.Add(p);
  }
  const float height = extent.max.y - extent.min.y;
  if (!std::isfinite(height) || !(height > 1e-6f)) return Fail("the figure has no height");
  float wanted = options.height_m;
  if (wanted <= 0) {
    const bool plausible = height >= kMinHeight_m && height <= kMaxHeight_m;
    wanted = plausible ? height : kDefaultHeight_m;
    if (!plausible) {
      warnings->push_back("the figure is " + Metres(height) + " m high and is scaled to " + Metres(wanted) +
                          " m; give its height to change that");
    }
  }
  *scale = wanted / height;
  ScaleAvatar(*scale, Vec3{0, -extent.min.y, 0} * *scale, avatar, body);
  avatar->height_m = wanted;
  return Ok();
}

// The rotation b, then a.
Quat Product(Quat a, Quat b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

// Turns the figure about the vertical by the quarter that brings its walk nearest to +Z.
void TurnToFace(Vec3 walk_mps, Avatar* avatar, Mesh* body, std::vector<std::string>* warnings) {
  const float away_rad = std::atan2(walk_mps.x, walk_mps.z);
  const float quarters = std::round(away_rad / (kPi / 2));
  if (quarters == 0) return;
  const float half_rad = -quarters * kPi / 4;
  const Quat turn{0, std::sin(half_rad), 0, std::cos(half_rad)};
  const Mat4 matrix = FromTranslationRotationScale({}, turn, {1, 1, 1});
  const auto turn_mesh = [&](Mesh* mesh) {
    for (Vec3& p : mesh->positions) p = TransformPoint(matrix, p);
    for (Vec3& n : mesh->normals) n = TransformDirection(matrix, n);
  };
  for (Mesh* mesh : AllMeshes(avatar)) turn_mesh(mesh);
  turn_mesh(body);
  const auto turn_root = [&](Transform* t) {
    t->translation = TransformPoint(matrix, t->translation);
    t->rotation = Normalized(Product(turn, t->rotation));
  };
  const size_t joints = avatar->joints.size();
  for (size_t j = 0; j < joints; ++j) {
    avatar->joints[j].inverse_bind = avatar->joints[j].inverse_bind * Inverse(matrix);
    if (avatar->joints[j].parent >= 0) continue;
    turn_root(&avatar->joints[j].rest);
    for (Clip& clip : avatar->clips) {
      for (size_t i = j; i < clip.transforms.size(); i += joints) turn_root(&clip.transforms[i]);
    }
  }
  char degrees[16];
  std::snprintf(degrees, sizeof degrees, "%.0f", static_cast<double>(-quarters * 90));
  warnings->push_back("the walk does not go towards +Z; the figure is turned by " + std::string(degrees) + " degrees");
}

// The first that is known: told by the source, the root's travel, the soles.
void SetWalkSpeed(float told_mps, Vec3 walk_mps, Avatar* avatar, std::vector<std::string>* warnings) {
  avatar->walk_speed_mps = told_mps > 0 ? told_mps : Length(walk_mps);
  if (avatar->walk_speed_mps > kMinSpeed_mps) return;
  avatar->walk_speed_mps = kDefaultSpeed_mps * std::sqrt(avatar->height_m / kDefaultHeight_m);
  warnings->push_back("the walk's speed cannot be told from its soles; " + Metres(avatar->walk_speed_mps) +
                      " m/s is taken");
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
  if (Error e = ScaleToHeight(options, avatar, &body, &scale, warnings)) return e;
  Vec3 walk_mps;
  for (Clip& clip : avatar->clips) {
    const Vec3 travel_mps = RemoveTravel(*avatar, avatar->height_m, &clip);
    if (clip.name == "walk") walk_mps = travel_mps;
    MakeLoop(*avatar, &clip, warnings);
  }
  const Clip& walk = *FindClip(*avatar, "walk");
  if (!(Length(walk_mps) > 0)) walk_mps = MeasureWalk(*avatar, walk, body);
  if (Length(walk_mps) > kMinSpeed_mps) TurnToFace(walk_mps, avatar, &body, warnings);
  PlaceClips(body, avatar);
  avatar->radius_m = TrunkRadius(*avatar, walk, body);
  SetWalkSpeed(options.walk_speed_mps * scale, walk_mps, avatar, warnings);
  return Ok();
}

}  // namespace flaneur
