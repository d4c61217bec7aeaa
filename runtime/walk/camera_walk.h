// How the camera moves: by the visitor, a scenario's legs or the guided tour, always under the crowd's rules
// (paper, 4.3.2).
#pragma once
#include "runtime/walk/visitor.h"

namespace flaneur {

// The asked direction is never changed: people ahead slow the camera and stop it at r_personal, walls stop it.
void MoveCamera(const CameraInput& input, const VisitorInTown& v);

}  // namespace flaneur
