// One description of a tour, used by tour.toml's reader, the pack's writer and reader, the simulation and the picture.
// Structs alone. Everything stands on the ground plane (x east, y north, z up). Metres, seconds, radians.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "runtime/base/math.h"
#include "runtime/tour_data/life_data.h"
#include "runtime/tour_data/settings.h"
#include "runtime/tour_data/visitor_data.h"

namespace flaneur {

struct CircleObstacle {
  Vec2 center;
  float radius_m = 0;
};
struct PolygonObstacle {
  std::vector<Vec2> outer;               // either orientation, first point not repeated
  std::vector<std::vector<Vec2>> holes;  // inside a hole is outside the obstacle
};
struct Obstacles {
  std::vector<CircleObstacle> circles;
  std::vector<PolygonObstacle> polygons;
};

// The walkable surface. Cell (column, row) covers [min_m.x + column * cell_m, ...) x [min_m.y + row * cell_m, ...); row
// 0 is the southernmost.
struct GroundRaster {
  Vec2 min_m;
  float cell_m = 0.25f;
  int columns = 0, rows = 0;
  std::vector<float> height_m;  // columns * rows, z at the cell's centre
  std::vector<uint8_t> kind;    // 0 none, 1 carriageway, 2 pavement, 3 square, 4 grass
};

// The pack, and every simulation of its tour, hold one and the same, which nobody changes. Never null.
using SharedGround = std::shared_ptr<const GroundRaster>;
inline SharedGround Share(GroundRaster ground) { return std::make_shared<const GroundRaster>(std::move(ground)); }

inline constexpr float kMaxSeat_m = 3, kMaxStay_s = 36000;
inline constexpr float kMaxRun_mps = 6, kMaxPlay_m = 60;
inline constexpr int kMaxPlayers = 20;  // of a place

// Where people come from and go to. kind: door, exit, goal (go there), loiter (stand there a while), spawn (start
// there), work (one of them does something there),
// play (children run about there).
struct Place {
  std::string name, kind;
  Vec2 position_m;
  float width_m = 1;
  std::optional<float> yaw_rad = std::nullopt;  // loiter, work: where people look; door, exit: the way out of it
  // Of work and play:
  std::string clip = {};                  // what they do, by its name; empty: they stand
  std::vector<std::string> avatars = {};  // who does it, by name; none: whoever has the clip
  // Of work:
  float seat_m = 0;  // height of what they sit on, over the ground; 0: as the clip has it
  float stay_s = 0;  // how long one stays; 0: the whole tour
  int people = 0;    // of play: so many
};

// Where people are, painted over the town: strengths by cell of the area, row 0 the southernmost. No columns: nothing
// is painted.
struct Painting {
  Vec2 min_m;
  float cell_m = 0;
  int columns = 0, rows = 0;
  std::vector<uint8_t> people;  // share of those who start there and go there; all 0: everywhere alike
  std::vector<uint8_t> loiter;  // where people stand about; all 0: at the loiter places
};

// The cell at p, -1 outside.
inline int PaintingCell(const Painting& painting, Vec2 p) {
  const Vec2 off = (p - painting.min_m) * (1 / painting.cell_m);
  if (!(off.x >= 0 && off.y >= 0 && off.x < static_cast<float>(painting.columns) &&
        off.y < static_cast<float>(painting.rows)))
    return -1;
  return static_cast<int>(off.y) * painting.columns + static_cast<int>(off.x);
}

struct TourStop {
  Vec2 position_m;
  std::optional<float> yaw_rad = std::nullopt;  // where one looks; none: to where the view is open
  float pause_s = 0;
  std::string caption = {};                          // in the tour's own language
  std::map<std::string, std::string> captions = {};  // by language, in all others
  std::map<std::string, StopSound> sounds = {};      // by language, what is said there
};

// What tour.toml says of the tour itself and the pack carries on, whatever town and avatars are made of.
inline constexpr double kLongestIdle_s = 86400;
struct TourData {
  std::string name;
  std::vector<Place> places;
  Painting painting;
  std::vector<TourStop> path;                 // guided path, in order; pause 0 and no caption: only a waypoint
  std::map<std::string, std::string> titles;  // what visitors read, by language; empty: the name
  std::string language = "en";                // of titles, captions and sounds for which no other is named
  std::string guide;                          // name of the avatar who leads the way along the path; empty: nobody does
  std::vector<Hotspot> hotspots;
  std::vector<Street> streets;
  std::vector<SoundPlace> sound_places;
  PhotoData photo;
  std::vector<Flock> flocks;
  std::vector<Smoke> smokes;
  std::map<std::string, std::string>
      thanks;               // what visitors read at the tour's end, by language; empty: a word of ours
  float home_after_s = 45;  // without a touch at the tour's end, until all is as at the beginning; 0: never
  CrowdSettings crowd;
  ControlSettings control;
  LightSettings light;
  WindSettings wind;
};

}  // namespace flaneur
