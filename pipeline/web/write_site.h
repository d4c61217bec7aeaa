// A tour as a static web site.
#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

#include "pipeline/web/lighter_pack.h"
#include "pipeline/web/pieces.h"
#include "runtime/base/error.h"

namespace flaneur {

struct SiteOptions {
  std::filesystem::path pack, folder;
  // The player as a page's code; empty: what is installed or built with this program.
  std::filesystem::path player;
  Lighter lighter;
  PieceLimits limits;
};

struct SiteResult {
  size_t first_bytes = 0, all_bytes = 0;  // on the line: until the first picture, and all of the tour
  size_t pieces = 0;
  std::string title, language;  // of the tour
  std::string element_script;   // for other pages, in the site's folder
};

// Writes beside the folder first, and takes its place as a whole; a site that was there before is gone then. Errors: no
// such pack or a damaged one, no player, a folder that holds anything else, a full disk.
Error WriteSite(const SiteOptions& options, SiteResult* result);

}  // namespace flaneur
