// Waits for whoever edits a tour. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <vector>

namespace flaneur {

// Remembers the files of these tours, and scripts beside them, as they are. Before the first bake.
void BeginWatching(const std::vector<std::filesystem::path>& tours);

// Returns when one has changed since then, or since the last return, and the change is over. False: interrupted.
bool AwaitChange(const std::vector<std::filesystem::path>& tours);

}  // namespace flaneur
