// Warnings on stderr, one line each. Internal to runtime/player.
#pragma once
#include <string>

namespace flaneur {

void Warn(const std::string& what);

}  // namespace flaneur
