// The townspeople: arrays by field, and the passes of one fixed step over them. Metres, seconds, radians, ground plane.
#pragma once
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/base/jobs.h"
#include "runtime/base/random.h"
#include "runtime/crowd/flow_field.h"
#include "runtime/crowd/groups.h"
#include "runtime/crowd/neighbours.h"
#include "runtime/crowd/slots.h"
#include "runtime/crowd/walkable.h"
#include "runtime/crowd/way_search.h"

namespace flaneur {

// How a person stands to the camera (paper, section 3.1). The values order by how much care is taken.
enum class ViewClass : uint8_t { kOutside, kBoundary, kVisible };
// kNear: within kNearArrival_m of the goal, and held up by others.
enum class Arrival : uint8_t { kNot, kNear, kThere };
// kWorking: keeps to a post, where nobody pushes them from, and is not asked to make room for the visitor's sake.
enum class Activity : uint8_t { kWalking, kStanding, kTalking, kWorking };

// A disc that some people keep out of: the visitor, or the paper's camera obstacles.
struct MovingObstacle {
  Vec2 center;
  float radius_m = 0;
  bool everyone = false;  // else only people with `avoids_camera`
  Vec2 velocity{};        // foreseen as it moves
  // Who has the choice passes so much farther away, of a disc that is for everyone; measured from a middle that lies so
  // far before its own.
  float room_m = 0;
  Vec2 before{};
  Vec2 talks_with{};  // from its middle, somebody to listen to: who has the choice does not pass between. Zero: nobody
};

// What a person has in mind between looks around (steering.h says when those are).
struct Mind {           // one line of the cache
  Vec2 ahead;           // unit vector of the heading
  Vec2 push;            // acceleration that people, walls and discs near ask for
  float asked_mps = 0;  // speed along the way
  float alone_mps = 0;  // what it would be without anybody around
  Vec2 clear_from;      // nothing stops anybody within clear_m of here
  float clear_m = 0;
  Vec2 left_line;   // where the person began to make room for the visitor
  int returns = 0;  // decisions left to go back to that line
  bool stands = false, avoids_camera = false;
  int8_t side = 0;   // on which they go round the visitor, see WayRound
  Vec2 round;        // unit vector of the way round the visitor; zero: the own way is free
  float lately = 1;  // speed along the way over what the density allows, mean over about two seconds
};

// From 0, who gets on, to 1, who has got nowhere lately, neither on nor back.
inline float IsHeldUp(const Mind& mind) {
  constexpr float kSlow = 0.12f, kNowhere = 0.08f;
  const float lately = mind.lately < 0 ? -mind.lately : mind.lately;
  return lately >= kSlow ? 0.0f : lately <= kNowhere ? 1.0f : (kSlow - lately) / (kSlow - kNowhere);
}

// Who was moved apart in this step, and no longer is where the grid has them: their indices, and lists by cell of the
// grid they are in now; -1 ends one.
struct Displaced {
  std::vector<int> people, first, next;
};

struct Crowd {
  std::vector<int> id, avatar;  // ids are never used again
  std::vector<int> slot;        // what others keep about a person stands here in their arrays, see slots.h
  std::vector<Vec2> position, velocity;
  std::vector<float> heading_rad, radius_m, preferred_mps, top_mps;
  std::vector<float> reach_m;  // of what is drawn of the person, from where they stand: arms, clothes, what they carry
  std::vector<float> view_reach_m;  // in this step, with what the tilt of the view adds; set with `view`
  std::vector<int> field;           // index into fields: where the person goes; -1: stays
  std::vector<Vec2> way;            // unit vector along the way there, zero: none; renewed now and then
  std::vector<uint8_t> sees_goal;   // walks straight to it; renewed now and then
  std::vector<Corner> corner;       // else, as long as the field isn't built: where the way leads first
  std::vector<Activity> activity;
  std::vector<Vec2> post;     // at work: where they stand or sit
  std::vector<int8_t> doing;  // at work: which of the avatar's other clips; -1: none
  std::vector<uint8_t> sits;  // at work: whoever comes, the visitor too, goes round them
  std::vector<float> wait_s;  // left to stand
  std::vector<Vec2> facing;   // where to look while standing; zero: as before
  std::vector<ViewClass> view;
  std::vector<uint8_t> was_visible;    // one step ago
  std::vector<uint8_t> avoids_camera;  // set by the control
  std::vector<Arrival> arrived;        // in the last step
  std::vector<Vec2> detour;  // velocity the person prefers for the next detour_s, whatever the goal; set by the control
  std::vector<float> detour_s;  // 0: none
  std::vector<float> walked_m;  // since appearing: drives the walk cycle
  std::vector<Mind> mind;
  std::vector<uint8_t> coast;      // steps left to walk straight on, out of sight and far from everything
  std::vector<int> group;          // index into groups; -1: alone
  std::vector<FlowField> fields;   // built where enough people have the same goal, let go where nobody has
  bool fields_come_later = false;  // true: a FieldBuilder builds those in asked_fields, not the step that asks
  std::vector<int> asked_fields;   // indices into fields
  std::vector<Group> groups;
  int next_id = 0;
  Slots slots;
  int64_t step = 0;
  // Farther than these from the viewer people decide half as often, and only follow their ways.
  Vec2 viewer;
  float r_unimportant_m = 1e9f, r_far_m = 1e9f;

  std::vector<Vec2> wanted;          // velocity, until the next decision
  std::vector<uint8_t> cares, turn;  // as decided last. turn: looks around and decides in this step
  WaySearch search;                  // knows this ground

  size_t size() const { return id.size(); }
};

// What passes need for their duration alone, whichever crowd it is: kept by who steps one so that a steady step
// allocates nothing. Holds nothing from one call to the next.
struct CrowdScratch {
  std::vector<int> caring;     // who cares, by index
  std::vector<Vec2> moved;     // by person: to where
  NeighbourGrid neighbours;    // of those who care
  std::vector<uint8_t> waits;  // by person: until everybody else has been looked at
  std::vector<std::pair<int, int>> contacts;
  std::vector<std::vector<std::pair<int, int>>> contacts_of_block;
  std::vector<uint8_t> pushed_in;  // by person: the pass of contact resolution that moved them last
  Displaced displaced;
  std::vector<uint64_t> order;  // where people are, along a curve, with their index
  std::vector<int> number;      // new index by old
  std::vector<std::byte> spare;
  std::vector<uint8_t> field_is_used;  // by field
};

struct Person {
  int avatar = 0;
  Vec2 position;
  float heading_rad = 0, radius_m = 0.25f, preferred_mps = 1.3f, top_mps = 1.9f;
  int field = -1;
  float reach_m = 0;  // see Crowd; never less than the radius
};

int AddPerson(const Person& person, Crowd* crowd);  // returns the id
void RemovePerson(size_t index, Crowd* crowd);      // the last one takes the place
// Gives people new indices so that who is near whom in the town is also near in memory: half of a step's time in a
// large crowd is waiting for memory. Everything else stays; for whoever steps a crowd to call every kSortEvery_steps.
void SortBySpace(CrowdScratch* scratch, Crowd* crowd);
// Sends the person there; -1: to stay.
void SetGoal(size_t index, int field, Crowd* crowd);
// The field for this goal; added, still to be built, where there is none yet.
int FieldFor(Vec2 goal, Crowd* crowd);
// Builds the field now, not only when enough people ask for their way.
void BuildField(const Walkable& w, int field, Crowd* crowd);
// The way from p to the goal of a field: looked up where it is built, and it is, or is asked for, for the eighth who
// asks; else searched for (way_search.h), so that any number of new goals in a step is no burden. `corner` is the
// asker's own.
Vec2 WayToGoal(const Walkable& w, int field, Vec2 p, bool look, Corner* corner, Crowd* crowd);

// One step of step_s. The same on every machine. Visible and boundary people within r_far_m of the viewer avoid each
// other; others only follow their way. Nobody's centre comes nearer to an obstacle than radius_m, nobody moves farther
// than top_mps * step_s. `jobs`: whose threads share the work where it is worth it (kFewPeople); the same bits with any
// number of them.
void StepCrowd(const Walkable& w, const std::vector<MovingObstacle>& moving, float step_s, CrowdScratch* scratch,
               Crowd* crowd, Jobs* jobs = nullptr);

// Boundary people who overlap are moved apart at once, none of them into the inner volume (paper, section 4.3.1).
// Whoever was visible one step ago stays where they are: the others make room. keep_out(p, reach_m) is true where
// somebody with that Crowd::reach_m would be in the inner volume at p. The class of those who were moved is the
// caller's to set anew: scratch->displaced.people.
void SeparateBoundary(const Walkable& w, bool (*keep_out)(Vec2 p, float reach_m, const void* volume),
                      const void* volume, CrowdScratch* scratch, Crowd* crowd);

// Over positions and headings: equal for equal runs.
uint64_t StateHash(const Crowd& crowd);

}  // namespace flaneur
