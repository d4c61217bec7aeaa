#include "runtime/web/headset.h"

#include <algorithm>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kGoesBeside_m = 0.08f;  // of the head, before the body follows
constexpr float kFarthest_m = 12, kMarch_m = 0.05f;

// The room's x and z axes on the ground.
Vec2 Right(const Headset& h) { return {std::sin(h.yaw_rad), -std::cos(h.yaw_rad)}; }
Vec2 Behind(const Headset& h) { return {-std::cos(h.yaw_rad), -std::sin(h.yaw_rad)}; }

Vec2 OnGround(Vec2 of_room, const Headset& h) { return Right(h) * of_room.x + Behind(h) * of_room.y; }
Vec2 OfRoom(Vec2 on_ground, const Headset& h) { return {Dot(on_ground, Right(h)), Dot(on_ground, Behind(h))}; }

Vec3 Body(const Simulation& s) {
  const Vec2 p = s.visitor.camera.view.position;
  return {p.x, p.y, HeightAt(s.town.walkable, p)};
}

// The sides of its picture lie at -1 and 1 of clip space: tangent = (side + m[2]) / m[0] of its row.
EyeFrustum FrustumOf(const RoomEye& eye, const Mat4& town_from_room) {
  const Mat4 room_from_eye = Inverse(eye.eye_from_room);
  const auto turned = [&](Vec3 d) {
    return Normalized(GroundFromGltf(TransformDirection(town_from_room, TransformDirection(room_from_eye, d))));
  };
  const auto tangent = [&](size_t row, float side) {
    return (side + eye.projection.m[2][row]) / eye.projection.m[row][row];
  };
  EyeFrustum f;
  f.place = GroundFromGltf(TransformPoint(town_from_room, eye.place));
  f.ahead = turned({0, 0, -1});
  f.right = turned({1, 0, 0});
  f.up = turned({0, 1, 0});
  f.left_tangent = tangent(0, -1);
  f.right_tangent = tangent(0, 1);
  f.lower_tangent = tangent(1, -1);
  f.upper_tangent = tangent(1, 1);
  return f;
}

}  // namespace

void PutOn(Vec3 head, float pictures_per_s, Simulation* s, Headset* h) {
  *h = {};
  h->worn = true;
  h->head = head;
  h->middle_m = {head.x, head.z};
  h->yaw_rad = s->visitor.camera.view.yaw_rad;
  h->own_fov_rad = s->visitor.camera.view.fov_rad;
  h->own_eye_m = s->visitor.camera.eye_height_m;
  ControlSettings& settings = s->control.settings;
  h->own_settings = settings;
  settings.max_yaw_rate_dps = kHeadTurn_radps * 180 / kPi;
  settings.method = LimitMethod::kFrameTime;
  settings.target_ms = 1000 / std::max(1.0f, pictures_per_s);
}

void TakeOff(const Headset& h, Simulation* s) {
  ControlSettings& settings = s->control.settings;
  settings.max_yaw_rate_dps = h.own_settings.max_yaw_rate_dps;
  settings.method = h.own_settings.method;
  settings.target_ms = h.own_settings.target_ms;
  s->visitor.camera.eye_height_m = h.own_eye_m;
  s->visitor.camera.pitch_rad = 0;
  SetFieldOfView(h.own_fov_rad, s);
}

void TurnRoom(float angle_rad, Headset* h) {
  const Vec2 aside = OnGround(Vec2{h->head.x, h->head.z} - h->middle_m, *h);
  h->yaw_rad = std::remainder(h->yaw_rad + angle_rad, 2 * kPi);
  h->middle_m = Vec2{h->head.x, h->head.z} - OfRoom(aside, *h);
}

// The room's front, -z, is the town's yaw: a turn by yaw - 90 degrees about the vertical.
Mat4 TownFromRoom(Vec3 body, const Headset& h) {
  const float half = (h.yaw_rad - kPi / 2) / 2;
  const Mat4 turn = FromTranslationRotationScale({}, {0, std::sin(half), 0, std::cos(half)}, {1, 1, 1});
  const Mat4 to_body = FromTranslationRotationScale(GltfFromGround(body), {}, {1, 1, 1});
  const Mat4 from_middle = FromTranslationRotationScale({-h.middle_m.x, 0, -h.middle_m.y}, {}, {1, 1, 1});
  return to_body * turn * from_middle;
}

void LookWithHead(const Headset& h, Simulation* s, CameraInput* input) {
  constexpr float kHardly_radps = 1e-5f;  // so that the tour leaves the view alone
  CameraState& camera = s->visitor.camera;
  const Mat4 town_from_room = TownFromRoom(Body(*s), h);
  std::vector<EyeFrustum> eyes;
  for (const RoomEye& eye : h.eyes) eyes.push_back(FrustumOf(eye, town_from_room));
  const HeadView head = ViewOfHead(camera.view.position, eyes);
  camera.eye_height_m = h.head.y;
  // The wedge of a bounded view holds all that the eyes see, however the head is pitched and rolled.
  input->pitch_rad = head.is_bounded ? 0 : head.pitch_rad;
  const float turn_rad = std::remainder(head.yaw_rad - camera.view.yaw_rad, 2 * kPi);
  input->yaw_rate_radps = turn_rad / Step_s(*s) + kHardly_radps;
  // Levels go by how large people are in an eye's picture, not in one as wide as both of them together.
  const RoomEye& eye = h.eyes.front();
  const float focal_px = eye.projection.m[0][0] * static_cast<float>(eye.width_px) / 2;
  SetPictureSize(static_cast<int>(2 * std::tan(head.fov_rad / 2) * focal_px), eye.height_px, s);
  SetFieldOfView(head.fov_rad, s);  // and with it the outer volume
}

std::optional<Vec2> WalkUnderHead(const Headset& h) {
  const Vec2 off = Vec2{h.head.x, h.head.z} - h.middle_m;
  if (Length(off) < kGoesBeside_m) return std::nullopt;
  return OnGround(off, h);
}

void Followed(Vec2 moved_m, Headset* h) { h->middle_m = h->middle_m + OfRoom(moved_m, *h); }

std::vector<EyePicture> PicturesOf(const Headset& h, Vec3 body) {
  const Mat4 town_from_room = TownFromRoom(body, h), room_from_town = Inverse(town_from_room);
  std::vector<EyePicture> pictures;
  for (const RoomEye& eye : h.eyes)
    pictures.push_back({eye.projection * eye.eye_from_room * room_from_town, TransformPoint(town_from_room, eye.place),
                        eye.left_px, eye.bottom_px, eye.width_px, eye.height_px});
  return pictures;
}

std::optional<Vec2> LandingPlace(Vec3 from, Vec3 along, const Headset& h, const Simulation& s) {
  const Walkable& w = s.town.walkable;
  const Mat4 town_from_room = TownFromRoom(Body(s), h);
  const Vec3 origin = GroundFromGltf(TransformPoint(town_from_room, from));
  const Vec3 way = Normalized(GroundFromGltf(TransformDirection(town_from_room, along)));
  for (float far_m = 0; far_m < kFarthest_m; far_m += kMarch_m) {
    const Vec3 p = origin + way * far_m;
    const Vec2 on{p.x, p.y};
    if (far_m > 0.5f && InsideObstacle(w, on)) return std::nullopt;
    if (flaneur::OnGround(w, on) && p.z <= HeightAt(w, on)) return IsFree(w, on) ? std::optional(on) : std::nullopt;
  }
  return std::nullopt;
}

void Teleport(Vec2 place, Simulation* s, Headset* h) {
  CameraState& camera = s->visitor.camera;
  camera.view.position = s->visitor.stuck_at = place;
  camera.velocity = {};
  s->visitor.stuck_s = 0;
  s->visitor.point_walk = {};
  h->middle_m = {h->head.x, h->head.z};
}

Vec3 InRoom(Vec2 place, const Headset& h, const Simulation& s) {
  const Vec3 ground = GltfFromGround({place.x, place.y, HeightAt(s.town.walkable, place)});
  return TransformPoint(Inverse(TownFromRoom(Body(s), h)), ground);
}

}  // namespace flaneur
