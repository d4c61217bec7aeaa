// The results of a bake: files of one folder that belong together, and so are replaced together.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/core/temporary_folder.h"
#include "runtime/base/error.h"

namespace flaneur {

inline constexpr const char* kManifest = "manifest.json";

// One process at a time in a folder of results.
class FolderLock {
 public:
  FolderLock() = default;
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

  // Waits, and says so once, where another process has it. Errors: interrupted. A file system without locks gives it.
  Error Take(const std::filesystem::path& folder);

 private:
  int descriptor_ = -1;
};

// Finishes, or takes back, what a killed process was about to replace, and removes what it left. Under the lock.
void RecoverResults(const std::filesystem::path& folder);

// The files `names` of the folder `staging`, which lies in `folder`, take their places in `folder` in one moment:
// whoever looks in between, even after a kill or a power cut, sees all earlier or all new ones. Those of `names` that
// staging lacks go. Where the file system knows no links, one comes after the other, the last name last. Under the
// lock. Errors: no permission, disk full; then all is as before.
Error ReplaceTogether(const std::filesystem::path& folder, TemporaryFolder* staging,
                      const std::vector<std::string>& names);

// Writes staging/manifest.json: the key of what was made, and size and SHA-256 of each of these files.
Error WriteManifest(const std::filesystem::path& staging, const std::string& key,
                    const std::vector<std::string>& names);

// The manifest of `folder`, with what `staging` has under these names in the place of what was there.
Error UpdateManifest(const std::filesystem::path& folder, const std::filesystem::path& staging,
                     const std::vector<std::string>& names);

// Whether the folder holds, byte for byte, what its manifest says was made under this key.
bool ResultsAreWhole(const std::filesystem::path& folder, const std::string& key);

// The names of its manifest; none where it has none.
std::vector<std::string> ResultNames(const std::filesystem::path& folder);

}  // namespace flaneur
