#include "pipeline/io/clip_keys.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kLeastReach_m = 0.05f;
// Of the tolerance, that left out keys may miss before values are fitted: tried in turn.
constexpr float kSlacks[] = {2.0f, 1.7f, 1.4f, 1.2f, 1.0f};
constexpr size_t kHopeless = 12;  // spans in a row that miss too much: longer ones will, too
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

Vec4 Interpolated(const Track& track, Vec4 a, Vec4 b, float t) {
  if (track.Rotates()) {
    const Quat q = Slerp({a.x, a.y, a.z, a.w}, {b.x, b.y, b.z, b.w}, t);
    return {q.x, q.y, q.z, q.w};
  }
  return a * (1 - t) + b * t;
}

// The greatest misfit of keys between these two where they have the given values; ends early above
// `most`. From the middle outwards, where it is mostly greatest.
float SpanMisfit(const Track& track, size_t first, size_t last, Vec4 a, Vec4 b, float most) {
  float worst = 0;
  const size_t between = last - first - 1, middle = first + 1 + between / 2;
  for (size_t n = 0; n < between && worst <= most; ++n) {
    const size_t off = (n + 1) / 2;
    const size_t k = n % 2 == 0 ? middle + off : middle - off;
    if (k <= first || k >= last) continue;
    const float t = static_cast<float>(k - first) / static_cast<float>(last - first);
    worst = std::max(worst, Misfit(track, Interpolated(track, a, b, t), track.keys[k]));
  }
  return worst;
}

// The keys that may come next after each one, with the misfit of what they leave out.
struct Span {
  size_t last;
  float misfit;
};
using Spans = std::vector<std::vector<Span>>;

Spans SpansOf(const Track& track) {
  const size_t keys = track.keys.size();
  Spans spans(keys);
  for (size_t first = 0; first + 1 < keys; ++first) {
    size_t failed = 0;
    for (size_t last = first + 1; last < keys && failed < kHopeless; ++last) {
      const float misfit =
          SpanMisfit(track, first, last, track.keys[first], track.keys[last], kSlacks[0]);
      failed = misfit > kSlacks[0] ? failed + 1 : 0;
      if (failed == 0) spans[first].push_back({last, misfit});
    }
  }
  return spans;
}

// Spans that serve both.
Spans Common(const Spans& a, const Spans& b) {
  Spans common(a.size());
  for (size_t k = 0; k < a.size(); ++k) {
    for (size_t i = 0, j = 0; i < a[k].size() && j < b[k].size();) {
      if (a[k][i].last == b[k][j].last) {
        common[k].push_back({a[k][i].last, std::max(a[k][i].misfit, b[k][j].misfit)});
        ++i, ++j;
      } else {
        a[k][i].last < b[k][j].last ? ++i : ++j;
      }
    }
  }
  return common;
}

// As few keys as spans of so much misfit allow.
std::vector<bool> FewestKeys(const Spans& spans, float slack) {
  const size_t keys = spans.size();
  std::vector<size_t> count(keys, SIZE_MAX), before(keys, 0);
  count[0] = 1;
  for (size_t k = 0; k < keys; ++k) {
    for (const Span& span : spans[k]) {
      if (span.misfit > slack || count[k] + 1 >= count[span.last]) continue;
      count[span.last] = count[k] + 1;
      before[span.last] = k;
    }
  }
  std::vector<bool> keep(keys, false);
  for (size_t k = keys - 1; k > 0; k = before[k]) keep[k] = true;
  keep[0] = true;
  return keep;
}

std::vector<size_t> Kept(const std::vector<bool>& keep) {
  std::vector<size_t> kept;
  for (size_t k = 0; k < keep.size(); ++k) {
    if (keep[k]) kept.push_back(k);
  }
  return kept;
}

// Values of the kept keys by least squares over all keys; the ends, where a clip loops, keep
// theirs.
std::vector<Vec4> FittedValues(const Track& track, const std::vector<size_t>& kept) {
  const size_t count = kept.size();
  std::vector<float> diagonal(count, 0), beside(count, 0);  // of the normal equations
  std::vector<Vec4> right(count), values(count);
  for (size_t i = 0; i + 1 < count; ++i) {
    for (size_t k = kept[i]; k < kept[i + 1]; ++k) {
      const float t = static_cast<float>(k - kept[i]) / static_cast<float>(kept[i + 1] - kept[i]);
      diagonal[i] += (1 - t) * (1 - t);
      diagonal[i + 1] += t * t;
      beside[i] += t * (1 - t);
      right[i] = right[i] + track.keys[k] * (1 - t);
      right[i + 1] = right[i + 1] + track.keys[k] * t;
    }
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
    if (!track.Rotates()) continue;
    const Vec4 v = values[i];
    values[i] = v * (1 / std::sqrt(Dot(v, v)));
  }
  return values;
}

// The kept keys' values: fitted where that tolerates the rest, their own where only that does; none
// where neither.
std::vector<Vec4> ValuesAt(const Track& track, const std::vector<size_t>& kept) {
  std::vector<Vec4> own;
  for (const size_t k : kept) own.push_back(track.keys[k]);
  for (const std::vector<Vec4>& values : {FittedValues(track, kept), own}) {
    bool fits = true;
    for (size_t i = 0; i < kept.size() && fits; ++i) {
      fits = Misfit(track, values[i], track.keys[kept[i]]) <= 1;
      if (!fits || i + 1 == kept.size()) continue;
      fits = SpanMisfit(track, kept[i], kept[i + 1], values[i], values[i + 1], 1) <= 1;
    }
    if (fits) return values;
  }
  return {};
}

// The keys to keep for all these tracks, whose spans these are.
std::vector<bool> KeptKeys(std::span<const Track* const> tracks, const Spans& spans) {
  for (const float slack : kSlacks) {
    const std::vector<bool> keep = FewestKeys(spans, slack);
    const std::vector<size_t> kept = Kept(keep);
    if (std::all_of(tracks.begin(), tracks.end(),
                    [&](const Track* track) { return !ValuesAt(*track, kept).empty(); })) {
      return keep;
    }
  }
  return FewestKeys(spans, 1);
}

size_t Count(const std::vector<bool>& keep) {
  return static_cast<size_t>(std::count(keep.begin(), keep.end(), true));
}

size_t KeyBytes(const Track& track) { return track.Rotates() ? kRotationBytes : kVectorBytes; }

void Fill(const Clip& clip, const std::vector<bool>& keep, Track* track) {
  const size_t keys = track->keys.size();
  const std::vector<size_t> kept = Kept(keep);
  for (const size_t k : kept) {
    const float share = keys > 1 ? static_cast<float>(k) / static_cast<float>(keys - 1) : 0.0f;
    track->channel.times.push_back(share * clip.duration_s);
  }
  track->channel.values = ValuesAt(*track, kept);
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
  std::vector<Spans> spans;
  std::vector<std::vector<bool>> own;
  for (const Track& track : tracks) {
    const Track* alone = &track;
    spans.push_back(SpansOf(track));
    own.push_back(KeptKeys({&alone, 1}, spans.back()));
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
  std::vector<bool> best;
  Spans common;
  for (const size_t i : order) {
    common = together.empty() ? spans[i] : Common(common, spans[i]);
    together.push_back(&tracks[i]);
    const std::vector<bool> shared = KeptKeys(together, common);
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
