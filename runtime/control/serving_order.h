// In which order people in sight are served with meshes. Internal to runtime/control.
#pragma once
#include "runtime/control/level_control.h"

namespace flaneur {

// Within r_high in force by distance, and who is a mesh keeps being one until somebody is nearer by kHysteresis_m; then
// who is a mesh anyway, as long as nobody else needs the place; then who comes into view, since nobody sees them
// change, by how near they will come. Whoever was seen as an impostor stays one until r_high reaches them, and beyond
// that where they leave the view soon and do not pass close; but within kNear_m only as long as there is no room, or so
// many are near that places are kept for who comes next.
enum Priority : uint8_t { kWithin, kHolds, kAppears, kWhereRoom, kStays };

inline constexpr float kNear_m = 8;  // nearer impostors show blur and holes to everybody

// Where the view's two edges have people on their inner side.
struct ViewEdges {
  Vec2 inward[2];
};
ViewEdges EdgesOf(const ViewCamera& camera);

// off: from the camera; last: what they were drawn as in the last step, if they were in sight; first: they are served
// before all others.
LevelState::InSight InOrder(const Crowd& crowd, size_t i, Vec2 off, Level last, const ViewEdges& edges, bool first,
                            const ControlSettings& settings, const LevelState& state);

// a is served before b.
bool IsServedBefore(const LevelState::InSight& a, const LevelState::InSight& b);

}  // namespace flaneur
