#include "runtime/web/told_map.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/array.h"
#include "runtime/visit/phrases.h"

namespace flaneur {

void DrawMap(const Simulation& s, int width_px, int height_px, float times, ToldMap* map) {
  constexpr int kMost_px = 2048;
  const MapView whole =
      WholeTown(s.town.walkable, std::clamp(width_px, 1, kMost_px), std::clamp(height_px, 1, kMost_px));
  map->view = Enlarged(whole, std::max(1.0f, times), s.visitor.camera.view.position);
  map->rgba = DrawTownMap(s.town.walkable, map->view);
}

nlohmann::json MarksOf(const ToldMap& map, const TourPack& pack, const Simulation& s, const std::string& language) {
  nlohmann::json stops = nlohmann::json::array(), streets = nlohmann::json::array();
  const auto place = [&](Vec2 p) {
    const Vec2 px = OnMap(map.view, p);
    return nlohmann::json{px.x, px.y};
  };
  const GuidedTour& tour = s.visitor.tour;
  for (const MapStop& stop : StopsOnMap(tour))
    stops.push_back({{"stop", stop.stop},
                     {"number", stop.number},
                     {"name", NameOfStop(tour, stop.stop)},
                     {"place", place(tour.stops[stop.stop].position_m)}});
  for (const Street& street : pack.streets) {
    const std::string name = TextIn(street.names, language, pack.language);
    if (!name.empty() && street.points.size() > 1)
      streets.push_back({{"name", name}, {"place", place(MiddleOf(street))}});
  }
  const ViewCamera& view = s.visitor.camera.view;
  const int street = StreetAt(pack.streets, view.position);
  const std::string name = street < 0 ? "" : TextIn(At(pack.streets, street).names, language, pack.language);
  const std::string here = name.empty() ? Say(Phrase::kYouAreHere, language) : Say(Phrase::kYouAreIn, language, {name});
  return {{"stops", stops},
          {"streets", streets},
          {"here", {{"place", place(view.position)}, {"yaw_rad", view.yaw_rad}, {"text", here}}}};
}

}  // namespace flaneur
