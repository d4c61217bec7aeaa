// People who walk together: abreast where there is room, in file where it is narrow; who is ahead waits, who is behind
// catches up.
#pragma once
#include <vector>

#include "runtime/base/jobs.h"
#include "runtime/crowd/walkable.h"

namespace flaneur {

struct Crowd;

inline constexpr int kMaxGroupSize = 4;

struct Group {
  int size = 0;
  int member[kMaxGroupSize] = {};  // indices of the crowd's arrays
  Vec2 ahead;                      // unit vector of the common way, averaged over a moment; zero: not known yet
  float room_m = 0;                // across the way, from here to where the group will soon be
  int abreast = 0;                 // in a row at the moment; 0: not known yet
  float pace[kMaxGroupSize] = {};  // what each member asks for: share of the own speed; 0: nothing
  Vec2 push[kMaxGroupSize] = {};   // and acceleration
};

// The people at the given indices, 2 to kMaxGroupSize of them and none in a group so far, go together from now on, at
// the speed of their slowest. Their goals stay the caller's to set.
void AddGroup(const std::vector<int>& members, Crowd* crowd);

// The person goes alone from now on; who is then left without company does too.
void LeaveGroup(size_t index, Crowd* crowd);

// Changes what members whose turn it is (steering.h) ask for in Crowd::mind, so that they get to their places in the
// group and stay there. Whoever is on a detour, stands or is out of sight is left alone. Allocates nothing.
//
// Places in a row are an elbow room apart, the inner ones of three and more slightly back: the V and U shapes of
// Moussaid, Perozo, Garnier, Helbing and Theraulaz, The walking behaviour of pedestrian social groups, PLoS ONE 5(4),
// 2010.
void WalkTogether(const Walkable& w, Jobs* jobs, Crowd* crowd);

}  // namespace flaneur
