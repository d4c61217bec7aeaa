// Things in the town that tell something to whoever looks at them: which are seen, which is looked at, which tells now.
// Knows nothing of drawing.
#pragma once
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "runtime/crowd/walkable.h"
#include "runtime/render/frame.h"
#include "runtime/tour_data/visitor_data.h"

namespace flaneur {

struct SeenHotspot {
  int hotspot = 0;
  Vec2 place;  // 0 to 1 from the picture's upper left corner
  float distance_m = 0;
  float off_rad = 0;   // from the middle of the view
  float interest = 0;  // 0 to 1: for how long it has been looked at; at 1 it tells
};

// A side of something large that stands there.
struct Wall {
  Vec2 a, b;
};

// Those at most so far away. Small things, such as stalls and carts, are looked over.
std::vector<Wall> LargeWallsAround(const Walkable& walkable, Vec2 around, float reach_m);
// Over the ground plan. What is at a wall, or within what it belongs to, is not behind that from this side.
bool IsBehindWalls(const std::vector<Wall>& walls, Vec2 from, Vec2 thing);

struct Hotspots {
  std::vector<Vec3> points;              // by hotspot: where it is
  std::vector<std::vector<Wall>> walls;  // by hotspot: of large things around it, which hide what is low behind them
  std::vector<float> looked_s;           // by hotspot
  std::vector<SeenHotspot> seen;         // in the last picture
  int open = -1;                         // tells now; -1: none
  float opened_off_rad = 0;              // where it was when it began
  float away_s = 0;                      // since it was looked at last
  int closed = -1;                       // by hand: it tells again once one has looked elsewhere
};

void PrepareHotspots(const std::vector<Hotspot>& all, const Walkable& walkable, Hotspots* hotspots);

// Where a point is in the picture, 0 to 1 from its upper left corner, or beyond; none behind the eye. aspect: width
// over height.
std::optional<Vec2> PlaceInPicture(const FrameInput& frame, float aspect, Vec3 point);

// Whether the picture's walls hide a point.
using IsHidden = std::function<bool(Vec3 point)>;

// Once a picture, passed_s after the one before. opens: what is looked at for a while tells by itself.
void LookForHotspots(const std::vector<Hotspot>& all, const FrameInput& frame, float aspect, bool opens, float passed_s,
                     const IsHidden& is_hidden, Hotspots* hotspots);

// A tap at a place of the picture, near_share of its height around it. False: there is none.
bool TapHotspot(Vec2 place, float aspect, float near_share, Hotspots* hotspots);
// The one nearest to the middle tells; if one does, it ends.
void AskHotspot(Hotspots* hotspots);
void CloseHotspot(Hotspots* hotspots);

}  // namespace flaneur
