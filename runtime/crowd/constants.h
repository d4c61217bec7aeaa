// Tuned numbers of the crowd, each with its unit and reason.
#pragma once
#include <cstddef>
#include <cstdint>

namespace flaneur {

// Fewer than this take a step in the caller's thread alone: sharing them out takes as long as their step.
inline constexpr size_t kFewPeople = 4000;

// Starting, stopping and stepping aside take adults about half a second (Fruin 1971; Teknomo 2002).
inline constexpr float kMaxAcceleration_mps2 = 3.0f;
// A body turns a right angle in about half a second when it has to; on the way far slower.
inline constexpr float kMaxTurnRate_radps = 3.6f;
// Slower than this the body keeps its heading, so that a jam doesn't make people spin.
inline constexpr float kTurnsAbove_mps = 0.15f;
// Time in which people settle into the velocity they prefer. Moussaid et al. 2009 measured 0.54 s from standing, and
// the limit of acceleration sees to that; walkers who were pushed off their way are back on it sooner.
inline constexpr float kRelaxation_s = 0.25f;

// How far ahead collisions are predicted; people evade 2 to 4 s before (Karamouzas, Skinner and Guy 2014).
inline constexpr float kAnticipation_s = 3.0f;
// The interaction energy of the same paper, k tau^-2 exp(-tau / tau0).
inline constexpr float kInteraction_k = 1.5f;
inline constexpr float kInteraction_tau0_s = 3.0f;
// One predicted collision never asks for more than this: beyond it contact resolution takes over.
inline constexpr float kMaxPush_mps2 = 5.0f;
// Passing so close is fine; chosen, with the next two, by the open field, the corridor and the classic cases of the
// tests.
inline constexpr float kPassing_m = 0.02f;
// Who comes from the right across one's way, by more than an angle of this sine, is let go first: so much braking is
// kept for them.
inline constexpr float kCrossing = 0.5f;
inline constexpr float kGiveWay = 0.4f;
// Nobody but people gives way between them and the visitor, or another disc: they mind it so many times as much as each
// other.
inline constexpr float kDiscMinded = 3.0f;
// What happens at one's back is felt, not foreseen.
inline constexpr float kAttentionBehind = 0.2f;
// Two who meet head on both step to their right: each sees the other turned this far to the left (radians).
inline constexpr float kPassOnTheRight_rad = 0.06f;
// Others farther than this don't matter within the anticipation at usual closing speeds.
inline constexpr float kNeighbourRadius_m = 3.0f;
// Cells of the grid in which people find each other.
inline constexpr float kGridCell_m = kNeighbourRadius_m / 2;

// People keep this beyond touching when they have the choice.
inline constexpr float kComfort_m = 0.12f;
inline constexpr float kSeparation_mps2 = 0.6f;
// Contacts are resolved until nothing moves, at most so many times a step.
inline constexpr int kContactPasses = 10;
// Pairs that corrections could bring together are watched too.
inline constexpr float kContactMargin_m = 0.02f;

// Weidmann 1993: v = v0 (1 - exp(-1.913 (1 / rho - 1 / rho_max))), rho_max = 5.4 people/m^2.
inline constexpr float kWeidmannGamma_pm2 = 1.913f;
inline constexpr float kWeidmannMaxDensity_pm2 = 5.4f;
inline constexpr float kMinDensitySpeed = 0.1f;  // share of the preferred speed: a jam still creeps and can dissolve
inline constexpr float kDensityRadius_m = 3.0f;

// Keeping off walls: a gentle push within this beyond touching.
inline constexpr float kWallComfort_m = 0.25f;
inline constexpr float kWallPush_mps2 = 2.5f;

// Cost of a metre of ground by kind, relative to pavement: none, carriageway, pavement, square, grass.
inline constexpr float kGroundCost[] = {0, 1.6f, 1.0f, 1.1f, 3.0f};
// A metre close to a wall costs this much more, so that ways keep off corners where there is room.
inline constexpr float kNearWallCost = 1.25f;
inline constexpr float kNearWall_m = 0.35f;
// People keep so much from obstacles where they have the choice: the navigation grid's free cells do. A door that
// leaves them less is gone through all the same, at such a cost that straight ways and whoever has another keep out of
// it.
inline constexpr float kByChoice_m = 0.05f;
inline constexpr float kNarrowCost = 1.5f;
// A metre up or down a gradient g counts 1 + 4 |g|, near the energy of walking on gentle slopes (Minetti et al. 2002).
inline constexpr float kSlopeCost = 4.0f;
// Gentler slopes are level to those who look for a straight way: they cost no more than a wall near by.
inline constexpr float kLevelSlope = (kNearWallCost - 1) / kSlopeCost;
// And is walked at 1 / (1 + 2 |g|) of the speed (near Tobler 1993 for the slopes of a town).
inline constexpr float kSlopeSlows = 2.0f;

// Cells of the navigation grid: a doorway of 1 m leaves 0.4 m to the centres of people, which holds at least one of
// them.
inline constexpr float kNavigationCell_m = 0.35f;
inline constexpr float kMaxNavigationCells = 1.5e6f;  // larger areas get larger cells
// A flow field that is built beside the steps comes after one step for each so many cells, and one more. At 30 steps a
// second that is 0.13 s for 326,000 cells, of which a free one in three takes a desktop computer of 2020 28 ms.
inline constexpr int64_t kCellsAStep = 90000;
// Walking into a goal's circle counts as arriving.
inline constexpr float kArrival_m = 0.5f;
// Where many have the same goal, those who come and those who leave would block each other for good: who is this near
// and gets on at less than such a share of their speed is there as well as anybody can be.
inline constexpr float kNearArrival_m = 3;
inline constexpr float kHeldUp = 0.4f;

// So many questions for the way to one goal are worth a flow field.
inline constexpr int kSharedGoal = 8;
// Every so many steps it is looked who still goes where; a field that nobody has gone by at two looks is let go: it
// takes as many bytes as the ground has cells, and most goals (a spot to stand at) are taken once in minutes.
inline constexpr int kFieldLook_steps = 300;
inline constexpr int kDesertedLooks = 2;

// People decide about ten times a second: reaction times are 0.1 to 0.2 s.
inline constexpr int kTurnEvery_steps = 3;
// Half as often, and at twice the distance a quarter as often, where nobody can see what they do.
inline constexpr int kFarTurnEvery_steps = 2 * kTurnEvery_steps, kFarthestTurnEvery_steps = 4 * kTurnEvery_steps;
// Lines of sight to the goal are renewed once in so many steps; once in twice as many while it is in sight.
inline constexpr int kSightEvery_steps = 10 * kTurnEvery_steps;
// People who were near each other so many steps ago mostly still are.
inline constexpr int kSortEvery_steps = 256;
// Who is out of sight and far from everything walks straight on for up to so many steps.
inline constexpr int kMaxCoast_steps = 8 * kTurnEvery_steps;

}  // namespace flaneur
