// The pack's title page, read before all else: its description and the page's own bytes are enough.
#pragma once
#include <filesystem>
#include <string>

#include "runtime/tour_data/title_page.h"

namespace flaneur {

struct PackTitle {
  std::string title;  // in the language wished for, else in the tour's own, else its name
  TitlePage page;     // its files have not been decoded
};

// False where this is no pack that can be read so; a page that is damaged is left out. PackFile::Open says what is
// wrong with it.
bool ReadPackTitle(const std::filesystem::path& path, const std::string& language, PackTitle* title);

}  // namespace flaneur
