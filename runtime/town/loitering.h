// Standing about: at market stalls, at the well, in talking pairs and threes. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// Spots around each loiter place: a row and a half before what there is to see, or a circle where nothing is said of
// that.
void PrepareLoitering(Town* town);

// Counts the person among those who loiter, and no longer.
void PlanToLoiter(size_t person, Town* town);
void StopLoitering(size_t person, Town* town);

// Fewer stand about, or are on their way to it, than should.
bool FewLoiter(const Town& town);

// Free spots of one loiter place for so many people, in spots[0 ... count - 1]; those nearest to `from` come first.
// False where there are not enough, but for those right before the visitor's eyes.
bool FindSpots(const Viewer& viewer, const Town& town, int place, Vec2 from, int count, int* spots);
// The spot is theirs: they stand there (`now`), or walk there from nearby.
void TakeSpot(size_t person, int spot, bool now, Town* town);

// Whoever stands within reach of p sets out again.
void StirLoiterers(Vec2 p, float reach_m, Town* town);

// True where somebody whose time is over stays on, as too few stand about.
bool StaysOn(size_t person, const Viewer& viewer, Town* town);

// For everybody: who comes near the loiter place they go to looks for a spot; who stands looks at things and at each
// other, comes back when pushed aside, and sets out again when a detour is asked of them.
void StepLoitering(const Viewer& viewer, Town* town);

}  // namespace flaneur
