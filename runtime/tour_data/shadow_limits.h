// What people's shadows may take at most: the control counts by it, the renderer keeps to it.
#pragma once

namespace flaneur {

inline constexpr float kFineShadow_m = 12;   // nearer people cast the shadow of their coarsest mesh,
inline constexpr float kTwoShadows_m = 18;   // nearer ones may stand on a border and cast the coarser one twice,
inline constexpr float kShadowReach_m = 72;  // those beyond of a much coarser figure, and nobody from here on

// Triangles of the two figures: the fine one, which has no more than the coarsest level either, and the coarse.
inline constexpr int kMaxShadowTriangles[] = {1600, 96};

}  // namespace flaneur
