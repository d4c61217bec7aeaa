// The guide: one of the townspeople, who walks ahead of the visitor, waits, and faces them at the stops. Internal to
// runtime/walk.
#pragma once
#include <vector>

#include "runtime/crowd/crowd.h"
#include "runtime/walk/guided_tour.h"

namespace flaneur {

struct Guide {
  int avatar = -1;   // -1: the tour has none
  int id = -1;       // in the crowd; -1: not there
  size_t index = 0;  // in the crowd's arrays
  int plans = 0;     // of the tour, that place and way_m are about
  float way_m = 0;   // how far along the tour's route
  Vec2 place;        // where to stand at the halt
  bool goes_to_place = false;
  float side = 0;        // of the route, on which the guide walks: 1 left, -1 right; 0: not yet chosen
  float on_route_s = 0;  // left to walk on the route itself
  bool is_left = true;   // of the picture's middle, or was when last clearly beside it
  bool walks = false;    // else stands and faces the visitor
  Vec2 velocity;         // wanted
  Corner corner;         // of the way back to the route
  float stuck_s = 0;     // since the guide got away from stuck_at
  Vec2 stuck_at;
  float waited_s = 0;  // how long the visitor has waited for the guide to get ahead
};

// In the crowd, on the way that the tour begins with.
void PlaceGuide(const VisitorInTown& v);

// To the visitor, who is elsewhere all of a sudden.
void BringGuide(const VisitorInTown& v);

// Where the visitor looks who takes leave of the guide; `now_rad` without one.
float LookOfLeave_rad(float now_rad, const VisitorInTown& v);

// Before the crowd's step: where the guide wants to walk now.
void LeadOn(const VisitorInTown& v);

// Before and after the control looks at the crowd: nobody asks the guide to make room, and everybody makes room for the
// guide, and does not pass between the two at a halt.
void ShieldGuide(const VisitorInTown& v, std::vector<MovingObstacle>* moving);
void UnshieldGuide(const VisitorInTown& v);

// How much slower the visitor walks while the guide has still to get ahead, 0 to 1.
float ShareOfPace(const VisitorInTown& v);

}  // namespace flaneur
