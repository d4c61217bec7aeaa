// What a bake did: report.json for programs, report.html for people.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/core/avatar.h"
#include "runtime/base/error.h"
#include "runtime/base/math.h"

namespace flaneur {

struct StageReport {
  std::string stage, item;
  double seconds = 0;  // of the clock, in this bake
  double work_s = 0;   // of processors, when it was made
  bool cached = false;
  double peak_mb = 0;  // of the child process that did the work, else of this one so far
  std::vector<std::pair<std::string, double>> figures;     // further numbers, by their key in report.json
  std::vector<AvatarLevel> levels;                         // an avatar's, without geometry
  std::vector<uint8_t> picture_png;                        // shown in report.html; may be empty
  std::vector<std::pair<std::string, std::string>> notes;  // what report.html says besides: a word and a text
};

// Of the guided tour.
struct ReportStop {
  Vec2 position_m;
  std::map<std::string, std::string> captions;  // by language
};

// What the check found, see docs/findings.md.
struct ReportFinding {
  int code = 0;
  std::string severity, title, feature, message, advice;
  Vec2 at_m;
};

struct BakeReport {
  std::string tour;
  std::vector<StageReport> stages;
  std::string pack_path;
  size_t pack_bytes = 0;
  std::string map_svg;  // the town's plan, inline in the HTML; may be empty
  std::vector<ReportFinding> findings;
  std::vector<ReportStop> stops;
  std::vector<std::string> warnings;
};

// Writes report.json and report.html into the folder. Errors: as for WriteFile.
Error WriteReport(const std::filesystem::path& folder, const BakeReport& report);

// A tour in the report over many.
struct TourRow {
  std::string name, state, error, report;  // report: where it is, from the page's folder
  double pack_mb = 0, work_s = 0;
  size_t warnings = 0, errors_found = 0;
};
std::string ToursHtml(const std::vector<TourRow>& tours);

// The page as text: needs no other file.
std::string ReportHtml(const BakeReport& report);

}  // namespace flaneur
