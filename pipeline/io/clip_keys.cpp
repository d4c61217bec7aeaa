#include "pipeline/io/clip_keys.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "pipeline/io/meshopt_codec.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kMinReach_m = 0.05f;
constexpr int kMinBits = 4, kMaxBits = 16;  // that the filter allows a rotation's component
// Of the tolerance, what keys left out of all channels at once may miss before values are fitted.
constexpr float kSharedMisfits[] = {0.7f, 1.5f, 3.0f};
constexpr int kMaxFiner = 8;  // halvings of a vector's step, from one that may do
// Together channels err by about three times what each of them may: tried in turn, by how much the
// first guess missed.
constexpr int kTrials = 5;
constexpr float kNearEnough = 0.93f;      // of the tolerance
constexpr size_t kWatchedVertices = 400;  // a mesh, and those farthest from a joint

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
Vec4 operator-(Vec4 a) { return {-a.x, -a.y, -a.z, -a.w}; }
Vec4 UnitLength(Vec4 v) { return v * (1 / std::sqrt(Dot(v, v))); }

float Misfit(const Track& track, Vec4 a, Vec4 b) {
  // Half the angle of a small rotation is the distance between quaternions of one sign.
  const Vec4 d = track.Rotates() && Dot(a, b) < 0 ? a - (-b) : a - b;
  return track.unit * std::sqrt(Dot(d, d));
}

Track MakeTrack(const Clip& clip, size_t joint, size_t joints, const char* path, float reach_m, float error_m) {
  Track track;
  track.channel.joint = joint;
  track.channel.path = path;
  const bool moves_itself = track.channel.path == "translation";
  const float reach = track.Rotates() ? 2 * reach_m : moves_itself ? 1 : reach_m;
  track.unit = error_m > 0 ? reach / error_m : 1e9f;
  for (size_t k = 0; k < static_cast<size_t>(clip.keys); ++k) {
    Vec4 key = Value(clip.transforms[k * joints + joint], path);
    // The shorter way round, also for players that interpolate by component.
    if (track.Rotates() && k > 0 && Dot(key, track.keys.back()) < 0) key = -key;
    track.keys.push_back(key);
  }
  return track;
}

Vec4 Interpolated(bool rotates, Vec4 a, Vec4 b, float t) {
  if (!rotates) return a * (1 - t) + b * t;
  const Quat q = Slerp({a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w}, t);
  return {q.x, q.y, q.z, q.w};
}

// Where keys are, in the source's keys: from 0 to its last, rising; just 0 for what stands still.
using Knots = std::vector<float>;

// A source key's place between two knots.
struct Place {
  size_t before;
  float share;
};

Place PlaceOf(size_t key, const Knots& knots) {
  const auto at = static_cast<float>(key);
  const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, at);
  const auto i = static_cast<size_t>(after - knots.begin());
  return {i - 1, (at - knots[i - 1]) / (knots[i] - knots[i - 1])};
}

Vec4 ValueAt(const std::vector<Vec4>& values, bool rotates, size_t key, const Knots& knots) {
  if (values.size() == 1) return values[0];
  const Place place = PlaceOf(key, knots);
  return Interpolated(rotates, values[place.before], values[place.before + 1], place.share);
}

// The greatest misfit of the source's keys; ends early where it is not tolerated.
float WorstMisfit(const Track& track, const std::vector<Vec4>& values, const Knots& knots) {
  float worst = 0;
  for (size_t k = 0; k < track.keys.size() && worst <= 1; ++k) {
    const Vec4 value = ValueAt(values, track.Rotates(), k, knots);
    worst = std::max(worst, Misfit(track, value, track.keys[k]));
  }
  return worst;
}

// Whether the keys between these two are off by at most so much.
bool SpanFits(const Track& track, size_t first, size_t last, float most) {
  for (size_t k = first + 1; k < last; ++k) {
    const float t = static_cast<float>(k - first) / static_cast<float>(last - first);
    const Vec4 value = Interpolated(track.Rotates(), track.keys[first], track.keys[last], t);
    if (Misfit(track, value, track.keys[k]) > most) return false;
  }
  return true;
}

// One value for a channel that stands still.
Vec4 Middle(const Track& track) {
  Vec4 low = track.keys[0], high = low;
  for (const Vec4& key : track.keys) {
    for (size_t c = 0; c < 4; ++c) {
      (&low.x)[c] = std::min((&low.x)[c], (&key.x)[c]);
      (&high.x)[c] = std::max((&high.x)[c], (&key.x)[c]);
    }
  }
  const Vec4 middle = (low + high) * 0.5f;
  return track.Rotates() && Dot(middle, middle) > 0 ? UnitLength(middle) : middle;
}

// Values at the knots by least squares over the source's keys; the ends, where a clip loops, keep
// theirs.
std::vector<Vec4> FittedValues(const Track& track, const Knots& knots) {
  if (knots.size() == 1) return {Middle(track)};
  if (knots.size() == track.keys.size()) return track.keys;
  const size_t count = knots.size();
  std::vector<float> diagonal(count, 1e-6f), beside(count, 0);  // of the normal equations
  std::vector<Vec4> right(count), values(count);
  for (size_t k = 0; k < track.keys.size(); ++k) {
    const auto [i, t] = PlaceOf(k, knots);
    diagonal[i] += (1 - t) * (1 - t);
    diagonal[i + 1] += t * t;
    beside[i] += t * (1 - t);
    right[i] = right[i] + track.keys[k] * (1 - t);
    right[i + 1] = right[i + 1] + track.keys[k] * t;
  }
  values[0] = track.keys.front();
  values[count - 1] = track.keys.back();
  if (count < 3) return values;
  right[1] = right[1] - values[0] * beside[0];
  right[count - 2] = right[count - 2] - values[count - 1] * beside[count - 2];
  for (size_t i = 2; i + 1 < count; ++i) {
    const float share = beside[i - 1] / diagonal[i - 1];
    diagonal[i] -= share * beside[i - 1];
    right[i] = right[i] - right[i - 1] * share;
  }
  for (size_t i = count - 2; i > 0; --i) {
    const Vec4 next = i + 2 < count ? values[i + 1] * beside[i] : Vec4{};
    values[i] = (right[i] - next) * (1 / diagonal[i]);
    if (track.Rotates() && Dot(values[i], values[i]) > 0) values[i] = UnitLength(values[i]);
  }
  return values;
}

template <typename T>
void Append(const T& value, std::vector<uint8_t>* bytes) {
  const size_t at = bytes->size();
  bytes->resize(at + sizeof value);
  std::memcpy(bytes->data() + at, &value, sizeof value);
}

void RoundRotations(const std::vector<Vec4>& values, int bits, KeyChannel* channel) {
  for (const Vec4& value : values) {
    const auto rounded = FilteredRotation(value, bits);
    Append(rounded, &channel->rounded);
    channel->values.push_back(Unfiltered(rounded));
    Vec4& back = channel->values.back();
    if (channel->values.size() > 1 && Dot(back, channel->values.end()[-2]) < 0) back = -back;
  }
}

void RoundVectors(const std::vector<Vec4>& values, int exponent, KeyChannel* channel) {
  for (const Vec4& value : values) {
    Vec4 back;
    for (size_t c = 0; c < 3; ++c) {
      const uint32_t rounded = FilteredNumber((&value.x)[c], exponent);
      Append(rounded, &channel->rounded);
      (&back.x)[c] = Unfiltered(rounded);
    }
    channel->values.push_back(back);
  }
}

// With as few bits as are tolerated; false where no number of bits is.
bool RoundTo(const std::vector<Vec4>& values, const Knots& knots, Track* track) {
  const int coarsest = static_cast<int>(std::floor(std::log2(2 / track->unit)));
  const int trials = track->Rotates() ? kMaxBits - kMinBits + 1 : kMaxFiner;
  for (int i = 0; i < trials; ++i) {
    track->channel.values.clear();
    track->channel.rounded.clear();
    if (track->Rotates()) {
      RoundRotations(values, kMinBits + i, &track->channel);
    } else {
      RoundVectors(values, coarsest - i, &track->channel);
    }
    if (WorstMisfit(*track, track->channel.values, knots) <= 1) return true;
  }
  return false;
}

// As few of the source's keys as leave no track's others off by more than `most`.
Knots SharedKnots(const std::vector<Track>& tracks, size_t last, float most) {
  Knots knots{0};
  for (size_t first = 0, next = 1; first < last; first = next) {
    next = first + 1;
    const auto fits = [&](const Track& track) { return SpanFits(track, first, next + 1, most); };
    while (next < last && std::all_of(tracks.begin(), tracks.end(), fits)) ++next;
    knots.push_back(static_cast<float>(next));
  }
  return knots;
}

// Those to try, few to many: evenly spaced, in whole shares of the source's keys where they divide,
// and where the clip's tracks bend.
std::vector<Knots> KnotsToTry(const std::vector<Track>& tracks, size_t last) {
  std::vector<Knots> all{{0}};
  for (size_t share = 1; share <= last; share = share < 3        ? share + 1
                                                : share % 3 == 0 ? share / 3 * 4
                                                                 : share / 2 * 3) {
    const size_t intervals = (last + share - 1) / share;
    Knots& knots = all.emplace_back();
    for (size_t k = 0; k <= intervals; ++k) {
      knots.push_back(static_cast<float>(k * last) / static_cast<float>(intervals));
    }
  }
  if (last > 1) {
    for (const float most : kSharedMisfits) all.push_back(SharedKnots(tracks, last, most));
  }
  std::stable_sort(all.begin(), all.end(), [](const Knots& a, const Knots& b) { return a.size() < b.size(); });
  return all;
}

void ChooseKeys(const Clip& clip, const std::vector<Knots>& all, Track* track) {
  KeyChannel& channel = track->channel;
  for (const Knots& knots : all) {
    const std::vector<Vec4> values = FittedValues(*track, knots);
    const bool whole = knots.size() == track->keys.size();
    if (!whole && WorstMisfit(*track, values, knots) > 1) continue;
    if (!RoundTo(values, knots, track)) {
      if (!whole) continue;
      channel.rounded.clear();
      channel.values = values;
    }
    channel.knots = knots;
    break;
  }
  const auto last = static_cast<float>(std::max(clip.keys - 1, 1));
  for (const float knot : channel.knots) channel.times.push_back(clip.duration_s * (knot / last));
}

bool Moves(const Track& track, const Transform& rest) {
  const Vec4 still = Value(rest, track.channel.path);
  return std::any_of(track.keys.begin(), track.keys.end(), [&](Vec4 key) { return Misfit(track, key, still) > 0.5f; });
}

std::vector<Track> MovingTracks(const Clip& clip, std::span<const Joint> joints, std::span<const float> reaches_m,
                                float error_m) {
  std::vector<Track> tracks;
  for (size_t j = 0; j < joints.size(); ++j) {
    for (const char* path : {"translation", "rotation", "scale"}) {
      Track track = MakeTrack(clip, j, joints.size(), path, reaches_m[j], error_m);
      if (Moves(track, joints[j].rest)) tracks.push_back(std::move(track));
    }
  }
  return tracks;
}

// A clip in which nothing moves is still as long as it is.
void HoldStill(const Clip& clip, KeyChannel* channel) {
  if (clip.keys < 2) return;
  channel->knots.push_back(static_cast<float>(clip.keys - 1));
  channel->times.push_back(clip.duration_s);
  channel->values.push_back(channel->values[0]);
  const std::vector<uint8_t> again = channel->rounded;
  channel->rounded.insert(channel->rounded.end(), again.begin(), again.end());
}

// A vertex by which the error of all channels together is told.
struct Watched {
  Vec3 position;
  std::array<uint16_t, 4> joints{};
  std::array<float, 4> weights{};
};

std::vector<Watched> VerticesToWatch(std::span<const Joint> joints, std::span<const Mesh> meshes) {
  std::vector<Watched> watched, farthest(joints.size());
  std::vector<float> reach(joints.size(), -1);
  for (const Mesh& mesh : meshes) {
    const size_t step = mesh.joints.size() / kWatchedVertices + 1;
    for (size_t v = 0; v < mesh.joints.size(); ++v) {
      const Watched vertex{mesh.positions[v], mesh.joints[v], mesh.weights[v]};
      if (v % step == 0) watched.push_back(vertex);
      for (size_t i = 0; i < 4; ++i) {
        if (!(vertex.weights[i] > 0)) continue;
        const size_t j = vertex.joints[i];
        const float far = Length(TransformPoint(joints[j].inverse_bind, vertex.position));
        if (far <= reach[j]) continue;
        reach[j] = far;
        farthest[j] = vertex;
      }
    }
  }
  for (size_t j = 0; j < joints.size(); ++j) {
    if (reach[j] >= 0) watched.push_back(farthest[j]);
  }
  return watched;
}

// The clip's key as the channels leave it.
std::vector<Transform> Restored(std::span<const Joint> joints, const std::vector<KeyChannel>& channels, size_t key) {
  std::vector<Transform> out;
  for (const Joint& joint : joints) out.push_back(joint.rest);
  for (const KeyChannel& channel : channels) {
    const bool rotates = channel.path == "rotation";
    const Vec4 v = ValueAt(channel.values, rotates, key, channel.knots);
    Transform& t = out[channel.joint];
    if (rotates) t.rotation = {v.x, v.y, v.z, v.w};
    if (channel.path == "translation") t.translation = {v.x, v.y, v.z};
    if (channel.path == "scale") t.scale = {v.x, v.y, v.z};
  }
  return out;
}

float WorstMoved(const Clip& clip, std::span<const Joint> joints, const std::vector<KeyChannel>& channels,
                 const std::vector<Watched>& watched) {
  float worst = 0;
  for (size_t k = 0; k < static_cast<size_t>(clip.keys); ++k) {
    const auto wanted = SkinningMatrices(joints, std::span(clip.transforms).subspan(k * joints.size(), joints.size()));
    const auto is = SkinningMatrices(joints, Restored(joints, channels, k));
    for (const Watched& vertex : watched) {
      Vec3 off;
      for (size_t i = 0; i < 4; ++i) {
        if (!(vertex.weights[i] > 0)) continue;
        const size_t j = vertex.joints[i];
        off = off +
              (TransformPoint(wanted[j], vertex.position) - TransformPoint(is[j], vertex.position)) * vertex.weights[i];
      }
      worst = std::max(worst, Length(off));
    }
  }
  return worst;
}

size_t RoundedBytes(const std::vector<KeyChannel>& channels) {
  std::vector<uint8_t> rotations, vectors;
  size_t exact = 0;
  for (const KeyChannel& channel : channels) {
    std::vector<uint8_t>& all = channel.path == "rotation" ? rotations : vectors;
    all.insert(all.end(), channel.rounded.begin(), channel.rounded.end());
    if (channel.rounded.empty()) exact += channel.values.size() * sizeof(Vec4);
  }
  return EncodeMeshopt(rotations, 8).size() + EncodeMeshopt(vectors, 12).size() + exact;
}

}  // namespace

std::vector<float> JointReaches(std::span<const Joint> joints, std::span<const Mesh> meshes) {
  std::vector<Vec3> pivots;
  for (const Joint& joint : joints) {
    pivots.push_back(TransformPoint(Inverse(joint.inverse_bind), {}));
  }
  std::vector<float> reaches(pivots.size(), kMinReach_m);
  for (const Mesh& mesh : meshes) {
    for (size_t v = 0; v < mesh.joints.size(); ++v) {
      for (size_t i = 0; i < 4; ++i) {
        if (!(mesh.weights[v][i] > 0)) continue;
        for (int j = mesh.joints[v][i]; j >= 0; j = At(joints, j).parent) {
          float& reach = At(reaches, j);
          reach = std::max(reach, Length(mesh.positions[v] - At(pivots, j)));
        }
      }
    }
  }
  return reaches;
}

std::vector<KeyChannel> AllKeys(const Clip& clip, std::span<const Joint> joints) {
  std::vector<KeyChannel> channels;
  for (Track& track : MovingTracks(clip, joints, std::vector<float>(joints.size()), 0)) {
    for (size_t k = 0; k < track.keys.size(); ++k) {
      const float last = static_cast<float>(std::max(clip.keys - 1, 1));
      track.channel.knots.push_back(static_cast<float>(k));
      track.channel.times.push_back(clip.duration_s * (static_cast<float>(k) / last));
    }
    track.channel.values = track.keys;
    channels.push_back(std::move(track.channel));
  }
  return channels;
}

std::vector<KeyChannel> ReduceKeys(const Clip& clip, std::span<const Joint> joints, std::span<const float> reaches_m,
                                   float error_m) {
  std::vector<Track> tracks = MovingTracks(clip, joints, reaches_m, error_m);
  const std::vector<Knots> knots = KnotsToTry(tracks, static_cast<size_t>(clip.keys) - 1);
  std::vector<KeyChannel> channels;
  bool moves = false;
  for (Track& track : tracks) {
    ChooseKeys(clip, knots, &track);
    moves = moves || track.channel.times.size() > 1;
    channels.push_back(std::move(track.channel));
  }
  if (!moves && !channels.empty()) HoldStill(clip, &channels[0]);
  return channels;
}

std::vector<KeyChannel> ReduceKeysTogether(const Clip& clip, std::span<const Joint> joints,
                                           std::span<const Mesh> meshes, float error_m) {
  const std::vector<float> reaches_m = JointReaches(joints, meshes);
  const std::vector<Watched> watched = VerticesToWatch(joints, meshes);
  float channel_error_m = error_m / 3, least_m = 1e30f;
  size_t least_bytes = SIZE_MAX;
  std::vector<KeyChannel> best;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<KeyChannel> channels = ReduceKeys(clip, joints, reaches_m, channel_error_m);
    const float worst_m = WorstMoved(clip, joints, channels, watched);
    const size_t bytes = worst_m <= error_m ? RoundedBytes(channels) : SIZE_MAX;
    if (bytes < least_bytes || (bytes == least_bytes && worst_m < least_m)) {
      least_bytes = bytes;
      least_m = worst_m;
      best = std::move(channels);
    }
    if (!(worst_m > 0) || (worst_m <= error_m && worst_m >= kNearEnough * error_m)) break;
    channel_error_m *= std::clamp(0.97f * error_m / worst_m, 0.3f, 3.0f);
  }
  return best;
}

}  // namespace flaneur
