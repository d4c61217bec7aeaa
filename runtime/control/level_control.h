// Who is drawn how: levels of detail within the triangle budget (paper, sections 3.2 and 4).
#pragma once
#include <vector>

#include "runtime/control/person_level.h"
#include "runtime/control/props.h"
#include "runtime/control/shadows.h"
#include "runtime/control/view_volumes.h"

namespace flaneur {

inline constexpr int kImpostorTriangles = 2;
inline constexpr int kUsualWidth_px = 1280, kUsualHeight_px = 720;  // of a picture, where nothing is drawn

struct LevelCost {
  int triangles = 0;
  float switch_px = 0;
};  // needed at this height on screen or above

struct AvatarCosts {
  std::vector<LevelCost> levels;  // finest first
  float height_m = 1.75f;
  float impostor_px = 128;  // height of its picture: adequate below one screen pixel per texel
  std::vector<Prop> props = {};
  ShadowCost shadow = {};
  std::vector<std::string> other_clips = {};  // names, by Crowd::doing
};

// What levels are chosen for in this step.
struct LevelQuery {
  ViewCamera camera;
  ViewMotion motion;                     // of the camera, in this step
  float frame_ms = 0;                    // what the last frame took, for LimitMethod::kFrameTime; 0: not known
  int screen_width_px = kUsualWidth_px;  // of the picture
  int64_t taken_triangles = 0;           // of the budget, by what is no person
  int first_id = -1;  // who is served before all others, and so is no impostor while anybody is a mesh; -1: nobody
};

struct LevelState {
  float r_high_m = 0;            // in force; 0 before the first step
  float budget_triangles = 0;    // in force
  float triangles_a_person = 0;  // in high resolution, averaged over the last while; method 2
  float shadow_triangles = 0;    // of everybody, likewise
  int limit = 0;                 // most people in high resolution, in force
  float headroom = 0;            // in force: who comes near starts with the level that serves at so many times the
                                 // pixels; below 1, where the budget is short, all are a little too coarse

  std::vector<PersonLevel> people;  // by person index
  struct Gone {
    int slot = 0, id = 0;
    PersonLevel level;
  };
  std::vector<Gone> gone;             // who has left the town before the visitor's eyes: they fade where they were
  std::vector<uint8_t> casts_shadow;  // by person index; how far it reaches is in `shadows`
  // Of those in view.
  int high = 0, low = 0, shortfalls = 0, switches_in_view = 0;
  // Of everybody who is drawn: who comes into the picture before the next step, or was in the last, counts as well.
  int meshes = 0, impostors = 0;
  int64_t triangles = 0;         // with props and the levels that fade out, but without shadows
  int64_t fading_triangles = 0;  // of them, of levels that fade out
  Props props;
  Shadows shadows;
  bool exceeded = false;

  ViewMotion motion;     // the camera's, averaged over a moment
  ViewCamera camera;     // of the last step
  bool started = false;  // there was one

  // What is remembered of somebody from step to step.
  struct Memory {
    int id = -1;
    PersonLevel level;
    int triangles = 0, from_triangles = 0;  // that these take
    bool in_sight = false;                  // in the last step
    bool here = false;                      // in this step, and near enough to be drawn
  };
  std::vector<Memory> memory;            // by slot
  std::vector<int> drawn, drawn_before;  // slots: of who is drawn in this step, and was in the last

  struct InSight {
    float distance_m, key_m;
    int person, id;
    uint8_t priority;
  };
  std::vector<InSight> in_sight;  // scratch: who may be in a picture until the next step
  std::vector<int> too_far;       // scratch: indices of who is in view, and was drawn, but no longer near enough
  std::vector<float> nearest;     // scratch
};

// The level of who is in view, chosen for this step; kNotDrawn: of all others.
inline Level LevelInView(const Crowd& crowd, const LevelState& state, size_t i) {
  return crowd.view[i] == ViewClass::kVisible ? state.people[i].level : kNotDrawn;
}

// Chooses everybody's level for this frame. LimitMethod::kCount keeps high_limit; with kFrameTime the budget follows
// the frame time towards target_ms, or 0.85 of it while the camera moves fast (paper, section 3.2), and the limit is
// what the budget affords. Both are about everybody of whom any part may be in a picture until the next step: pictures
// come between steps, and follow the hand that turns the view at once. The budget is for all triangles together,
// shadows included, and holds whatever happens: who does not fit becomes an impostor, and where even those do not fit,
// the farthest are not drawn. Where it is short for long, all who are near get coarser levels before the last of them
// is served with none, and get them back when there is plenty. A change of level, and appearing or vanishing within the
// view, is faded where the budget has room for both levels.
void ChooseLevels(const Crowd& crowd, const std::vector<AvatarCosts>& avatars, const ControlSettings& settings,
                  const LevelQuery& query, LevelState* state);

}  // namespace flaneur
