#include "runtime/render/people_batches.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace flaneur {
namespace {

constexpr float kSunDistance_m = 500;
constexpr float kMeshShadow_m = 20;  // nearer impostors cast their coarsest mesh's shadow: it does not change when they do

ClipRows RowsOf(const PackClip& clip) {
  ClipRows out;
  out.frames = std::max(1, clip.frames);
  for (const Mat4& m : clip.matrices) {
    for (size_t r = 0; r < 3; ++r) out.rows.push_back({m.m[0][r], m.m[1][r], m.m[2][r], m.m[3][r]});
  }
  return out;
}

void AddScaled(const Vec4* from, float scale, size_t count, Vec4* to) {
  for (size_t i = 0; i < count; ++i) {
    to[i] = {to[i].x + scale * from[i].x, to[i].y + scale * from[i].y, to[i].z + scale * from[i].z, to[i].w + scale * from[i].w};
  }
}

// Between two frames of a clip, and between two clips, matrices are mixed linearly: near enough for steps of a thirtieth of a
// second and for the fifth of a second in which a walk ends.
void AddMoment(const AvatarLayout& avatar, const ClipMoment& moment, float share, Vec4* row) {
  const ClipRows& clip = avatar.clips[static_cast<size_t>(moment.clip)];
  const size_t width = static_cast<size_t>(avatar.joints) * 3;
  const float at = moment.phase * static_cast<float>(clip.frames);
  const int a = std::clamp(static_cast<int>(at), 0, clip.frames - 1), b = (a + 1) % clip.frames;
  const float between = at - static_cast<float>(a);
  AddScaled(&clip.rows[static_cast<size_t>(a) * width], share * (1 - between), width, row);
  AddScaled(&clip.rows[static_cast<size_t>(b) * width], share * between, width, row);
}

size_t AddPose(const DrawnPerson& person, const AvatarLayout& avatar, PeopleBatches* out) {
  const size_t row = out->pose_rows++;
  out->poses.resize(out->pose_rows * out->pose_width);
  Vec4* texels = &out->poses[row * out->pose_width];
  std::fill_n(texels, out->pose_width, Vec4{});
  AddMoment(avatar, person.moment, 1 - person.other_share, texels);
  if (person.other_share > 0) AddMoment(avatar, person.other, person.other_share, texels);
  return row;
}

// A mesh faces glTF's +Z; turned about the vertical by heading + 90 degrees it faces the heading.
PersonInstance Placed(const DrawnPerson& person, float row) {
  const Vec3 p = GltfFromGround(person.position);
  return {{p.x, p.y, p.z, person.heading_rad + kPi / 2}, {row, person.share_from, person.share_to, 0}, {}, {}, {}, {}, {}};
}

const PackImpostorClip& ImpostorClip(const PackImpostor& atlas, ClipKind kind) {
  static constexpr const char* kNames[] = {"walk", "idle", "talk"};
  const auto found = std::find_if(atlas.clips.begin(), atlas.clips.end(),
                                  [&](const PackImpostorClip& c) { return c.name == kNames[static_cast<size_t>(kind)]; });
  return found != atlas.clips.end() ? *found : atlas.clips.front();
}

size_t NearestElevation(const PackImpostor& atlas, float elevation_deg) {
  const auto nearest = std::min_element(atlas.elevations_deg.begin(), atlas.elevations_deg.end(), [&](float a, float b) {
    return std::abs(a - elevation_deg) < std::abs(b - elevation_deg);
  });
  return static_cast<size_t>(nearest - atlas.elevations_deg.begin());
}

// The view that `direction` (with a fraction) lies before, and the next one.
void SetViews(const PackImpostor& atlas, size_t first_cell, float direction, PersonInstance* out) {
  // Beyond the silhouettes of both lie those between them, and what perspective and motion make larger.
  constexpr float kAround_px = 4;
  const int d0 = static_cast<int>(direction) % atlas.directions;
  const int views[2] = {d0, (d0 + 1) % atlas.directions};
  float origins[4], azimuths[2];
  Vec4 window{0, 0, 0, 0};
  for (size_t k = 0; k < 2; ++k) {
    const PackImpostorCell& cell = atlas.cells[first_cell + static_cast<size_t>(views[k])];
    const float left = cell.x, top = cell.y, right = left + cell.width, bottom = top + cell.height;
    out->cells[k] = {left, top, right, bottom};
    origins[2 * k] = cell.origin_x;
    origins[2 * k + 1] = cell.origin_y;
    azimuths[k] = 2 * kPi * static_cast<float>(views[k]) / static_cast<float>(atlas.directions);
    window.x = std::min(window.x, left - origins[2 * k]);
    window.y = std::min(window.y, origins[2 * k + 1] - bottom);
    window.z = std::max(window.z, right - origins[2 * k]);
    window.w = std::max(window.w, origins[2 * k + 1] - top);
  }
  out->origins = {origins[0], origins[1], origins[2], origins[3]};
  out->views.x = azimuths[0];
  out->views.y = azimuths[1];
  out->window = {(window.x - kAround_px) * atlas.texel_m, (window.y - kAround_px) * atlas.texel_m,
                 (window.z + kAround_px) * atlas.texel_m, (window.w + kAround_px) * atlas.texel_m};
  out->look.w = direction - std::floor(direction);
}

PersonInstance AsImpostor(const DrawnPerson& person, const PackImpostor& atlas, Vec3 eye) {
  const Vec3 from = GroundFromGltf(eye) - person.position;
  const float distance = std::max(std::sqrt(from.x * from.x + from.y * from.y), 1e-3f);
  const ClipMoment& moment = person.other_share > 0.5f ? person.other : person.moment;
  const PackImpostorClip& clip = ImpostorClip(atlas, moment.clip);
  const float at = moment.phase * static_cast<float>(clip.phases), nearest = std::floor(at + 0.5f);
  const int phase = static_cast<int>(nearest) % clip.phases;
  const size_t elevation = NearestElevation(atlas, std::atan2(from.z, distance) * 180 / kPi);
  const float elevation_rad = atlas.elevations_deg[elevation] * kPi / 180;
  const size_t row = static_cast<size_t>(clip.first_frame + phase) * atlas.elevations_deg.size() + elevation;

  PersonInstance out = Placed(person, at - nearest);
  const float turn = (std::atan2(from.y, from.x) - person.heading_rad) / (2 * kPi);
  out.views = {0, 0, std::sin(elevation_rad), std::cos(elevation_rad)};
  SetViews(atlas, row * static_cast<size_t>(atlas.directions), (turn - std::floor(turn)) * static_cast<float>(atlas.directions), &out);
  // Right of the view from the eye: ahead turned clockwise; on the ground (x, y), then glTF's (x, z).
  out.right = {-from.y / distance, -from.x / distance};
  return out;
}

void AddBatches(std::vector<PeopleBatches::Entry>* entries, std::vector<PersonInstance>* instances,
                std::vector<PeopleBatch>* batches) {
  const auto key = [](const PeopleBatch& b) { return std::tuple(b.level < 0, b.avatar, b.level, b.fades); };
  std::stable_sort(entries->begin(), entries->end(), [&](const auto& a, const auto& b) { return key(a.batch) < key(b.batch); });
  batches->clear();
  for (const PeopleBatches::Entry& e : *entries) {
    if (batches->empty() || key(batches->back()) != key(e.batch)) {
      batches->push_back(e.batch);
      batches->back().first = instances->size();
    }
    ++batches->back().count;
    instances->push_back(e.instance);
  }
  entries->clear();
}

}  // namespace

AvatarLayout LayoutOf(const PackAvatar& avatar) {
  AvatarLayout layout{avatar.joints, static_cast<int>(avatar.levels.size()), {RowsOf(avatar.walk), RowsOf(avatar.idle), RowsOf(avatar.talk)},
                      avatar.impostor};
  PackImpostor& atlas = layout.impostor;
  for (PackTexture* picture : {&atlas.albedo, &atlas.normal, &atlas.depth, &atlas.motion}) picture->levels.clear();
  return layout;
}

void SortPeople(const std::vector<DrawnPerson>& people, const std::vector<AvatarLayout>& avatars, Vec3 eye, Vec3 to_sun,
                float shadow_reach_m, PeopleBatches* out) {
  out->instances.clear();
  out->pose_rows = 0;
  std::vector<PersonInstance>& meshes = out->mesh_instances;
  meshes.assign(people.size(), {});
  for (size_t i = 0; i < people.size(); ++i) {
    const DrawnPerson& person = people[i];
    const AvatarLayout& avatar = avatars[static_cast<size_t>(person.avatar)];
    const int level = std::min(person.level, avatar.levels - 1);
    const bool near = Length(GltfFromGround(person.position) - eye) < kMeshShadow_m;
    if (level >= 0 || near) meshes[i] = Placed(person, static_cast<float>(AddPose(person, avatar, out)));
    const bool fades = person.share_from > 0 || person.share_to < 1;
    out->entries.push_back({{person.avatar, level, fades, 0, 0}, level >= 0 ? meshes[i] : AsImpostor(person, avatar.impostor, eye)});
  }
  AddBatches(&out->entries, &out->instances, &out->seen);
  for (size_t i = 0; i < people.size(); ++i) {
    const DrawnPerson& person = people[i];
    const AvatarLayout& avatar = avatars[static_cast<size_t>(person.avatar)];
    const bool half = person.share_to - person.share_from >= 0.5f;  // of the two of a fade one casts the shadow
    const float distance_m = Length(GltfFromGround(person.position) - eye);
    if (!half || distance_m > shadow_reach_m) continue;
    // A shadow shows less than the person: the next coarser mesh but the coarsest does.
    const int level = person.level >= 0           ? std::max(std::min(person.level, avatar.levels - 1), avatar.levels - 2)
                      : distance_m < kMeshShadow_m ? avatar.levels - 1
                                                   : -1;
    out->entries.push_back({{person.avatar, level, false, 0, 0},
                            level >= 0 ? meshes[i] : AsImpostor(person, avatar.impostor, eye + to_sun * kSunDistance_m)});
  }
  AddBatches(&out->entries, &out->instances, &out->shadows);
}

}  // namespace flaneur
