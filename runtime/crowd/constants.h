// Tuned numbers of the crowd, each with its unit and reason.
#pragma once

namespace flaneur {

// Mean top walking acceleration of adults; starting and stopping takes about half a second (Fruin 1971, Teknomo 2002).
inline constexpr float kMaxAcceleration_mps2 = 2.5f;
// A walking person turns a corner of 90 degrees within about a second; standing people turn faster than this but need not.
inline constexpr float kMaxTurnRate_radps = 2.8f;
// How far ahead collisions are predicted; people start to evade 2 to 4 s before (Karamouzas, Skinner, Guy 2014).
inline constexpr float kAnticipation_s = 3.0f;
// Strength of the power-law interaction energy, tau^-2 exp(-tau / tau0) (same paper, section III).
inline constexpr float kInteraction_k = 1.5f;
inline constexpr float kInteraction_tau0_s = 3.0f;
// Time in which people settle into the velocity they prefer (Helbing and Molnar 1995: 0.5 s).
inline constexpr float kRelaxation_s = 0.5f;
// Neighbours farther than this don't matter within the anticipation at walking speeds that close in.
inline constexpr float kNeighbourRadius_m = 3.5f;
inline constexpr int kMaxNeighbours = 10;  // the nearest decide; more only cost time
// People keep this beyond touching when they have the choice.
inline constexpr float kComfort_m = 0.12f;
inline constexpr float kSeparation_mps2 = 6.0f;
// Weidmann 1993: v = v0 (1 - exp(-1.913 (1/rho - 1/rho_max))), rho_max = 5.4 people/m^2.
inline constexpr float kWeidmannGamma = 1.913f;
inline constexpr float kWeidmannMaxDensity_pm2 = 5.4f;
// Cost of a metre of ground by kind, relative to pavement: none (not walkable), carriageway, pavement, square, grass.
inline constexpr float kGroundCost[] = {0, 1.6f, 1.0f, 1.1f, 3.0f};
// Cells of the navigation grid; half a person's width keeps doors of 1 m open.
inline constexpr float kNavigationCell_m = 0.5f;
// Walking into a goal's circle counts as arriving.
inline constexpr float kArrival_m = 0.7f;

}  // namespace flaneur
