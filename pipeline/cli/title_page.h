// The title page that tour.toml names: a picture that fills the screen, and a logo over it. Internal to pipeline/cli.
#pragma once
#include <filesystem>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/toml_table.h"
#include "runtime/tour_data/title_page.h"

namespace flaneur {

struct TitlePageSettings {
  std::filesystem::path picture, logo;  // empty: none
  Vec3 background = TitlePage{}.background;
};

// Of the table [title_page].
void ReadTitlePageSettings(TomlTable table, TitlePageSettings* settings);

std::vector<std::filesystem::path> FilesOf(const TitlePageSettings& settings);

// In the sizes and formats of a pack. Errors: a file that is no picture; names it.
Error MakeTitlePage(const TitlePageSettings& settings, TitlePage* page);

}  // namespace flaneur
