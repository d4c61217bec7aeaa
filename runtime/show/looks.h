// What people and birds of one model differ in, for life. Internal to runtime/show.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "runtime/pack/tour_pack.h"

namespace flaneur {

// Of a number of turns: what goes beyond whole ones.
inline float Fraction(float x) { return x - std::floor(x); }

// DrawnPerson's tints, size and breadth. Those who came one after the other, as those of a group, wear different
// colours.
std::array<uint8_t, 3> TintsOf(const PackAvatar& avatar, int id);
float SizeOf(const PackAvatar& avatar, int id);
float BreadthOf(const PackAvatar& avatar, int id);

}  // namespace flaneur
