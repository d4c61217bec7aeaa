// Sending people somewhere, together with whom they walk with. Internal to runtime/town.
#pragma once
#include "runtime/town/town.h"

namespace flaneur {

// The people who do what a person does: the group, or the person alone.
struct Company {
  int size = 1;
  size_t member[kMaxGroupSize];  // indices of the crowd's arrays
};

Company CompanyOf(const Crowd& crowd, size_t person);

// Sends the person to a field's goal, -1 to stay; a loiter spot of theirs is free again.
void Send(size_t person, int field, Town* town);
void SendAll(const Company& company, int field, Town* town);

}  // namespace flaneur
