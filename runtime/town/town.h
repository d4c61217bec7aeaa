// The town as it lives: its ground and places, its people, and what they have in mind. Knows nothing of who looks at it
// but what a Viewer says, and nothing of drawing.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/random.h"
#include "runtime/control/enclosure.h"
#include "runtime/control/view_volumes.h"
#include "runtime/crowd/crowd.h"
#include "runtime/crowd/density_map.h"
#include "runtime/crowd/field_builder.h"
#include "runtime/tour_data/tour_data.h"
#include "runtime/town/flock.h"
#include "runtime/town/outlook.h"

namespace flaneur {

struct Area {
  Vec2 min_m, max_m;
};

inline bool Contains(const Area& area, Vec2 p) {
  return p.x >= area.min_m.x && p.y >= area.min_m.y && p.x <= area.max_m.x && p.y <= area.max_m.y;
}

// Somebody whom a scenario names.
struct ScenarioPerson {
  Vec2 position_m;
  std::vector<Vec2> goals_m;
  bool stay = false;
  std::string avatar, group;                             // who names the same group walks together; empty: alone
  float speed_mps = 0, top_speed_mps = 0, radius_m = 0;  // 0: the pack's
};

struct PersonPlan {         // of one person
  std::vector<Vec2> goals;  // after the present one, next first
  bool stay = false, leaves = true;
  bool loiters = false;  // on the way to a loiter place, or there
  int spot = -1;         // index into Town::loiter_spots, of the one that is theirs
  float held_up_s = 0;   // by the visitor, near this place
  Vec2 held_up_at{};
  int work = -1;     // index into Town::work_spots, of the one that is theirs
  int play = -1;     // index into Town::play_places, of the one where they play
  float play_s = 0;  // of play: left to stand, or before they give up a way
  int id = -1;       // whose it is
};

struct LoiterSpot {       // where one person can stand at a loiter place
  Vec2 position_m, look;  // look: unit vector to what there is to see
  int place = 0;          // index into Town::places
  bool taken = false, there = false;
  int partner = -1;  // index of the spot whose occupant they talk with
};

struct WorkSpot {         // where one person works
  Vec2 position_m, look;  // look: unit vector, as in LoiterSpot
  int place = 0;          // index into Town::places
  float room_m = 0;       // to the nearest obstacle
  bool taken = false, there = false;
  float left_s = 0;  // taken: that they stay there, where they do not stay for ever; free: until somebody comes
};

struct PlayPlace {
  int place = 0;             // index into Town::places
  std::vector<Vec2> points;  // between which they run, two at least
};

struct PlaceLists {                                                                 // indices into Town::places
  std::vector<int> gates, goals, loiters, spawns, works, plays, destinations, all;  // all: without works, plays
};

// Of an avatar, as far as whom it may be and how much room they take.
struct Resident {
  std::string avatar;  // its name
  float share = 1;     // of the crowd, relative to the others'
  float radius_m = 0.25f;
  float reach_m = 0;                          // of what is drawn of them, as Crowd::reach_m
  bool leads = false;                         // is the guide's figure, and nobody's besides
  std::vector<std::string> other_clips = {};  // what they can do at work, by Crowd::doing
  std::vector<float> clip_mps = {};           // of each, the speed it is made for; 0: on the spot
  std::vector<uint8_t> clip_sits = {};        // of each, whether it has a seat
};

inline constexpr const char* kPlainFigure = "person";  // everybody's avatar where there is no pack

struct Town {
  std::vector<Resident> residents;  // by avatar
  CrowdSettings settings;
  Walkable walkable;
  std::vector<Place> places;
  Painting painting;
  PlaceLists place_lists;
  std::vector<LoiterSpot> loiter_spots;  // by place
  std::vector<WorkSpot> work_spots;      // one a place
  std::vector<PlayPlace> play_places;
  std::vector<int> place_of_field;  // by index into crowd.fields, -1: no place; see PlaceOfField
  std::optional<Area> crowd_area;   // in which people start and walk about; none: all over town
  int target_people = 0;            // kept up by people who appear out of sight
  int next_company = 0;             // how many come together next, once there is room for them; 0: not drawn yet
  int loiterers = 0;                // people whose plan is to loiter,
  int workers = 0;                  // to work

  std::vector<FlockState> flocks;

  Crowd crowd;
  CrowdScratch scratch;  // of whoever steps the crowd
  Jobs* jobs = nullptr;  // build fields; they outlive the town
  FieldBuilder field_builder;
  std::vector<PersonPlan> plans;  // by Crowd::slot, see PlanOf
  Enclosure enclosure;
  Outlook outlook;
  std::vector<std::pair<size_t, std::array<int8_t, Outlook::kMoments>>> outlook_near;  // scratch of StepOutlook
  DensityMap density;                                                                  // of everybody, once a second
  Random random;
  int64_t step = 0;                   // so many are over
  std::vector<std::string> warnings;  // of what cannot be as the tour says
};

inline PersonPlan& PlanOf(size_t person, Town* town) {
  return town->plans[static_cast<size_t>(town->crowd.slot[person])];
}
inline const PersonPlan& PlanOf(size_t person, const Town& town) {
  return town.plans[static_cast<size_t>(town.crowd.slot[person])];
}

// What the townspeople's comings and goings heed of the visitor and of the control.
struct Viewer {
  const ControlSettings& settings;
  bool present = true;  // false: everybody counts as visible, and nobody has to be kept out of the way
  ViewCamera camera;
  Vec2 velocity;
  float outer_apex_back_m = 0;
  int high = 0, limit = 0;  // people in high resolution now, and the most there may be
};
// The visitor's body: as wide as ways are laid for, so that whatever stands about stays well before the near plane, and
// never so narrow that a wall would be cut by it.
inline constexpr float kCameraRadius_m = 0.3f, kWidestCamera_m = 0.45f;
inline float CameraRadius_m(const Walkable& w) {
  return std::clamp(w.person_radius_m, kCameraRadius_m, kWidestCamera_m);
}
inline bool Adapts(const Viewer& viewer) { return viewer.present && viewer.settings.adaptation == Adaptation::kFull; }

}  // namespace flaneur
