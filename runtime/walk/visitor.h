// Who looks at the town: the camera, and what moves it - hands, a scenario's legs or the guided tour.
#pragma once
#include <algorithm>
#include <optional>
#include <vector>

#include "runtime/control/view_volumes.h"
#include "runtime/town/town.h"
#include "runtime/walk/guide.h"
#include "runtime/walk/guided_tour.h"
#include "runtime/walk/point_walk.h"
#include "runtime/walk/start.h"

namespace flaneur {

inline constexpr float kEyeHeight_m = 1.65f;
inline constexpr float kUsualAspect = 16.0f / 9;

// Where the camera is put, above everybody's heads, whatever the rules of walking.
struct FlyingCamera {
  Vec2 position;
  float eye_height_m = 0;
  std::optional<float> yaw_rad;  // at once
};

struct Visitor;

// People who hold the visitor up though they are not of this town: those of a run that is shown beside it.
struct OtherPeople {
  std::vector<Vec2> position;
  std::vector<float> radius_m;
};

// What the visitor asks for in a step.
struct CameraInput {
  bool active = false;  // false: scenario or guided tour moves the camera
  Vec2 direction;       // asked way, unit or zero
  float speed_mps = 0, yaw_rate_radps = 0;
  std::optional<Vec2> walk_to;  // sets out for there; a direction ends it
  float walk_to_mps = 1.4f;
  std::optional<float> pitch_rad;
  std::optional<FlyingCamera> flies;  // while active
  TourWish tour;                      // active or not
  // Runs shown side by side go the same way at the same moments: one minds the others' people as well, all others go as
  // it has gone.
  const OtherPeople* minds = nullptr;
  const Visitor* as = nullptr;
};

struct CameraState {
  ViewCamera view;
  float pitch_rad = 0, eye_height_m = kEyeHeight_m;
  float aspect = kUsualAspect;  // of the picture, width over height
  Vec2 velocity;
  Vec2 asked_velocity;  // what the visitor wants: who holds them up sees it
  float yaw_rate_radps = 0, asked_mps = 0, actual_mps = 0;
  bool present = true;  // false: everybody counts as visible
  bool flies = false;   // above heads
};

// A part of a scenario's way.
struct CameraLeg {
  enum class Kind { kWalk, kTurn, kWait, kFollow, kWander } kind = Kind::kWait;
  Vec2 to_m;
  float speed_mps = 1.4f;
  float facing_deg = 0;  // while walking: the view's direction from the way's, anticlockwise
  float turn_deg = 0, rate_dps = 60;
  float wait_s = 0, look_about_deg = 0;  // so far to either side, to and fro at rate_dps
  float follow_s = 0, behind_m = 2.5f;   // whoever walks in view and is nearest when nobody is followed yet
  float wander_s = 0;                    // by legs drawn from the seed, see wander.h
  uint64_t seed = 1;
};

// How the visitor likes to be shown about.
struct VisitorComfort {
  float pace = 1;              // of the tour, and how long it lets one read where it is below 1
  bool captions_stay = false;  // as long as the stop can be heard
  bool clear_marks = false;    // on the ground
};

struct Visitor {
  CameraState camera;
  Start start;
  GuidedTour tour;
  Guide guide;
  PointWalk point_walk;
  float looks_aside_rad = 0;  // that the tour keeps the view turned away from the guide
  float looks_about_s = 0;    // left until the tour turns the view again
  VisitorComfort comfort;
  bool gentle = false;          // the tour turns the view slowly, and walks slowly
  std::vector<CameraLeg> legs;  // of the scenario; empty: the guided tour
  size_t leg = 0;
  float leg_done = 0;    // seconds waited or followed, or radians turned
  int followed_id = -1;  // by the leg; -1: nobody
  Random wander;         // of a leg that draws others,
  CameraLeg drawn_leg;   // the one drawn last,
  float wandered_s = 0;  // and since when it does; 0: nothing is drawn yet
  float stuck_s = 0;     // since the camera got away from stuck_at
  Vec2 stuck_at;
  bool finished = false;  // the last leg is over
};

// What a visitor's step works on.
struct VisitorInTown {
  const ControlSettings& settings;
  Town& town;
  Visitor& visitor;
  const OtherPeople* others = nullptr;  // who hold the visitor up as well
};

}  // namespace flaneur
