// The program's own picture, for windows of tours without a logo; packaging/flaneur.svg is the same for menus.
#pragma once
#include <cstdint>
#include <vector>

namespace flaneur {

// RGBA, 8 bits a channel, top row first: a walker under a town gate.
std::vector<uint8_t> IconPicture(int side_px);

}  // namespace flaneur
