#include "runtime/visit/hotspots.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"

namespace flaneur {
namespace {

constexpr float kLooksAt_rad = 0.11f;                           // so near the middle of the view is looked at
constexpr float kOpens_s = 1.1f;                                // of looking
constexpr float kNoticed = 0.6f;                                // of interest, where nothing opens by itself
constexpr float kLooksAway_rad = 0.45f, kMoreAway_rad = 0.25f;  // from the middle; from where it was when it began
constexpr float kCloses_s = 0.8f;                               // of looking or being away
constexpr float kLeaves = 1.15f;                                // of the radius
constexpr float kLargeThing_m2 = 15;  // smaller ones, such as stalls and carts, are looked over
constexpr float kLow_m = 4;           // what is higher is seen over walls
constexpr float kFromWall_m = 1.2f;   // a thing at a wall, or within what it belongs to, is seen from this side

float Area_m2(const std::vector<Vec2>& ring) {
  float twice = 0;
  for (size_t k = 0; k < ring.size(); ++k) twice += Cross(ring[k], ring[(k + 1) % ring.size()]);
  return std::abs(twice) / 2;
}

float Distance_m(Vec2 p, Vec2 a, Vec2 b) {
  const Vec2 along = b - a;
  const float length2 = Dot(along, along);
  const float share = length2 > 0 ? std::clamp(Dot(p - a, along) / length2, 0.0f, 1.0f) : 0;
  return Length(p - (a + along * share));
}

void AddWalls(const std::vector<Vec2>& ring, Vec2 around, float reach_m, std::vector<Wall>* walls) {
  for (size_t k = 0; k < ring.size(); ++k) {
    const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
    if (Distance_m(around, a, b) < reach_m) walls->push_back({a, b});
  }
}

bool Cuts(const Wall& wall, Vec2 from, Vec2 to) {
  const Vec2 way = to - from, along = wall.b - wall.a;
  const float side_a = Cross(way, wall.a - from), side_b = Cross(way, wall.b - from);
  const float side_from = Cross(along, from - wall.a), side_to = Cross(along, to - wall.a);
  return side_a * side_b < 0 && side_from * side_to < 0;
}

float OffMiddle_rad(const FrameInput& frame, Vec3 point) {
  const Vec3 to = Normalized(point - frame.eye);
  const float level = std::cos(frame.pitch_rad);
  const Vec3 ahead{level * std::cos(frame.yaw_rad), level * std::sin(frame.yaw_rad), std::sin(frame.pitch_rad)};
  return std::acos(std::clamp(Dot(to, ahead), -1.0f, 1.0f));
}

void Open(int hotspot, float off_rad, Hotspots* h) {
  h->open = hotspot;
  h->opened_off_rad = off_rad;
  h->away_s = 0;
  h->closed = -1;
}

const SeenHotspot* FindSeen(const Hotspots& h, int hotspot) {
  const auto found = std::find_if(h.seen.begin(), h.seen.end(), [&](const auto& s) { return s.hotspot == hotspot; });
  return found == h.seen.end() ? nullptr : &*found;
}

const SeenHotspot* NearestToMiddle(const Hotspots& h) {
  const auto least = std::min_element(h.seen.begin(), h.seen.end(),
                                      [](const auto& a, const auto& b) { return a.off_rad < b.off_rad; });
  return least == h.seen.end() ? nullptr : &*least;
}

void FollowInterest(bool opens, float passed_s, Hotspots* h) {
  const SeenHotspot* nearest = NearestToMiddle(*h);
  const int looked_at = nearest != nullptr && nearest->off_rad < kLooksAt_rad ? nearest->hotspot : -1;
  for (size_t k = 0; k < h->looked_s.size(); ++k) {
    const bool grows = static_cast<int>(k) == looked_at;
    const float most_s = (opens && h->closed != looked_at ? 1 : kNoticed) * kOpens_s;
    h->looked_s[k] = grows ? std::max(std::min(h->looked_s[k] + passed_s, most_s), h->looked_s[k] - passed_s)
                           : std::max(0.0f, h->looked_s[k] - passed_s);
  }
  if (h->closed >= 0 && h->closed != looked_at && At(h->looked_s, h->closed) <= 0) h->closed = -1;
  for (SeenHotspot& seen : h->seen) seen.interest = At(h->looked_s, seen.hotspot) / kOpens_s;
  if (looked_at >= 0 && h->open != looked_at && At(h->looked_s, looked_at) >= kOpens_s)
    Open(looked_at, nearest->off_rad, h);
}

void EndWhenAway(float passed_s, Hotspots* h) {
  if (h->open < 0) return;
  const SeenHotspot* seen = FindSeen(*h, h->open);
  const float most_rad = std::max(kLooksAway_rad, h->opened_off_rad + kMoreAway_rad);
  h->away_s = seen != nullptr && seen->off_rad < most_rad ? 0 : h->away_s + passed_s;
  if (h->away_s > kCloses_s) h->open = -1;
}

}  // namespace

std::vector<Wall> LargeWallsAround(const Walkable& w, Vec2 around, float reach_m) {
  std::vector<Wall> walls;
  for (const PolygonObstacle& o : w.polygons) {
    if (Area_m2(o.outer) < kLargeThing_m2) continue;
    AddWalls(o.outer, around, reach_m, &walls);
    for (const auto& hole : o.holes) AddWalls(hole, around, reach_m, &walls);
  }
  return walls;
}

bool IsBehindWalls(const std::vector<Wall>& walls, Vec2 eye, Vec2 thing) {
  const Vec2 way = thing - eye;
  const float far_m = Length(way);
  if (far_m <= kFromWall_m) return false;
  const Vec2 before = eye + way * ((far_m - kFromWall_m) / far_m);
  return std::any_of(walls.begin(), walls.end(), [&](const Wall& wall) { return Cuts(wall, eye, before); });
}

void PrepareHotspots(const std::vector<Hotspot>& all, const Walkable& w, Hotspots* h) {
  *h = {};
  h->looked_s.assign(all.size(), 0);
  for (const Hotspot& hotspot : all) {
    const Vec2 p = hotspot.position_m;
    const int cell = OnGround(w, p) ? CellAt(w, p) : NearestFreeCell(w, p, hotspot.radius_m);
    const float ground_m = OnGround(w, p) ? HeightAt(w, p) : cell >= 0 ? HeightAt(w, CellCenter(w, cell)) : 0;
    h->points.push_back({p.x, p.y, ground_m + hotspot.height_m});
    const bool low = hotspot.height_m < kLow_m;
    h->walls.push_back(low ? LargeWallsAround(w, p, hotspot.radius_m * kLeaves) : std::vector<Wall>{});
  }
}

std::optional<Vec2> PlaceInPicture(const FrameInput& frame, float aspect, Vec3 point) {
  const Vec3 off = point - frame.eye;
  const Vec2 front{std::cos(frame.yaw_rad), std::sin(frame.yaw_rad)};
  const float level = off.x * front.x + off.y * front.y, right = off.x * front.y - off.y * front.x;
  const float ahead = level * std::cos(frame.pitch_rad) + off.z * std::sin(frame.pitch_rad);
  const float up = off.z * std::cos(frame.pitch_rad) - level * std::sin(frame.pitch_rad);
  if (ahead < 0.05f) return std::nullopt;
  const float half = std::tan(frame.fov_rad / 2);
  return Vec2{0.5f + right / (2 * ahead * half), 0.5f - up * aspect / (2 * ahead * half)};
}

void LookForHotspots(const std::vector<Hotspot>& all, const FrameInput& frame, float aspect, bool opens, float passed_s,
                     const IsHidden& is_hidden, Hotspots* h) {
  h->seen.clear();
  for (size_t k = 0; k < all.size(); ++k) {
    const Vec3 point = h->points[k];
    const float far_m = Length(Vec2{point.x - frame.eye.x, point.y - frame.eye.y});
    const float reach_m = all[k].radius_m * (h->open == static_cast<int>(k) ? kLeaves : 1);
    if (far_m > reach_m) continue;
    const auto place = PlaceInPicture(frame, aspect, point);
    if (!place || place->x < 0 || place->x > 1 || place->y < 0 || place->y > 1) continue;
    if (IsBehindWalls(h->walls[k], {frame.eye.x, frame.eye.y}, {point.x, point.y})) continue;
    if (is_hidden && is_hidden(point)) continue;
    h->seen.push_back({static_cast<int>(k), *place, far_m, OffMiddle_rad(frame, point), 0});
  }
  FollowInterest(opens, passed_s, h);
  EndWhenAway(passed_s, h);
}

bool TapHotspot(Vec2 place, float aspect, float near_share, Hotspots* h) {
  const SeenHotspot* best = nullptr;
  float best_share = near_share;
  for (const SeenHotspot& seen : h->seen) {
    const Vec2 off = seen.place - place;
    const float share = Length(Vec2{off.x * aspect, off.y});
    if (share < best_share) best = &seen, best_share = share;
  }
  if (best == nullptr) return false;
  if (best->hotspot == h->open) CloseHotspot(h);
  else Open(best->hotspot, best->off_rad, h);
  return true;
}

void AskHotspot(Hotspots* h) {
  if (h->open >= 0) return CloseHotspot(h);
  if (const SeenHotspot* nearest = NearestToMiddle(*h)) Open(nearest->hotspot, nearest->off_rad, h);
}

void CloseHotspot(Hotspots* h) {
  h->closed = h->open;
  h->open = -1;
}

}  // namespace flaneur
