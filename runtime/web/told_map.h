// The visitor's map for a web page: its picture, and what stands on it. Internal to runtime/web.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "runtime/pack/tour_pack.h"
#include "runtime/visit/town_map.h"

namespace flaneur {

struct ToldMap {
  MapView view;
  std::vector<uint8_t> rgba;  // of the last view
};

// `times` as large as the whole town, around the visitor.
void DrawMap(const Simulation& simulation, int width_px, int height_px, float times, ToldMap* map);
// Stops, names of streets and the visitor, in pixels of its picture.
nlohmann::json MarksOf(const ToldMap& map, const TourPack& pack, const Simulation& simulation,
                       const std::string& language);

}  // namespace flaneur
