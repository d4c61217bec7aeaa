// A folder that is gone, with all in it, when its owner goes out of scope.
#pragma once
#include <filesystem>
#include <string>

#include "runtime/base/error.h"

namespace flaneur {

class TemporaryFolder {
 public:
  TemporaryFolder() = default;
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();

  // Makes a new folder, readable by this user alone, inside `parent`, or inside the system's folder
  // for temporary files (environment variable TMPDIR, else /tmp) where that is empty.
  // Errors: missing parent, no permission, disk full.
  Error Create(const std::string& prefix, const std::filesystem::path& parent = {});

  const std::filesystem::path& path() const { return path_; }  // empty before Create

 private:
  std::filesystem::path path_;
};

}  // namespace flaneur
