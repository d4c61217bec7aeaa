#include "runtime/render/people_batches.h"

#include <algorithm>
#include <cmath>

#include "runtime/render/shaders/shared.glsl"

namespace flaneur {
namespace {

constexpr float kAround_m = 0.35f;      // arms, skirts and props reach so far beyond a person's radius
constexpr float kLongestShadow_m = 12;  // as far as one may fall into view
constexpr float kContactReach_m = 30, kContactFade_m = 8;  // of the shade about feet
constexpr float kFarImpostor_m = 15;                       // nearer ones are drawn before all farther ones,
constexpr size_t kNearBatches = 5;                         // of the avatars that have most of them

// By ClipKind.
std::vector<const PackClip*> ClipsOf(const PackAvatar& avatar) {
  std::vector<const PackClip*> clips{&avatar.walk, &avatar.idle, &avatar.talk};
  for (const PackOtherClip& other : avatar.other_clips) clips.push_back(&other.clip);
  return clips;
}

// The largest numbers of all clips, so that 16 bits hold them with the finest steps.
void SetSteps(const PackAvatar& avatar, AvatarLayout* layout) {
  float turn = 1e-6f, shift_m = 1e-6f;
  for (const PackClip* clip : ClipsOf(avatar)) {
    for (const Mat4& m : clip->matrices) {
      for (size_t r = 0; r < 3; ++r) {
        for (size_t c = 0; c < 3; ++c) turn = std::max(turn, std::abs(m.m[c][r]));
        shift_m = std::max(shift_m, std::abs(m.m[3][r]));
      }
    }
  }
  layout->turn_step = turn / 32767;
  layout->shift_step_m = shift_m / 32767;
}

ClipRows RowsOf(const PackClip& clip, const AvatarLayout& layout) {
  ClipRows out;
  out.frames = std::max(1, clip.frames);
  out.rows.reserve(clip.matrices.size() * 3);
  const auto steps = [](float value, float step) {
    return static_cast<int16_t>(std::lround(std::clamp(value / step, -32767.0f, 32767.0f)));
  };
  for (const Mat4& m : clip.matrices) {
    for (size_t r = 0; r < 3; ++r) {
      out.rows.push_back({steps(m.m[0][r], layout.turn_step), steps(m.m[1][r], layout.turn_step),
                          steps(m.m[2][r], layout.turn_step), steps(m.m[3][r], layout.shift_step_m)});
    }
  }
  return out;
}

void AddScaled(const PoseRow* from, float turn, float shift, size_t count, Vec4* to) {
  for (size_t i = 0; i < count; ++i) {
    const PoseRow& r = from[i];
    to[i].x += turn * static_cast<float>(r[0]);
    to[i].y += turn * static_cast<float>(r[1]);
    to[i].z += turn * static_cast<float>(r[2]);
    to[i].w += shift * static_cast<float>(r[3]);
  }
}

// Between two frames of a clip, and between two clips, matrices are mixed linearly: near enough for steps of a
// thirtieth of a second and for the fifth of a second in which a walk ends.
void AddMoment(const AvatarLayout& avatar, const ClipMoment& moment, float share, Vec4* row) {
  const ClipRows& clip = avatar.clips[static_cast<size_t>(moment.clip)];
  const size_t width = static_cast<size_t>(avatar.joints) * 3;
  const float at = moment.phase * static_cast<float>(clip.frames);
  const int a = std::clamp(static_cast<int>(at), 0, clip.frames - 1), b = (a + 1) % clip.frames;
  const float between = at - static_cast<float>(a);
  const auto add = [&](int frame, float part) {
    AddScaled(&clip.rows[static_cast<size_t>(frame) * width], part * avatar.turn_step, part * avatar.shift_step_m,
              width, row);
  };
  add(a, share * (1 - between));
  add(b, share * between);
}

size_t AddPose(const DrawnPerson& person, const AvatarLayout& avatar, PeopleBatches* out) {
  const size_t row = out->pose_rows++;
  out->poses.resize(std::max(out->poses.size(), out->pose_rows * out->pose_width));
  Vec4* texels = &out->poses[row * out->pose_width];
  std::fill_n(texels, out->pose_width, Vec4{});
  AddMoment(avatar, person.moment, 1 - person.other_share, texels);
  if (person.other_share > 0) AddMoment(avatar, person.other, person.other_share, texels);
  return row;
}

// Once a person, however much is drawn of them.
float RowOfPose(uint32_t number, const DrawnPerson& person, const AvatarLayout& avatar, PeopleBatches* out) {
  int& row = out->pose_rows_of[number];
  if (row < 0) row = static_cast<int>(AddPose(person, avatar, out));
  return static_cast<float>(row);
}

uint8_t SizeByte(float size) {
  return static_cast<uint8_t>(
      std::clamp(std::lround(SIZE_MIDDLE + (static_cast<double>(size) - 1) / SIZE_STEP), 1l, 255l));
}

// A mesh faces glTF's +Z; turned about the vertical by heading + 90 degrees it faces the heading.
PersonInstance Placed(const DrawnPerson& person, float row, float phases) {
  const Vec3 p = GltfFromGround(person.position);
  const auto& t = person.tints;
  return {{p.x, p.y, p.z, person.heading_rad + kPi / 2},
          {row, person.share_from, person.share_to, phases},
          {static_cast<uint8_t>(t[0] | t[1] << 4), t[2], SizeByte(person.breadth), SizeByte(person.size)}};
}

const ClipMoment& MainMoment(const DrawnPerson& person) {
  return person.other_share > 0.5f ? person.other : person.moment;
}

size_t NearestElevation(const PackImpostor& atlas, const DrawnPerson& person, Vec3 eye) {
  if (atlas.elevations_deg.size() == 1) return 0;
  const Vec3 from = GroundFromGltf(eye) - person.position;
  const float elevation_deg = std::atan2(from.z, std::max(Length(Vec2{from.x, from.y}), 1e-3f)) * 180 / kPi;
  const auto nearest =
      std::min_element(atlas.elevations_deg.begin(), atlas.elevations_deg.end(),
                       [&](float a, float b) { return std::abs(a - elevation_deg) < std::abs(b - elevation_deg); });
  return static_cast<size_t>(nearest - atlas.elevations_deg.begin());
}

// Which of the directions is left to the vertex shader.
PersonInstance AsImpostor(const DrawnPerson& person, const AvatarLayout& avatar, Vec3 eye) {
  const PackImpostor& atlas = avatar.impostor;
  const ClipMoment& moment = MainMoment(person);
  const int own = avatar.impostor_clips[static_cast<size_t>(moment.clip)];
  const ImpostorClip& clip = atlas.clips[static_cast<size_t>(std::max(0, own))];
  // Who cannot stand but walk stands still at the first step, as their mesh does.
  const float at = own >= 0 ? moment.phase * static_cast<float>(clip.phases) : 0, nearest = std::floor(at + 0.5f);
  const size_t frame = static_cast<size_t>(clip.first_frame + static_cast<int>(nearest) % clip.phases);
  const size_t row = frame * atlas.elevations_deg.size() + NearestElevation(atlas, person, eye);
  const size_t cell = static_cast<size_t>(avatar.first_cell) + row * static_cast<size_t>(atlas.directions);
  return Placed(person, static_cast<float>(cell), at - nearest);
}

// In the nearest of the clip's moments that coarse shadows know.
PersonInstance AsCoarseShadow(const DrawnPerson& person, const AvatarLayout& avatar) {
  const ClipMoment& moment = MainMoment(person);
  const auto clip = static_cast<size_t>(moment.clip);
  const int rows = avatar.shadow_rows[clip];
  const int row = static_cast<int>(std::lround(moment.phase * static_cast<float>(rows))) % rows;
  return Placed(person, static_cast<float>(avatar.first_shadow_row[clip] + row), 0);
}

Box BoxOf(const DrawnPerson& person, const AvatarLayout& avatar) {
  const Vec3 p = GltfFromGround(person.position);
  const float around_m = person.size * person.breadth * (avatar.radius_m + kAround_m);
  return {{p.x - around_m, p.y - 0.1f, p.z - around_m},
          {p.x + around_m, p.y + person.size * avatar.height_m * 1.15f + 0.1f, p.z + around_m}};
}

// The person and the shadow on level ground.
Box WithShadow(const Box& box, float lift_m, Vec3 to_sun) {
  const float along = std::min((box.high.y - box.low.y + lift_m) / std::max(to_sun.y, 0.01f),
                               kLongestShadow_m / std::max(0.01f, Length(Vec2{to_sun.x, to_sun.z})));
  Box out = box;
  Include({box.low.x - to_sun.x * along, box.low.y - lift_m, box.low.z - to_sun.z * along}, &out);
  Include({box.high.x - to_sun.x * along, box.low.y - lift_m, box.high.z - to_sun.z * along}, &out);
  return out;
}

// In a coarse picture a coarser mesh serves.
Level LevelAt(float distance_m, const DrawnPerson& person, const AvatarLayout& avatar, float focal_px) {
  Level level = person.level;
  if (focal_px <= 0 || !IsMesh(level)) return level;
  const float high_px = avatar.height_m * focal_px / std::max(distance_m, 0.1f);
  while (level.mesh + 1 < avatar.levels && high_px < avatar.switch_px[static_cast<size_t>(level.mesh)]) ++level.mesh;
  return level;
}

// The level itself; where it is not loaded yet, a coarser one that is, the impostor, or the coarsest.
Level LoadedLevel(Level level, int levels, const AvatarReady& ready) {
  for (int k = level.mesh; IsMesh(level) && k < levels; ++k) {
    if (ready.levels[static_cast<size_t>(k)]) return MeshLevel(k);
  }
  if (ready.impostor) return kImpostor;
  return levels > 0 && ready.levels[static_cast<size_t>(levels) - 1] ? MeshLevel(levels - 1) : kNotDrawn;
}

// Who is nearer hides others, and is drawn before them: by steps of so much within a batch.
constexpr float kStep_m = 1.5f;
constexpr int kSteps = 64;

// Batches in the order of their keys, and their instances one after the other, nearest first.
void Gather(int keys, auto batch_of, auto instance_of, PeopleBatches* out, std::vector<PeopleBatch>* batches) {
  out->counts.assign(static_cast<size_t>(keys * kSteps) + 1, 0);
  const auto slot = [](const PeopleBatches::Entry& e) { return static_cast<size_t>(e.key * kSteps + e.step); };
  for (const PeopleBatches::Entry& e : out->entries) ++out->counts[slot(e) + 1];
  batches->clear();
  size_t first = out->instances.size();
  for (int key = 0; key < keys; ++key) {
    const size_t before = first;
    for (int step = 0; step < kSteps; ++step) {
      const auto at = static_cast<size_t>(key * kSteps + step);
      const size_t count = out->counts[at + 1];
      out->counts[at] = first;
      first += count;
    }
    if (first == before) continue;
    batches->push_back(batch_of(key));
    batches->back().first = before;
    batches->back().count = first - before;
  }
  out->instances.resize(first);
  for (const PeopleBatches::Entry& e : out->entries) out->instances[out->counts[slot(e)]++] = instance_of(e);
  out->entries.clear();
}

// Impostors have keys from `first` on, near ones by avatar and then far ones: most near ones keep their own draws.
void JoinFewNear(int first, int avatars, PeopleBatches* out) {
  out->counts.assign(static_cast<size_t>(avatars), 0);
  const auto is_near = [&](const PeopleBatches::Entry& e) { return e.key >= first && e.key < first + avatars; };
  for (const PeopleBatches::Entry& e : out->entries) {
    if (is_near(e)) ++out->counts[static_cast<size_t>(e.key - first)];
  }
  const auto keeps = [&](int avatar) {
    const size_t own = out->counts[static_cast<size_t>(avatar)];
    size_t more = 0;
    for (int k = 0; k < avatars; ++k) {
      const size_t other = out->counts[static_cast<size_t>(k)];
      more += other > own || (other == own && k < avatar) ? 1 : 0;
    }
    return more < kNearBatches;
  };
  for (PeopleBatches::Entry& e : out->entries) {
    if (is_near(e) && !keeps(e.key - first)) e.key += avatars;
  }
}

int StepOf(float distance_m) { return std::min(kSteps - 1, static_cast<int>(distance_m / kStep_m)); }

// Batches by number: meshes by avatar, mesh and whether they fade, then near and far impostors by avatar. Behind an
// avatar's levels stand its props.
struct BatchKeys {
  int avatars = 0, levels = 1, meshes = 0;
};

BatchKeys KeysFor(const std::vector<AvatarLayout>& avatars) {
  BatchKeys keys;
  keys.avatars = static_cast<int>(avatars.size());
  for (const AvatarLayout& avatar : avatars) keys.levels = std::max(keys.levels, avatar.levels + avatar.props);
  keys.meshes = keys.avatars * keys.levels * 2;
  return keys;
}

int KeyOfMesh(int avatar, int mesh, bool fades, const BatchKeys& keys) {
  return (avatar * keys.levels + mesh) * 2 + (fades ? 1 : 0);
}

int KeyOfImpostor(int avatar, float distance_m, const BatchKeys& keys) {
  return keys.meshes + (distance_m > kFarImpostor_m ? keys.avatars : 0) + avatar;
}

PeopleBatch BatchOf(int key, const BatchKeys& keys) {
  if (key >= keys.meshes) return {(key - keys.meshes) % keys.avatars, -1, true, 0, 0};
  return {key / (2 * keys.levels), key / 2 % keys.levels, key % 2 == 1, 0, 0};
}

bool InSight(const PeopleSight& sight, const Box& box) {
  return MayTouch(sight.frustum, box) && (sight.walls == nullptr || MayBeSeen(*sight.walls, box, true));
}

bool CastsShadow(const DrawnPerson& person, const Box& box, float distance_m, const AvatarReady& ready,
                 const PeopleSight& sight) {
  const bool greater_part = person.share_to - person.share_from >= 0.5f;  // of the two of a change one casts the shadow
  return greater_part && person.casts_shadow && ready.shadow && distance_m < sight.shadow_reach_m &&
         InSight(sight, WithShadow(box, person.lift_m, sight.to_sun));
}

// What shades the ground about somebody's feet. Look: the ground's rise a metre along x and z, radius, how much.
void AddContact(const DrawnPerson& person, float distance_m, const AvatarLayout& avatar, const PeopleSight& sight,
                PeopleBatches* out) {
  constexpr float kAroundFeet_m = 0.1f;
  constexpr float kContact_m = 0.6f, kNoContact_m = 1.5f;  // over the ground: who sits shades it, who flies does not
  const float near = std::clamp((kNoContact_m - person.lift_m) / (kNoContact_m - kContact_m), 0.0f, 1.0f);
  const float share = near * std::clamp((kContactReach_m - distance_m) / kContactFade_m, 0.0f, 1.0f) *
                      (person.share_to - person.share_from) * sight.contact_shade;
  if (share <= 0 || !IsDrawn(person.level)) return;
  PersonInstance contact = Placed(person, 0, 0);
  contact.place.y -= person.lift_m;
  contact.look = {person.slope.x, -person.slope.y,
                  person.size * person.breadth * std::min(avatar.radius_m, 0.5f * avatar.height_m) + kAroundFeet_m,
                  share};
  out->contact_instances.push_back(contact);
}

// Seen from the sun a shadow lies where its caster does: in the map that holds the caster. Who stands on the fine map's
// border is in both.
void AddShadow(uint32_t number, const DrawnPerson& person, const Box& box, float distance_m, const PeopleSight& sight,
               PeopleBatches* out) {
  const bool whole = LiesWithin(sight.fine_map, box);
  const int coarse = whole && distance_m < sight.fine_shadow_m ? 0 : 1;
  const PeopleBatches::Entry entry{number, 2 * person.avatar + coarse, 0};
  if (MayTouch(sight.fine_map, box)) out->shadow_entries[0].push_back(entry);
  if (!whole) out->shadow_entries[1].push_back(entry);
}

// Their level as far as it is loaded, and their props.
void AddPerson(uint32_t number, const DrawnPerson& person, float distance_m, const AvatarLayout& avatar,
               const AvatarReady& ready, const PeopleSight& sight, const BatchKeys& keys, PeopleBatches* out) {
  const Level asked = LevelAt(distance_m, person, avatar, sight.focal_px);
  const Level level = LoadedLevel(asked, avatar.levels, ready);
  out->not_loaded += level != asked ? 1 : 0;
  if (!IsDrawn(level)) return;
  const bool fades = person.share_from > 0 || person.share_to < 1;
  const int key = IsMesh(level) ? KeyOfMesh(person.avatar, level.mesh, fades, keys)
                                : KeyOfImpostor(person.avatar, distance_m, keys);
  out->entries.push_back({number, key, StepOf(distance_m)});
  for (int k = 0; person.props >> k != 0; ++k) {
    const int mesh = avatar.levels + k;
    if ((person.props >> k & 1) == 0 || !ready.levels[static_cast<size_t>(mesh)]) continue;
    // All in one draw, whether somebody fades or not.
    out->entries.push_back({number, KeyOfMesh(person.avatar, mesh, true, keys), StepOf(distance_m), !IsMesh(level)});
  }
}

PersonInstance InstanceOf(const PeopleBatches::Entry& e, const DrawnPerson& person, const AvatarLayout& avatar,
                          const PeopleSight& sight, const BatchKeys& keys, PeopleBatches* out) {
  if (e.key >= keys.meshes) return AsImpostor(person, avatar, sight.eye);
  PersonInstance instance = Placed(person, RowOfPose(e.person, person, avatar, out), e.on_impostor ? 1.0f : 0.0f);
  if (BatchOf(e.key, keys).level >= avatar.levels) {
    instance.look.y = 0, instance.look.z = person.props_share;
    instance.tints = {0, 0, 0, instance.tints[3]};  // a basket is no cloth, though it may have a cloth's colour
  }
  return instance;
}

}  // namespace

std::vector<int> ImpostorClipsOf(const PackAvatar& avatar) {
  std::vector<std::string> names{"walk", "idle", "talk"};
  for (const PackOtherClip& other : avatar.other_clips) names.push_back(other.name);
  std::vector<int> clips;
  for (const std::string& name : names) {
    const auto& all = avatar.impostor.clips;
    const auto found = std::find_if(all.begin(), all.end(), [&](const ImpostorClip& c) { return c.name == name; });
    const bool stands = found == all.end() && clips.size() > static_cast<size_t>(ClipKind::kIdle);
    clips.push_back(found != all.end() ? static_cast<int>(found - all.begin())
                    : stands           ? clips[static_cast<size_t>(ClipKind::kIdle)]
                                       : -1);
  }
  return clips;
}

AvatarLayout LayoutOf(const PackAvatar& avatar) {
  AvatarLayout layout;
  layout.joints = avatar.joints;
  layout.levels = static_cast<int>(avatar.levels.size());
  layout.props = static_cast<int>(avatar.props.size());
  layout.height_m = avatar.height_m;
  layout.radius_m = avatar.radius_m;
  for (const PackLevel& level : avatar.levels) layout.switch_px.push_back(level.switch_px);
  SetSteps(avatar, &layout);
  for (const PackClip* clip : ClipsOf(avatar)) {
    layout.clips.push_back(RowsOf(*clip, layout));
    layout.shadow_rows.push_back(std::min(layout.clips.back().frames, kMaxShadowFrames));
  }
  layout.first_shadow_row.resize(layout.clips.size());
  layout.impostor_clips = ImpostorClipsOf(avatar);
  static_cast<ImpostorLayout&>(layout.impostor) = avatar.impostor;
  return layout;
}

size_t ClipBytes(const AvatarLayout& layout) {
  size_t bytes = 0;
  for (size_t k = 0; k < layout.clips.size(); ++k) {
    bytes += layout.clips[k].rows.size() * sizeof(PoseRow);
    bytes += static_cast<size_t>(layout.shadow_rows[k] * layout.joints) * 3 * sizeof(Vec4);
  }
  return bytes;
}

int ShadowFrame(const ClipRows& clip, int shadow_row, int shadow_rows) {
  return shadow_row * clip.frames / shadow_rows;
}

void SortPeople(const std::vector<DrawnPerson>& people, const std::vector<AvatarLayout>& avatars,
                const std::vector<AvatarReady>& ready, const PeopleSight& sight, PeopleBatches* out) {
  out->instances.clear();
  out->entries.clear();
  for (std::vector<PeopleBatches::Entry>& entries : out->shadow_entries) entries.clear();
  out->pose_rows = 0;
  out->hidden = out->not_loaded = 0;
  out->contact_instances.clear();
  out->pose_rows_of.assign(people.size(), -1);
  const BatchKeys keys = KeysFor(avatars);
  for (size_t i = 0; i < people.size(); ++i) {
    const auto index = static_cast<size_t>(people[i].avatar);
    const Box box = BoxOf(people[i], avatars[index]);
    const float distance_m = Length(GltfFromGround(people[i].position) - sight.eye);
    if (CastsShadow(people[i], box, distance_m, ready[index], sight)) {
      AddShadow(static_cast<uint32_t>(i), people[i], box, distance_m, sight, out);
    }
    if (!InSight(sight, box)) {
      ++out->hidden;
      continue;
    }
    AddContact(people[i], distance_m, avatars[index], sight, out);
    AddPerson(static_cast<uint32_t>(i), people[i], distance_m, avatars[index], ready[index], sight, keys, out);
  }
  JoinFewNear(keys.meshes, keys.avatars, out);
  const auto instance_of = [&](const PeopleBatches::Entry& e) {
    return InstanceOf(e, people[e.person], avatars[static_cast<size_t>(people[e.person].avatar)], sight, keys, out);
  };
  Gather(
      keys.meshes + 2 * keys.avatars, [&](int key) { return BatchOf(key, keys); }, instance_of, out, &out->seen);
  const auto shadow_batch_of = [](int key) { return PeopleBatch{key / 2, key % 2, false, 0, 0}; };
  const auto shadow_of = [&](const PeopleBatches::Entry& e) {
    const DrawnPerson& person = people[e.person];
    const AvatarLayout& avatar = avatars[static_cast<size_t>(person.avatar)];
    if (e.key % 2 == 1) return AsCoarseShadow(person, avatar);
    return Placed(person, RowOfPose(e.person, person, avatar, out), 0);  // its feet stand where the person's do
  };
  for (size_t map = 0; map < out->shadows.size(); ++map) {
    std::swap(out->entries, out->shadow_entries[map]);
    Gather(2 * keys.avatars, shadow_batch_of, shadow_of, out, &out->shadows[map]);
  }
  out->contacts = {0, 0, false, out->instances.size(), out->contact_instances.size()};
  out->instances.insert(out->instances.end(), out->contact_instances.begin(), out->contact_instances.end());
}

}  // namespace flaneur
