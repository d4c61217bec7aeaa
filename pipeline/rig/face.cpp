#include "pipeline/rig/face.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "pipeline/rig/clip_loop.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kLeastShare = 0.6f;  // of a shape that its joints must make
constexpr float kEnough = 0.97f;     // with which no further joint is worth its place
constexpr float kGain = 0.02f;       // of the shape, that a further one must add
constexpr size_t kMostJoints = 4;    // a shape: lids go down and up, lips up, down and together
constexpr float kLeast = 0.0005f;    // of the figure's height: what moves less is not seen
constexpr float kMost = 0.12f;       // likewise: what moves farther is no face
constexpr float kMostWeight = 0.3f;  // of a vertex on a joint of the face: the rest stays with head, jaw and neck
constexpr float kLeastWeight = 1 / 255.0f;  // less is none in a file
constexpr float kIdle_s = 12, kTalk_s = 6;  // about as long as these get, for blinks and words that do not come in time
constexpr float kLeastGap_s = 2, kMostGap_s = 6;  // between blinks
constexpr float kRate_hz = 30;                    // of keys of a clip that had none

const char* NameOf(FaceMove move) { return move == FaceMove::kBlink ? "Blink" : "OpenMouth"; }

// One direction, and how far along it each vertex goes.
struct OneWay {
  Vec3 direction;  // unit
  float most = 0;  // of all vertices
};

float Along(const OneWay& way, Vec3 offset) { return std::max(0.0f, Dot(offset, way.direction)); }

double Squares(const FaceShape& shape) {
  double sum = 0;
  for (const auto& offsets : shape.offsets) {
    for (const Vec3 d : offsets) sum += static_cast<double>(Dot(d, d));
  }
  return sum;
}

// The direction that makes most of the movement, forwards only.
OneWay Fit(const FaceShape& shape) {
  OneWay way;
  for (const auto& offsets : shape.offsets) {
    for (const Vec3 d : offsets) way.direction = Length(d) > Length(way.direction) ? d : way.direction;
  }
  way.direction = Normalized(way.direction);
  for (int turn = 0; turn < 12; ++turn) {
    Vec3 next;
    for (const auto& offsets : shape.offsets) {
      for (const Vec3 d : offsets) next = next + d * Along(way, d);
    }
    if (!(Length(next) > 0)) return {};
    way.direction = Normalized(next);
  }
  for (const auto& offsets : shape.offsets) {
    for (const Vec3 d : offsets) way.most = std::max(way.most, Along(way, d));
  }
  return way;
}

// Of the same mesh, what a direction does not make.
FaceShape Rest(const OneWay& way, FaceShape shape) {
  for (auto& offsets : shape.offsets) {
    for (Vec3& d : offsets) d = d - way.direction * Along(way, d);
  }
  return shape;
}

// The fewest directions that make the movement, each of what the ones before leave. `share`: of it, that they make.
std::vector<OneWay> FitAll(const FaceShape& shape, float* share) {
  std::vector<OneWay> ways;
  const double whole = Squares(shape);
  FaceShape left = shape;
  for (*share = 0; ways.size() < kMostJoints && *share < kEnough;) {
    const OneWay way = Fit(left);
    left = Rest(way, std::move(left));
    const float now = whole > 0 ? static_cast<float>(1 - Squares(left) / whole) : 0;
    if (now < *share + kGain) break;
    ways.push_back(way);
    *share = now;
  }
  return ways;
}

// The joint that the moved vertices follow most.
int Carrier(const FaceShape& shape, const Avatar& avatar) {
  std::vector<float> moved(avatar.joints.size(), 0.0f);
  for (size_t m = 0; m < shape.offsets.size(); ++m) {
    for (size_t v = 0; v < shape.offsets[m].size(); ++v) {
      for (size_t i = 0; i < 4; ++i)
        moved[avatar.meshes[m].joints[v][i]] += avatar.meshes[m].weights[v][i] * Length(shape.offsets[m][v]);
    }
  }
  return static_cast<int>(std::max_element(moved.begin(), moved.end()) - moved.begin());
}

// Gives `joint` so much of a vertex, taken from `carrier`, with which it moves otherwise, and only then from the
// others.
void Give(float weight, uint16_t joint, uint16_t carrier, std::array<uint16_t, 4>* joints,
          std::array<float, 4>* weights) {
  std::array<std::pair<float, uint16_t>, 5> all{};
  float lacking = weight, left = 0;
  for (size_t i = 0; i < 4; ++i) {
    float own = (*weights)[i];
    if ((*joints)[i] == carrier) {
      const float taken = std::min(own, lacking);
      own -= taken, lacking -= taken;
    }
    all[i] = {own, (*joints)[i]};
    left += own;
  }
  for (size_t i = 0; i < 4 && left > 0; ++i) all[i].first *= (left - lacking) / left;
  all[4] = {weight, joint};
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  const float sum = all[0].first + all[1].first + all[2].first + all[3].first;
  for (size_t i = 0; i < 4; ++i) {
    (*weights)[i] = all[i].first / sum;
    (*joints)[i] = all[i].first > 0 ? all[i].second : uint16_t{0};
  }
}

// At the end of the joints, so that nobody's number changes.
int AppendJoint(const char* name, int parent, Vec3 end, Avatar* avatar) {
  const size_t before = avatar->joints.size();
  Joint joint;
  joint.name = name;
  joint.parent = parent;
  joint.inverse_bind = At(avatar->joints, parent).inverse_bind;
  joint.rest.translation = TransformDirection(joint.inverse_bind, end);
  avatar->joints.push_back(std::move(joint));
  for (Clip& clip : avatar->clips) {
    std::vector<Transform> wider;
    for (size_t i = 0; i < clip.transforms.size(); ++i) {
      wider.push_back(clip.transforms[i]);
      if (i % before == before - 1) wider.emplace_back();
    }
    clip.transforms = std::move(wider);
  }
  return static_cast<int>(before);
}

// With the vertices that go along that way.
int AddJoint(const OneWay& way, const FaceShape& shape, int carrier, Avatar* avatar) {
  const int joint = AppendJoint(NameOf(shape.move), carrier, way.direction * (way.most / kMostWeight), avatar);
  for (size_t m = 0; m < shape.offsets.size(); ++m) {
    Mesh& mesh = avatar->meshes[m];
    for (size_t v = 0; v < shape.offsets[m].size(); ++v) {
      const float weight = kMostWeight * Along(way, shape.offsets[m][v]) / way.most;
      if (weight < kLeastWeight) continue;
      Give(weight, static_cast<uint16_t>(joint), static_cast<uint16_t>(carrier), &mesh.joints[v], &mesh.weights[v]);
    }
  }
  return joint;
}

float HeightOf(const Avatar& avatar) {
  Vec3 low{1e30f, 1e30f, 1e30f}, high = low * -1;
  for (const Mesh& mesh : avatar.meshes) {
    for (const Vec3 p : mesh.positions) {
      low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
      high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z, 0.0f});
}

Transform* TransformsOf(int key, size_t joints, Clip* clip) {
  return clip->transforms.data() + static_cast<size_t>(key) * joints;
}

// How far closed an eye is, so long after it began to close.
float Lid(float s) {
  constexpr float kClosed_s = 0.05f, kOpens_s = 0.085f, kOpen_s = 0.17f;  // closed in one key at least
  if (s <= 0 || s >= kOpen_s) return 0;
  if (s < kClosed_s) return s / kClosed_s;
  return s < kOpens_s ? 1 : (kOpen_s - s) / (kOpen_s - kOpens_s);
}

using Random = std::minstd_rand;

float Between(float low, float high, Random* random) {
  return low + (high - low) * static_cast<float>((*random)() % 1000) / 1000;
}

// Irregular also across the loop's end.
std::vector<float> Blinks(float duration_s, Random* random) {
  std::vector<float> begins;
  for (float s = Between(0.3f, 1, random); s < duration_s - 1; s += Between(kLeastGap_s, kMostGap_s, random))
    begins.push_back(s);
  return begins;
}

struct Syllable {
  float begin_s, duration_s, opening;
};

// Words of two to five syllables, with breath between them.
std::vector<Syllable> Syllables(float duration_s, Random* random) {
  std::vector<Syllable> all;
  float s = Between(0.1f, 0.3f, random);
  while (true) {
    for (int k = static_cast<int>(Between(2, 6, random)); k > 0; --k) {
      const float length_s = Between(0.16f, 0.28f, random);
      if (s + length_s > duration_s) return all;
      all.push_back({s, length_s, Between(0.35f, 1, random)});
      s += length_s;
    }
    s += Between(0.15f, 0.5f, random);
  }
}

float Opening(const std::vector<Syllable>& syllables, float s) {
  for (const Syllable& each : syllables) {
    const float share = (s - each.begin_s) / each.duration_s;
    if (share > 0 && share < 1) return each.opening * (0.5f - 0.5f * std::cos(2 * kPi * share));
  }
  return 0;
}

// A second as another clip begins.
Clip Still(const Clip& clip, size_t joints) {
  Clip still{clip.name, 1, static_cast<int>(kRate_hz) + 1, {}};
  const auto end = clip.transforms.begin() + static_cast<std::ptrdiff_t>(joints);
  for (int k = 0; k < still.keys; ++k) still.transforms.insert(still.transforms.end(), clip.transforms.begin(), end);
  return still;
}

void Repeat(float about_s, size_t joints, Clip* clip) {
  const int times = std::max(1, static_cast<int>(std::lround(about_s / std::max(clip->duration_s, 0.1f))));
  const std::vector<Transform> once = clip->transforms;
  for (int k = 1; k < times; ++k)  // each begins with the key that the one before ends with
    clip->transforms.insert(clip->transforms.end(), once.begin() + static_cast<std::ptrdiff_t>(joints), once.end());
  clip->keys = 1 + times * (clip->keys - 1);
  clip->duration_s *= static_cast<float>(times);
}

void Play(const std::vector<FaceJoint>& face, const std::vector<Vec3>& ends, size_t joints, Random* random,
          Clip* clip) {
  const std::vector<float> blinks = Blinks(clip->duration_s, random);
  const std::vector<Syllable> syllables = Syllables(clip->duration_s, random);
  for (int key = 0; key < clip->keys; ++key) {
    const float s = TimeOf(*clip, key);
    float lid = 0;
    for (const float begin : blinks) lid = std::max(lid, Lid(s - begin));
    for (size_t f = 0; f < face.size(); ++f) {
      const bool speaks = face[f].move == FaceMove::kOpenMouth;
      const float amount = !speaks ? lid : clip->name == "talk" ? Opening(syllables, s) : 0;
      TransformsOf(key, joints, clip)[face[f].joint].translation = ends[f] * amount;
    }
  }
}

Clip* Find(const char* name, Avatar* avatar) {
  const auto found =
      std::find_if(avatar->clips.begin(), avatar->clips.end(), [&](const Clip& clip) { return clip.name == name; });
  return found == avatar->clips.end() ? nullptr : &*found;
}

std::string WhyNot(FaceMove move, float share, float most) {
  char text[200];
  const char* what = move == FaceMove::kBlink ? "closing the eyes" : "opening the mouth";
  if (most > kMost) {
    std::snprintf(text, sizeof text,
                  "its morph target for %s is left out: it moves vertices by %.0f %% of the figure's height", what,
                  100 * static_cast<double>(most));
  } else {
    std::snprintf(text, sizeof text, "its morph target for %s is left out: joints make only %.0f %% of it", what,
                  100 * static_cast<double>(share));
  }
  return text;
}

}  // namespace

std::vector<FaceJoint> AddFaceJoints(const std::vector<FaceShape>& shapes, Avatar* avatar,
                                     std::vector<std::string>* warnings) {
  std::vector<FaceJoint> face;
  const float height = HeightOf(*avatar);
  for (const FaceShape& shape : shapes) {
    const float most = Fit(shape).most / height;
    if (!(most > kLeast)) continue;
    float share = 0;
    const std::vector<OneWay> ways = FitAll(shape, &share);
    if (share < kLeastShare || most > kMost) {
      warnings->push_back(WhyNot(shape.move, share, most));
      continue;
    }
    const int carrier = Carrier(shape, *avatar);
    FaceShape left = shape;
    for (const OneWay& way : ways) {
      face.push_back({AddJoint(way, left, carrier, avatar), shape.move});
      left = Rest(way, std::move(left));
    }
  }
  return face;
}

void MoveFace(const std::vector<FaceJoint>& face, Avatar* avatar) {
  if (face.empty()) return;
  const size_t joints = avatar->joints.size();
  for (const auto& [name, otherwise] : {std::pair{"idle", "walk"}, {"talk", "idle"}}) {
    if (Find(name, avatar) != nullptr) continue;
    Clip like = *Find(otherwise, avatar);
    if (like.name == "walk") like = Still(like, joints);
    like.name = name;
    avatar->clips.push_back(std::move(like));
  }
  std::vector<Vec3> ends;
  for (const FaceJoint& each : face) {
    Transform& rest = At(avatar->joints, each.joint).rest;
    ends.push_back(rest.translation);
    rest.translation = {};
  }
  Random random(1);
  for (const char c : avatar->name) random.seed(31 * static_cast<unsigned>(random()) + static_cast<unsigned char>(c));
  for (const auto& [name, about_s] : {std::pair{"idle", kIdle_s}, {"talk", kTalk_s}}) {
    Clip* clip = Find(name, avatar);
    if (clip->keys < 3) *clip = Still(*clip, joints);
    Repeat(about_s, joints, clip);
    Play(face, ends, joints, &random, clip);
  }
}

}  // namespace flaneur
