#include "pipeline/io/gltf_pose.h"

#include <algorithm>
#include <cmath>

#include "pipeline/core/rotation.h"
#include "runtime/base/array.h"

namespace flaneur {
namespace {

Vec4 Mix(Vec4 a, float wa, Vec4 b, float wb) {
  return {a.x * wa + b.x * wb, a.y * wa + b.y * wb, a.z * wa + b.z * wb, a.w * wa + b.w * wb};
}

Quat ToQuat(Vec4 v) { return {v.x, v.y, v.z, v.w}; }
Vec4 ToVec4(Quat q) { return {q.x, q.y, q.z, q.w}; }

// Hermite spline between key k and the next, as glTF's appendix on interpolation has it.
Vec4 Cubic(const DocumentChannel& channel, size_t k, float t, float interval_s) {
  const float t2 = t * t, t3 = t2 * t;
  const Vec4* v = channel.values.data() + 3 * k;
  const Vec4 ends = Mix(v[1], 2 * t3 - 3 * t2 + 1, v[4], 3 * t2 - 2 * t3);
  const Vec4 slopes = Mix(v[2], (t3 - 2 * t2 + t) * interval_s, v[3], (t3 - t2) * interval_s);
  return Mix(ends, 1, slopes, 1);
}

Vec4 Sample(const DocumentChannel& channel, float time_s) {
  const auto& times = channel.times;
  const bool cubic = channel.interpolation == Interpolation::kCubic;
  const auto value = [&](size_t k) { return channel.values[cubic ? 3 * k + 1 : k]; };
  const auto next = std::upper_bound(times.begin(), times.end(), time_s);
  if (next == times.begin()) return value(0);
  const size_t k = static_cast<size_t>(next - times.begin()) - 1;
  if (next == times.end() || channel.interpolation == Interpolation::kStep) return value(k);
  const float interval_s = times[k + 1] - times[k];
  const float t = (time_s - times[k]) / interval_s;
  if (cubic) return Cubic(channel, k, t, interval_s);
  if (channel.path == ChannelPath::kRotation) {
    return ToVec4(Slerp(Normalized(ToQuat(value(k))), Normalized(ToQuat(value(k + 1))), t));
  }
  return Mix(value(k), 1 - t, value(k + 1), t);
}

void Apply(const DocumentChannel& channel, float time_s, DocumentNode* node) {
  if (node->has_matrix) {
    const Transform t = Decomposed(node->matrix);
    node->translation = t.translation;
    node->rotation = t.rotation;
    node->scale = t.scale;
    node->has_matrix = false;
  }
  const Vec4 v = Sample(channel, time_s);
  switch (channel.path) {
    case ChannelPath::kTranslation:
      node->translation = {v.x, v.y, v.z};
      break;
    case ChannelPath::kRotation:
      node->rotation = Normalized(ToQuat(v));
      break;
    case ChannelPath::kScale:
      node->scale = {v.x, v.y, v.z};
      break;
  }
}

}  // namespace

ClipSpan SpanOf(const DocumentClip& clip) {
  ClipSpan span;
  for (size_t i = 0; i < clip.channels.size(); ++i) {
    const auto& times = clip.channels[i].times;
    span.start_s = i == 0 ? times.front() : std::min(span.start_s, times.front());
    span.end_s = i == 0 ? times.back() : std::max(span.end_s, times.back());
  }
  return span;
}

std::vector<Mat4> PoseAt(const GltfDocument& document, const DocumentClip& clip, float time_s) {
  std::vector<Mat4> world(document.nodes.size());
  std::vector<Mat4> local(document.nodes.size());
  std::vector<int> moved_of(document.nodes.size(), -1);
  std::vector<DocumentNode> moved;
  for (const DocumentChannel& channel : clip.channels) {
    int& index = At(moved_of, channel.node);
    if (index < 0) {
      index = Count(moved);
      moved.push_back(At(document.nodes, channel.node));
    }
    Apply(channel, time_s, &At(moved, index));
  }
  for (size_t i = 0; i < local.size(); ++i)
    local[i] = LocalMatrix(moved_of[i] < 0 ? document.nodes[i] : At(moved, moved_of[i]));
  for (const int i : document.order) {
    const int parent = At(document.nodes, i).parent;
    const size_t n = static_cast<size_t>(i);
    world[n] = parent < 0 ? local[n] : At(world, parent) * local[n];
  }
  return world;
}

Transform Decomposed(const Mat4& matrix) {
  const auto column = [&](size_t c) { return Vec3{matrix.m[c][0], matrix.m[c][1], matrix.m[c][2]}; };
  Vec3 x = column(0), y = column(1), z = column(2);
  Transform out;
  out.translation = column(3);
  out.scale = {Length(x), Length(y), Length(z)};
  if (Dot(Cross(x, y), z) < 0) out.scale.x = -out.scale.x;
  if (out.scale.x == 0 || out.scale.y == 0 || out.scale.z == 0) return out;
  x = Normalized(x * (1 / out.scale.x));
  y = Normalized(y - x * Dot(x, y));
  z = Cross(x, y);
  out.rotation = Normalized(QuatFromBasis(x, y, z));
  return out;
}

}  // namespace flaneur
