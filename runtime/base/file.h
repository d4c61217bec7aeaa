// Whole files in and out. Paths in messages are as given by the caller.
#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/error.h"

namespace flaneur {

// `extension` in small letters, as ".obj"; the file's may be in either.
bool HasExtension(const std::filesystem::path& path, std::string_view extension);

// Errors: missing, a directory, unreadable; each names the path.
Error ReadFile(const std::filesystem::path& path, std::vector<uint8_t>* bytes);
Error ReadTextFile(const std::filesystem::path& path, std::string* text);

// Writes beside the target, flushes, then renames: the target is either the old file or the whole new one.
// Creates missing parent folders. Errors: no permission, disk full.
Error WriteFile(const std::filesystem::path& path, std::span<const uint8_t> bytes);
Error WriteTextFile(const std::filesystem::path& path, std::string_view text);

// What WriteFile would complain of by now, told before long work instead of after it: a folder in the way, no
// permission, a disk that is full already. Leaves nothing behind.
Error CheckWritable(const std::filesystem::path& path);

}  // namespace flaneur
