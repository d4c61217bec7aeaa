// The paper's control as one value: who is drawn how, and who is asked to go elsewhere.
#pragma once
#include <vector>

#include "runtime/control/foresight.h"
#include "runtime/control/level_control.h"
#include "runtime/tour_data/settings.h"

namespace flaneur {

struct Control {
  ControlSettings settings;
  std::vector<AvatarCosts> avatars;
  float outer_apex_back_m = 0;  // of the outer view volume, see OuterApexBack_m
  LevelState levels;
  ForesightState foresight;
};

}  // namespace flaneur
