// A slow way above people's heads, where there is room for it: as high as what stands around is far, so that nothing
// that juts out of a house, no crown of a tree and no vault of a gate is flown through.
#pragma once
#include <vector>

#include "runtime/crowd/walkable.h"
#include "runtime/crowd/way_search.h"

namespace flaneur {

// The eye is above hats, and below where upper storeys and crowns of trees begin unless they are far.
inline constexpr float kLowestFlight_m = 2.2f, kHighestFlight_m = 5;

struct Flight {
  std::vector<Vec2> points;     // gently curved, so far from each other as kFlightStep_m at most
  std::vector<float> at_m;      // way from the start to each
  std::vector<float> height_m;  // of the eye over the ground at each
  float way_m = 0, speed_mps = 0;
};
inline constexpr float kFlightStep_m = 0.5f;

struct FlightPlace {
  Vec2 position;
  float eye_height_m = 0;
};

// How high the eye may be at a place.
float FlightHeight_m(const Walkable& walkable, Vec2 place);
// No points: there is no way.
Flight PlanFlight(const Walkable& walkable, Vec2 from, Vec2 to, WaySearch* search);
bool IsOver(const Flight& flight);
FlightPlace PlaceAt(const Flight& flight, float way_m);
// On by passed_s, from standstill to standstill. The eye is where PlaceAt says.
void FlyOn(float passed_s, Flight* flight);

}  // namespace flaneur
