// What people do for a visitor who stands somewhere, whether the crowd adapts or not. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// Whoever stood there would fill the visitor's view, or stand at their elbow.
bool IsBeforeEyes(const Viewer& viewer, Vec2 p);

// Once a step, for everybody. True where somebody cannot get on, or where they want to be, for the visitor: they had
// better go somewhere else.
bool IsHeldUpByVisitor(size_t person, const Viewer& viewer, Town* town);
// A field to go to then, on their side of the visitor if there is any.
int DestinationAway(size_t person, const Viewer& viewer, Town* town);

}  // namespace flaneur
