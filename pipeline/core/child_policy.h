// What this process lets its child processes and its readers do. Decided once, by the verb that runs, before any work;
// afterwards all threads only read it.
#pragma once
#include <filesystem>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

struct ChildPolicy {
  double time_limit_s = 3600;  // of each child process; 0: none
  // Where files that others name (the URIs of a glTF, what a script reads) may lie. Empty: anywhere.
  std::vector<std::filesystem::path> roots;
};

void SetChildPolicy(ChildPolicy policy);
const ChildPolicy& GetChildPolicy();

// Whether `path`, links followed, lies in one of the folders; none: yes.
bool LiesWithin(const std::filesystem::path& path, const std::vector<std::filesystem::path>& folders);

// Errors: the file lies outside the policy's roots.
Error CheckWithinRoots(const std::filesystem::path& path);

}  // namespace flaneur
