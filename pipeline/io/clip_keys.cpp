#include "pipeline/io/clip_keys.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kLeastReach_m = 0.05f;
constexpr size_t kRotationBytes = 8, kVectorBytes = 12, kTimeBytes = 4;  // of a key, as written

// All keys of one channel; an error of 1 is just tolerated.
struct Track {
  KeyChannel channel;
  float unit = 1;  // errors per unit of difference
  std::vector<Vec4> keys;
  bool Rotates() const { return channel.path == "rotation"; }
};

Vec4 Value(const Transform& t, const std::string& path) {
  if (path == "rotation") return {t.rotation.x, t.rotation.y, t.rotation.z, t.rotation.w};
  const Vec3 v = path == "translation" ? t.translation : t.scale;
  return {v.x, v.y, v.z, 0};
}

float Dot(Vec4 a, Vec4 b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }
Vec4 operator-(Vec4 a, Vec4 b) { return {a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w}; }
Vec4 operator-(Vec4 a) { return {-a.x, -a.y, -a.z, -a.w}; }

float Misfit(const Track& track, Vec4 a, Vec4 b) {
  // Half the angle of a small rotation is the distance between quaternions of one sign.
  const Vec4 d = track.Rotates() && Dot(a, b) < 0 ? a - (-b) : a - b;
  return track.unit * std::sqrt(Dot(d, d));
}

Track MakeTrack(const Clip& clip, size_t joint, size_t joints, const char* path, float reach_m,
                float error_m) {
  Track track;
  track.channel.joint = joint;
  track.channel.path = path;
  track.unit = 1 / error_m;
  if (track.Rotates()) track.unit = 2 * reach_m / error_m;
  if (track.channel.path == "scale") track.unit = reach_m / error_m;
  for (size_t k = 0; k < static_cast<size_t>(clip.keys); ++k) {
    Vec4 key = Value(clip.transforms[k * joints + joint], path);
    // The shorter way round, also for players that interpolate by component.
    if (track.Rotates() && k > 0 && Dot(key, track.keys.back()) < 0) key = -key;
    track.keys.push_back(key);
  }
  return track;
}

Vec4 Interpolated(const Track& track, size_t first, size_t last, size_t k) {
  const float t = static_cast<float>(k - first) / static_cast<float>(last - first);
  const Vec4 a = track.keys[first], b = track.keys[last];
  if (track.Rotates()) {
    const Quat q = Slerp({a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w}, t);
    return {q.x, q.y, q.z, q.w};
  }
  return {a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, a.z + (b.z - a.z) * t, 0};
}

// The keys to keep for all these tracks: the greatest misfit splits a run, as Ramer, Douglas and
// Peucker do for lines.
void KeepKeys(std::span<const Track* const> tracks, size_t first, size_t last,
              std::vector<bool>* keep) {
  (*keep)[first] = (*keep)[last] = true;
  float worst = 1;
  size_t split = 0;
  for (const Track* track : tracks) {
    for (size_t k = first + 1; k < last; ++k) {
      const float misfit = Misfit(*track, Interpolated(*track, first, last, k), track->keys[k]);
      if (misfit <= worst) continue;
      worst = misfit;
      split = k;
    }
  }
  if (split == 0) return;
  KeepKeys(tracks, first, split, keep);
  KeepKeys(tracks, split, last, keep);
}

std::vector<bool> KeptKeys(std::span<const Track* const> tracks) {
  const size_t keys = tracks[0]->keys.size();
  std::vector<bool> keep(keys, false);
  KeepKeys(tracks, 0, keys - 1, &keep);
  return keep;
}

size_t Count(const std::vector<bool>& keep) {
  return static_cast<size_t>(std::count(keep.begin(), keep.end(), true));
}

size_t KeyBytes(const Track& track) { return track.Rotates() ? kRotationBytes : kVectorBytes; }

void Fill(const Clip& clip, const std::vector<bool>& keep, Track* track) {
  const size_t keys = track->keys.size();
  for (size_t k = 0; k < keys; ++k) {
    if (!keep[k]) continue;
    const float share = keys > 1 ? static_cast<float>(k) / static_cast<float>(keys - 1) : 0.0f;
    track->channel.times.push_back(share * clip.duration_s);
    track->channel.values.push_back(track->keys[k]);
  }
}

bool Moves(const Track& track, const Transform& rest) {
  const Vec4 still = Value(rest, track.channel.path);
  return std::any_of(track.keys.begin(), track.keys.end(),
                     [&](Vec4 key) { return Misfit(track, key, still) > 0.5f; });
}

}  // namespace

std::vector<float> JointReaches(std::span<const Joint> joints, std::span<const Mesh> meshes) {
  std::vector<Vec3> pivots;
  for (const Joint& joint : joints) {
    pivots.push_back(TransformPoint(Inverse(joint.inverse_bind), {}));
  }
  std::vector<float> reaches(pivots.size(), kLeastReach_m);
  for (const Mesh& mesh : meshes) {
    for (size_t v = 0; v < mesh.joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        if (!(mesh.weights[v][i] > 0)) continue;
        for (int j = mesh.joints[v][i]; j >= 0; j = joints[static_cast<size_t>(j)].parent) {
          float& reach = reaches[static_cast<size_t>(j)];
          reach = std::max(reach, Length(mesh.positions[v] - pivots[static_cast<size_t>(j)]));
        }
      }
    }
  }
  return reaches;
}

std::vector<KeyChannel> ReduceKeys(const Clip& clip, std::span<const Joint> joints,
                                   std::span<const float> reaches_m, float error_m) {
  std::vector<Track> tracks;
  for (size_t j = 0; j < joints.size(); ++j) {
    for (const char* path : {"translation", "rotation", "scale"}) {
      Track track = MakeTrack(clip, j, joints.size(), path, reaches_m[j], error_m);
      if (Moves(track, joints[j].rest)) tracks.push_back(std::move(track));
    }
  }
  std::vector<std::vector<bool>> own;
  for (const Track& track : tracks) {
    const Track* alone = &track;
    own.push_back(KeptKeys({&alone, 1}));
  }
  // Those that need the most keys share their times; how many do is what takes the fewest bytes.
  std::vector<size_t> order(tracks.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return Count(own[a]) > Count(own[b]); });
  const auto alone_bytes = [&](size_t i) {
    return Count(own[i]) * (KeyBytes(tracks[i]) + kTimeBytes);
  };
  size_t rest = 0, values = 0, sharing = 0, least = SIZE_MAX;
  for (size_t i = 0; i < tracks.size(); ++i) rest += alone_bytes(i);
  least = rest;
  std::vector<const Track*> together;
  std::vector<bool> shared, best;
  for (const size_t i : order) {
    together.push_back(&tracks[i]);
    shared = KeptKeys(together);
    rest -= alone_bytes(i);
    values += KeyBytes(tracks[i]);
    const size_t bytes = rest + Count(shared) * (values + kTimeBytes);
    if (bytes >= least) continue;
    least = bytes;
    sharing = together.size();
    best = shared;
  }
  std::vector<KeyChannel> channels;
  for (size_t n = 0; n < order.size(); ++n) {
    Fill(clip, n < sharing ? best : own[order[n]], &tracks[order[n]]);
  }
  for (Track& track : tracks) channels.push_back(std::move(track.channel));
  return channels;
}

}  // namespace flaneur
