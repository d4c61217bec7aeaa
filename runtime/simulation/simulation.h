// The tour as it plays: the town, the visitor and the control, one fixed step at a time. Knows nothing of drawing.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/control/control.h"
#include "runtime/pack/tour_pack.h"
#include "runtime/simulation/birds.h"
#include "runtime/simulation/scenario.h"
#include "runtime/town/town.h"
#include "runtime/walk/visitor.h"

namespace flaneur {

struct Simulation {
  Town town;
  Visitor visitor;
  Control control;
  std::vector<MovingObstacle> moving;  // of this step: the visitor, the guide, the paper's camera obstacles
  BirdLevels birds;
  DrawingModel drawing;
  std::optional<float> hour;  // of the day at the start; none: the light of the pack
  int screen_width_px = kUsualWidth_px, screen_height_px = kUsualHeight_px;  // of the picture levels are chosen for
  float relief_m = 0;                  // between the lowest and the highest ground to walk on
  double step_ms = 0, control_ms = 0;  // what the last step took, and the control's part of it
};

inline float Step_s(const Simulation& s) { return Step_s(s.control.settings); }
inline float Time_s(const Simulation& s) { return static_cast<float>(s.town.step) * Step_s(s); }
inline VisitorInTown InTown(Simulation* s) { return {s->control.settings, s->town, s->visitor}; }

// `pack` may be null where the scenario has its own ground. Errors: no walkable ground, a scenario's person inside an
// obstacle or with a goal nobody can reach, an unknown avatar, no ground at all; each names the person. More people
// than fit: as many as do, and a warning. `simulation` stays where it is from the first step on; `jobs` outlives it.
Error StartSimulation(const TourPack* pack, const Scenario& scenario, Simulation* simulation, Jobs* jobs = nullptr);

// Horizontal; the outer volume follows.
void SetFieldOfView(float fov_rad, Simulation* simulation);

// The picture's size: levels, and what a pitched camera sees, follow.
void SetPictureSize(int width_px, int height_px, Simulation* simulation);

// What drawing this frame takes by the scenario's model of a machine; 0 without one.
float FrameTimeByModel_ms(const Simulation& simulation);

// frame_ms: what the last frame took, for the frame-time method; 0: unknown.
void StepSimulation(const CameraInput& input, float frame_ms, Simulation* simulation);

}  // namespace flaneur
