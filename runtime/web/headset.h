// A visit by headset: where the room of the headset stands in the town, and what its eyes see there. The room has the
// axes of WebXR: x right, y up from the floor, z behind. Internal to runtime/web.
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "runtime/control/head_view.h"
#include "runtime/render/eyes.h"
#include "runtime/simulation/simulation.h"

namespace flaneur {

// As WebXR tells it.
struct RoomEye {
  Mat4 projection, eye_from_room;
  Vec3 place;  // in the room
  int left_px = 0, bottom_px = 0, width_px = 0, height_px = 0;
};

struct Headset {
  bool worn = false;
  float yaw_rad = 0;  // of the room's front, in the town
  Vec2 middle_m;      // of the room's floor (x, z): what of it stands where the visitor's body is
  float own_fov_rad = 1, own_eye_m = kEyeHeight_m;  // without it
  ControlSettings own_settings;
  std::vector<RoomEye> eyes;
  Vec3 head;  // in the room
};

// The room's front is where the visitor looks. Control follows the headset's pictures and a head's turns from now on.
void PutOn(Vec3 head, float pictures_per_s, Simulation* simulation, Headset* headset);
void TakeOff(const Headset& headset, Simulation* simulation);
// The room turns about the visitor's head.
void TurnRoom(float angle_rad, Headset* headset);

// From the room to the town, in glTF's axes, for a body there.
Mat4 TownFromRoom(Vec3 body_on_ground, const Headset& headset);

// Before a step: the simulation sees by the head, to where `input` turns the view.
void LookWithHead(const Headset& headset, Simulation* simulation, CameraInput* input);
// A wish to walk that takes the body to where the head has gone in the room; none while it has hardly gone.
std::optional<Vec2> WalkUnderHead(const Headset& headset);
// After it: so far the body has followed.
void Followed(Vec2 moved_m, Headset* headset);

// For the picture.
std::vector<EyePicture> PicturesOf(const Headset& headset, Vec3 body_on_ground);

// Where a ray of the room meets ground that one can stand on, at most 12 m away and not behind anything.
std::optional<Vec2> LandingPlace(Vec3 from, Vec3 along, const Headset& headset, const Simulation& simulation);
// The visitor is there at once.
void Teleport(Vec2 place, Simulation* simulation, Headset* headset);
// A place of the town's ground, in the room.
Vec3 InRoom(Vec2 place, const Headset& headset, const Simulation& simulation);

}  // namespace flaneur
