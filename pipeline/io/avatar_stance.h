// How a figure as read stands in the world: up, facing, size, and what its file makes doubtful about them.
#pragma once
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"
#include "pipeline/rig/humanoid.h"
#include "runtime/base/error.h"

namespace flaneur {

// "x", "-x", "y", ...: a direction in the file.
Error ReadAxis(const std::string& text, Vec3* axis);

// Turns everything about the origin: bind pose, rest pose and, where `clips`, all clips.
void TurnFigure(Quat turn, bool clips, Avatar* avatar, Mesh* body);

// Stands the figure up: by `up` and `forward` where given, else by its skeleton, the bind pose and the clips each as
// they need it, by quarters. A bind pose or walk that lies or stands on its head is turned, with a warning; one that
// faces elsewhere is left to the walk.
Error StandUp(const std::string& up, const std::string& forward, const std::vector<NamedBone>& told, Avatar* avatar,
              Mesh* body, std::vector<std::string>* warnings);

// Where the figure faces in its walk, unit and level: on the whole as the mean over the walk, which sways, and to the
// degree as the bind pose where that faces the same way. `by_shape`: the joints' names don't tell, so that front and
// back may be the wrong way round. False where nothing tells.
bool FacingInWalk(const Avatar& avatar, const std::vector<NamedBone>& told, const Clip& walk, Vec3* forward,
                  bool* by_shape);

// By how much the head is lower in the bind pose than it is standing, over the feet: of who is bound seated or in a
// stride. 0 where it is not, or where that cannot be told.
float BoundLowerBy(const Avatar& avatar, const std::vector<NamedBone>& told);

// The height that a person with this skeleton would have, without hats and hair, in the figure's unit; 0: not told.
float HeightOfSkeleton(const Avatar& avatar, const std::vector<NamedBone>& told);

// The unit, in metres, in which a person of that height is one: 0.01 for 175. 0: none.
float UnitOf(float height);

// Vertices that hang on feet or what is below them; empty where no feet are known.
std::vector<bool> OnFeet(const Avatar& avatar, const std::vector<NamedBone>& told, const Mesh& mesh);

// Whether the skeleton has a head that nothing hangs on, as outfits have that are sold without a body.
bool IsHeadless(const Avatar& avatar, const std::vector<NamedBone>& told);

// Whether a second person's bones are among the joints; `which`: one of them.
bool HasSecondPerson(const std::vector<Joint>& joints, std::string* which);

}  // namespace flaneur
