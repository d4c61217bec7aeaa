// What people and birds of one model differ in, for life. Internal to runtime/show.
#pragma once
#include <array>
#include <cstdint>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// DrawnPerson's tints and size. Those who came one after the other, as those of a group, wear different colours.
std::array<uint8_t, 3> TintsOf(const PackAvatar& avatar, int id);
float SizeOf(const PackAvatar& avatar, int id);

}  // namespace flaneur
