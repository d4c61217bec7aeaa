// Who will be near the visitor in the next seconds, over all of the town that can get there: what people's choices of
// where to go heed, so that hardly anybody has to be kept away once they are in view. Internal to runtime/town.
#pragma once
#include <array>

#include "runtime/base/math.h"
#include "runtime/control/sectors.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {

struct Town;
struct Viewer;

struct Outlook {
  static constexpr int kMoments = 4;

  struct Moment {
    Vec2 visitor;             // forecast
    Sectors<int> around{};    // people within r_high
    Sectors<int> too_many{};  // in the fullest view over the sector; negative: so many more have room
  };
  Vec2 velocity;         // the visitor's, averaged over some seconds
  float reach_m = 0;     // of what counts, r_high
  float pressure = 0;    // 0 to 1: how strictly the limit is kept; grows while there are too many
  float usual = 0;       // people in the fullest view if everybody near were spread evenly, averaged
  bool is_full = false;  // there are too many in some view of some moment
  std::array<Moment, kMoments> moments{};
};

// Before anybody is placed: where they start heeds the limit as well. The first picture keeps it however many are usual
// there; in other views as many more may be as later.
void BeginOutlook(int people, const Viewer& viewer, Town* town);
bool ShowsTooManyAtStart(const Viewer& viewer, const Town& town, Vec2 p);
bool HasRoomAtStart(const Viewer& viewer, const Town& town, Vec2 p);

// Only with full adaptation. Looks a few times a second, and sends people elsewhere who are out of sight, or far away,
// and would be too many.
void StepOutlook(const Viewer& viewer, Town* town);

// How much somebody counts who walks like this from `from` to the goal of a field: 0, where there is room for them all
// the way.
float InTheWay(const Viewer& viewer, const Town& town, Vec2 from, int field, float speed_mps);

// True where somebody who stays at p is too many, soon or now.
bool IsFullAt(const Viewer& viewer, const Town& town, Vec2 p);

}  // namespace flaneur
