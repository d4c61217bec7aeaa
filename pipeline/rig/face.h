// Faces that blink and speak without morph targets: the player moves vertices by joints alone.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/face_names.h"

namespace flaneur {

// How far a movement of the face takes each vertex, at its fullest, in the bind pose.
struct FaceShape {
  FaceMove move = FaceMove::kNone;
  std::vector<std::vector<Vec3>> offsets;  // by the avatar's meshes; of a mesh that it leaves alone: empty
};

struct FaceJoint {
  int joint = 0;
  FaceMove move = FaceMove::kNone;
};

// Makes of each shape one to four joints that hang on the one which its vertices follow most, the head: a joint moves
// along one direction, and takes each vertex along by its weight as far as the shape goes that way. The joints' rest is
// the movement's end; in all clips they lie still on the head. A shape that joints make too little of, or that moves
// more than a face, is left out, with a warning, and one that nobody could see without.
std::vector<FaceJoint> AddFaceJoints(const std::vector<FaceShape>& shapes, Avatar* avatar,
                                     std::vector<std::string>* warnings);

// Lets the eyes blink in idle and talk, every 2 to 6 seconds, at moments that the avatar's name chooses, and the mouth
// open in talk. For that idle becomes as long as some blinks, and who has no idle or talk stands still in one. Clips
// must loop.
void MoveFace(const std::vector<FaceJoint>& face, Avatar* avatar);

}  // namespace flaneur
