// Whether a tour may do what a stranger's must not: run scripts, and read files outside its own folder. Internal to
// pipeline/cli.
#pragma once
#include <filesystem>

#include "pipeline/cli/tour_settings.h"
#include "runtime/base/error.h"

namespace flaneur {

struct Trust {
  bool scripts = false;  // .py sources may run
  bool outside = false;  // files outside the tour's folder may be read
};

// Flaneur's own scripts and files may always be used. All else that is a script or lies outside the tour's folder needs
// `trust`, or a tour in a folder that the user has trusted before: on a terminal the user is asked, once and for all.
// Errors: it was refused; names the line of tour.toml, and the option.
Error CheckTrust(const std::filesystem::path& tour, const TourSettings& settings, const Trust& trust);

// Whether a model (glTF; others name no files that are read) names only files that may be read. Errors: names the file.
Error CheckFilesOfModel(const std::filesystem::path& model);

// The file that holds the trusted folders, one a line. Empty: there is no home for it.
std::filesystem::path TrustedFoldersFile();

}  // namespace flaneur
