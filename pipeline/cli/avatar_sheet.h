// Contact sheets of people: their levels and clips at a glance.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/avatar.h"

namespace flaneur {

// PNG: the levels, walking, from the front and half from behind; then each clip's phases from the left, one from the
// front and one from behind.
std::vector<uint8_t> AvatarSheet(const AvatarLevels& levels);

struct SheetEntry {
  std::filesystem::path input;
  Avatar avatar;  // empty where it could not be read
  std::filesystem::path picture, output;
  std::vector<std::string> warnings;
  std::string error;
};

// An HTML page that shows the pictures beside it, with each person's figures, warnings and errors.
std::string SheetPage(const std::vector<SheetEntry>& entries);

}  // namespace flaneur
