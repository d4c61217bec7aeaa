// Whose something unfinished is, as a part of its name: a process, which may have ended without tidying up, on this
// machine or on another that shares the folder. Internal to pipeline/core.
#pragma once
#include <string>
#include <string_view>

namespace flaneur {

// This process's mark.
std::string OwnerMark();

// Whether the process whose mark is found in `name` has surely ended. Of another machine's nobody can tell: no.
bool OwnerHasEnded(std::string_view name);

}  // namespace flaneur
