// What every file from outside must bear, however broken: read it, and go on with what came of it.
#pragma once
#include <filesystem>
#include <string>

namespace flaneur::fuzz {

// Each returns what promise was broken, or nothing. A refusal must be one line that names the file; what is taken must
// be sound: indices in range, finite numbers, rings that are some. Crashes and endless loops are for the caller to see.
std::string TryTown(const std::filesystem::path& path);
std::string TryObstacles(const std::filesystem::path& path);

}  // namespace flaneur::fuzz
