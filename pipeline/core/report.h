// What a bake did: report.json for programs, report.html for people.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"

namespace flaneur {

struct StageReport {
  std::string stage, item;
  double seconds = 0;
  bool cached = false;
  double peak_mb = 0;  // of the child process that did the work, else of this one so far
  std::vector<std::pair<std::string, double>> figures;  // further numbers, by their key in report.json
  std::vector<AvatarLevel> levels;                      // an avatar's, without geometry
  std::string picture_png;                              // path, relative to the report; may be empty
};

struct BakeReport {
  std::string tour;
  std::vector<StageReport> stages;
  std::string pack_path;
  size_t pack_bytes = 0;
  std::string map_svg;  // the town's plan, inline in the HTML; may be empty
  std::vector<std::string> warnings;
};

// Writes report.json and report.html into the folder. Errors: as for WriteFile.
Error WriteReport(const std::filesystem::path& folder, const BakeReport& report);

}  // namespace flaneur
