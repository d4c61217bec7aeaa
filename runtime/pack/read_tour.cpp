#include "runtime/pack/read_tour.h"

#include <cmath>
#include <cstring>
#include <span>
#include <utility>

#include "runtime/base/array.h"
#include "runtime/base/limits.h"
#include "runtime/pack/allowance.h"
#include "runtime/pack/read_life.h"
#include "runtime/pack/read_visitor_data.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {
namespace {

void ReadObstacle(const TourObject& json, size_t* points, Obstacles* obstacles) {
  json.Text("name");
  json.OneOf("kind", {"building", "wall", "tree", "lamp", "other"});
  if (json.Has("radius_m")) {
    const float radius_m = json.Real("radius_m", TourObject::kAboveZero, kMostSide_m);
    obstacles->circles.push_back({json.Point("center_m"), radius_m});
    return;
  }
  PolygonObstacle polygon{json.Ring("outer_m"), {}};
  if (json.Has("holes_m")) polygon.holes = json.Rings("holes_m");
  *points += polygon.outer.size();
  for (const auto& hole : polygon.holes) *points += hole.size();
  if (*points > kMostObstaclePoints) json.Refuse("and those before it have more points than a tour may have");
  obstacles->polygons.push_back(std::move(polygon));
}

// Where a raster lies; how many cells it has.
template <typename Raster>
size_t ReadRasterFrame(const TourObject& json, Raster* raster) {
  raster->min_m = json.Point("min_m");
  raster->cell_m = json.Real("cell_m", kLeastCell_m, kMostCell_m);
  const double most = std::floor(kMostSide_m / static_cast<double>(raster->cell_m));
  raster->columns = json.Whole("columns", 1, most);
  raster->rows = json.Whole("rows", 1, most);
  return static_cast<size_t>(raster->columns) * static_cast<size_t>(raster->rows);
}

std::span<const uint8_t> ViewOfSize(const GltfFile& file, const TourObject& json, const char* key, size_t bytes) {
  const auto view = BufferView(file, json.View(key, Member(file.json, "bufferViews").size()));
  if (view.size() != bytes) json.Refuse("has views of the wrong size");
  return view;
}

Painting ReadPainting(const GltfFile& file, const TourObject& json) {
  Painting painting;
  const size_t cells = ReadRasterFrame(json, &painting);
  const auto people = ViewOfSize(file, json, "people_view", cells),
             loiter = ViewOfSize(file, json, "loiter_view", cells);
  file.allowance->TakeMemory(2 * cells, "the painting");
  painting.people.assign(people.begin(), people.end());
  painting.loiter.assign(loiter.begin(), loiter.end());
  return painting;
}

TourStop ReadStop(const GltfFile& file, const TourObject& json, TourPack* pack) {
  TourStop stop{json.Point("position_m")};
  if (json.Has("yaw_rad")) stop.yaw_rad = json.Yaw("yaw_rad");
  stop.pause_s = json.Real("pause_s", 0, kMostPause_s);
  stop.caption = json.Text("caption", kMostText_bytes);
  stop.captions = ReadTranslations(json, "captions");
  stop.sounds = ReadSounds(file, json, pack);
  return stop;
}

Place ReadPlay(const TourObject& json) {
  Place place{json.Text("name"), "play", json.Point("position_m")};
  place.width_m = json.Real("width_m", TourObject::kAboveZero, kMaxPlay_m);
  place.clip = json.Text("clip");
  place.people = json.Whole("people", 1, kMaxPlayers);
  if (json.Has("avatars")) place.avatars = json.Texts("avatars");
  return place;
}

Place ReadWork(const TourObject& json) {
  Place place{json.Text("name"), "work", json.Point("position_m")};
  place.yaw_rad = json.Yaw("yaw_rad");
  if (json.Has("clip")) place.clip = json.Text("clip");
  if (json.Has("avatars")) place.avatars = json.Texts("avatars");
  if (json.Has("seat_m")) place.seat_m = json.Real("seat_m", 0, kMaxSeat_m);
  if (json.Has("stay_s")) place.stay_s = json.Real("stay_s", 0, kMaxStay_s);
  return place;
}

}  // namespace

void ReadTour(const GltfFile& file, const TourObject& tour, TourPack* pack) {
  pack->name = tour.Text("name");
  pack->titles = ReadTranslations(tour, "titles");
  size_t points = 0;
  for (const TourObject& o : tour.Objects("obstacles", kMostObstacles)) ReadObstacle(o, &points, &pack->obstacles);
  for (const TourObject& p : tour.Objects("places", kMostPlaces)) {
    pack->places.push_back({p.Text("name"), p.OneOf("kind", {"door", "exit", "goal", "loiter", "spawn"}),
                            p.Point("position_m"), p.Real("width_m", TourObject::kAboveZero, kMostSide_m)});
    if (p.Has("yaw_rad")) pack->places.back().yaw_rad = p.Yaw("yaw_rad");
  }
  if (tour.Has("work")) {
    for (const TourObject& w : tour.Objects("work", kMostPlaces)) pack->places.push_back(ReadWork(w));
  }
  if (tour.Has("play")) {
    for (const TourObject& p : tour.Objects("play", kMostPlaces)) pack->places.push_back(ReadPlay(p));
  }
  if (tour.Has("painting")) pack->painting = ReadPainting(file, tour.Object("painting"));
  for (const TourObject& s : tour.Objects("path", kMostStops)) pack->path.push_back(ReadStop(file, s, pack));
  if (tour.Has("language")) pack->language = tour.Text("language");
  if (tour.Has("guide")) pack->guide = tour.Text("guide");
  if (tour.Has("title_page")) {
    const TourObject page = tour.Object("title_page");
    page.Color("background");
    for (const char* view : {"picture_view", "logo_view"}) {
      if (page.Has(view)) page.View(view, Member(file.json, "bufferViews").size());
    }
  }
  ReadVisitorData(file, tour, pack);
  ReadLife(tour, pack);
  pack->thanks = ReadTranslations(tour, "thanks");
  if (tour.Has("home_after_s")) pack->home_after_s = tour.Real("home_after_s", 0, kLongestIdle_s);
  VisitFields(tour.Object("crowd"), &pack->crowd);
  VisitFields(tour.Object("control"), &pack->control);
  VisitFields(tour.Object("light"), &pack->light);
}

GroundRaster ReadGround(const GltfFile& file, const TourObject& json) {
  GroundRaster ground;
  const size_t cells = ReadRasterFrame(json, &ground);
  const auto heights = ViewOfSize(file, json, "height_view", cells * 4);
  const auto kinds = ViewOfSize(file, json, "kind_view", cells);
  file.allowance->TakeMemory(5 * cells, "the ground");
  ground.height_m.resize(cells);
  std::memcpy(ground.height_m.data(), heights.data(), heights.size());
  for (float h : ground.height_m) {
    if (!(std::abs(static_cast<double>(h)) <= kMostCoordinate_m))
      throw PackRefused("has a ground height that is not finite, or out of range");
  }
  ground.kind.assign(kinds.begin(), kinds.end());
  return ground;
}

}  // namespace flaneur
