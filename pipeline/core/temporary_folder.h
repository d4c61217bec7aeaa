// A folder that is gone, with all in it, when its owner goes out of scope.
#pragma once
#include <filesystem>
#include <mutex>
#include <string>

#include "runtime/base/error.h"

namespace flaneur {

// Removes what processes that were killed have left in `folder`. What living ones, and other machines, have there
// stays.
void SweepLeftovers(const std::filesystem::path& folder);

// Of this process, all; nobody makes new ones then. For who ends it in the middle of its work.
void RemoveTemporaryFolders();
// Held while what is in temporary folders is in use under other names.
std::recursive_mutex& TemporaryFoldersMutex();

class TemporaryFolder {
 public:
  TemporaryFolder() = default;
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  // Makes a new folder, readable by this user alone, inside `parent`, or inside the system's folder
  // for temporary files (environment variable TMPDIR, else /tmp) where that is empty. Its name says whose it is. What
  // killed processes have left beside it goes.
  // Errors: missing parent, no permission, disk full.
  Error Create(const std::string& prefix, const std::filesystem::path& parent = {});

  // From now on it stays, until somebody sweeps after this process has ended.
  void Keep();

  const std::filesystem::path& path() const { return path_; }  // empty before Create

 private:
  std::filesystem::path path_;
};

}  // namespace flaneur
