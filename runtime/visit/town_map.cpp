#include "runtime/visit/town_map.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flaneur {
namespace {

constexpr float kMargin = 0.04f;                  // of the picture, around the whole town
constexpr int kRowsOfPixel = 4;                   // lines that a pixel's coverage is counted in
constexpr float kSmallThing_m2 = 6;               // a stall or a well, no house
constexpr float kLamp_m = 0.2f, kCrown_m = 1.7f;  // thinner than a trunk; as which a tree is drawn
constexpr float kShadow_px = 1.6f;

using Color = std::array<uint8_t, 3>;
// By the ground's kind: nothing, carriageway, pavement, square, grass.
constexpr Color kGround[] = {{214, 204, 182}, {245, 238, 222}, {238, 229, 209}, {250, 243, 228}, {193, 207, 160}};
constexpr Color kHouse{176, 112, 84}, kSmall{148, 128, 104}, kTree{126, 158, 96}, kShade{120, 100, 80};

struct Canvas {
  const MapView& view;
  std::vector<uint8_t>* rgba;
  std::vector<float> cover;      // of one row
  std::vector<float> crossings;  // of one line

  void Blend(int x, int y, Color color, float share) {
    uint8_t* p = &(*rgba)[(static_cast<size_t>(y) * static_cast<size_t>(view.width_px) + static_cast<size_t>(x)) * 4];
    for (size_t c = 0; c < 3; ++c) {
      const float mixed = static_cast<float>(p[c]) + (static_cast<float>(color[c]) - static_cast<float>(p[c])) * share;
      p[c] = static_cast<uint8_t>(std::lround(mixed));
    }
  }

  void AddSpan(float from, float to) {
    from = std::max(from, 0.0f);
    to = std::min(to, static_cast<float>(view.width_px));
    for (int x = static_cast<int>(from); static_cast<float>(x) < to; ++x) {
      const float low = std::max(from, static_cast<float>(x)), high = std::min(to, static_cast<float>(x + 1));
      cover[static_cast<size_t>(x)] += (high - low) / kRowsOfPixel;
    }
  }

  // Rings in pixels; what an odd number of them encloses is filled.
  void Fill(const std::vector<std::vector<Vec2>>& rings, Color color) {
    float low = 1e9f, high = -1e9f, left = 1e9f, right = -1e9f;
    for (const Vec2& p : rings.front()) {
      low = std::min(low, p.y), high = std::max(high, p.y), left = std::min(left, p.x), right = std::max(right, p.x);
    }
    if (right < 0 || left > static_cast<float>(view.width_px)) return;
    const int first = std::max(0, static_cast<int>(low)), last = std::min(view.height_px - 1, static_cast<int>(high));
    for (int y = first; y <= last; ++y) FillRow(rings, y, color);
  }

  void FillRow(const std::vector<std::vector<Vec2>>& rings, int y, Color color) {
    cover.assign(static_cast<size_t>(view.width_px), 0);
    for (int line = 0; line < kRowsOfPixel; ++line) {
      const float at = static_cast<float>(y) + (static_cast<float>(line) + 0.5f) / kRowsOfPixel;
      crossings.clear();
      for (const auto& ring : rings) {
        for (size_t k = 0; k < ring.size(); ++k) {
          const Vec2 a = ring[k], b = ring[(k + 1) % ring.size()];
          if ((a.y <= at) == (b.y <= at)) continue;
          crossings.push_back(a.x + (b.x - a.x) * (at - a.y) / (b.y - a.y));
        }
      }
      std::sort(crossings.begin(), crossings.end());
      for (size_t k = 0; k + 1 < crossings.size(); k += 2) AddSpan(crossings[k], crossings[k + 1]);
    }
    for (int x = 0; x < view.width_px; ++x) {
      if (const float share = cover[static_cast<size_t>(x)]; share > 0) Blend(x, y, color, std::min(share, 1.0f));
    }
  }
};

Color GroundColor(const GroundRaster& g, Vec2 p) {
  const int column = static_cast<int>(std::floor((p.x - g.min_m.x) / g.cell_m));
  const int row = static_cast<int>(std::floor((p.y - g.min_m.y) / g.cell_m));
  if (column < 0 || row < 0 || column >= g.columns || row >= g.rows) return kGround[0];
  const uint8_t kind = g.kind[static_cast<size_t>(row) * static_cast<size_t>(g.columns) + static_cast<size_t>(column)];
  return kGround[kind < std::size(kGround) ? kind : 0];
}

void DrawGround(const GroundRaster& g, Canvas* canvas) {
  for (int y = 0; y < canvas->view.height_px; ++y) {
    for (int x = 0; x < canvas->view.width_px; ++x) {
      canvas->Blend(x, y, kGround[0], 1);
      for (int k = 0; k < 4; ++k) {  // each later quarter weighs as much as all before it had
        const Vec2 at{static_cast<float>(x) + 0.25f + 0.5f * static_cast<float>(k % 2),
                      static_cast<float>(y) + 0.25f + 0.5f * static_cast<float>(k / 2)};
        canvas->Blend(x, y, GroundColor(g, FromMap(canvas->view, at)), 1 / static_cast<float>(k + 1));
      }
    }
  }
}

float Area_m2(const std::vector<Vec2>& ring) {
  float twice = 0;
  for (size_t k = 0; k < ring.size(); ++k) twice += Cross(ring[k], ring[(k + 1) % ring.size()]);
  return std::abs(twice) / 2;
}

std::vector<Vec2> RingOnMap(const std::vector<Vec2>& ring, float shift_px, const MapView& view) {
  std::vector<Vec2> out;
  for (const Vec2& p : ring) out.push_back(OnMap(view, p) + Vec2{shift_px, shift_px});
  return out;
}

void DrawThings(const Walkable& w, bool shade, Canvas* canvas) {
  const float shift_px = shade ? kShadow_px : 0;
  for (const PolygonObstacle& o : w.polygons) {
    std::vector<std::vector<Vec2>> rings{RingOnMap(o.outer, shift_px, canvas->view)};
    for (const auto& hole : o.holes) rings.push_back(RingOnMap(hole, shift_px, canvas->view));
    canvas->Fill(rings, shade ? kShade : Area_m2(o.outer) < kSmallThing_m2 ? kSmall : kHouse);
  }
}

void DrawTrees(const Walkable& w, Canvas* canvas) {
  for (const CircleObstacle& o : w.circles) {
    if (o.radius_m < kLamp_m) continue;
    std::vector<Vec2> ring;
    for (int k = 0; k < 16; ++k) {
      const float angle = 2 * kPi * static_cast<float>(k) / 16;
      ring.push_back(
          OnMap(canvas->view, o.center + Vec2{std::cos(angle), std::sin(angle)} * std::max(kCrown_m, o.radius_m)));
    }
    canvas->Fill({ring}, kTree);
  }
}

}  // namespace

Vec2 OnMap(const MapView& v, Vec2 p) {
  return {static_cast<float>(v.width_px) / 2 + (p.x - v.center_m.x) * v.px_per_m,
          static_cast<float>(v.height_px) / 2 - (p.y - v.center_m.y) * v.px_per_m};
}

Vec2 FromMap(const MapView& v, Vec2 px) {
  return {v.center_m.x + (px.x - static_cast<float>(v.width_px) / 2) / v.px_per_m,
          v.center_m.y - (px.y - static_cast<float>(v.height_px) / 2) / v.px_per_m};
}

MapView WholeTown(const Walkable& w, int width_px, int height_px) {
  const GroundRaster& g = *w.ground;
  Vec2 low{1e9f, 1e9f}, high{-1e9f, -1e9f};
  for (int row = 0; row < g.rows; ++row) {
    for (int column = 0; column < g.columns; ++column) {
      if (g.kind[static_cast<size_t>(row) * static_cast<size_t>(g.columns) + static_cast<size_t>(column)] == 0)
        continue;
      const Vec2 p = g.min_m + Vec2{static_cast<float>(column), static_cast<float>(row)} * g.cell_m;
      low = {std::min(low.x, p.x), std::min(low.y, p.y)};
      high = {std::max(high.x, p.x + g.cell_m), std::max(high.y, p.y + g.cell_m)};
    }
  }
  MapView view{{}, 1, width_px, height_px};
  if (low.x > high.x) return view;
  view.center_m = (low + high) * 0.5f;
  const Vec2 size = high - low;
  view.px_per_m = (1 - 2 * kMargin) * std::min(static_cast<float>(width_px) / std::max(size.x, 1.0f),
                                               static_cast<float>(height_px) / std::max(size.y, 1.0f));
  return view;
}

MapView Enlarged(const MapView& whole, float times, Vec2 center_m) {
  MapView view = whole;
  view.px_per_m *= times;
  const Vec2 half{static_cast<float>(whole.width_px) / 2 / whole.px_per_m * (1 - 1 / times),
                  static_cast<float>(whole.height_px) / 2 / whole.px_per_m * (1 - 1 / times)};
  view.center_m = {std::clamp(center_m.x, whole.center_m.x - half.x, whole.center_m.x + half.x),
                   std::clamp(center_m.y, whole.center_m.y - half.y, whole.center_m.y + half.y)};
  return view;
}

std::vector<uint8_t> DrawTownMap(const Walkable& w, const MapView& view) {
  std::vector<uint8_t> rgba(static_cast<size_t>(view.width_px) * static_cast<size_t>(view.height_px) * 4, 255);
  Canvas canvas{view, &rgba, {}, {}};
  DrawGround(*w.ground, &canvas);
  DrawThings(w, true, &canvas);
  DrawThings(w, false, &canvas);
  DrawTrees(w, &canvas);
  return rgba;
}

std::vector<MapStop> StopsOnMap(const GuidedTour& tour) {
  std::vector<MapStop> stops;
  for (size_t k = 0; k < tour.stops.size(); ++k) {
    if (RestOf_s(tour, k) > 0 && !NameOfStop(tour, k).empty()) stops.push_back({k, static_cast<int>(stops.size()) + 1});
  }
  return stops;
}

int StreetAt(const std::vector<Street>& streets, Vec2 p) {
  int nearest = -1;
  float least_m = kNearStreet_m;
  for (size_t k = 0; k < streets.size(); ++k) {
    for (size_t i = 0; i + 1 < streets[k].points.size(); ++i) {
      const Vec2 a = streets[k].points[i], along = streets[k].points[i + 1] - a;
      const float length2 = Dot(along, along);
      const float share = length2 > 0 ? std::clamp(Dot(p - a, along) / length2, 0.0f, 1.0f) : 0;
      const float off_m = Length(p - (a + along * share));
      if (off_m < least_m) nearest = static_cast<int>(k), least_m = off_m;
    }
  }
  return nearest;
}

Vec2 MiddleOf(const Street& street) {
  float whole_m = 0;
  for (size_t i = 0; i + 1 < street.points.size(); ++i) whole_m += Length(street.points[i + 1] - street.points[i]);
  float left_m = whole_m / 2;
  for (size_t i = 0; i + 1 < street.points.size(); ++i) {
    const Vec2 along = street.points[i + 1] - street.points[i];
    const float length_m = Length(along);
    if (length_m > 0 && left_m <= length_m) return street.points[i] + along * (left_m / length_m);
    left_m -= length_m;
  }
  return street.points.empty() ? Vec2{} : street.points.back();
}

}  // namespace flaneur
