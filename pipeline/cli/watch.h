// Waits for whoever edits a tour. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <vector>

namespace flaneur {

// Returns when a file of these tours, or a script beside one, has changed since the last call, and the change is over.
// False: interrupted.
bool AwaitChange(const std::vector<std::filesystem::path>& tours);

}  // namespace flaneur
