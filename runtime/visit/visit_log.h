// What a kiosk keeps of each visit: when, how long, in which language, how much of the tour. Nothing of who it was.
#pragma once
#include <ctime>
#include <filesystem>
#include <string>

#include "runtime/base/error.h"

namespace flaneur {

struct VisitRecord {
  std::time_t began = 0;
  float length_s = 0;  // until the last touch, or as long as the tour led
  std::string language;
  size_t stops_reached = 0, stops = 0;  // of those that one rests at
};

// Who keeps them.
class VisitLog {
 public:
  virtual ~VisitLog() = default;
  virtual Error Note(const VisitRecord& visit) = 0;
};

// One line at the end of FOLDER/visits.csv, on the disk when it returns. A line that a power cut left unfinished is
// taken away first. From kMostVisitLog_bytes on the file becomes visits.1.csv, that one visits.2.csv, and so on; the
// oldest of kOldLogs goes. Errors: what the system says.
inline constexpr std::uintmax_t kMostVisitLog_bytes = 1000000;
inline constexpr int kOldLogs = 4;
Error AppendVisit(const std::filesystem::path& folder, const VisitRecord& visit);

// $XDG_STATE_HOME/flaneur, else ~/.local/state/flaneur; empty where neither is known.
std::filesystem::path VisitLogFolder();

}  // namespace flaneur
