// What a kiosk has to do with files while it runs. Internal to runtime/desktop.
#pragma once
#include <filesystem>

#include "runtime/visit/kiosk_settings.h"
#include "runtime/visit/visit_log.h"

namespace flaneur {

// Into the folder that the settings name, else the usual one; nowhere where they want no statistics.
class VisitLogFile : public VisitLog {
 public:
  explicit VisitLogFile(const KioskSettings& settings);
  Error Note(const VisitRecord& visit) override;

 private:
  std::filesystem::path folder_;
};

// Whether another pack lies where the one that is played came from.
class PackWatch {
 public:
  explicit PackWatch(std::filesystem::path path);
  // Looks every few seconds. True once a new file has been there for a while, and is a pack that can be opened; one
  // that is not is warned of once.
  bool IsReplaced(double now_s);

 private:
  struct Mark {
    std::filesystem::file_time_type written{};
    std::uintmax_t bytes = 0;
    bool operator==(const Mark&) const = default;
  };
  Mark Look() const;

  std::filesystem::path path_;
  Mark played_, seen_;
  double looked_s_ = 0, seen_s_ = 0;
};

}  // namespace flaneur
