// A visitor's settings where there are no files.
#pragma once
#include <string>
#include <vector>

#include "runtime/visit/player_settings.h"

namespace flaneur {

// As ReadPlayerSettings of a file with this text; `name` stands for it. PlayerSettingsText is the way back.
Error TakePlayerSettings(const std::string& text, const std::string& name, PlayerSettings* settings,
                         std::vector<std::string>* warnings);

}  // namespace flaneur
